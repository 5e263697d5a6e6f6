"""What other libraries have by other names; `vorotool.compat` gives it theirs."""

from vorotool.engines.delaunay.cells import voronoi_polygons
from vorotool.engines.peers.distance_transform import distance_transform, expand_labels
from vorotool.engines.peers.medial_axis import medial_axis

__all__ = ["distance_transform", "expand_labels", "medial_axis", "voronoi_polygons"]
