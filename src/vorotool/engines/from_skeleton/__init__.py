"""Results derived from a skeleton: nearest points, points along branches, rebuilt shapes."""
