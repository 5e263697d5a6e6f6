"""Entry point: finds the command, and turns every outcome into an exit code."""

from __future__ import annotations

import io
import os
import sys
from contextlib import suppress
from importlib import import_module
from typing import TYPE_CHECKING, NoReturn, TextIO

import click
from click.utils import _expand_args

from vorotool import __version__
from vorotool.errors import VorotoolError, similar
from vorotool.jobs.terminal import escaped, explained, print_text, tell
from vorotool.products import commands
from vorotool.signals import handle_termination, ignore_interrupts, insist_on_the_end, received, settled

if TYPE_CHECKING:
    from pathlib import Path

    from click.shell_completion import CompletionItem

COMMANDS = {**{name: each.summary for name, each in commands.COMMANDS.items()}, **commands.OTHERS}
"""Commands and what they do; a command is made when it is called."""

EXIT_OUTPUT, EXIT_INTERRUPTED, EXIT_BROKEN_PIPE = 4, 130, 141


class LazyGroup(click.Group):
    """A group whose commands are imported only when they are used."""

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the command; one that is mistyped is refused with those that are meant, perhaps."""
        name = args[0]
        if not name.startswith("-") and not ctx.resilient_parsing and name not in COMMANDS:
            close = similar(name.replace("_", "-"), COMMANDS)
            advice = f"did you mean {close}?" if close else f"use one of {', '.join(COMMANDS)}"
            raise click.UsageError(f"unknown command {name!r}: {advice}", ctx)
        if name not in commands.COMMANDS or ctx.resilient_parsing:
            return super().resolve_command(ctx, args)
        from vorotool.cli.command import computing_command

        return name, computing_command(name, args[1:]), args[1:]

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Names in the order of the registry."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Make or import a command."""
        if cmd_name not in COMMANDS:
            return None
        from vorotool.cli.command import EPILOG, computing_command

        if cmd_name in commands.COMMANDS:
            return computing_command(cmd_name)
        command: click.Command = import_module(f"vorotool.cli.commands.{cmd_name}").command
        command.epilog = EPILOG.format(cmd_name)
        return command

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem[str]]:
        """Offer commands without importing them."""
        from click.shell_completion import CompletionItem

        found = [CompletionItem(name, help=text) for name, text in COMMANDS.items() if name.startswith(incomplete)]
        return found or click.Command.shell_complete(self, ctx, incomplete)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """List the commands without importing them."""
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Say where the manual pages and the documents are."""
        with formatter.section("Documentation"):
            formatter.write_text("vorotool COMMAND --help lists all options of a command, -h the common ones.")
            for name, where in places():
                formatter.write(f"  {name}\n      {where}\n")


vorotool = LazyGroup(
    "vorotool",
    context_settings={"help_option_names": ["-h", "--help"]},
    help="""Exact Voronoi diagrams of images, points and polygons.

\b
Example:
  vorotool sample dots.csv -o dots.csv
  vorotool tessellate dots.csv --size 512x512 --what color -o picture.png""",
)
click.version_option(__version__, prog_name="vorotool")(vorotool)


def main(arguments: list[str] | None = None) -> NoReturn:
    """Run the command line and leave with its exit code."""
    if None in (sys.stdout, sys.stderr):
        _replace_closed_streams()
    handle_termination()
    insist_on_the_end()
    try:
        code = _run(arguments)
    except KeyboardInterrupt:  # while the end was being told
        code = EXIT_INTERRUPTED
    code = settled(code)
    try:
        sys.stdout.flush()
    except OSError as error:
        _abandon(sys.stdout)
        if isinstance(error, BrokenPipeError):
            code = EXIT_BROKEN_PIPE
        elif code != EXIT_OUTPUT:  # which has been reported
            code = _fail(f"standard output cannot be written: {error.strerror or error}", EXIT_OUTPUT)
    try:
        sys.stderr.flush()
    except OSError:  # nobody hears what is wrong; the exit code remains
        _abandon(sys.stderr)
    ignore_interrupts()
    sys.exit(code)


def _abandon(stream: TextIO) -> None:
    """Let what is left in a stream's buffer go nowhere: the interpreter flushes it once more when it ends."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def _replace_closed_streams() -> None:
    """Put something in the place of closed streams, or the next file that is opened takes their number.

    Messages then go nowhere; what is written to standard output fails, as it should.
    """
    for number, name, flags in ((1, "stdout", os.O_RDONLY), (2, "stderr", os.O_WRONLY)):
        if getattr(sys, name) is None:
            opened = os.open(os.devnull, flags)
            os.dup2(opened, number)
            if opened != number:
                os.close(opened)
            setattr(sys, name, os.fdopen(number, "w", encoding="utf-8", closefd=False))


def _run(arguments: list[str] | None) -> int:
    if arguments is None:
        arguments = _expand_args(sys.argv[1:]) if os.name == "nt" else sys.argv[1:]
    try:  # without `click.Command.main`, which prints something, or exits, where a signal or a closed pipe ends the run
        if os.environ.get("_VOROTOOL_COMPLETE"):  # a shell asks what an argument can be
            from vorotool.cli.commands.completion import complete

            return complete(vorotool)
        with vorotool.make_context("vorotool", [*arguments]) as context:
            vorotool.invoke(context)
        return 0
    except (Exception, KeyboardInterrupt) as error:
        return _told(error, arguments)


def _told(error: Exception | KeyboardInterrupt, arguments: list[str]) -> int:
    """Say what is wrong; the exit code."""
    if isinstance(error, click.UsageError) and isinstance(error.__context__ or error, click.NoSuchOption):
        files = [each for each in arguments if each.startswith("-") and os.path.lexists(each)]
        if files:
            said = f"{files[0]} is taken for an option: for the file of this name write ./{files[0]}"
            error = click.UsageError(said, error.ctx)
    if isinstance(error, click.exceptions.Exit):
        return error.exit_code
    if isinstance(error, KeyboardInterrupt | BrokenPipeError):
        return EXIT_INTERRUPTED if isinstance(error, KeyboardInterrupt) else EXIT_BROKEN_PIPE
    if isinstance(error, click.ClickException):
        shown = io.StringIO()
        error.show(shown)
        with suppress(OSError):  # the exit code remains
            print_text(_lines_of(shown.getvalue()), sys.stderr)
        return error.exit_code
    if received():  # an interrupt that a library turned into an error of its own
        return received()
    if isinstance(error, OSError) and not isinstance(error, VorotoolError):
        return _fail(_of_streams(error), EXIT_OUTPUT)
    return _fail(*explained(error))


def _lines_of(text: str) -> str:
    """Write the lines of click's message as ours are."""
    lines = (f"error: {line[7:]}" if line.startswith("Error: ") else line for line in text.split("\n"))
    return "\n".join(map(escaped, lines))


def _of_streams(error: OSError) -> str:
    """Outputs have their own messages: this is about the help, a warning, or a path that is looked at."""
    if error.filename is not None:
        name = os.fsdecode(error.filename) if isinstance(error.filename, bytes) else error.filename
        return f"{name} cannot be used: {error.strerror or error}; check who may do so"
    return f"standard output or standard error cannot be written: {error.strerror or error}; redirect it elsewhere"


def _fail(message: str, code: int) -> int:
    with suppress(OSError):  # the exit code remains
        tell(f"error: {message}")
    return code


MANUAL, DOCUMENTS = "share/man/man1/vorotool.1", "share/doc/vorotool/README.md"
"""Ends of the paths of the first manual page and of the first document."""


def places() -> list[tuple[str, str]]:
    """Return what there is to read and where, as rows of the help; nothing for what is not installed."""
    rows = []
    manual, documents = _installed(MANUAL), _installed(DOCUMENTS)
    if manual is not None:
        rows.append(("man vorotool, man vorotool-COMMAND", f"in {_printable(manual.parents[1])}"))
    if documents is not None:
        rows.append((_printable(documents), "the README, and the documents that it links to"))
    return rows


def _installed(end: str) -> Path | None:
    """Return the path of a file of the package outside the folder of its modules."""
    from importlib import metadata
    from pathlib import Path

    try:
        files = metadata.files("vorotool") or []
    except metadata.PackageNotFoundError:
        return None
    found = (Path(str(file.locate())).resolve() for file in files if file.as_posix().endswith(end))
    return next((path for path in found if path.is_file()), None)


def _printable(path: Path) -> str:
    """Escape what standard output cannot show."""
    encoding = sys.stdout.encoding or "ascii"
    return str(path).encode(encoding, "backslashreplace").decode(encoding)
