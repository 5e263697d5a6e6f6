"""What a shell offers for arguments: files of the kinds that are read or written, formats, names from lists."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

import click

from vorotool.products.formats import EXTENSIONS

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

Candidates = Callable[[click.Context, click.Parameter, str], "list[CompletionItem[str]]"]

SEPARATOR = "|"
"""Between extensions."""


def files(extensions: Iterable[str]) -> Candidates:
    """Offer files with one of the extensions, and folders; the shell looks for them."""
    joined = SEPARATOR.join(extensions)
    return lambda context, parameter, begun: [_item(joined, "file")]


def any_file(context: click.Context, parameter: click.Parameter, begun: str) -> list[CompletionItem[str]]:
    """Offer files and folders."""
    return [_item("_", "path")]


def folders(context: click.Context, parameter: click.Parameter, begun: str) -> list[CompletionItem[str]]:
    """Offer folders."""
    return [_item("_", "dir")]


def words(names: Collection[str]) -> Candidates:
    """Offer what begins so."""
    return lambda context, parameter, begun: [_item(name) for name in names if name.startswith(begun)]


def outputs_of(formats: Mapping[str, Sequence[str]]) -> Candidates:
    """Offer files with the extensions of formats, and folders."""
    written = {fmt for possible in formats.values() for fmt in possible}
    return files(extension[1:] for extension, fmt in EXTENSIONS.items() if fmt in written)


def formats_of(formats: Mapping[str, Sequence[str]]) -> Candidates:
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
