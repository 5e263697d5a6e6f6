"""``vorotool sample``."""

from __future__ import annotations

import click

from vorotool.cli.command import candidates, words
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
        from vorotool.jobs.samples import write_all_samples

        write_all_samples("." if output is None else output)
    elif name is not None:
        from vorotool.jobs.samples import write_sample

        write_sample(name, output)
    elif output is not None:
        raise UsageError(f"-o {output} needs the name of a sample, or --all: use one of {', '.join(SAMPLES)}")
    else:
        from vorotool.jobs.terminal import print_text

        width = max(map(len, SAMPLES))
        print_text("".join(f"{each:{width}}  {text}\n" for each, text in SAMPLES.items()))
