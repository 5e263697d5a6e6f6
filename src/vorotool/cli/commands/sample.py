"""``vorotool sample``."""

from __future__ import annotations

import click

from vorotool.cli.options.suggestions import any_file, words
from vorotool.products.samples import SAMPLES


@click.command("sample")
@click.argument("name", required=False, shell_complete=words(SAMPLES))
@click.option(
    "-o", "--output", metavar="FILE", help="Where to write; by default standard output.", shell_complete=any_file
)
def command(name: str | None, output: str | None) -> None:
    """Write a small file to try commands on; without a name, list all.

    \b
    Example:
      vorotool sample dots.csv -o dots.csv

    The examples of all commands use these files, so that they run in any folder. Text goes to standard output unless
    -o names a file, so that it can be read by another command: vorotool sample shape.json | vorotool skeleton-exact -
    """
    from vorotool.errors import UsageError

    if name is not None:
        from vorotool.jobs.samples import write_sample

        write_sample(name, output)
    elif output is not None:
        raise UsageError(f"-o {output} needs the name of a sample: use one of {', '.join(SAMPLES)}")
    else:
        width = max(map(len, SAMPLES))
        click.echo("\n".join(f"{each:{width}}  {text}" for each, text in SAMPLES.items()))
