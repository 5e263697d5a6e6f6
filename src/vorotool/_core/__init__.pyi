"""Compiled core of vorotool (private: use the functions of the package)."""

from vorotool._core import (
    alpha as alpha,
    arrangement as arrangement,
    cells as cells,
    cells_in_space as cells_in_space,
    compression as compression,
    delaunay as delaunay,
    digital as digital,
    distances as distances,
    graphs as graphs,
    kernel as kernel,
    label_images as label_images,
    offsets as offsets,
    proximity as proximity,
    pruning as pruning,
    sampled_skeleton as sampled_skeleton,
    segment_voronoi as segment_voronoi,
    skeleton as skeleton,
    spatial as spatial,
    tessellation as tessellation,
    tetrahedra as tetrahedra,
    tetrahedral_alpha as tetrahedral_alpha,
    text as text,
    thickness as thickness,
    volumes as volumes,
    voronoi as voronoi
)
