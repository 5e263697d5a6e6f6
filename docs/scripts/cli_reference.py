"""Print the command-line reference, made from the commands: `docs/scripts/cli_reference.py > docs/cli.md`."""

import sys

import click

from vorotool.cli.main import COMMANDS, vorotool
from vorotool.products.formats import FORMATS
from vorotool.products.registry import PRODUCTS


def reference() -> str:
    """The help of every command, as Markdown."""
    parts = [
        "# Command-line reference",
        "",
        "Made by `python docs/scripts/cli_reference.py`; a test keeps it true.",
        "",
    ]
    context = click.Context(vorotool, info_name="vorotool", terminal_width=100, max_content_width=100)
    for name in COMMANDS:
        command = vorotool.get_command(context, name)
        assert command is not None
        inner = click.Context(command, info_name=name, parent=context, terminal_width=100, max_content_width=100)
        parts += [f"## vorotool {name}", "", "```text", command.get_help(inner), "```", ""]
        parts += [*formats_of(name), ""] if name in PRODUCTS else []
    return "\n".join(parts)


def formats_of(command: str) -> list[str]:
    """The table of what a command writes in which formats, with the endings of files."""
    rows = [f"| `{what}` | {', '.join(map(_named, each.formats))} |" for what, each in PRODUCTS[command].items()]
    return ["| `--what` | formats, the default first |", "|---|---|", *rows]


def _named(name: str) -> str:
    each = FORMATS[name]
    return f"{each.title} (`{'`, `'.join(each.endings)}`)"


if __name__ == "__main__":
    sys.stdout.write(reference())
