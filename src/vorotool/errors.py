"""Errors that a user can act on, each with the exit code of the command line."""

from __future__ import annotations


class VorotoolError(Exception):
    """Base of all errors raised on purpose; a bare one is a defect of ours (exit 1)."""

    exit_code = 1


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
