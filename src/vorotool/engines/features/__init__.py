"""Features of polygons taken one by one: batches of them, and their order."""
