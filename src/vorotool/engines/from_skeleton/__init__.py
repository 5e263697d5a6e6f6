"""What follows from a skeleton: nearest points, points along branches, rebuilt shapes."""
