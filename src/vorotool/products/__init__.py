"""What there is to write: formats, and the results that have a place in them. Nothing heavy is imported for it."""
