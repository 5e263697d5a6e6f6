"""Smooth lines: within their tolerance both ways, with one tangent; closed forms, and made shapes."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

import vorotool
from support.few import few
from vorotool.numeric.curves.flatten import cubic_polylines, places_at
from vorotool.types.skeleton.lines import LedOn

ELL = [[0, 0], [60, 0], [60, 40], [50, 40], [50, 10], [0, 10]]


def blob(seed, corners=40, noise=2.0):
    random = np.random.default_rng(seed)
    angle = np.linspace(0, 2 * np.pi, corners, endpoint=False)
    radius = 60 + 15 * np.sin(3 * angle + seed) + random.normal(0, noise, corners)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)


def mask_of_strokes(seed, size=80):
    random = np.random.default_rng(seed)
    lines = [shapely.LineString(random.uniform(12, size - 12, (3, 2))).buffer(random.uniform(2, 5)) for _ in range(2)]
    rows, columns = np.mgrid[:size, :size]
    return shapely.contains_xy(shapely.union_all(lines), columns, rows)


def lines_of(seed):
    """Skeletons whole and pruned, with their ends, and centerlines; of polygons and of masks."""
    shape = blob(seed) if seed % 2 else vorotool.outlines(mask_of_strokes(seed))
    whole = vorotool.skeleton_exact(shape)
    pruned = vorotool.prune(whole, scale=1.5)
    yield from (whole, pruned, vorotool.extend_ends(pruned), vorotool.centerline(pruned))


def whole_lines(lines, tolerance):
    """Polylines of branches, with what leads on, found without the code under test."""
    path = lines.path if isinstance(lines, LedOn) else lines
    points, start = path.flattened(tolerance)
    made = []
    for branch in range(int(path.branch[-1]) + 1):
        arcs = np.flatnonzero(path.branch == branch)
        places = np.concatenate([points[start[arc] : start[arc + 1]] for arc in arcs])
        if isinstance(lines, LedOn):
            ends = lines.ends[branch]
            places = np.concatenate([ends[:1], places, ends[1:]])
        made.append(places[~np.isnan(places[:, 0])])
    return made


def dense(places, step):
    return shapely.get_coordinates(shapely.segmentize(shapely.LineString(places), step))


@pytest.mark.parametrize("seed", few(range(4), 1))
@pytest.mark.parametrize("tolerance", [3.0, 0.5, 0.05])
def test_no_place_is_farther_than_the_error(seed, tolerance):
    for lines in lines_of(seed):
        smoothed = vorotool.smooth(lines, tolerance)
        assert smoothed.error.max() <= tolerance
        fine = tolerance / 200
        curves, start = cubic_polylines(smoothed.control, fine)
        branches = whole_lines(lines, fine)
        assert len(branches) == len(smoothed)
        for line, places in enumerate(branches):
            own = np.flatnonzero(smoothed.line == line)
            fit = np.concatenate([curves[start[k] : start[k + 1]] for k in own])
            step = max(tolerance / 4, np.ptp(places, axis=0).max() / 100)
            allowed = smoothed.error[line] + 2 * fine + 1e-9
            for some, other in ((dense(fit, step), places), (dense(places, step), fit)):
                far = shapely.distance(shapely.points(some), shapely.LineString(other))
                assert far.max() <= allowed
        vorotool.verify_smooth(smoothed)


@pytest.mark.parametrize("seed", range(4))
def test_ends_stay_and_tangents_go_on(seed):
    for lines in lines_of(seed):
        smoothed = vorotool.smooth(lines, 0.4)
        for line, places in enumerate(whole_lines(lines, 1.0)):
            control = smoothed.control[smoothed.line == line]
            assert control[0, 0].tolist() == places[0].tolist()
            assert control[-1, 3].tolist() == places[-1].tolist()
            assert (control[1:, 0] == control[:-1, 3]).all()
            before, behind = control[:-1, 3] - control[:-1, 2], control[1:, 1] - control[1:, 0]
            cross = before[:, 0] * behind[:, 1] - before[:, 1] * behind[:, 0]
            size = np.hypot(*before.T) * np.hypot(*behind.T)
            assert (np.abs(cross) <= 1e-6 * size).all()
            assert ((before * behind).sum(axis=1) > 0).all()


def test_closed_branches_have_one_tangent_all_around():
    angle = np.linspace(0, 2 * np.pi, 64, endpoint=False)
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    ring = vorotool.PolygonSet(np.concatenate([9 * circle, 6 * circle[::-1]]), [0, 64, 128], [0, 1], [0, 0])
    skeleton = vorotool.prune(vorotool.skeleton_exact(ring), scale=3)
    smoothed = vorotool.smooth(skeleton, 0.01)
    (line,) = np.unique(smoothed.line)
    assert line == 0
    first, last = smoothed.control[0], smoothed.control[-1]
    assert first[0].tolist() == last[3].tolist()
    out, back = first[1] - first[0], last[3] - last[2]
    assert abs(out[0] * back[1] - out[1] * back[0]) < 1e-9
    assert len(smoothed.control) <= 8


def test_nothing():
    triangle = vorotool.skeleton_exact([[0, 0], [4, 0], [0, 3]])
    names = ("vertices", "radius", "arcs", "control", "sites", "polygon", "side", "branch", "length", "error_bound")
    skeleton = replace(triangle, **{name: getattr(triangle, name)[:0] for name in names})
    smoothed = vorotool.smooth(skeleton, 0.1)
    assert (len(smoothed), smoothed.control.shape) == (0, (0, 4, 2))
    vorotool.verify_smooth(smoothed)


def test_a_tolerance_that_is_too_small():
    with pytest.raises(vorotool.InputError, match="fitted curves need at least 5"):
        vorotool.smooth(vorotool.skeleton_exact(ELL), 1e-9)
    with pytest.raises(vorotool.InputError, match="invalid lines: expected a Skeleton of "):
        vorotool.smooth(ELL, 1)


def test_the_checker_finds_faults():
    smoothed = vorotool.smooth(vorotool.prune(vorotool.skeleton_exact(ELL), scale=1.5), 0.4)
    faults = {
        "is farther from its": replace(smoothed, error=smoothed.error / 3),
        "does not begin and end": replace(smoothed, control=smoothed.control + 1),
        "there are 0 smooth lines": replace(
            smoothed, control=smoothed.control[:0], start=np.zeros(1), error=smoothed.error[:0]
        ),
    }
    bent = smoothed.control.copy()
    bent[0, 2] += [0.3, 0.2]
    faults["has a corner inside"] = replace(smoothed, control=bent)
    for message, wrong in faults.items():
        with pytest.raises(vorotool.VerificationError, match=message):
            vorotool.verify_smooth(wrong)


def test_parts_and_polylines_of_cubic_curves():
    random = np.random.default_rng(4)
    control = random.normal(0, 5, (50, 4, 2))
    first, last = np.sort(random.random((2, 50)), axis=0)
    t = random.random(50)
    parts = parts_between(control, first, last)
    np.testing.assert_allclose(places_at(parts, t), places_at(control, first + t * (last - first)), atol=1e-12)
    for tolerance in (1.0, 0.01):
        points, start = cubic_polylines(control, tolerance)
        for k in range(50):
            places = places_at(np.repeat(control[k : k + 1], 500, axis=0), np.linspace(0, 1, 500))
            line = shapely.LineString(points[start[k] : start[k + 1]])
            assert shapely.distance(shapely.points(places), line).max() <= tolerance


def parts_between(control, first, last):
    """(n, 4, 2) control points of the parts of curves from one parameter to another."""
    made = np.empty_like(control)
    for k, parameters in enumerate(((first,) * 3, (first, first, last), (first, last, last), (last,) * 3)):
        points = np.moveaxis(control, 1, 0)
        for t in parameters:  # the blossom
            points = points[:-1] + t[:, None] * (points[1:] - points[:-1])
        made[:, k] = points[0]
    return made
