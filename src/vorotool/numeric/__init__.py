"""What all rooms share: ragged arrays, curves, exact functions, units, coordinate reference systems, threads."""
