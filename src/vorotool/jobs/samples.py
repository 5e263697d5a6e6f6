"""The small files that come with the package, written where they are wanted."""

from __future__ import annotations

from pathlib import Path

from vorotool.errors import UsageError
from vorotool.formats.samples import sample
from vorotool.products.formats import EXTENSIONS, FORMATS


def write_sample(name: str, output: str | None) -> None:
    """Write a sample; the bytes are those of the package.

    Parameters
    ----------
    name : str
        One of `vorotool.products.samples.SAMPLES`.
    output : str, optional
        Where to write; by default standard output, for text.

    Raises
    ------
    UsageError
        If there is no such sample, or it is binary and nothing says where to.

    Examples
    --------
    >>> write_sample("dots", None)
    Traceback (most recent call last):
        ...
    vorotool.errors.UsageError: there is no sample 'dots': did you mean dots.csv?
    """
    from vorotool.formats.io.atomic_output import open_output

    path = sample(name)
    is_binary = not FORMATS[EXTENSIONS[Path(name).suffix]].is_text
    if output is None and is_binary:
        raise UsageError(f"{name} is binary: say where it goes with -o {name}")
    with open_output(output or "-", binary=is_binary) as out:
        out.write(path.read_bytes())
