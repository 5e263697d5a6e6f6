"""Bounds of approximate skeletons against the exact ones, at many places of each arc: see `--help`.

Exit 1 if a bound does not hold, if the median of bound and true error is above 3, if the errors away from corners do
not go with the square of the step, in the median over steps that are no longer than most edges, if a tolerance is not
met, or from the exact skeleton not where no corner is flatter than 170 degrees. `--places 100`
"""

import argparse
import time
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from PIL import Image

import vorotool
from vorotool.engines.arrangement.planar_graph import planar_graph
from vorotool.engines.arrangement.repaired_polygons import placed_shapes
from vorotool.engines.sampled_skeleton.approximate import (
    ApproximateSkeleton,
    SamplingOptions,
    Wanted,
    approximate_skeleton,
    sampled_graph,
)
from vorotool.engines.sampled_skeleton.hausdorff import deviation, exact_skeleton
from vorotool.engines.sampled_skeleton.per_feature import skeleton_within
from vorotool.engines.skeleton.shortened_edges import corner_sectors
from vorotool.engines.skeleton.verify_bounds import distances_to, places_on_arcs
from vorotool.types.polygons.shapely_geometry import to_shapely

DATA = Path(__file__).parents[2] / "data"
STEPS = (25, 50, 100, 200, 400)
TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
FLAT = 170


def random_shapes(rng: np.random.Generator) -> dict[str, Any]:
    """Around a middle, and with holes."""
    shapes: dict[str, Any] = {}
    for k, count in enumerate((5, 12, 30, 60)):
        angle = np.sort(rng.random(count)) * 2 * np.pi
        radius = rng.uniform(0.3, 1, count) * 1000
        shapes[f"random {k}"] = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    for k, count in enumerate((1, 3, 6, 12)):
        square = shapely.box(0, 0, 1000, 700)
        for x, y in rng.uniform((60, 60), (940, 640), (count, 2)):
            angle = np.sort(rng.random(rng.integers(3, 9))) * 2 * np.pi
            square -= shapely.Polygon(np.stack([x + 45 * np.cos(angle), y + 45 * np.sin(angle)], axis=1))
        shapes[f"holes {k}"] = square
    return shapes


def natural_earth() -> dict[str, Any]:
    """Lakes and land, the ones with most vertices and some smaller ones."""
    shapes: dict[str, Any] = {}
    for name, ranks in (("ne_110m_land", (1, 4)), ("ne_50m_lakes", (0, 3, 9)), ("ne_110m_lakes", (0, 4))):
        polygons = np.array(to_shapely(vorotool.read(DATA / f"{name}.geojson")), dtype=object)
        order = np.argsort(-shapely.get_num_coordinates(polygons), kind="stable")
        shapes |= {f"{name} {rank}": polygons[order[rank]] for rank in ranks}
    return shapes


def masks() -> dict[str, Any]:
    """Pixel outlines of the largest blobs."""
    from skimage.measure import label

    labels = label(np.array(Image.open(DATA / "blobs.png")) > 0)
    order = np.argsort(-np.bincount(labels.ravel())[1:])[:5] + 1
    shapes = {}
    for k, number in enumerate(order.tolist()):
        y, x = np.nonzero(labels == number)
        shapes[f"mask {k}"] = shapely.union_all(shapely.box(x - 0.5, y - 0.5, x + 0.5, y + 0.5))
    return shapes


class Shape:
    """One shape with its exact skeleton."""

    def __init__(self, name: str, shape: Any) -> None:
        self.name, self.graph = name, planar_graph(shape)
        self.placed = placed_shapes(self.graph)
        self.extent = float(np.ptp(self.placed.polygons.xy, axis=0).max())
        ends = self.graph.points[self.graph.segments].astype(np.float64)
        self.usual_edge = float(np.median(np.hypot(*(ends[:, 0] - ends[:, 1]).T))) * self.graph.scale
        self.exact = exact_skeleton(self.sampled(self.extent))

    def sampled(self, step: float, sampling: str = "paper") -> ApproximateSkeleton:
        """Approximate it by a step."""
        return approximate_skeleton(sampled_graph(self.graph, self.placed, SamplingOptions(step, None, sampling)))

    def flattest(self) -> float:
        """The widest angle under 180 degrees."""
        sectors, points = corner_sectors(self.graph), self.graph.points.astype(np.float64)
        a, b = (_way(self.graph.segments[s], sectors.point, points) for s in (sectors.right, sectors.left))
        turn = np.arctan2(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], (a * b).sum(axis=1))
        inside = self.graph.is_inside[sectors.face]
        return float(np.degrees(turn[inside].max(initial=0.0)))


def _way(ends: Any, at: Any, points: Any) -> Any:
    return points[np.where(ends[:, 0] == at, ends[:, 1], ends[:, 0])] - points[at]


def check_steps(shape: Shape, places: int) -> tuple[int, Any, Any]:
    """Violations, the ratios of bounds and true errors, and orders of errors away from corners; prints a line."""
    ratios, violations, away = [], 0, []
    for part in STEPS:
        step = shape.extent / part
        found = shape.sampled(step)
        skeleton = found.skeleton
        spots = places_on_arcs(skeleton, np.linspace(0, 1, places))
        true = distances_to(shape.exact, spots.reshape(-1, 2)).reshape(len(skeleton), places)
        bound = np.where(np.isnan(skeleton.error_bound), np.inf, skeleton.error_bound)[:, None]
        violations += int(np.count_nonzero(true > bound))
        large = (true > 1e-12 * shape.extent) & np.isfinite(bound)
        ratios.append((bound / np.where(large, true, 1))[large])
        far = shape.sampled(step, "symmetric").skeleton
        is_away = far.radius[far.arcs].min(axis=1) > 0.04 * shape.extent
        away.append(float(np.nanmax(far.error_bound[is_away], initial=0.0)) if is_away.any() else np.nan)
    ratio = np.concatenate(ratios)
    orders = np.log2(np.array(away[:-1]) / np.array(away[1:]))
    print(
        f"{shape.name:16} {len(shape.graph):5} edges: {violations} violations, median {np.median(ratio):.2f}, "
        f"90 % below {np.quantile(ratio, 0.9):.1f}; orders {' '.join(f'{order:.2f}' for order in orders)}"
    )
    is_usual = shape.extent / np.array(STEPS[:-1]) <= shape.usual_edge
    return violations, ratio, orders[is_usual & np.isfinite(orders)]


def check_tolerances(shape: Shape, tolerances: tuple[float, ...] = TOLERANCES) -> int:
    """Failures; prints a line."""
    failures, words = 0, []
    flattest = shape.flattest()
    for tolerance in tolerances:
        wanted = tolerance * shape.extent
        found = skeleton_within(shape.graph, shape.placed, wanted, Wanted(complete=True))
        there, back = deviation(found.skeleton, shape.exact), deviation(shape.exact, found.skeleton)
        assert there is not None
        assert back is not None
        failures += there.largest > wanted or (back.largest > wanted and flattest <= FLAT)
        words.append(f"{len(found.shapes.samples)}: {there.largest / wanted:.2f}, {back.largest / wanted:.2f}")
    print(f"{'':16} flattest {flattest:.2f}; seeds: parts of the tolerance there, back: {'; '.join(words)}")
    return failures


def main() -> int:
    """Run all; exit 1 if something does not hold."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--places", type=int, default=100)
    arguments = parser.parse_args()
    warnings.simplefilter("ignore")
    start = time.monotonic()
    violations, failures, ratios, orders = 0, 0, [], []
    for name, given in (random_shapes(np.random.default_rng(1)) | natural_earth() | masks()).items():
        shape = Shape(name, given)
        wrong, ratio, order = check_steps(shape, arguments.places)
        violations += wrong
        ratios.append(ratio)
        orders.append(order)
        failures += check_tolerances(shape)
    median, order = (float(np.median(np.concatenate(values))) for values in (ratios, orders))
    print(f"{violations} violations, median of bound and true error {median:.2f}, {failures} tolerances not met")
    print(f"median order of errors away from corners {order:.2f}")
    print(f"{time.monotonic() - start:.0f} s")
    return int(violations > 0 or failures > 0 or median > 3 or not 1.8 <= order <= 2.2)
