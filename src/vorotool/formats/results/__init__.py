"""Writers of results, one module a kind; a reader of those that are read back."""
