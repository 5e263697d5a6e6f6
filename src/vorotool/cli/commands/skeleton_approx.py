"""``vorotool skeleton-approx``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from vorotool.cli.options.help_page import GroupedCommand
from vorotool.cli.options.lengths import Length
from vorotool.cli.options.skeleton import skeleton_options
from vorotool.cli.run import run_command
from vorotool.errors import UsageError
from vorotool.jobs.inputs import JobInput
from vorotool.jobs.job import Recipe
from vorotool.jobs.options import Options
from vorotool.jobs.run_log import Run
from vorotool.jobs.skeleton_checks import check_options
from vorotool.products.registry import formats_of

if TYPE_CHECKING:
    from vorotool.jobs.skeletons.approximate import ApproximateProducts


@click.command("skeleton-approx", cls=GroupedCommand)
@skeleton_options(
    click.option("--step", type=Length(zero=False), metavar="H", help="Sample the edges at this distance."),
    click.option(
        "--tolerance",
        type=Length(zero=False),
        metavar="E",
        help="Instead of a step: sample as finely as it takes for all errors to be at most E.",
    ),
    click.option(
        "--sampling",
        type=click.Choice(["paper", "symmetric"], case_sensitive=False),
        help="From the first end of each edge (default with --step), or from both ends alike (with --tolerance).",
    ),
    click.option(
        "--complete/--no-complete",
        default=None,
        help="Join corners by lines along their bisectors; by default with --tolerance.",
    ),
    click.option("--compare", is_flag=True, help="Say how far the exact skeleton is, both ways; in --stats, too."),
    command="skeleton-approx",
)
def command(**options: Any) -> None:
    """Approximate the skeleton of polygons by samples of their edges, with a certified error of each arc.

    \b
    Example:
      vorotool sample two-shapes.json -o two-shapes.json
      vorotool skeleton-approx two-shapes.json --step 4 -o skeleton.svg

    INPUT is as for skeleton-exact. Of the Voronoi diagram of the samples, the edges between samples of one edge are
    left out, and those that the shapes cross. No point of an arc is farther from the exact skeleton than its
    error_bound.
    """
    o = Options("skeleton-approx", **options)
    if (o.step is None) == (o.tolerance is None):
        raise UsageError("use either --step H or --tolerance E")
    if o.tolerance is not None and o.sampling == "paper":
        raise UsageError("--sampling paper has one step everywhere: use it with --step, or leave it out")
    run_command(RECIPE, o)


def _products(run: Run, o: Options, given: JobInput) -> ApproximateProducts:
    from vorotool.jobs.skeletons.approximate import ApproximateProducts

    return ApproximateProducts(run, o, given)


RECIPE = Recipe("skeleton-approx", formats_of("skeleton-approx"), check_options, _products, "polygons")
