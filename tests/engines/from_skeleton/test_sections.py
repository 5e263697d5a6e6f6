"""Places and sections along centerlines: at equal steps from end to end, straight across, up to the outline."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

from support.few import few
from vorotool import VerificationError, centerline, extend_ends, points_along, prune, skeleton_exact
from vorotool.engines.from_skeleton.points_along import verify_sections
from vorotool.engines.skeleton.clearance import SitePlaces

CURVE = shapely.LineString([(x, 3 * np.sin(x / 4)) for x in np.linspace(0, 30, 120)])
ROAD = CURVE.buffer(1, cap_style="flat")
CROSSING = shapely.LineString([(-20, 0), (20, 0)]).buffer(1).union(shapely.LineString([(0, 0), (3, 15)]).buffer(0.8))
ISLAND = shapely.box(0, 0, 20, 4).difference(shapely.Point(9, 1.7).buffer(0.8))
SHAPES = {
    "road": ROAD,
    "crossing": CROSSING,
    "island": ISLAND,
    "box": shapely.box(0.1, 0.1, 8.3, 2.2),
    "arrow": shapely.Polygon([(1.3, 0.1), (2.9, 0.7), (1.3, 2.3), (1.7, 0.9)]),
}


def wide(shape, scale=1.3):
    return prune(skeleton_exact(shape), scale=scale)


EVERY, ENDS = [0.41, 1, 100], ["middle", "corner", "none"]
PAIRS_FIRST = [
    (name, end, EVERY[(k + i + turn) % 3])
    for turn in range(3)
    for k, name in enumerate(SHAPES)
    for i, end in enumerate(ENDS)
]


@pytest.mark.parametrize(("name", "ends", "every"), few(PAIRS_FIRST, len(SHAPES) * len(ENDS)))
def test_steps_go_on_from_end_to_end(name, ends, every):
    lines = centerline(wide(SHAPES[name]), ends=ends)
    points = points_along(lines, every=every)
    assert points.along.tolist() == [every * k for k in range(int(lines.length[0] / every) + 1)]
    verify_sections(points, lines, every)
    line = lines.to_shapely()[0]
    places = shapely.line_interpolate_point(shapely.LineString(lines.flattened(1e-7)[0]), points.along)
    assert shapely.distance(places, shapely.points(points.xy)).max() < 1e-5
    first, last = (shapely.Point(line.coords[k]) for k in (0, -1))
    assert first.distance(shapely.Point(points.xy[0])) == 0
    assert last.distance(shapely.Point(points.xy[-1])) <= every


@pytest.mark.parametrize("seed", few(range(6), 2))
def test_feet_are_the_first_crossings_of_the_outline(seed):
    random = np.random.default_rng(seed)
    angle = np.sort(random.uniform(0, 2 * np.pi, 60))
    radius = 100 + 30 * np.sin(5 * angle) + random.normal(0, 4, 60)
    shape = shapely.Polygon(np.column_stack([radius * np.cos(angle), radius * np.sin(angle)]))
    shape = shape.difference(shapely.Point(random.uniform(-30, 30, 2)).buffer(8))
    for lines in (centerline(wide(shape, 1.5)), extend_ends(wide(shape, 1.2))):
        points = points_along(lines, every=7.3)
        verify_sections(points, lines, 7.3)
        kept = points.transects()
        assert len(kept) > len(points) / 2
        for xy, feet, rings, width in zip(kept.xy, kept.feet, kept.rings, kept.width, strict=True):
            assert width == pytest.approx(np.hypot(*(feet[1] - feet[0])))
            for foot, ring in zip(feet, rings, strict=True):
                way = (foot - xy) / np.hypot(*(foot - xy))
                ray = shapely.LineString([xy, xy + 500 * way])
                first = shapely.Point(xy).distance(ray.intersection(shape.boundary))
                assert first == pytest.approx(np.hypot(*(foot - xy)), rel=1e-6, abs=1e-6)
                outline = [shape.exterior, *shape.interiors][ring]
                assert outline.distance(shapely.Point(foot)) < 1e-6


@pytest.mark.filterwarnings("ignore::vorotool.errors.VorotoolWarning")
def test_features_together_end_sections_at_each_other():
    room, table = shapely.box(0, 0, 20, 4), shapely.box(9, 1, 11, 2)
    alone, both = (
        points_along(centerline(prune(skeleton_exact([room, table], features=features), scale=1.5)), every=1)
        for features in ("separate", "together")
    )
    assert alone.width[alone.polygon == 0].max() == pytest.approx(4)
    near = (both.xy[:, 0] > 9.2) & (both.xy[:, 0] < 10.8) & (both.radius > 0)
    assert near.any()
    assert both.width[near].max() < 3


@pytest.mark.parametrize("name", ["road", "island"])
def test_what_is_changed_is_refused(name):
    lines = centerline(wide(SHAPES[name]))
    points = points_along(lines, every=1)
    middle = len(points) // 2
    turn = np.array([[0.98, 0.2], [-0.2, 0.98]])

    def changed(field, change):
        values = getattr(points, field).copy()
        change(values)
        return replace(points, **{field: values})

    def turned(feet):
        feet[middle] = points.xy[middle] + (feet[middle] - points.xy[middle]) @ turn

    def moved(xy):
        xy[middle] += 0.01

    def swapped(feet):
        feet[middle] = feet[middle, ::-1].copy()

    def lengthened(feet):
        feet[middle, 0] += feet[middle, 0] - feet[middle, 1]

    def later(along):
        along[middle] += 1e-9

    wrong = [changed("feet", each) for each in (turned, swapped, lengthened)]
    wrong += [changed("xy", moved), changed("along", later)]
    for each in wrong:
        with pytest.raises(VerificationError):
            verify_sections(each, lines, 1)
    with pytest.raises(VerificationError):
        verify_sections(points, lines, 1.5)


SQUARE = [[0, 0], [4, 0], [4, 4], [0, 4]]


def star(count, seed):
    random = np.random.default_rng(seed)
    angle = np.sort(random.uniform(0, 2 * np.pi, count))
    radius = 100 + 30 * np.sin(5 * angle) + random.normal(0, 2, count)
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])


SKELETONS = {
    "rectangle": lambda: skeleton_exact([[0, 0], [8, 0], [8, 2], [0, 2]]),
    "star": lambda: skeleton_exact(star(200, 1)),
    "pruned": lambda: prune(skeleton_exact(star(200, 2)), angle=50),
    "outside": lambda: skeleton_exact(star(100, 3), side="both", frame=(-200, -200, 400, 400)),
    "gap": lambda: skeleton_exact(star(60, 4), gap=0.001),
    "several": lambda: skeleton_exact([SQUARE, star(50, 5)]),
}


def steps(skeleton, every):
    """The arc of each point, its way along the branch, and that along the arc."""
    whole = np.concatenate([[0.0], np.cumsum(skeleton.length)])
    start = np.flatnonzero(np.diff(skeleton.branch, prepend=-1))
    arcs, alongs, parts = [], [], []
    for first, end in zip(start, [*start[1:], len(skeleton)], strict=True):
        count = int(np.floor(np.add.reduceat(skeleton.length, start)[list(start).index(first)] / every)) + 1
        for along in every * np.arange(count):
            reached = whole[first] + along
            arc = min(max(int(np.searchsorted(whole, reached, side="right")) - 1, first), end - 1)
            arcs.append(arc)
            alongs.append(along)
            parts.append(min(max(along - (whole[arc] - whole[first]), 0), skeleton.length[arc]))
    return np.array(arcs), np.array(alongs), np.array(parts)


@pytest.mark.parametrize("name", SKELETONS)
@pytest.mark.parametrize("parts", [3.0, 101.0, 1500.0])
def test_steps_are_those_of_the_formulas(name, parts):
    skeleton = SKELETONS[name]()
    every = float(skeleton.length.sum()) / parts
    arc, along, within = steps(skeleton, every)
    measures = skeleton.measures(arc)
    u = measures.parameter(within)
    xy, radius = measures.place(u), measures.radius(u)
    sites = SitePlaces(skeleton)
    feet = np.stack([sites.feet(skeleton.sites[arc, hand], xy) for hand in (0, 1)], axis=1)
    for threads in (1, 3):
        found = points_along(skeleton, every=every, threads=threads)
        for ours, theirs in ((found.arc, arc), (found.along, along), (found.xy, xy), (found.radius, radius)):
            assert ours.tobytes() == theirs.astype(ours.dtype).tobytes()
        assert found.feet.tobytes() == feet.tobytes()
