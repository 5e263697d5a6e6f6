"""Label arrays, point input, progress, parallel parts."""
