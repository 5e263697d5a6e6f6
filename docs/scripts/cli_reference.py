"""Print the command-line reference, made from the commands: `docs/scripts/cli_reference.py > docs/cli.md`."""

import sys

import click

from vorotool.cli.main import COMMANDS, vorotool


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
    return "\n".join(parts)


if __name__ == "__main__":
    sys.stdout.write(reference())
