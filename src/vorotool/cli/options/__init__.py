"""Parameter types and option groups."""
