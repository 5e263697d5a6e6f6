"""``vorotool info``."""

from __future__ import annotations

from typing import Any

import click

from vorotool.cli.command import candidates, option
from vorotool.products.options import options_of

_FILES = candidates("info", "inputs")


def _run(**given: Any) -> None:
    from vorotool.jobs.description import describe_inputs
    from vorotool.jobs.options import Options

    describe_inputs(Options("info", **given))


command = click.Command(
    "info",
    params=[
        click.Argument(["inputs"], metavar="INPUT...", nargs=-1, shell_complete=_FILES),
        click.Option(["--json"], is_flag=True, help="Print a JSON object on one line for each input."),
        *(option("info", row) for row in options_of("info").values()),
    ],
    callback=_run,
    help="""Show how a file is read: its format, content, size and place, and the commands that accept it.

\b
Example:
  vorotool sample cells.png -o cells.png
  vorotool info cells.png

INPUT is any file that a command reads, FILE:LAYER for a layer of one that has several, or a folder of files; - is
standard input. Each of several inputs is described; exit code 6 means that some cannot be read. Nothing is computed,
and only standard output is written.""",
)
