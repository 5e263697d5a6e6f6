"""Libraries that not every user needs: imported when they are used, named with the way to get them where they lack."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from vorotool.errors import UsageError


def needed(module: str, extra: str, purpose: str) -> Any:
    """Import a library of one of the extras of the package.

    Parameters
    ----------
    module : str
        What is imported: the library, or a module of it.
    extra : str
        The extra that has it.
    purpose : str
        What needs it, in the plural.

    Returns
    -------
    module
        As `importlib.import_module` gives it.

    Raises
    ------
    UsageError
        If it is not installed; the command that installs it is given.

    Examples
    --------
    >>> needed("json", "gis", "GeoPackages").dumps([1])
    '[1]'
    >>> needed("no_such_library.part", "gis", "GeoPackages")
    Traceback (most recent call last):
        ...
    vorotool.errors.UsageError: GeoPackages need the package no_such_library: pip install 'vorotool[gis]'
    """
    try:
        return import_module(module)
    except ImportError:
        package = module.partition(".")[0]
        raise UsageError(f"{purpose} need the package {package}: pip install 'vorotool[{extra}]'") from None
