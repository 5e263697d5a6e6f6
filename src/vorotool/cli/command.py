"""Commands for click, made from the tables of commands and of options; help has groups, and ``-h`` a short page."""

from __future__ import annotations

import inspect
import os
import re
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from math import isnan, nan
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from vorotool.cli.values import UnexpectedError
from vorotool.errors import meant
from vorotool.jobs.terminal import print_text
from vorotool.products.commands import COMMANDS
from vorotool.products.formats import EXTENSIONS, FORMATS
from vorotool.products.inputs import DRAWN_NAMES, NAMES_WITH, names_of
from vorotool.products.options import GROUPS, flags_of, options_of
from vorotool.products.registry import PRODUCTS, all_layers, formats_of

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

    from vorotool.products.options.row import Option

    ParameterType = click.ParamType[Any]
else:
    ParameterType = click.ParamType  # which only click from 8.4 on says what it converts to

Convert = Callable[[str], Any]


class Value(ParameterType):
    """A value that a function of `vorotool.cli.values` takes from text."""

    def __init__(self, kind: str, metavar: str, convert: Convert | None = None) -> None:
        self.kind = self.name = kind
        self._metavar, self._convert = metavar, convert

    def get_metavar(self, param: click.Parameter, ctx: click.Context | None = None) -> str:
        """Return it as it is written: ``WxH``, not ``WXH``."""
        return self._metavar

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Convert text; while a shell completes what follows, numbers stay as they are."""
        if not isinstance(value, str) or (self._convert is None and ctx is not None and ctx.resilient_parsing):
            return value
        try:
            return (self._convert or _function(self.kind))(value)
        except UnexpectedError as error:
            self.fail(f"{value!r}: {error}", param, ctx)


class Choice(click.Choice):  # type: ignore[type-arg]  # that of click 8.1 takes none
    """One of a few names."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Refuse others, and say which name is meant, perhaps."""
        try:
            return super().convert(value, param, ctx)
        except click.BadParameter as error:
            self.fail(error.message.rstrip(".") + meant(str(value), self.choices), param, ctx)

    def get_missing_message(self, *_: object, **__: object) -> str:
        """List the names on one line."""
        return f"Choose from {', '.join(map(str, self.choices))}"


class _InRange(ParameterType):
    """A number with a least value, and perhaps a largest."""

    noun = ""
    min: Any
    max: Any

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Refuse what is not a number, and what is beyond the limits, in the same words."""
        try:
            number = super().convert(value, param, ctx)
        except click.BadParameter:
            number = nan
        if isinstance(number, float) and isnan(number):
            limits = f"of at least {self.min:n}" if self.max is None else f"from {self.min:n} to {self.max:n}"
            self.fail(f"{value!r}: expected {self.noun} {limits}", param, ctx)
        return number


class Whole(_InRange, click.IntRange):
    """An integer."""

    noun = "an integer"


class Real(_InRange, click.FloatRange):
    """A number."""

    noun = "a number"


class Names(Value):
    """Names from a list, separated by commas."""

    def __init__(self, metavar: str, choices: tuple[str, ...]) -> None:
        from vorotool.cli.values.names import names_among

        super().__init__("names", metavar, names_among(choices))
        self.choices = choices

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem[str]]:
        """Offer what is not in the list yet."""
        return listed(self.choices, incomplete)


def _function(kind: str) -> Convert:
    """Return a function of `vorotool.cli.values` by its name."""
    from importlib import import_module

    module, name = kind.split(".")
    return getattr(import_module(f"vorotool.cli.values.{module}"), name)


def _type_of(command: str, row: Option) -> ParameterType:
    """Return the type of the values of an option that are no text."""
    kind, _, rest = row.type.partition(":")
    if kind == "choice":
        return Choice(rest.split(), case_sensitive=False)
    if kind in ("int", "float"):
        number: Any = int if kind == "int" else float
        least, most = (number(text) if text else None for text in rest.split(":"))
        if least is None and most is None:
            return click.INT
        return Whole(least, most) if kind == "int" else Real(least, most)
    if kind == "results":
        return Names(row.metavar, tuple(PRODUCTS[command]))
    if kind == "layers":
        return Names(row.metavar, all_layers(command))
    return Value(kind, row.metavar)


def _joined(_ctx: click.Context, _param: click.Parameter, value: tuple[tuple[Any, ...], ...]) -> Any:
    """Join the lists of an option that is repeated; None where it is not given."""
    return tuple(dict.fromkeys(each for values in value for each in values)) or None


def _help_of(command: str, row: Option) -> str:
    if "{" not in row.help:
        return row.help
    own = PRODUCTS[command]
    names = {
        "results": lambda: ", ".join(own),
        "formats": lambda: ", ".join(dict.fromkeys(fmt for each in own.values() for fmt in each.formats)),
        "layers": lambda: ", ".join(all_layers(command)),
        "of_polygons": lambda: ", ".join(own["polygons"].usual_for),
        "flattened": lambda: ", ".join(each.title for each in FORMATS.values() if each.flattens),
    }
    return re.sub(r"\{(\w+)\}", lambda match: names[match[1]](), row.help)


def option(command: str, row: Option, *, is_shown: bool = True) -> click.Option:
    """Make an option of a command: with help, and what shells offer, if these are asked for."""
    kind = _type_of(command, row) if row.type else None
    more: dict[str, Any] = {}
    if row.is_flag:
        more = {"is_flag": True}
    elif row.is_pair:
        more = {"default": None}
    else:
        is_named = kind is None or row.type.partition(":")[0] in ("int", "float")
        more = {"type": kind, "metavar": row.metavar if is_named else None, "multiple": bool(row.repeats)}
    if row.repeats == "joined":
        more["callback"] = _joined
    if is_shown:
        more["help"] = _help_of(command, row)
        more["shell_complete"] = candidates(command, row.complete) if row.complete else None
    if row.env:
        more |= {"envvar": f"VOROTOOL_{row.env}", "show_envvar": True}
    if row.parameter == "what" and command != "alphashape":
        more |= {"default": (next(iter(PRODUCTS[command])),), "show_default": True}
    elif row.default is not None and not row.repeats:
        more |= {"default": row.default, "show_default": row.default not in (False, 0.0) or row.env != ""}
    return click.Option([*row.spellings, row.parameter], **more)


EPILOG = "Manual page: man vorotool-{}. Documents: vorotool --help says where they are."


def computing_command(name: str, given: Sequence[str] | None = None) -> click.Command:
    """Make a command that reads inputs and writes results: with all options, or those that arguments can mean."""
    words = {argument.partition("=")[0] for argument in given or ()}
    words |= {f"-{letter}" for word in words if word[:1] == "-" != word[1:2] for letter in word[1:]}
    is_shown = given is None or bool(words & {"-h", "--help"})
    about, rows, files = COMMANDS[name], options_of(name).values(), None
    if is_shown:
        read = DRAWN_NAMES if about.reads is None else NAMES_WITH[about.reads]
        files = candidates(name, f"files:{' '.join(read)}")
    params: list[click.Parameter] = [
        click.Argument([each], metavar=metavar, nargs=count, required=count == 1, shell_complete=files)
        for each, metavar, count in _ARGUMENTS.get(name, (("inputs", "INPUT...", -1),))
    ]
    params += [
        option(name, row, is_shown=is_shown)
        for row in rows
        if is_shown
        or (row.env and f"VOROTOOL_{row.env}" in os.environ)
        or any(flag in words for pair in row.spellings for flag in pair.split("/"))
    ]
    if is_shown:
        params.append(short_help_option())

    def run(**values: Any) -> None:
        from vorotool.cli.run import run_command

        context = click.get_current_context()
        origins = ((each, context.get_parameter_source(each)) for each in context.params)
        run_command(name, values, {each: _SOURCES[origin] for each, origin in origins if origin in _SOURCES})

    return GroupedCommand(
        name,
        context_settings={"help_option_names": ["--help"]},
        params=params,
        callback=run,
        help=about.text,
        epilog=EPILOG.format(name),
    )


_ARGUMENTS = {"distance": (("a", "A", 1), ("b", "B", 1))}
_SOURCES = {ParameterSource.COMMANDLINE: "typed", ParameterSource.ENVIRONMENT: "environment"}
"""Where options that are not at their defaults come from."""

Candidates = Callable[[click.Context, click.Parameter, str], "list[CompletionItem[str]]"]

SEPARATOR = "|"
"""Between extensions."""


def candidates(command: str, spec: str) -> Candidates:
    """Return what offers the values of an option, as the table of options has it."""
    kind, _, rest = spec.partition(":")
    if kind in ("any", "folders"):
        return lambda context, parameter, begun: [_item("_", "path" if kind == "any" else "dir")]
    if kind == "words":
        return words(rest.split())
    if kind == "formats":
        return _formats_of(formats_of(command))
    if kind == "inputs":
        held: Any = rest.split() or [None]
        return _files([*NAMES_WITH[None]]) if held == [None] else _files([*names_of(*held)])
    written = {fmt for possible in formats_of(command).values() for fmt in possible} if kind == "outputs" else set()
    return _files(rest.split() or [ending[1:] for ending, fmt in EXTENSIONS.items() if fmt in written])


def _files(extensions: Iterable[str]) -> Candidates:
    """Offer files with one of the extensions, and folders; the shell looks for them."""
    joined = SEPARATOR.join(extensions)
    return lambda context, parameter, begun: [_item(joined, "file")]


def words(names: Collection[str]) -> Candidates:
    """Offer what begins so."""
    return lambda context, parameter, begun: [_item(name) for name in names if name.startswith(begun)]


def _formats_of(formats: Mapping[str, Sequence[str]]) -> Candidates:
    """Offer the formats of what ``--what`` names before, or of all."""

    def offer(context: click.Context, parameter: click.Parameter, begun: str) -> list[CompletionItem[str]]:
        wanted = context.params.get("what") or formats
        found = dict.fromkeys(fmt for what in wanted for fmt in formats[what])
        return [_item(fmt) for fmt in found if fmt.startswith(begun)]

    return offer


def listed(choices: Sequence[str], begun: str) -> list[CompletionItem[str]]:
    """Offer what is not yet in a list that commas separate."""
    before, comma, last = begun.rpartition(",")
    given = before.split(",")
    return [_item(f"{before}{comma}{name}") for name in choices if name.startswith(last) and name not in given]


def _item(value: str, kind: str = "plain") -> CompletionItem[str]:
    from click.shell_completion import CompletionItem

    return CompletionItem(value, type=kind)


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
