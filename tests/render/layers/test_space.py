"""Pictures of triangulations in space: what is seen, and where."""

import re

import numpy as np
import pytest
import shapely

import vorotool
from support.documents import ROOT
from vorotool.render.canvas.layers import page_of
from vorotool.render.layers.mesh import seen, space_layers, surface_layers

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


def test_no_seams_between_faces_of_a_surface(tmp_path):
    shape = vorotool.alpha_shape(BALL, r=50)
    svg = tmp_path / "a.svg"
    for options, is_sealed in (({}, True), ({"layers": ["surface", "edges"]}, False)):
        vorotool.write(shape, svg, what="surface", **options)
        faces = re.search('<g id="surface"(.*?)</g>', svg.read_text(), re.DOTALL)[1]
        fills, strokes = (re.findall(f'<path[^>]* {name}="(#[0-9a-f]+)"', faces) for name in ("fill", "stroke"))
        assert len(fills) > 20
        assert strokes == (fills if is_sealed else [])
        assert ("stroke-width" in faces) == is_sealed


def test_the_knot_of_the_gallery_is_a_closed_tube():
    points = np.loadtxt(ROOT / "data/knot.xyz")
    shape = vorotool.alpha_shape(points, r=1.3)
    assert (shape.region_count, shape.cavity_count, shape.tunnel_count, len(shape.isolated)) == (1, 0, 1, 0)
    sides = np.sort(shape.surface[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    assert (np.unique(sides, axis=0, return_counts=True)[1] % 2 == 0).all()
    (faces,) = surface_layers(shape, page_of(shape), ["surface"])
    shown = shapely.polygons(seen(points)[faces.corners.reshape(-1, 3)])
    covered = shapely.union_all(shapely.polygons(seen(points)[shape.surface])).area
    assert shapely.union_all(shown).area == pytest.approx(covered)
    assert len(shown) < len(shape.surface)  # backs are not drawn


@pytest.mark.parametrize("scale", [1.0, 2.0**-600, 2.0**600])
def test_no_face_of_a_surface_is_drawn_over_one_in_front_of_it(scale):
    ball = np.random.default_rng(5).normal(size=(400, 3))
    for points, r in ((ball, 0.4), (ball * [1, 1, 0.05], 0.15)):  # the second has many slivers
        shape = vorotool.alpha_shape(points * scale, r=r * scale)
        (faces,) = surface_layers(shape, page_of(shape), ["surface"])
        corners = points[faces.corners.reshape(-1, 3)]
        shown = shapely.polygons(seen(corners.reshape(-1, 3)).reshape(-1, 3, 2))
        below, above = shapely.STRtree(shown).query(shown, predicate="overlaps")
        below, above = below[below < above], above[below < above]
        both = shapely.intersection(shown[below], shown[above])
        is_wide = shapely.area(both) > 1e-6
        assert is_wide.sum() > 100
        places = shapely.get_coordinates(shapely.centroid(both[is_wide]))
        depths = [_depth(corners[rows[is_wide]], places) for rows in (below, above)]
        assert (depths[1] - depths[0] > -1e-9).all()


def _depth(corners, places):
    """Give how near each place of the page on a triangle is to the viewer."""
    right, up = seen(np.eye(3)).T
    xy, near = seen(corners.reshape(-1, 3)).reshape(-1, 3, 2), corners @ np.cross(right, up)
    equations = np.concatenate([xy, np.ones((len(xy), 3, 1))], axis=2)
    plane = np.linalg.solve(equations, near[:, :, None])[:, :, 0]
    return (plane * np.column_stack([places, np.ones(len(places))])).sum(axis=1)
