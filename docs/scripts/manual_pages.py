"""Write the manual pages, made from the commands themselves: `docs/scripts/manual_pages.py [FOLDER]`.

click-man 0.6 finds no command, as the entry point is a function that loads the one that is called; given the group
itself it writes one page, that of the group, since it looks for commands that are loaded already. It knows no exit
codes, groups of options or examples.
"""

import re
import sys
from collections.abc import Iterator
from pathlib import Path

import click

from vorotool import __version__
from vorotool.cli.command import GroupedCommand
from vorotool.cli.main import COMMANDS, vorotool

FOLDER = Path(__file__).parents[1] / "man/man1"

EXITS = {
    0: "Done.",
    1: "An internal error in vorotool, or --verify failed.",
    2: "Usage.",
    3: "Bad input: the message names the file, the place, the value and what to do.",
    4: "Output cannot be written; an older file is untouched.",
    5: "A limit would be exceeded, known before memory is taken.",
    6: "Some of many inputs failed.",
}


def pages() -> dict[str, str]:
    """Text of each page by its name."""
    root = click.Context(vorotool, info_name="vorotool")
    made = {"vorotool.1": page("vorotool", "exact Voronoi diagrams", vorotool, root, list_of_commands())}
    for name, purpose in COMMANDS.items():
        command = vorotool.get_command(root, name)
        assert command is not None
        context = click.Context(command, info_name=name, parent=root)
        made[f"vorotool-{name}.1"] = page(f"vorotool-{name}", purpose.rstrip("."), command, context, [])
    return made


def page(name: str, purpose: str, command: click.Command, context: click.Context, middle: list[str]) -> str:
    """One page in the language of man(7)."""
    others = [other for other in ("vorotool", *(f"vorotool-{each}" for each in COMMANDS)) if other != name]
    lines = [
        f'.TH "{quoted(name.upper())}" 1 "" "vorotool {__version__}" "vorotool manual"',
        ".SH NAME",
        rf"{quoted(name)} \- {quoted(purpose)}",
        ".SH SYNOPSIS",
        rf"\fB{quoted(context.command_path)}\fR {quoted(' '.join(command.collect_usage_pieces(context)))}",
        ".SH DESCRIPTION",
        *description(command.help or ""),
        *middle,
        ".SH OPTIONS",
        *options(command, context),
        ".SH EXIT STATUS",
        *(line for code, text in EXITS.items() for line in (".TP", str(code), quoted(text))),
        ".SH SEE ALSO",
        *(rf"\fB{quoted(other)}\fR(1){',' * (other != others[-1])}" for other in others),
    ]
    return "\n".join(lines) + "\n"


def list_of_commands() -> list[str]:
    """The commands, each with what it does."""
    named = ((".TP", rf"\fBvorotool\-{quoted(name)}\fR(1)", quoted(text)) for name, text in COMMANDS.items())
    return [".SH COMMANDS", *(line for lines in named for line in lines)]


def description(text: str) -> Iterator[str]:
    """Paragraphs; those that click does not wrap keep their lines."""
    for number, paragraph in enumerate(text.strip().split("\n\n")):
        lines = [line for line in paragraph.split("\n") if line]
        if number:
            yield ".PP"
        if lines[0].strip() == "\b":
            yield from (".nf", *map(quoted, lines[1:]), ".fi")
        else:
            yield quoted(" ".join(line.strip() for line in lines))


def options(command: click.Command, context: click.Context) -> Iterator[str]:
    """Each option with its value, and what it is for, in the groups of the help."""
    if isinstance(command, GroupedCommand):
        for title, rows in command.grouped(context).items():
            yield from (f".SS {title}", *listed(rows))
    else:
        records = (parameter.get_help_record(context) for parameter in command.get_params(context))
        yield from listed([record for record in records if record is not None and record[0].startswith("-")])


def listed(rows: list[tuple[str, str]]) -> Iterator[str]:
    """Paragraphs of options."""
    for names, text in rows:
        yield from (".TP", " ".join(map(bold, names.split(" "))), quoted(text))


def bold(word: str) -> str:
    """A word, bold if it is an option."""
    name = word.rstrip(",")
    return rf"\fB{quoted(name)}\fR{word[len(name) :]}" if name.startswith("-") else quoted(word)


def quoted(text: str) -> str:
    """Text in which nothing is taken for a request or an escape."""
    text = text.replace("\\", r"\e").replace("-", r"\-")
    text = re.sub(r"[^\x00-\x7f]", lambda m: rf"\[u{ord(m[0]):04X}]", text)
    return rf"\&{text}" if text.startswith((".", "'")) else text


def main() -> None:
    """Write all pages; those of commands that are no more are removed."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER
    folder.mkdir(parents=True, exist_ok=True)
    made = pages()
    for old in {path.name for path in folder.glob("*.1")} - made.keys():
        (folder / old).unlink()
    for name, text in made.items():
        (folder / name).write_text(text, encoding="ascii")


if __name__ == "__main__":
    main()
