"""Plain arrays of results as NPY: those of the library, the same as the other formats have, and read back as points."""

import io

import numpy as np
import pytest
from scipy.spatial import Delaunay

import vorotool
from support.readers.written import rows_of, written
from support.refusals import refused
from vorotool.errors import UsageError

XY = np.random.default_rng(8).integers(0, 60, (40, 2)).astype(float)


def array(value, what):
    return np.load(io.BytesIO(written(value, "npy", what)))


def unordered(rows):
    return {tuple(sorted(row)) for row in rows.tolist()}


def test_triangles_and_edges_are_those_of_scipy():
    points = np.random.default_rng(9).random((50, 2))
    mesh, peer = vorotool.delaunay(points), Delaunay(points)
    triangles = array(mesh, "triangles")
    assert (triangles.dtype, triangles.shape) == (np.dtype("<i4"), (len(peer.simplices), 3))
    assert unordered(triangles) == unordered(peer.simplices)
    edges = array(mesh, "edges")
    assert unordered(edges) == {pair for row in peer.simplices for pair in unordered(row[[[0, 1], [1, 2], [0, 2]]])}


@pytest.mark.parametrize("what", ["edges", "complex"])
def test_edges_of_shapes(what):
    shape = vorotool.alpha_shape(XY, r=8)
    labels = [[int(row["label_a"]), int(row["label_b"])] for row in rows_of(written(shape, "csv", what))]
    assert len(labels) > 4
    assert (array(shape, what) + 1).tolist() == labels


def test_radii_of_the_spectrum():
    family = vorotool.alpha_complex(XY)
    radii = [float(row["r"]) for row in rows_of(written(family, "csv", "spectrum"))]
    assert array(family, "spectrum").tolist() == radii
    assert array(family, "spectrum").dtype == np.dtype("<f8")


@pytest.mark.parametrize("what", ["table", "cells"])
def test_what_is_no_plain_array(what):
    value = vorotool.delaunay(XY) if what == "table" else vorotool.voronoi_cells(XY)
    refused(UsageError, "'npy'", written, value, "npy", what)
