"""What counts from 0 and what from 1, as the reference of the library states it."""

import io

import numpy as np
import pytest

import vorotool
from support.readers.written import bytes_of
from vorotool.products.registry import parts_of, write_product

MESH = vorotool.delaunay([[0, 0], [4, 0], [0, 3], [5, 5]])
SKELETON = vorotool.skeleton_exact([[0, 0], [4, 0], [0, 3]])
IMAGE = vorotool.tessellate([[0, 0], [2, 1]], shape=(2, 3))
SHAPE = vorotool.alpha_shape(MESH.points, r=3)


def written(value, what, fmt):
    return bytes_of(write_product, value, parts_of(value)[what], fmt)


def test_index_arrays_of_values_count_from_0():
    assert MESH.edges.min() == MESH.triangles.min() == MESH.hull.min() == 0
    assert SHAPE.edges.min() == SKELETON.arcs.min() == SKELETON.polygon.min() == 0
    assert SKELETON.sites.max() == len(SKELETON.site_table) - 1


def test_labels_count_from_1_and_0_is_none():
    assert sorted(set(IMAGE.labels.ravel().tolist())) == [1, 2]
    far = vorotool.tessellate([[0, 0]], shape=(1, 9), max_distance=2)
    assert far.labels.tolist() == [[1, 1, 1, 0, 0, 0, 0, 0, 0]]


@pytest.mark.parametrize(
    "table",
    [
        vorotool.edge_table(MESH),
        vorotool.triangle_table(MESH),
        vorotool.point_table(MESH),
        vorotool.site_table(MESH),
        vorotool.region_table(IMAGE),
        vorotool.neighbor_table(IMAGE),
        vorotool.arc_table(SKELETON),
        vorotool.branch_table(SKELETON),
        vorotool.polygon_table(SKELETON),
        vorotool.element_table(SKELETON),
    ],
)
def test_columns_of_labels_count_from_1_and_all_others_from_0(table):
    assert table.table() == table
    for name, values in table.items():
        if "label" in name:
            assert np.ma.compressed(values).min(initial=1) == 1, name
        elif name in ("source_index", "arc", "branch", "element"):
            assert values.min() == 0, name


@pytest.mark.parametrize(("what", "expected"), [("edges", MESH.edges + 1), ("triangles", MESH.triangles + 1)])
def test_npz_has_the_columns_of_the_tables(what, expected):
    with np.load(io.BytesIO(written(MESH, what, "npz"))) as arrays:
        assert np.array_equal(np.stack([arrays[name] for name in arrays if name.startswith("label")], axis=1), expected)
