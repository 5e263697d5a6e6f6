"""What callers hold, made of values: geometry of shapely, data frames, graphs."""
