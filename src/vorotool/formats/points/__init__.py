"""Point readers, one module a format."""
