"""Bytes of an input, and what is checked before a parser sees them."""

from __future__ import annotations

import os
import re
import sys
import threading
import warnings
import zlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import fields
from typing import Any, BinaryIO, TypeVar

from vorotool.errors import InputError, LimitError, UsageError, VorotoolError, option
from vorotool.formats.io.descriptors import STANDARD, descriptor_of, number_of, open_input, stream_kind
from vorotool.frozen import frozen
from vorotool.numeric.parallel import start

STANDARD_INPUT = "standard input"
GZIP = b"\x1f\x8b\x08"
"""The first bytes of what gzip has packed."""
NPY, NPZ = b"\x93NUMPY", b"PK\x03\x04"
"""The first bytes of an array of NumPy, and of several; of other ZIP archives, too."""
MOST_OF_GZIP = 2**30
"""Bytes that gzip may have packed in an input."""
MOST_BLANKS = 2**12
"""Bytes of an input that are looked at for anything but blanks."""
NESTING_LIMIT = 100
"""Levels of brackets; no file of points or polygons has ten."""

Result = TypeVar("Result")


@frozen
class Source:
    """The content of one input."""

    name: str  # the path as the user wrote it, or `standard input`: what messages say
    data: bytes  # the whole content
    format: str = ""  # one of `vorotool.products.inputs.INPUTS`, once it has been told
    document: Any = None  # the JSON in it, or the features of a map, once that has been parsed
    layer: str | None = None  # the layer of a map that is wanted
    max_sites: int | None = None  # most features of a map, which are read to tell what they are
    flatten: float | None = None  # how far lines may be from the curves of these
    is_unpacked: bool = False  # the content was packed by gzip

    @property
    def is_file(self) -> bool:
        """Whether it has a place where it can be read again, with what is beside it."""
        return self.name != STANDARD_INPUT and not self.is_unpacked and stream_kind(self.name) is None

    @property
    def suffix(self) -> str:
        """Extension of the name in lower case, with its dot, that of gzip left out; empty for standard input."""
        return suffix_of(self.name.lower().removesuffix(".gz"))


@frozen
class StoredParts:
    """A file or folder that is read in parts, by other processes, too."""

    name: str  # as the user wrote it
    path: str  # absolute, for processes in other folders

    def __getstate__(self) -> dict[str, Any]:
        """Leave out what is open."""
        return {each.name: getattr(self, each.name) for each in fields(self)}


def read_source(path: str | os.PathLike[str], layer: str | None = None) -> Source:
    """Read a whole file, which FILE:LAYER may name, or standard input for ``-``; what gzip has packed is unpacked."""
    asked = os.fspath(path)
    name, named = split_layer(asked)
    if named is not None and layer is not None:
        given = option("--input-layer", "layer")
        raise UsageError(f"{asked} names the layer {named!r}, and {given} the layer {layer!r}: leave out one of them")
    layer = layer if named is None else named
    with explained_reading(name):
        data = read_bytes(name)
    spoken = STANDARD_INPUT if name == STANDARD else name
    if (name == STANDARD or descriptor_of(name) == 0) and (not data or (len(data) < MOST_BLANKS and data.isspace())):
        raise InputError(f"{spoken} is empty: check the program that writes it, or name a file instead of {name}")
    if data.startswith(GZIP) and not name.lower().endswith(".svgz"):
        return Source(spoken, _unpacked(data, spoken), layer=layer, is_unpacked=True)
    return Source(spoken, data, layer=layer)


def suffix_of(path: str) -> str:
    """Return the extension of a path with its dot, in lower case; empty where it has none."""
    name = os.path.basename(path.rstrip("/"))
    dot = name.rfind(".")
    return name[dot:].lower() if 0 < dot < len(name) - 1 else ""


def without_gz(name: str) -> str:
    """Return a name without the extension of gzip."""
    return name[: -len(".gz")] if name.lower().endswith(".gz") else name


def _unpacked(data: bytes, name: str) -> bytes:
    """Undo gzip up to the limit."""
    from vorotool.formats.io.unpacking import unpack_gzip

    try:
        made = unpack_gzip(data, MOST_OF_GZIP)
    except (ValueError, zlib.error) as error:
        raise InputError(f"{name} cannot be unpacked by gzip: {error}; is the file damaged or cut off?") from None
    if len(made) > MOST_OF_GZIP:
        raise LimitError(
            f"{name} holds more than {MOST_OF_GZIP} bytes packed by gzip: unpack it first, and give the file"
        )
    return made


@contextmanager
def explained_reading(name: str) -> Iterator[None]:
    """Turn what the system says of a file that is read into an error that tells what to do."""
    if not name:
        raise InputError("the name of the input is empty: name a file, or - for standard input")
    try:
        yield
    except FileNotFoundError:
        raise InputError(f"{name}: there is no such file; {_advice(name)}") from None
    except IsADirectoryError:
        raise InputError(f"{name} is a directory: name the files in it, for example {name}/*") from None
    except PermissionError:
        raise InputError(f"{name} cannot be read: permission denied; check who owns it") from None
    except InputError:
        raise
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"{name!r} cannot be read: {reason}; check the path") from None


@contextmanager
def reading(name: str) -> Iterator[None]:
    """Let errors carry the name of an input that is read: the words of all readers name it."""
    try:
        yield
    except VorotoolError as error:
        if error.source is None and not isinstance(error, UsageError):
            error.source = name
        raise


def read_bytes(name: str) -> bytes:
    """Read all that a file holds, or that comes through a stream."""
    return b"".join(_taken(name, lambda file: file.read() or b""))


def copy_stream(name: str, out: BinaryIO) -> None:
    """Copy all that comes through a stream, or is in a file, without holding it."""
    from shutil import copyfileobj  # it brings compressors

    _taken(name, lambda file: copyfileobj(file, out))


def _taken(name: str, take: Callable[[BinaryIO], Result]) -> list[Result]:
    """Let what a file or a stream is read from be taken to its end, and what is in the buffer of a stream before it."""
    number = 0 if name == STANDARD else descriptor_of(name)
    if number is None:
        with open(name, "rb") as file:
            return [take(file)]
    spoken = STANDARD_INPUT if name == STANDARD else name
    standard, made = number_of(sys.stdin), list[Result]()
    try:
        if name == STANDARD or standard == number:
            made.append(take(sys.stdin.buffer))
            if standard is None or not hasattr(os, "get_blocking") or os.get_blocking(standard):
                return made
        with open_input(number) as file:
            return [*made, take(file)]
    except IsADirectoryError:
        raise
    except (AttributeError, ValueError):  # None or closed, as under a daemon
        raise InputError(f"{spoken} is closed: name a file instead of {name}") from None
    except OSError as error:
        raise InputError(f"{spoken} cannot be read: {error.strerror}; name a file instead of {name}") from None


def _advice(name: str) -> str:
    from pathlib import Path

    if name.startswith("file://"):
        return "give its path, without file://"
    if "://" in name:
        return "nothing is read from the network: download it first"
    parent = Path(name).parent
    place = f"looked in {parent.resolve()}" if parent.is_dir() else f"the folder {parent} does not exist either"
    return f"check the path ({place})"


def check_nesting(text: str | bytes, limit: int = NESTING_LIMIT, name: str = "the text") -> None:
    """Refuse brackets nested beyond ``limit`` before a recursive parser sees them."""
    data = text.encode("utf-8", "replace") if isinstance(text, str) else text
    from vorotool import _core

    offset = _core.text.find_too_deep(data, limit)
    if offset is not None:
        line = data.count(b"\n", 0, offset) + 1
        raise InputError(f"{name}, line {line}: brackets are nested more than {limit} deep; check the brackets")


_SHORTEST = 2
"""Characters of a file before a colon: a single one is a drive letter."""
_NOT_IN_NAMES = r'[<>:"/\\|?*\x00-\x1f]'
"""Characters that file names cannot have somewhere."""


def split_layer(name: str) -> tuple[str, str | None]:
    """Split FILE:LAYER at the last colon behind a file; the layer is None where the name is a file's, or nothing's."""
    if os.path.lexists(name):
        return name, None
    end = name.rfind(":", 0, -1)
    while end >= _SHORTEST:
        if os.path.exists(name[:end]) and not os.path.isdir(name[:end]):
            return name[:end], name[end + 1 :]
        end = name.rfind(":", 0, end)
    return name, None


def file_of(name: str) -> str:
    """Return the file of FILE:LAYER, or of a name without a layer."""
    return split_layer(name)[0]


def check_input(name: str) -> None:
    """Refuse a file that is not there."""
    with explained_reading(name):
        if stream_kind(file_of(name)) is None:
            os.stat(file_of(name))


def output_name(name: str) -> str:
    """Return the name that outputs of an input are named after: ``x.roads.gpkg`` for ``folder/x.gpkg:roads``."""
    file, layer = split_layer(name)
    from pathlib import Path

    if layer is None:
        return Path(name).name
    path = Path(file[: -len(".gz")] if file.lower().endswith(".gz") else file)
    return f"{path.stem}.{re.sub(_NOT_IN_NAMES, '_', layer)}{path.suffix or '.layer'}"


_MOMENT = 0.05
"""Seconds after which signals are looked for."""

MOST_UNPACKED = 1 << 29
"""Bytes that any file may become, however small it is."""
_MOST_TIMES = 100


def check_pixels(name: str, width: int, height: int, max_pixels: int) -> None:
    """Refuse an image that is empty or larger than the limit, from its header alone."""
    if width < 1 or height < 1:
        raise InputError(f"{name} is {width} x {height} pixels: an image needs at least 1 x 1")
    if width * height > max_pixels:
        limit = option(f"--max-pixels {max_pixels}")
        raise LimitError(
            f"{name} is {width} x {height} = {width * height} pixels, more than {limit}: "
            "raise that if there is memory for it, or crop the image"
        )


def check_unpacked(name: str, size: int, packed: int) -> None:
    """Refuse what becomes larger than 512 MiB and than 100 times the file that holds it."""
    if size > max(MOST_UNPACKED, _MOST_TIMES * packed):
        raise LimitError(
            f"{name} has {packed} bytes that unpack to at least {size}, more than {_MOST_TIMES} times as many: split "
            "it, or write it without compression"
        )


def interruptible(work: Callable[[], Result]) -> Result:
    """Call what takes long in a library that does not look for signals: in a thread, so that this one sees them."""
    if threading.current_thread() is not threading.main_thread():
        return work()
    from concurrent.futures import Future, wait

    future: Future[Result] = Future()
    start(work, future)
    while not future.done():  # a signal may reach another thread, which does not wake this one
        wait([future], _MOMENT)
    return future.result()


@contextmanager
def decoding(name: str, kind: str) -> Iterator[None]:
    """Turn whatever a decoder raises or warns of on damaged bytes into one InputError that names the file."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    except (VorotoolError, MemoryError):
        raise
    except Exception as error:  # decoders raise nearly everything on damaged bytes, IndexError included
        reason = " ".join(str(error).split()) or type(error).__name__
        damage = InputError(f"{name} cannot be read as {kind}: {reason}; is the file damaged or cut off?")
        damage.source = name
        raise damage from error
