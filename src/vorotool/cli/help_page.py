"""Help of commands: all options in groups by ``--help``, the common ones by ``-h``."""

from __future__ import annotations

import inspect
import re
from typing import Any

import click

from vorotool.jobs.terminal import print_text
from vorotool.products.commands import COMMANDS
from vorotool.products.options import GROUPS, flags_of
from vorotool.products.registry import PRODUCTS

_COMMON = (
    "output format what by enclosures size r step tolerance side prune distance seeds threshold layers out_dir jobs"
)
COMMON = _COMMON.split(" ")
"""Parameters from which the short page takes the first ten that a command has."""

MOST, MOST_NAMES = 10, 5
CLOSE = 0.75
"""How like an option that is mistyped is to those that are named: --offset is not like --aspect."""


class GroupedCommand(click.Command):
    """A command whose ``--help`` has groups, and whose ``-h`` is a short page."""

    def make_parser(self, ctx: click.Context) -> Any:
        """Let short options be found at first: click looks for long ones, and for others like them, before."""
        parser = super().make_parser(ctx)
        long, short = (vars(parser).get(name) for name in ("_long_opt", "_short_opt"))
        if long is not None and short is not None:
            long.update({name: each for name, each in short.items() if name not in long})
        return parser

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Say what to do instead where an option is one of other commands."""
        if "--fill-holes" in args:
            from vorotool.cli.values.lengths import with_hole_areas

            args = with_hole_areas(args)
        typed = [*args]
        try:
            return super().parse_args(ctx, args)
        except click.NoSuchOption as error:
            name = error.option_name
            instead = dict(COMMANDS[self.name or ""].instead)
            if name in instead:
                raise click.UsageError(f"{self.name} has no {name}: {instead[name]}", ctx) from None
            if re.match(r"-[.\d]", name):
                number = next(each for each in typed if each.startswith(name))
                said = f"{number} is a number, not an option: separate the values of a list by commas, as in -d -1,-2"
                raise click.UsageError(said, ctx) from None
            others = [each for each in COMMANDS if name in flags_of(each)]
            if others:
                have = "has it" if len(others) == 1 else "have it"
                raise click.UsageError(f"{self.name} has no {name}: {', '.join(others)} {have}", ctx) from None
            from difflib import get_close_matches

            near = get_close_matches(name, {*flags_of(self.name or ""), "-h", "--help"}, cutoff=CLOSE)
            raise click.NoSuchOption(name, possibilities=near, ctx=ctx) from None

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the options under the titles of their groups."""
        for title, rows in self.grouped(ctx).items():
            with formatter.section(title):
                formatter.write_dl(rows)

    def grouped(self, ctx: click.Context) -> dict[str, list[tuple[str, str]]]:
        """Options and what they are for, under the titles of their groups."""
        records = self._records(ctx)
        names = {title: {row.parameter for row in rows} for title, rows in GROUPS.items()}
        groups = {title: [records.pop(each) for each in [*records] if each in names[title]] for title in names}
        return {title: rows for title, rows in groups.items() if rows} | {"Help": list(records.values())}

    def _records(self, ctx: click.Context) -> dict[str, tuple[str, str]]:
        """Left and right columns of the options by their names."""
        options = [param for param in self.get_params(ctx) if isinstance(param, click.Option)]
        made = ((param.name or "", param.get_help_record(ctx)) for param in options)
        return {name: record for name, record in made if record is not None}

    def _shortened(self, name: str, record: tuple[str, str]) -> tuple[str, str]:
        """Name the first of many products only."""
        own = list(PRODUCTS.get(self.name or "", ()))
        if name != "what" or len(own) <= MOST_NAMES:
            return record
        return record[0], f"What to write: {', '.join(own[:MOST_NAMES])}, and {len(own) - MOST_NAMES} more."

    def show_short(self, ctx: click.Context) -> None:
        """Print the short page."""
        formatter = ctx.make_formatter()
        self.format_usage(ctx, formatter)
        first, example, *_ = inspect.cleandoc(self.help or "").split("\n\n")
        for text in (first, example):
            formatter.write_paragraph()
            with formatter.indentation():
                formatter.write_text(text)
        records = self._records(ctx)
        with formatter.section("Common options"):
            formatter.write_dl([self._shortened(name, records[name]) for name in COMMON if name in records][:MOST])
        formatter.write_paragraph()
        formatter.write_text(f"All options: {ctx.command_path} --help")
        print_text(formatter.getvalue().rstrip("\n") + "\n")
        ctx.exit()


def short_help_option() -> click.Option:
    """Make ``-h``."""

    def show(ctx: click.Context, _param: click.Parameter, value: bool) -> None:
        if value and not ctx.resilient_parsing and isinstance(ctx.command, GroupedCommand):
            ctx.command.show_short(ctx)

    return click.Option(
        ["-h", "short_help_page"],
        is_flag=True,
        is_eager=True,
        expose_value=False,
        help="Show the most common options and exit.",
        callback=show,
    )
