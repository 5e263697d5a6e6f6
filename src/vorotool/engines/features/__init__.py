"""Features of polygons one by one: batches that do not change each other, and the order of the input."""
