"""The samples that come with the package: their names and paths."""

from __future__ import annotations

from difflib import get_close_matches
from importlib.resources import files
from pathlib import Path

from vorotool.errors import UsageError
from vorotool.numeric.checks import is_choice
from vorotool.products.samples import SAMPLES


def sample(name: str) -> Path:
    """Return the path of a sample file of the package.

    Parameters
    ----------
    name : str
        Name of a sample, with or without its extension: ``dots.csv`` or ``dots``. ``vorotool sample`` lists all.

    Returns
    -------
    Path
        The file in the package, for `read`.

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
    return Path(str(files("vorotool").joinpath("samples", sample_name(name))))


def sample_name(name: str) -> str:
    """Return the full name of a sample that is named with or without its extension."""
    names = {Path(each).stem: each for each in SAMPLES} | {each: each for each in SAMPLES}
    if not is_choice(name, names):
        close = " or ".join(dict.fromkeys(names[each] for each in get_close_matches(str(name).lower(), names)))
        advice = f"did you mean {close}?" if close else f"use one of {', '.join(SAMPLES)}"
        raise UsageError(f"there is no sample {name!r}: {advice}")
    return names[name]
