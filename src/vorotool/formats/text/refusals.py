"""Refusals of unknown formats and layers."""

from __future__ import annotations

from collections.abc import Collection

from vorotool.errors import UsageError


def check_what(what: str, choices: Collection[str], value: str) -> None:
    """Refuse a part that a value does not have.

    Parameters
    ----------
    what : str
        The part.
    choices : collection of str
        Those that it has.
    value : str
        The value, with its verb.

    Raises
    ------
    UsageError
        If there is no such part.

    Examples
    --------
    >>> check_what("faces", ["edges", "triangles"], "a triangulation is")
    Traceback (most recent call last):
    vorotool.errors.UsageError: 'faces' is nothing that a triangulation is written as: use edges or triangles
    """
    if what not in choices:
        raise UsageError(f"{what!r} is nothing that {value} written as: use {' or '.join(choices)}")


def check_format(fmt: str, formats: Collection[str], what: str) -> None:
    """Refuse a format that has no place for what is to be written.

    Parameters
    ----------
    fmt : str
        The format.
    formats : collection of str
        Those that have.
    what : str
        What is to be written.

    Raises
    ------
    UsageError
        If the format is none of them.

    Examples
    --------
    >>> check_format("obj", ["csv", "wkt"], "cells")
    Traceback (most recent call last):
    vorotool.errors.UsageError: cells cannot be written as 'obj': use one of csv, wkt
    """
    if fmt not in formats:
        raise UsageError(f"{what} cannot be written as {fmt!r}: use one of {', '.join(formats)}")
