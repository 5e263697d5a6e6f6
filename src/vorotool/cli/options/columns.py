"""Options about columns of tables: those of the input, and those of the tables of many inputs."""

from __future__ import annotations

from typing import Any

import click

from vorotool.cli.options.parameter_types import ParameterType
from vorotool.cli.options.suggestions import files


class Columns(ParameterType[tuple[str, ...]]):
    """Names of columns, separated by commas."""

    name = "COLUMN[,...]"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[str, ...]:
        """Split the names."""
        if isinstance(value, tuple):
            return value
        names = tuple(name.strip() for name in value.split(","))
        if not all(names):
            self.fail(f"{value!r}: expected names of columns, separated by commas", param, ctx)
        return names


def accumulated(_ctx: click.Context, _param: click.Parameter, value: tuple[tuple[Any, ...], ...]) -> Any:
    """Join the lists of an option that is repeated; None where it is not given."""
    return tuple(dict.fromkeys(each for values in value for each in values)) or None


TABLE_OPTIONS = {
    "with": click.option(
        "--with",
        "with_columns",
        type=Columns(),
        multiple=True,
        callback=accumulated,
        help="Columns of the input for rows about parts of features (branches, points, ...); for rows about several "
        "(edges, neighbors) as COLUMN_a, COLUMN_b.",
    ),
    "table": click.option(
        "--table",
        metavar="FILE",
        help="Write the tables of all inputs as one (CSV, TSV, JSON): the rows of --what, if that is a table, else of "
        "table.",
        shell_complete=files(("csv", "tsv", "json")),
    ),
    "table-inputs": click.option(
        "--table-inputs",
        metavar="FILE",
        help="Write a row an input, also of those without objects: what became of it, and how many rows it has.",
        shell_complete=files(("csv", "tsv", "json")),
    ),
    "fields": click.option(
        "--fields",
        metavar="REGEX",
        help="Add columns to --table and --table-inputs: the named groups, (?P<name>...), found in each path.",
    ),
}
