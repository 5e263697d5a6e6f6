"""Sources, atomic outputs, stores, limits, disk space, row bands; knows no format."""
