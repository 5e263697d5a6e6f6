"""What callers hold: made into values, and values into shapely geometry, data frames and graphs."""
