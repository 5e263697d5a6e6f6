"""Make the page of the site that has the options of all commands, and the formats of their results.

sphinx-click 6.2 reads the same objects, but knows no groups of options, names a value after its parameter where its
type has a name of its own (`--what <what>` for `--what A[,B…]`, `--size <size>` for `--size WxH`), and makes no
tables of formats.
"""

import inspect
import re
from collections.abc import Iterator

import click

from vorotool.cli.command import GroupedCommand
from vorotool.cli.main import COMMANDS, vorotool
from vorotool.products.formats import FORMATS
from vorotool.products.registry import PRODUCTS

OPTION = re.compile(r"(?<![\w`-])(--?[a-z][a-z-]*)")


def reference() -> str:
    """The help of every command, as Markdown."""
    parts = ["# Command-line reference", ""]
    context = click.Context(vorotool, info_name="vorotool")
    for name in COMMANDS:
        command = vorotool.get_command(context, name)
        assert command is not None
        parts += [f"## vorotool {name}", "", *section(command, click.Context(command, info_name=name, parent=context))]
        parts += [*formats_of(name), ""] if name in PRODUCTS else []
    return "\n".join(parts)


def section(command: click.Command, context: click.Context) -> Iterator[str]:
    """What a command does, how it is called, and its options."""
    yield from (f"`{context.command_path} {' '.join(command.collect_usage_pieces(context))}`", "")
    for paragraph in inspect.cleandoc(command.help or "").split("\n\n"):
        lines = [line.strip() for line in paragraph.splitlines() if line.strip() != "\b"]
        if lines[0].startswith("Example"):
            yield from ("```sh", *lines[1:], "```", "")
        elif paragraph.startswith("\b"):
            yield from ("```text", *lines, "```", "")
        else:
            yield from (marked(" ".join(lines)), "")
    for title, rows in groups(command, context).items():
        yield from (f"**{title}**", "", *(f"- `{names}`: {marked(text)}" for names, text in rows), "")


def groups(command: click.Command, context: click.Context) -> dict[str, list[tuple[str, str]]]:
    """Options and what they are for, as the help groups them."""
    if isinstance(command, GroupedCommand):
        return command.grouped(context)
    records = (parameter.get_help_record(context) for parameter in command.get_params(context))
    return {"Options": [record for record in records if record is not None and record[0].startswith("-")]}


def marked(text: str) -> str:
    """Plain text as Markdown, with options as code."""
    return OPTION.sub(r"`\1`", re.sub(r"([\\`*_<>\[\]|])", r"\\\1", text))


def formats_of(command: str) -> list[str]:
    """The table of what a command writes in which formats, with the endings of files."""
    rows = [f"| `{what}` | {', '.join(map(_named, each.formats))} |" for what, each in PRODUCTS[command].items()]
    return ["| `--what` | formats, the default first |", "|---|---|", *rows]


def _named(name: str) -> str:
    each = FORMATS[name]
    return f"{each.title} (`{'`, `'.join(f'.{end}' for end in each.extensions or (each.name,))}`)"
