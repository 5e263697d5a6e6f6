"""Errors that a user can act on, with their exit codes, and the messages of errors, warnings and notes."""

from __future__ import annotations

import re
import sys
import warnings
from collections.abc import Iterable
from enum import Enum, auto

_TYPED, _PARAMETER, _END = "\ufdd0", "\ufdd1", "\ufdd2"
"""Noncharacters of Unicode, which no text has: they stand around the two readings of an option in a message."""

_OPTION = f"{_TYPED}([^{_TYPED}-{_END}]*){_PARAMETER}([^{_TYPED}-{_END}]*){_END}"


def option(typed: str, parameter: str | None = None) -> str:
    """Name an option in a message, as it is typed on the command line and as a parameter of Python.

    The text has both readings until it is shown, so that it can be put together with other text, kept, and sent to
    another process. Errors and warnings show the parameter; `VorotoolError.typed` and `Message.typed` what is typed.

    Parameters
    ----------
    typed : str
        As it is typed on the command line, where an option has a value with that.
    parameter : str, optional
        As it is written in Python. By default the name with underscores, and ``=`` before the value, if there is one.

    Returns
    -------
    str
        Both.

    Examples
    --------
    >>> error = UsageError(f"use {option('--window X,Y,W,H', 'window=(x, y, w, h)')}, or {option('--max-sites 9')}")
    >>> print(error)
    use window=(x, y, w, h), or max_sites=9
    >>> error.typed
    'use --window X,Y,W,H, or --max-sites 9'
    """
    if parameter is None:
        name, _, value = typed.lstrip("-").partition(" ")
        parameter = f"{name.replace('-', '_')}{'=' if value else ''}{value}"
    return f"{_TYPED}{typed}{_PARAMETER}{parameter}{_END}"


def element(noun: str, *index: int) -> str:
    """Name an element of an array by its index, which the command line, where it is a row of a file, counts from 1.

    Examples
    --------
    >>> error = InputError(f"{element('point', 2)} is (0.0, nan)")
    >>> print(error)
    point [2] is (0.0, nan)
    >>> error.typed
    'point 3 is (0.0, nan)'
    """
    if not index:  # one number in place of an array
        return noun
    *place, noun = noun.rpartition(", ")  # where it is may be named in two forms, too
    return "".join(place) + option(f"{noun} {index[0] + 1}", f"{noun} [{', '.join(map(str, index))}]")


STRICT = option("--strict", "strict=True")
NO_PROPERTIES = option("--no-properties", "properties=False")
FORMAT = option("-f", "fmt=...")
OTSU = option("--threshold otsu", 'threshold="otsu"')
OUTPUT = option("-o", "path=...")
NO_CLOBBER = option("--no-clobber", "no_clobber=True")
OVERWRITE = option("--overwrite", "overwrite=True")
AS_JSON = option("--input-format json", 'input_format="json"')
INPUT_FORMAT = option("--input-format", "input_format=...")
AS_VOLUME = option("tessellate --volume", 'geometry="volume"')
"""Options that many messages name."""


def _typed(text: str) -> str:
    """Read a text with options as the command line has them."""
    return re.sub(_OPTION, r"\1", text)


def _parameters(text: str) -> str:
    """Read a text with options as Python has them."""
    return re.sub(_OPTION, r"\2", text)


def similar(name: str, names: Iterable[str]) -> str:
    """Join the names that a mistyped one may stand for by "or"; empty where none is like it."""
    from difflib import SequenceMatcher, get_close_matches

    typed = name.lower()
    found = get_close_matches(typed, list(names))
    best = SequenceMatcher(None, found[0], typed).ratio() if found else 0.0
    return " or ".join(each for each in found if SequenceMatcher(None, each, typed).ratio() > 0.9 * best)


def meant(name: str, names: Iterable[str]) -> str:
    """Return the end of a message about a mistyped name: which of the names is meant, perhaps."""
    found = similar(name, names)
    return f"; did you mean {found}?" if found else ""


class Kind(Enum):
    """Kinds of notes and warnings that callers tell apart."""

    GENERAL = auto()
    DEGREES = auto()
    """Longitude and latitude are treated as planar."""
    UNNAMED_CRS = auto()
    """Coordinates that may be longitude and latitude are taken for planar ones."""
    EMPTY_INPUT = auto()
    """An input holds nothing: no geometry, or an image without foreground."""
    EMPTY_RESULT = auto()
    """A result holds nothing, which an empty input implies."""


class Message(str):
    """A line for the user with its kind and its input, so that nothing depends on its wording.

    It is text, and equal to text, so that whoever takes lines takes these as well: the text in which options are
    parameters.

    Parameters
    ----------
    text : str
        The line, which may have texts of `option`.
    kind : Kind
        What it is about.
    source : str, optional
        The input that the words name; None where they name none.

    Attributes
    ----------
    marked : str
        The line in both readings, of which others can be made.

    Examples
    --------
    >>> line = Message("degrees.csv: lengths are in degrees", Kind.DEGREES, source="degrees.csv")
    >>> line.kind is Kind.DEGREES, line.source, line == "degrees.csv: lengths are in degrees"
    (True, 'degrees.csv', True)
    """

    kind: Kind
    source: str | None
    marked: str

    def __new__(cls, text: str = "", kind: Kind = Kind.GENERAL, *, source: str | None = None) -> Message:
        """Make the line."""
        line = super().__new__(cls, _parameters(text))
        line.kind, line.source = kind, source
        line.marked = text.marked if isinstance(text, Message) else text
        return line

    @property
    def typed(self) -> Message:
        """The line as the command line says it.

        Examples
        --------
        >>> line = Message(f"nothing is left: {option('--invert', 'invert=True')} turns it")
        >>> line, line.typed
        ('nothing is left: invert=True turns it', 'nothing is left: --invert turns it')
        """
        return Message(_typed(self.marked), self.kind, source=self.source)

    @classmethod
    def of(cls, text: str) -> Message:
        """Convert text to a message; plain text is of the general kind, and has no source.

        Examples
        --------
        >>> Message.of("3 points are left out").source is None
        True
        """
        return text if isinstance(text, Message) else cls(text)


class VorotoolError(Exception):
    """Base class of all errors of vorotool; raised itself, it is an internal error (exit 1).

    Parameters
    ----------
    text : str, optional
        The message, in which `option` may name options.

    Attributes
    ----------
    source : str or None
        The input named in the message, or None.
    marked : str
        The message template for both readings, command line and library; `str` names options as parameters.
    """

    exit_code = 1
    source: str | None = None
    marked: str

    def __init__(self, text: str = "") -> None:
        """Store the message in both readings."""
        message = Message.of(text)
        self.marked = message.marked
        super().__init__(str(message))

    @property
    def typed(self) -> Message:
        """Message as printed on the command line."""
        return Message(_typed(self.marked), source=self.source)


class VerificationError(VorotoolError):
    """Error for a result that a checker found wrong (exit 1).

    Parameters
    ----------
    text : str, optional
        The message, in which `option` may name options.
    """


class UsageError(VorotoolError, ValueError):
    """Error for conflicting options, or an option's value out of range (exit 2).

    Parameters
    ----------
    text : str, optional
        The message, in which `option` may name options.
    """

    exit_code = 2


class InputError(VorotoolError, ValueError):
    """Error for unusable input; the message names the file, the position, the value and what to do (exit 3).

    Parameters
    ----------
    text : str, optional
        The message, in which `option` may name options.
    """

    exit_code = 3


class OutputError(VorotoolError, OSError):
    """Error for output that cannot be written; an existing file is untouched (exit 4).

    Parameters
    ----------
    text : str, optional
        The message, in which `option` may name options.
    """

    exit_code = 4


class LimitError(VorotoolError):
    """Error for a limit that would be exceeded; raised before memory is allocated (exit 5).

    Parameters
    ----------
    text : str, optional
        The message, in which `option` may name options.
    """

    exit_code = 5


class BatchError(VorotoolError):
    """Error for a batch in which some inputs failed (exit 6).

    Parameters
    ----------
    text : str, optional
        The message, in which `option` may name options.
    """

    exit_code = 6


class VorotoolWarning(UserWarning):
    """Warning that something was repaired, snapped or guessed: one line with counts.

    Parameters
    ----------
    text : str, optional
        The message, in which `option` may name options.
    """

    def __init__(self, text: str = "") -> None:
        """Store the message."""
        super().__init__(Message.of(text))

    @property
    def message(self) -> Message:
        """Message of the warning, one line."""
        return Message.of(*self.args)


class RepairWarning(VorotoolWarning):
    """Warning that polygons were repaired before they were used.

    Parameters
    ----------
    text : str, optional
        The message, in which `option` may name options.
    """


def warn(message: VorotoolWarning | str, category: type[VorotoolWarning] = VorotoolWarning) -> None:
    """Issue a warning at the line outside this package that called it.

    Parameters
    ----------
    message : VorotoolWarning or str
        The line.
    category : type
        Of a line that is text.

    Examples
    --------
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     warnings.simplefilter("always")
    ...     warn("2 seeds were moved")
    >>> str(caught[0].message)
    '2 seeds were moved'
    """
    level, frame = 2, sys._getframe(1)
    while frame.f_back is not None and frame.f_globals.get("__name__", "").startswith("vorotool."):
        level, frame = level + 1, frame.f_back
    warnings.warn(message, category, stacklevel=level)


def silent(category: type[VorotoolWarning] = VorotoolWarning) -> warnings.catch_warnings[None]:
    """Return a context without warnings: what they say was said before, or is not about what was asked for."""
    return warnings.catch_warnings(action="ignore", category=category)
