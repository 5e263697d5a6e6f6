"""The public values: each declares its fields once, and gives its rows, its features and its tables."""
