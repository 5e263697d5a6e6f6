"""Pictures of triangulations in space: what is seen, and where."""

import numpy as np
import pytest
import shapely

import vorotool
from vorotool.render.layers.pages import page_of
from vorotool.render.layers.space import seen, space_layers

RNG = np.random.default_rng(3)
BALL = RNG.normal(size=(80, 3)) * [3, 1, 2]


def test_the_view_is_a_projection():
    right, up = seen(np.eye(3)).T
    assert np.allclose([right @ right, up @ up, right @ up], [1, 1, 0])
    assert seen(np.array([[0.0, 0, 1]]))[0, 1] > 0  # z goes upwards


@pytest.mark.parametrize("scale", [1.0, 2.0**-600, 2.0**600])
def test_the_front_of_a_hull_covers_its_outline_once(scale):
    mesh = vorotool.delaunay(BALL * scale)
    (faces,) = space_layers(mesh, page_of(mesh), ["hull"])
    shown = shapely.polygons(seen(BALL)[faces.corners.reshape(-1, 3)])
    outline = shapely.convex_hull(shapely.multipoints(seen(BALL)))
    assert shapely.area(shown).sum() == pytest.approx(outline.area)
    assert shapely.union_all(shown).area == pytest.approx(outline.area)
    assert 0 <= faces.color_of.min() <= faces.color_of.max() < len(faces.colors)


def test_what_is_nearer_is_drawn_later():
    mesh = vorotool.delaunay(BALL)
    (faces,) = space_layers(mesh, page_of(mesh), ["hull"])
    right, up = seen(np.eye(3)).T
    depth = BALL[faces.corners.reshape(-1, 3)].mean(axis=1) @ np.cross(right, up)
    assert (np.diff(depth) >= -1e-12).all()


def test_pictures_show_the_highest_point_on_top(tmp_path):
    corner = vorotool.delaunay([[0, 0, 0], [4, 0, 0], [0, 3, 0], [1, 1, 5]])
    page = page_of(corner)
    assert page.place(seen(corner.points))[:, 1].argmin() == 3
    for name in ("a.svg", "a.png"):
        vorotool.write(corner, tmp_path / name, what="hull")
        assert (tmp_path / name).stat().st_size > 100
