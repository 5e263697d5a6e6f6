"""Values: arrays and what follows from them by indexing. They know no files, no pictures, no engines."""
