"""Functions over all result types (scaled, table)."""
