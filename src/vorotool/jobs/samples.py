"""The small files that come with the package: where they are, and written where they are wanted."""

from __future__ import annotations

from difflib import get_close_matches
from importlib.resources import files
from pathlib import Path

from vorotool.errors import UsageError
from vorotool.products.formats import EXTENSIONS, FORMATS
from vorotool.products.samples import SAMPLES


def sample(name: str) -> Path:
    """Give the path of a small file that comes with the package, for `read`.

    Parameters
    ----------
    name : str
        ``dots.csv``, ``six-seeds.csv``, ``blobs.png``, ``cells.png``, ``shape.json``, ``two-shapes.json``,
        ``segments.wkt`` or ``great-lakes.geojson``; ``vorotool sample`` says what each is.

    Returns
    -------
    Path
        Of the file in the package.

    Raises
    ------
    UsageError
        If there is no such sample; the message has the names.

    Examples
    --------
    >>> import vorotool
    >>> len(vorotool.read(sample("dots.csv")))
    53
    """
    if name not in SAMPLES:
        meant = " or ".join(get_close_matches(name.lower(), SAMPLES))
        raise UsageError(f"there is no sample {name!r}: " + (f"did you mean {meant}?" if meant else _listing()))
    return Path(str(files("vorotool").joinpath("samples", name)))


def write_sample(name: str, output: str | None) -> None:
    """Write a sample; the bytes are those of the package.

    Parameters
    ----------
    name : str
        One of `SAMPLES`.
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


def _listing() -> str:
    return f"use one of {', '.join(SAMPLES)}"
