"""``vorotool info``."""

from __future__ import annotations

from typing import Any

import click

from vorotool.cli.options.shared import inputs_argument, shared
from vorotool.jobs.options import Options
from vorotool.products.inputs import NAMES_WITH


@click.command("info")
@inputs_argument(NAMES_WITH[None])
@click.option("--json", is_flag=True, help="Print a JSON object on one line for each input.")
@shared("columns", "input-format", "input-crs", "page", "follow", "threads", "max-pixels")
def command(**options: Any) -> None:
    """Tell how a file is read: its format, what it holds, how much, where, and which commands take it.

    \b
    Example:
      vorotool sample cells.png -o cells.png
      vorotool info cells.png

    INPUT is any file that a command reads, FILE:LAYER for a layer of one that has several, or a folder of files; - is
    standard input. Of several inputs each is told, and exit code 6 says that some cannot be read. Nothing is computed,
    and nothing is written but what is printed.
    """
    from vorotool.jobs.description import describe_inputs

    describe_inputs(Options("info", **options))
