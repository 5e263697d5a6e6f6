"""Outputs that appear whole or not at all."""

from __future__ import annotations

import errno
import os
import stat
import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from functools import partial
from typing import BinaryIO, NamedTuple

from vorotool.errors import FORMAT, NO_CLOBBER, OUTPUT, OutputError, UsageError, VorotoolError
from vorotool.formats.io.descriptors import (
    STANDARD,
    check_writable,
    descriptor_of,
    number_of,
    open_onward,
    open_output_descriptor,
)
from vorotool.formats.io.sources import file_of
from vorotool.formats.io.temporaries import Placement, committed_together, new_file
from vorotool.numeric.parallel import scoped

STANDARD_OUTPUT = "standard output"


class Rules(NamedTuple):
    """What an output must not replace, for its further files."""

    no_clobber: bool = False  # as for `open_output`
    inputs: Sequence[str | os.PathLike[str]] = ()  # as for `open_output`
    option: str = OUTPUT  # as for `open_output`

    def check(self, name: str, target: str | None = None) -> None:
        """Refuse to replace or remove a file, which is a target that links have been followed to."""
        target = followed(name, self.option) if target is None else target
        if not os.path.exists(target):
            return
        for each in self.inputs:
            if is_same_file(target, os.fspath(each)):
                raise UsageError(
                    f"{name} is also an input, which is never replaced: choose another name with {self.option}"
                )
        if self.no_clobber:
            raise clobber_error(name, self.option)


_RULES: ContextVar[Rules] = ContextVar("rules", default=Rules())  # noqa: B039, they are frozen


def current_rules() -> Rules:
    """Return the rules of the output that is being written."""
    return _RULES.get()


@contextmanager
def open_output(
    path: str | os.PathLike[str],
    *,
    binary: bool = False,
    no_clobber: bool = False,
    inputs: Iterable[str | os.PathLike[str]] = (),
    option: str = OUTPUT,
) -> Iterator[BinaryIO]:
    """Open an output that replaces an older file only when all of it has been written."""
    name = os.fspath(path)
    rules = Rules(no_clobber, tuple(inputs), option)
    descriptor, target, is_regular = check_output(name, binary=binary, **rules._asdict())
    told = partial(explained, name, option)
    if descriptor is not None:  # open already: written in order, after what it holds
        with told(), open_output_descriptor(descriptor) as out:
            yield out
        return
    if name == STANDARD:  # where standard output is no descriptor
        with told():
            sys.stdout.flush()
            yield sys.stdout.buffer
            sys.stdout.buffer.flush()
        return
    if not is_regular:  # a pipe or a device
        with told(), open_onward(target) as out:
            if binary and out.isatty():
                raise terminal_error()
            yield out
        return
    with told(), committed_together() as commit:
        temporary = commit.make(target, partial(new_file, like=target))
        with scoped(_RULES, rules), temporary.opened() as out:
            yield out

        def check() -> None:
            if os.path.exists(target):
                raise clobber_error(name, option)

        commit.placements[target] = Placement(temporary, told, check if no_clobber else None)


class Place(NamedTuple):
    """Where an output goes."""

    descriptor: int | None  # that is open already
    target: str  # of others the file, links followed
    is_regular: bool  # an ordinary file, which may be replaced, is there or will be


def check_output(
    path: str | os.PathLike[str],
    *,
    binary: bool = False,
    no_clobber: bool = False,
    inputs: Iterable[str | os.PathLike[str]] = (),
    makes_folder: bool = False,
    option: str = OUTPUT,
) -> Place:
    """Find out where an output goes, and refuse one that cannot be written: before any work, too."""
    name = os.fspath(path)
    if name == STANDARD:
        number, is_terminal = number_of(sys.stdout), sys.stdout.isatty()
    else:
        number = descriptor_of(name)
        is_terminal = number is not None and os.isatty(number)
    if binary and is_terminal:
        raise terminal_error()
    if number is not None:
        with explained(name, option):
            check_writable(number)
    if number is not None or name == STANDARD:
        return Place(number, name, False)
    target, mode = followed(name, option), None
    with suppress(OSError):
        mode = os.stat(target).st_mode
    if not name:
        raise OutputError("the name of the output is empty: name a file")
    if name.endswith(os.sep) or (mode is not None and stat.S_ISDIR(mode)):
        raise OutputError(f"{name!r} is a directory: name a file in it")
    if mode is not None and not stat.S_ISREG(mode):
        return Place(None, target, False)
    if mode is not None:
        Rules(no_clobber, tuple(inputs), option).check(name, target)
        if not os.access(target, os.W_OK):
            raise OutputError(f"{name} cannot be written: it is write-protected; choose another name with {option}")
    check_folder(name, os.path.dirname(target), makes_folder=makes_folder, option=option)
    return Place(None, target, True)


def check_folder(name: str, folder: str, *, makes_folder: bool = False, option: str = OUTPUT) -> None:
    """Refuse an output whose folder is not there, unless it is made, or cannot be written in."""
    while makes_folder and not os.path.exists(folder):
        folder = os.path.dirname(folder)
    if not os.path.isdir(folder):
        code = errno.ENOTDIR if os.path.exists(folder) else errno.ENOENT
        raise failure(name, OSError(code, "not a directory"), option)
    if not os.access(folder, os.W_OK | os.X_OK):
        raise failure(name, OSError(errno.EACCES, f"no permission to write in {folder}"), option)


def make_folder(path: str | os.PathLike[str]) -> None:
    """Make a folder for outputs and those above it, where they are not there yet."""
    try:
        os.makedirs(path, exist_ok=True)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise OutputError(f"the folder {os.fspath(path)!r} cannot be created: {reason}; name another") from error


def terminal_error() -> UsageError:
    """Say that a terminal is no place for what is not text."""
    return UsageError(
        f"binary output is not written to a terminal: name a file with {OUTPUT}, or a text format with {FORMAT}"
    )


def spoken(name: str) -> str:
    """Give what messages call an output."""
    return STANDARD_OUTPUT if name == STANDARD else name


def followed(name: str, option: str = OUTPUT) -> str:
    """Follow links, so that a file is replaced and not the link to it."""
    try:
        if descriptor_of(name, of_others=True) is not None:
            raise OutputError(
                f"{name} is open in another process and cannot be opened again: name a file with {option}"
            )
        target = os.path.realpath(name)
        try:
            os.stat(target)
        except FileNotFoundError:
            pass
        except OSError as error:
            if error.errno == errno.ELOOP:
                text = f"{name} cannot be written: its links lead back to themselves; choose another name"
                raise OutputError(text) from None
            if error.errno != errno.ENOTDIR:
                raise
    except VorotoolError:
        raise
    except (OSError, ValueError) as error:
        fault = getattr(error, "strerror", None) or error
        raise OutputError(f"{name!r} cannot be written: {fault}; choose another name") from None
    return target


def clobber_error(name: str, option: str = OUTPUT) -> OutputError:
    """Say that an output is there already, with ``--no-clobber``."""
    return OutputError(f"{name} already exists, and {NO_CLOBBER} is set: choose another name with {option}")


def is_same_file(target: str | os.PathLike[str], source: str) -> bool:
    """Whether an output is an input; ``-`` is standard input."""
    try:
        if source == STANDARD:
            return os.path.samestat(os.stat(target), os.fstat(sys.stdin.fileno()))
        return os.path.samefile(target, file_of(source))
    except (OSError, ValueError, AttributeError):  # an input that is not there, or no file, is no output
        return False


@contextmanager
def explained(name: str, option: str = OUTPUT) -> Iterator[None]:
    """Turn what the system says of an output into an `OutputError` that names it."""
    try:
        yield
    except (BrokenPipeError, VorotoolError):
        raise
    except OSError as error:
        raise failure(name, error, option) from error


def failure(name: str, error: OSError, option: str = OUTPUT) -> OutputError:
    """Say why an output cannot be written, and what to do."""
    elsewhere = f"write elsewhere with {option}"
    advice = {
        "ENOENT": "create the directory first",
        "ENOTDIR": "a part of the path is a file, choose another folder",
        "ENOSPC": f"free some space, or {elsewhere}",
        "EDQUOT": f"free some space, or {elsewhere}",
    }
    code, reason = errno.errorcode.get(error.errno or 0, ""), error.strerror or error
    if code == "ENOENT":
        reason = "the directory does not exist"
        folder = os.path.dirname(name) or "."
        if os.path.isdir(folder):  # as in /proc and /dev/fd, which are made by the system
            code, reason = "", f"no file can be created in {folder}"
    return OutputError(f"{spoken(name)} cannot be written: {reason}; {advice.get(code, elsewhere)}")
