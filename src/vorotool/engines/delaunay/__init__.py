"""Points -> triangulation, cells, Voronoi edges."""
