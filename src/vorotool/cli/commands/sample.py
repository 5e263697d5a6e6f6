"""``vorotool sample``: write the samples that come with the package."""

from __future__ import annotations

import os
from pathlib import Path

import click

from vorotool.cli.command import candidates, words
from vorotool.errors import OutputError, UsageError
from vorotool.formats import sample
from vorotool.products.formats import EXTENSIONS, FORMATS
from vorotool.products.samples import SAMPLES


@click.command("sample")
@click.argument("name", required=False, shell_complete=words(SAMPLES))
@click.option("--all", "every", is_flag=True, help="Write every sample into a folder.")
@click.option(
    "-o",
    "--output",
    metavar="FILE",
    help="Output file; by default standard output. With --all a folder; by default the current one.",
    shell_complete=candidates("sample", "any"),
)
def command(name: str | None, every: bool, output: str | None) -> None:
    """Write a small file to try commands on; without a name, list all.

    \b
    Example:
      vorotool sample dots.csv -o dots.csv

    The examples of all commands and of the documentation use these files. vorotool sample --all writes every one into
    the current folder and never replaces a file with other content. Text goes to standard output unless -o names a
    file, for another command to read: vorotool sample shape.json | vorotool skeleton-exact -
    """
    from vorotool.errors import UsageError

    if every and name is not None:
        raise UsageError(f"--all writes every sample: leave out {name}, or --all")
    if every:
        write_all_samples("." if output is None else output)
    elif name is not None:
        write_sample(name, output)
    elif output is not None:
        raise UsageError(f"-o {output} needs the name of a sample, or --all: use one of {', '.join(SAMPLES)}")
    else:
        from vorotool.jobs.terminal import print_text

        width = max(map(len, SAMPLES))
        print_text("".join(f"{each:{width}}  {text}\n" for each, text in SAMPLES.items()))


def write_sample(name: str, output: str | None) -> None:
    """Write a sample; the bytes are those of the package."""
    from vorotool.formats.io.atomic_output import open_output

    path = sample(name)
    is_binary = not FORMATS[EXTENSIONS[path.suffix]].is_text
    if output is None and is_binary:
        raise UsageError(f"{path.name} is binary: name a file with -o {path.name}")
    with open_output(output or "-", binary=is_binary) as out:
        out.write(path.read_bytes())


def write_all_samples(folder: str) -> None:
    """Write every sample into a folder, which is made if it is missing; never replace a file with other content."""
    from vorotool.formats.io.atomic_output import make_folder
    from vorotool.formats.io.descriptors import STANDARD
    from vorotool.formats.io.temporaries import committed_together

    if folder == STANDARD:
        raise UsageError("--all writes files: name a folder with -o")
    make_folder(folder)
    targets = {name: Path(folder) / name for name in SAMPLES}
    missing = {name: target for name, target in targets.items() if not _is_written(name, target)}
    with committed_together():
        for name, target in missing.items():
            write_sample(name, str(target))


def _is_written(name: str, target: Path) -> bool:
    """Whether a sample is in its place already; refuse to replace anything else that is there."""
    if not os.path.lexists(target):
        return False
    if target.is_file() and target.read_bytes() == sample(name).read_bytes():
        return True
    raise OutputError(f"{target} exists with other content, which is never replaced: name another folder with -o")
