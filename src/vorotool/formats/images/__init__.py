"""Images: readers and writers, whole and by bands of rows."""
