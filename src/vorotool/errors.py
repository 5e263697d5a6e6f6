"""Errors that a user can act on, each with the exit code of the command line; and what is said beside them."""

from __future__ import annotations

from enum import Enum, auto


class Kind(Enum):
    """Kinds of notes and warnings that callers tell apart."""

    GENERAL = auto()
    DEGREES = auto()
    """Longitude and latitude are treated as planar."""
    UNNAMED_CRS = auto()
    """Coordinates that may be longitude and latitude are taken for planar ones."""
    NO_FOREGROUND = auto()
    """An image holds nothing."""
    EMPTY_RESULT = auto()
    """A result holds nothing: of an image without foreground that goes without saying."""


class Message(str):
    """A line for the user that knows what it is about: nothing is to be told from its words.

    It is text, and equal to text, so that whoever takes lines takes these as well.

    Parameters
    ----------
    text : str
        The line.
    kind : Kind
        What it is about.
    source : str, optional
        The input that the words name; None where they name none.

    Examples
    --------
    >>> said = Message("degrees.csv: lengths are in degrees", Kind.DEGREES, source="degrees.csv")
    >>> said.kind is Kind.DEGREES, said.source, said == "degrees.csv: lengths are in degrees"
    (True, 'degrees.csv', True)
    """

    kind: Kind
    source: str | None

    def __new__(cls, text: str = "", kind: Kind = Kind.GENERAL, *, source: str | None = None) -> Message:
        """Make the line."""
        line = super().__new__(cls, text)
        line.kind, line.source = kind, source
        return line

    @classmethod
    def of(cls, text: str) -> Message:
        """Give a line as a message; plain text is about nothing in particular, and names no input.

        Examples
        --------
        >>> Message.of("3 points are left out").source is None
        True
        """
        return text if isinstance(text, Message) else cls(text)


class VorotoolError(Exception):
    """Base of all errors raised on purpose; a bare one is a defect of ours (exit 1).

    Attributes
    ----------
    source : str or None
        The input that the words name; None where they name none.
    """

    exit_code = 1
    source: str | None = None


class VerificationError(VorotoolError):
    """A shipped checker found a result wrong (exit 1)."""


class UsageError(VorotoolError, ValueError):
    """Options that do not go together, or an option's value out of range (exit 2)."""

    exit_code = 2


class InputError(VorotoolError, ValueError):
    """Input that cannot be used: the message names the file, the place, the value and what to do (exit 3)."""

    exit_code = 3


class OutputError(VorotoolError, OSError):
    """Output that cannot be written; an older file is untouched (exit 4)."""

    exit_code = 4


class LimitError(VorotoolError):
    """A limit would be exceeded; found before memory is taken (exit 5)."""

    exit_code = 5


class BatchError(VorotoolError):
    """A batch in which some inputs failed (exit 6)."""

    exit_code = 6


class VorotoolWarning(UserWarning):
    """Something was repaired, snapped or guessed; one line that counts what was done."""

    @property
    def message(self) -> Message:
        """The line."""
        return Message.of(*self.args[:1])


class RepairWarning(VorotoolWarning):
    """Polygons were repaired where they were placed."""
