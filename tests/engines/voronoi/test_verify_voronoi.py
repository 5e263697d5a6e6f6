"""Every fault that a map may have is found."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from tests.support.families.site_families import row_houses

from vorotool import PolygonSet, verify_voronoi, voronoi
from vorotool.errors import VerificationError

SITES = [*row_houses(1, 3), shapely.Point(30, 5), shapely.LineString([(0, 20), (20, 22)]), shapely.box(5, 5, 8, 12)]


@pytest.fixture(scope="module")
def cells():
    made = voronoi(SITES)
    verify_voronoi(made)
    return made


def changed(cells, name, change):
    array = getattr(cells, name).copy()
    change(array)
    return replace(cells, **{name: array})


def swap(array):
    array[:] = array[::-1]


FAULTS = {
    "an arc that is turned": ("arcs", lambda a: a[:1].sort(axis=1) or swap(a[0])),
    "an arc that does not exist": ("ring_arcs", lambda a: a.__setitem__(0, 10**6)),
    "a ring against its cell": ("ring_arcs", lambda a: np.negative(a, out=a)),
    "a ring in another order": ("ring_arcs", lambda a: swap(a[:3])),
    "sides of another cell": ("sites", swap),
    "a radius": ("radius", lambda a: a.__imul__(1.01)),
    "a vertex": ("vertices", lambda a: a.__setitem__(0, a[0] + 1e-3)),
    "all vertices": ("vertices", lambda a: a.__iadd__(1)),
    "a control point": ("control", lambda a: a.__iadd__(0.1)),
}


@pytest.mark.parametrize("name", list(FAULTS))
def test_faults(cells, name):
    with pytest.raises(VerificationError):
        verify_voronoi(changed(cells, *FAULTS[name]))


def test_another_frame(cells):
    x, y, w, h = cells.frame
    with pytest.raises(VerificationError, match="the cells have an area"):
        verify_voronoi(replace(cells, frame=(x, y, w, h + 1)))


@pytest.mark.parametrize("far", [300.3, 30033.7])
def test_what_a_far_frame_moves_between_enclosures_is_no_fault(far):
    random = np.random.default_rng(0)
    sites, walls = random.random((20, 2)) * 10, shapely.Polygon(random.random((3, 2)) * 14 - 2)
    verify_voronoi(voronoi(sites, enclosures=walls, frame=(-far, -far, 2 * far, 2 * far)))


def test_another_order_of_ties():
    made = voronoi([shapely.box(0, 0, 6, 6), shapely.box(0, 0, 6, 9)])
    with pytest.raises(VerificationError, match="comes first"):
        verify_voronoi(exchanged(made))
    with pytest.raises(VerificationError, match="comes first"):
        verify_voronoi(
            exchanged(voronoi([shapely.LineString([(0, 0), (-8, -1)]), shapely.LineString([(0, 0), (-8, 1)])]))
        )


def exchanged(cells):
    """The cells of two sites in the other order."""
    half = len(cells.ring_arcs) - cells.ring_starts[cells.polygon_starts[cells.cell_starts[1]]]
    rings = np.roll(cells.ring_arcs, half)
    assert len(cells.ring_starts) == 3
    sites = np.where(cells.sites < 0, cells.sites, 1 - cells.sites)
    return replace(
        cells,
        ring_arcs=rings,
        ring_starts=[0, half, len(rings)],
        sites=sites,
        polygons=PolygonSet(
            np.concatenate([cells.polygons.ring(1), cells.polygons.ring(0)]),
            [0, len(cells.polygons.ring(1)), len(cells.polygons.xy)],
            cells.polygons.ring_kind,
            [0, 1],
        ),
    )


def test_another_site():
    made = voronoi([[0, 0], [4, 0]])
    with pytest.raises(VerificationError):
        verify_voronoi(replace(made, polygons=voronoi([[0, 0], [4.1, 0]]).polygons))
