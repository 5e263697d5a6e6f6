"""One value of each public type, with attributes, an index and a reference system where it has them; and empty ones."""

import warnings
from dataclasses import replace
from functools import cache, wraps

import numpy as np
import pandas

import vorotool
from vorotool.numeric.crs import crs_member

CRS = "EPSG:2056"
ARCS = ("arcs", "control", "sites", "polygon", "side", "branch", "length", "error_bound")
NOT_VALUES = {"PlacePair", "Box", "Frame", "PixelGrid", "VoxelFrame", "VoxelGrid"}
"""Small records of numbers, which are dataclasses as Python has them."""


def without_warnings(function):
    """Make values of what is repaired or noted without a word."""

    @wraps(function)
    def called():
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", vorotool.VorotoolWarning)
            return function()

    return called


def point_set(count=12, seed=3):
    """Random points with columns, an index with a name, and a reference system; one is a duplicate."""
    xy = np.random.default_rng(seed).integers(0, 100, (count, 2)).astype(float)
    xy[-1] = xy[0]
    names = [chr(97 + k) for k in range(count)]
    index = pandas.Index(np.arange(100, 100 + count), name="station")
    return vorotool.PointSet(xy, properties={"name": names}, y_axis="up", crs=crs_member(CRS), index=index)


def polygon_set():
    """A polygon with a hole, one of two parts, and a line; rows 7, 8, 8 and 9 of a data frame."""
    shapes = vorotool.PolygonSet(
        [*_square(0, 0, 20), *_square(4, 4, 3), *_square(30, 0, 6), *_square(40, 0, 9), (0, 30), (10, 30), (12, 40)],
        [0, 4, 8, 12, 16, 19],
        [0, 1, 0, 0, 2],
        [0, 0, 1, 2, 3],
        ids=["p", "q", "q", "r"],
        feature=[0, 1, 1, 2],
        properties={"depth": [1, 2, 2, None]},
        crs=crs_member(CRS),
        y_axis="up",
        index=pandas.Index([7, 8, 8, 9], name="row"),
    )
    return shapes


def _square(x, y, side):
    return [(x, y), (x + side, y), (x + side, y + side), (x, y + side)]


def label_image():
    """A tessellation of points with columns."""
    xy = np.random.default_rng(7).permutation(30 * 40)[:9]
    points = vorotool.PointSet(np.stack([xy % 40, xy // 40], axis=1), properties={"name": list("abcdefghi")})
    return vorotool.tessellate(vorotool.seeds_from_points(points), shape=(30, 40))


@cache
@without_warnings
def example_values():
    """Give a value of each public type of values by its name."""
    points, polygons, image = point_set(), polygon_set(), label_image()
    mesh = vorotool.delaunay(points)
    shape = vorotool.alpha_shape(mesh, r=30)
    skeleton = vorotool.skeleton_exact(polygons)
    return {
        "PointSet": points,
        "PolygonSet": polygons,
        "SeedSet": image.seeds,
        "LabelImage": image,
        "Raster": vorotool.Raster(np.random.default_rng(1).integers(0, 99, (9, 14)).astype(np.uint16)),
        "Table": vorotool.region_table(image),
        "Triangulation": mesh,
        "DigitalTriangulation": vorotool.digital_triangulation(image),
        "DigitalComparison": vorotool.compare_digital(image.seeds, shape=image.shape),
        "CellSet": vorotool.voronoi_cells(mesh),
        "AlphaComplex": shape.family,
        "AlphaShape": shape,
        "AlphaHull": vorotool.alpha_hull(shape),
        "PlanarGraph": vorotool.planar_graph(polygons),
        "Skeleton": skeleton,
        "CriticalValues": vorotool.critical_values(skeleton, "angle"),
        "Centerlines": vorotool.centerline(vorotool.prune(skeleton, angle=60)),
        "ExtendedSkeleton": vorotool.extend_ends(skeleton),
        "SmoothLines": vorotool.smooth(skeleton, 0.5),
        "SkeletonPoints": vorotool.points_along(skeleton, every=3),
        "Necks": vorotool.necks(skeleton),
        "Parts": vorotool.parts(skeleton, neck=1),
        "Offsets": vorotool.offset(polygons, [-1, 2]),
        "VoronoiMap": vorotool.voronoi(polygons),
        "Discs": vorotool.largest_discs(polygons, count=2),
        "Distances": vorotool.hausdorff(polygons, points),
        "ProximityGraph": vorotool.proximity_graph(mesh, "gabriel"),
        "CellStatistics": vorotool.cell_statistics(points),
        "RegionPersistence": vorotool.persistence(shape.family),
    }


@cache
def volume_values():
    """Give a value of each public type of volumes by its name."""
    points = vorotool.VolumePoints(np.random.default_rng(4).integers(0, 9, (6, 3)).astype(float))
    labels = vorotool.tessellate(points, shape=(7, 8, 9))
    return {
        "Volume": vorotool.Volume(labels.labels),
        "VolumePoints": points,
        "VolumeSeeds": labels.seeds,
        "LabelVolume": labels,
        "Tetrahedralization": vorotool.delaunay(points),
        "SpaceAlphaComplex": vorotool.alpha_complex(points),
        "SpaceAlphaShape": vorotool.alpha_shape(points, r=3),
        "SpaceCellSet": vorotool.voronoi_cells(points),
    }


@cache
@without_warnings
def empty_values():
    """Give values without anything in them, or with a single thing, by their names."""
    none = vorotool.PointSet(np.empty((0, 2)))
    no_polygons = vorotool.PolygonSet(np.empty((0, 2)), [0], [], [])
    one = vorotool.delaunay([[3, 4]])
    triangle = vorotool.skeleton_exact([[0, 0], [4, 0], [0, 3]])
    return {
        "no points": none,
        "one point": vorotool.PointSet([[3, 4]]),
        "mesh of none": vorotool.delaunay(none),
        "mesh of one": one,
        "cell of one": vorotool.voronoi_cells(one),
        "no polygons": no_polygons,
        "lines": vorotool.PolygonSet([[0, 0], [4, 0], [9, 9]], [0, 2, 3], [2, 2], [0, 1]),
        "no skeleton": replace(
            triangle,
            **{name: getattr(triangle, name)[:0] for name in (*ARCS, "vertices", "radius")},
        ),
        "no cells": vorotool.voronoi([]),
        "no labels": vorotool.LabelImage(np.zeros((3, 4), np.uint8)),
        "one pixel": vorotool.LabelImage(np.ones((1, 1), np.uint8)),
        "one grey": vorotool.Raster(np.full((2, 2), 7.5)),
        "no rows": vorotool.Table({"label": np.empty(0, np.int64)}),
        "no columns": vorotool.Table({}),
    }
