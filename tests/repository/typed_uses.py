"""Uses of the library that type checkers accept, and misuses that are errors: nothing here is run.

``test_types.py`` has mypy read it: what a line gives is asserted, and a misuse that is no error is one.
"""

# ruff: noqa: B018

from __future__ import annotations

from fractions import Fraction
from typing import Any, assert_type

import numpy as np
import numpy.typing as npt

import vorotool
from vorotool.engines import masks
from vorotool.engines.delaunay.cells import voronoi_polygons
from vorotool.typing import ImageLike, PointsLike, PolygonsLike

POINTS = [[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]]
ARRAY: npt.NDArray[np.float64] = np.zeros((3, 2))
MASK: npt.NDArray[np.bool_] = np.zeros((3, 4), np.bool_)


class Frame:
    """A data frame of some library."""

    columns = ("x", "y")

    def __getitem__(self, name: str) -> list[float]:
        """Give a column."""
        return [0.0]


class Feature:
    """A geometry of some library."""

    @property
    def __geo_interface__(self) -> dict[str, Any]:
        """A point."""
        return {"type": "Point", "coordinates": (0, 0)}


def handed_on(points: PointsLike, image: ImageLike, polygons: PolygonsLike) -> None:
    """Whatever has such a type is taken."""
    vorotool.delaunay(points)
    vorotool.tessellate(points)
    vorotool.tessellate(image)
    vorotool.outlines(image)
    vorotool.skeleton_exact(polygons)


def values() -> None:
    """Values have their types."""
    image = vorotool.tessellate(POINTS, shape=(4, 5), max_distance=Fraction(1, 3))
    assert_type(image, vorotool.LabelImage)
    image.labels.dtype
    assert_type(vorotool.region_table(image), vorotool.Table)
    assert_type(vorotool.seeds_from_raster(MASK, mode="components", threshold="otsu"), vorotool.SeedSet)
    mesh = vorotool.delaunay(ARRAY)
    assert_type(mesh, vorotool.Triangulation)
    assert_type(mesh.points, npt.NDArray[np.float64])
    assert_type(vorotool.voronoi_cells(mesh, frame=(0, 0, 4, 4), clip=Feature()), vorotool.CellSet)
    assert_type(vorotool.delaunay(Frame()), vorotool.Triangulation)
    assert_type(vorotool.delaunay([Feature(), Feature()]), vorotool.Triangulation)
    skeleton = vorotool.skeleton_exact({"type": "Polygon", "coordinates": []}, side="both")
    assert_type(skeleton, vorotool.Skeleton)
    assert_type(vorotool.prune(skeleton, scale=1.5), vorotool.Skeleton)
    assert_type(vorotool.offset(skeleton, [-1, 2.5], features="together"), vorotool.Offsets)
    assert_type(vorotool.alpha_shape(vorotool.alpha_complex(mesh), r=2, rule="printed"), vorotool.AlphaShape)
    assert_type(vorotool.outlines(MASK, outline="contour"), vorotool.PolygonSet)
    assert_type(vorotool.to_geojson(mesh), dict[str, Any])
    assert_type(mesh.table(), vorotool.Table)
    assert_type(vorotool.__version__, str)
    read = vorotool.read("a.csv", geometry="points")
    assert_type(
        read,
        vorotool.PointSet
        | vorotool.PolygonSet
        | vorotool.Raster
        | vorotool.Skeleton
        | vorotool.Offsets
        | vorotool.VoronoiMap,
    )
    assert_type(vorotool.read("a.tif", geometry="volume"), vorotool.Volume)
    assert_type(vorotool.read("a.csv", geometry="space"), vorotool.VolumePoints)


def results_by_arguments() -> None:
    """Some results depend on an argument."""
    assert_type(masks.distance_transform(MASK), npt.NDArray[np.float64])
    assert_type(masks.distance_transform(MASK, return_distances=False, return_indices=True), npt.NDArray[np.int32])
    distances, indices = masks.distance_transform(MASK, spacing=(2, 0.5), return_indices=True)
    assert_type(distances, npt.NDArray[np.float64])
    assert_type(indices, npt.NDArray[np.int32])
    assert_type(vorotool.tessellate([[1, 1]], shape=(3, 3)), vorotool.LabelImage)
    assert_type(vorotool.tessellate([[1, 1, 1]], shape=(3, 3, 3)), vorotool.LabelVolume)
    assert_type(vorotool.tessellate([[1, 1, 1]], window=(0, 0, 0, 3, 3, 3)), vorotool.LabelVolume)
    assert_type(vorotool.tessellate(vorotool.VolumePoints(np.ones((1, 3)))), vorotool.LabelVolume)
    assert_type(vorotool.delaunay(vorotool.VolumePoints(np.ones((1, 3)))), vorotool.Tetrahedralization)
    assert_type(vorotool.alpha_complex(vorotool.VolumePoints(np.ones((2, 3)))), vorotool.SpaceAlphaComplex)
    assert_type(vorotool.alpha_shape(vorotool.VolumePoints(np.ones((2, 3))), r=1), vorotool.SpaceAlphaShape)
    assert_type(masks.medial_axis(MASK), npt.NDArray[np.bool_])
    assert_type(masks.medial_axis(MASK, return_distance=True), tuple[npt.NDArray[np.bool_], npt.NDArray[np.float64]])


def misuses() -> None:
    """Each is an error."""
    mesh, skeleton = vorotool.delaunay(POINTS), vorotool.skeleton_exact(POINTS)
    vorotool.tessellate([[1, 1]], shap=(3, 3))  # type: ignore[call-overload]
    vorotool.tessellate([[1, 1]], shape=3)  # type: ignore[call-overload]
    vorotool.tessellate([[1, 1]], method="fast")  # type: ignore[call-overload]
    vorotool.tessellate()  # type: ignore[call-overload]
    vorotool.delaunay(None)  # type: ignore[call-overload]
    vorotool.delaunay(POINTS, True)  # type: ignore[call-overload]
    vorotool.delauney(POINTS)  # type: ignore[attr-defined]
    mesh.triangle  # type: ignore[attr-defined]
    mesh.points = ARRAY  # type: ignore[misc]
    vorotool.seeds_from_raster(MASK, mode="label")  # type: ignore[arg-type]
    vorotool.outlines(MASK, outline="cracks")  # type: ignore[arg-type]
    vorotool.skeleton_exact(POINTS, side="inside")  # type: ignore[arg-type]
    vorotool.skeleton_exact(object())  # type: ignore[arg-type]
    vorotool.skeleton_approx(POINTS, sampling="both")  # type: ignore[arg-type]
    vorotool.offset(POINTS, "1")  # type: ignore[arg-type]
    vorotool.offset(POINTS, 1, features=True)  # type: ignore[arg-type]
    vorotool.alpha_shape(POINTS, rule="wrong")  # type: ignore[call-overload]
    vorotool.alpha_shape(POINTS, r="auto")  # type: ignore[call-overload]
    vorotool.critical_values(skeleton, "width")  # type: ignore[arg-type]
    vorotool.prune(mesh)  # type: ignore[arg-type]
    vorotool.prune(skeleton, scale="1.5")  # type: ignore[arg-type]
    vorotool.centerline(skeleton, ends="round")  # type: ignore[arg-type]
    vorotool.read("a.csv", geometry="lines")  # type: ignore[call-overload]
    vorotool.read(3)  # type: ignore[call-overload]
    vorotool.write(mesh)  # type: ignore[call-arg]
    voronoi_polygons(POINTS, extend_to=4)  # type: ignore[arg-type]
    masks.expand_labels(MASK, "far")  # type: ignore[arg-type]
    masks.distance_transform(MASK, return_indices=1)  # type: ignore[call-overload]
