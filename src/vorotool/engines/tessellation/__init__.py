"""Image/seeds -> label image."""
