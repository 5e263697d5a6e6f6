"""What a shell offers for arguments: files of the kinds that are read or written, formats, names from lists."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import click

from vorotool.products.formats import EXTENSIONS
from vorotool.products.inputs import NAMES_WITH, names_of
from vorotool.products.registry import formats_of

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

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
