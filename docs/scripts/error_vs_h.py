"""Errors of approximate skeletons against the step, beside the paper's; as a table: `error_vs_h.py OUT.svg`.

Of each shape and step the largest measured distance from the exact skeleton and the largest certified bound, over three
kinds of arcs: parabolas, straight ones away from corners, and straight ones near to them.
"""

import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import vorotool
from vorotool.engines.arrangement.planar_graph import planar_graph
from vorotool.engines.arrangement.repaired_polygons import placed_shapes
from vorotool.engines.sampled_skeleton.approximate import SamplingOptions, Wanted, approximate_skeleton, sampled_graph
from vorotool.engines.sampled_skeleton.hausdorff import (
    distances_to,
    error_summary,
    exact_skeleton,
    places_on_arcs,
    widened,
)
from vorotool.render.canvas.layers import Curves, Layer, Lines, Page, Points, Texts, bounds_of
from vorotool.render.canvas.styles import FAINT, INK, PALE, RESULT, SEED
from vorotool.render.canvas.svg import write_layers_svg
from vorotool.types.skeleton.segment_voronoi import EDGE

DATA = Path(__file__).parents[2] / "data"
SHAPES = {"shape.json": "interior", "two-shapes.json": "interior", "two-segments.wkt": "exterior"}
STEPS = (25, 50, 100, 200, 400)
"""Of the extent a step."""
AWAY = 0.04
"""Of the extent: the least clearance of arcs away from corners."""
PLACES = 9
PARABOLAS, STRAIGHT, NEAR = "parabolas", "straight, away from corners", "straight, near corners"
COLORS = {PARABOLAS: "#117733", STRAIGHT: RESULT, NEAR: SEED}

DECADES = (-6, -2)
"""Of the errors that are shown."""
HALVING, DECADE, PANEL = 1.2, 1.6, 6.5
"""Widths of the picture: of a halving of the step, of ten times the error, and from panel to panel."""


class Row(NamedTuple):
    """Parts of the extent; NaN where there are no such arcs."""

    step: float
    measured: dict[str, float]
    bound: dict[str, float]
    estimate: float


def rows_of(name: str, side: str) -> list[Row]:
    """Measure one shape."""
    graph = planar_graph(vorotool.read(DATA / name))
    placed, rows = placed_shapes(graph), []
    extent = float(np.ptp(placed.polygons.xy, axis=0).max())
    exact = None
    for part in STEPS:
        step = extent / part
        found = approximate_skeleton(sampled_graph(graph, placed, SamplingOptions(step)), Wanted(side))
        skeleton = found.skeleton
        if exact is None:
            exact = exact_skeleton(found, side=side, frame=skeleton.frame and widened(skeleton.frame))
        spots = places_on_arcs(skeleton, np.linspace(0, 1, PLACES)).reshape(-1, 2)
        true = distances_to(exact, spots).reshape(-1, PLACES).max(axis=1)
        edges = (skeleton.site_table.kind == EDGE)[skeleton.sites].sum(axis=1)
        is_away = skeleton.radius[skeleton.arcs].min(axis=1) > AWAY * extent
        chosen = dict(zip(COLORS, (edges == 1, (edges == 2) & is_away, (edges == 2) & ~is_away), strict=True))
        largest = [
            {kind: values[of].max() / extent if of.any() else np.nan for kind, of in chosen.items()}
            for values in (true, skeleton.error_bound)
        ]
        estimate = error_summary(found, step=step)["parabolas"]["largest_estimate"]
        rows.append(Row(step / extent, *largest, estimate / extent))
    return rows


def table(measures: dict[str, list[Row]]) -> str:
    """Give all numbers as Markdown."""
    lines = [
        f"| shape | h | {PARABOLAS} | h²/(8 y0) | {STRAIGHT} | {NEAR} | measured / h |",
        "|---|---|---|---|---|---|---|",
    ]
    for name, rows in measures.items():
        for row in rows:
            pairs = {kind: _cell("{:.2e}, {:.2e}", row.measured[kind], row.bound[kind]) for kind in COLORS}
            constant = _cell("{:.2f}", row.measured[NEAR] / row.step)
            cells = [f"{row.step:g}", pairs[PARABOLAS], f"{row.estimate:.2e}", pairs[STRAIGHT], pairs[NEAR], constant]
            lines.append(f"| {name} | {' | '.join(cells)} |")
        orders = {kind: _cell("order {:.2f}", order_of(rows, kind)) for kind in COLORS}
        lines.append(f"| {name} | | {orders[PARABOLAS]} | order 2 | {orders[STRAIGHT]} | {orders[NEAR]} | |")
    return "\n".join(lines) + "\n"


def order_of(rows: list[Row], kind: str) -> float:
    """By how much the measured error goes with the step, from the first step to the last."""
    first, last = rows[0], rows[-1]
    return float(np.log(first.measured[kind] / last.measured[kind]) / np.log(first.step / last.step))


def _cell(form: str, *values: float) -> str:
    return form.format(*values) if np.isfinite(values).all() else ""


def picture(measures: dict[str, list[Row]]) -> list[Layer]:
    """Draw a panel a shape: dots are measured, lines are bounds, broken ones are the paper's."""
    layers: list[Layer] = []
    for number, (name, rows) in enumerate(measures.items()):
        panel = Panel(number, np.array([row.step for row in rows]))
        layers += panel.axes(name)
        for kind, color in COLORS.items():
            measured, bound = (np.array([getattr(row, of)[kind] for row in rows]) for of in ("measured", "bound"))
            if np.isfinite(bound).all():
                layers += [panel.line(bound, color), Points("measured", panel.places(measured), color, 3.5)]
        constant = max(np.nanmax([row.measured[STRAIGHT], row.measured[NEAR]]) / row.step for row in rows)
        layers.append(panel.line(np.array([row.estimate for row in rows]), INK, is_broken=True))
        layers.append(panel.line(constant * panel.steps, FAINT, is_broken=True))
    legend = {"dots measured, lines bounds": INK, "broken: h²/(8 y0)": INK, "broken: C h": FAINT} | COLORS
    for k, (text, color) in enumerate(legend.items()):
        layers.append(Texts("legend", np.array([[0.9 + 3.1 * k, DECADE * (DECADES[0] - 0.9)]]), [text], color, 12))
    return layers


class Panel(NamedTuple):
    """Where the errors of a shape are drawn: logarithms to the right and upwards."""

    number: int
    steps: NDArray[np.float64]

    def places(self, errors: NDArray[np.float64]) -> NDArray[np.float64]:
        """Of one error a step."""
        across = PANEL * self.number + HALVING * np.log2(self.steps[0] / self.steps)
        return np.stack([across, DECADE * np.log10(errors)], axis=1)

    def line(self, errors: NDArray[np.float64], color: str, *, is_broken: bool = False) -> Curves:
        """From step to step."""
        first = np.arange(len(errors) - 1, dtype=np.int32)
        pairs = np.stack([first, first + 1], axis=1)
        straight = np.full(len(first), -1, dtype=np.int32)
        return Curves("line", self.places(errors), pairs, straight, color, 1.5, is_broken)

    def axes(self, name: str) -> list[Layer]:
        """A line a power of ten, and what is measured below and above."""
        powers = np.arange(DECADES[0], DECADES[1] + 1)
        ends = np.stack([self.places(np.full(len(self.steps), 10.0**power))[[0, -1]] for power in powers])
        pairs = np.arange(2 * len(powers), dtype=np.int32).reshape(-1, 2)
        lifts = np.outer(np.where(powers > -4, 0.13, -0.07), [0, 1])  # texts are beneath places in the upper half
        below = self.places(np.full(len(self.steps), 10.0 ** DECADES[0])) - [0, 0.7]
        return [
            Lines("axes", ends.reshape(-1, 2), pairs, PALE, 1),
            Texts("powers", ends[:, 0] - np.array([0.5, 0]) + lifts, [f"{10.0**k:.0e}" for k in powers], INK, 11),
            Texts("steps", below, [f"h {step:g}" for step in self.steps], INK, 11),
            Texts("name", np.array([ends[-1].mean(axis=0)]) + np.array([[0, 0.5]]), [name], INK, 13),
        ]


def main() -> None:
    """Write the picture, and print the table."""
    measures = {name: rows_of(name, side) for name, side in SHAPES.items()}
    layers = picture(measures)
    with Path(sys.argv[1]).open("wb") as out:
        write_layers_svg(out, layers, Page(bounds_of(*(layer.points for layer in layers)), width=1400, y_up=True))
    sys.stdout.write(table(measures))


if __name__ == "__main__":
    main()
