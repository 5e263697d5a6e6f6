"""Image readers and writers, whole and by bands."""
