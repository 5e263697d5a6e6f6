"""What the commands that make skeletons do with their options."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from types import SimpleNamespace
from typing import TYPE_CHECKING

from vorotool.cli.batch.dispatch import run_command
from vorotool.jobs.inputs import naming
from vorotool.jobs.job import Recipe
from vorotool.jobs.run_log import Run
from vorotool.jobs.skeleton_checks import check_options
from vorotool.jobs.skeleton_input import read_polygons
from vorotool.products.registry import formats_of

if TYPE_CHECKING:
    from vorotool.geometry.polygons.polygon_set import PolygonSet
    from vorotool.jobs.skeleton import SkeletonProducts


def run_skeletons(
    name: str, o: SimpleNamespace, make: Callable[[PolygonSet, SimpleNamespace, Run], SkeletonProducts]
) -> None:
    """Read polygons, make what a command makes of them, check it, and write it."""
    run_command(Recipe(name, formats_of(name), check_options, partial(_products, make), "polygons"), o)


def _products(
    make: Callable[[PolygonSet, SimpleNamespace, Run], SkeletonProducts], run: Run, o: SimpleNamespace, source: str
) -> SkeletonProducts:
    with naming(source), run.phase("read"):
        polygons = read_polygons(run, o, source)
    with naming(source):
        return make(polygons, o, run)
