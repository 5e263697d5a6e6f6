"""The small files that come with the package: where they are."""

from __future__ import annotations

from difflib import get_close_matches
from importlib.resources import files
from pathlib import Path

from vorotool.errors import UsageError
from vorotool.products.samples import SAMPLES


def sample(name: str) -> Path:
    """Give the path of a small file that comes with the package, for `read`.

    Parameters
    ----------
    name : str
        ``dots.csv``, ``six-seeds.csv``, ``blobs.png``, ``cells.png``, ``nuclei.tif``, ``shape.json``,
        ``two-shapes.json``, ``segments.wkt`` or ``great-lakes.geojson``; ``vorotool sample`` says what each is.

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


def _listing() -> str:
    return f"use one of {', '.join(SAMPLES)}"
