"""Ways in which a command can be given its input and leave its output, all of which must give the same bytes."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

DATA = Path(__file__).parents[3] / "data"
PATIENCE = 120
"""Seconds after which a process that still runs is hung."""
HEADER, FOOTER = b"what was there before\n", b"what comes after\n"

INPUTS = ("file", "-", "/dev/stdin", "redirected", "descriptor", "fifo", "substitution")
SHARED = ("appended", "appended -", "between")
OUTPUTS = ("file", "-", "/dev/stdout", "descriptor", "fifo", *SHARED, "broken -", "broken", "full")


@dataclass(frozen=True)
class Case:
    """A command line, in which IN stands for the input and OUT for the output."""

    line: str
    source: str
    fmt: str

    @property
    def command(self) -> str:
        """Its name."""
        return self.line.split()[0]

    def arguments(self, source: str, output: str) -> list[str]:
        """The command line, with names."""
        names = {"IN": source, "OUT": output}
        return [names.get(word, word) for word in f"{self.line} -f {self.fmt} -q".split()]


def _cases(line: str, source: str, *formats: str) -> list[Case]:
    return [Case(line, source, fmt) for fmt in formats]


CASES = [
    *_cases("tessellate IN -o OUT", "six-seeds.csv", "png", "tiff", "npy", "text", "svg"),
    *_cases("tessellate IN -o OUT --what color", "six-seeds.csv", "png", "svg"),
    *_cases("tessellate IN -o OUT --what distance", "six-seeds.csv", "tiff", "npy"),
    *_cases("tessellate IN -o OUT --what table", "blobs.png", "csv", "json", "npz"),
    *_cases("tessellate IN -o OUT --what distance2", "labels.tif", "tiff"),
    *_cases("tessellate IN -o OUT", "labels.tif", "tiff", "png"),
    *_cases("tessellate IN -o OUT --what neighbors", "labels.npy", "csv"),
    *_cases("tessellate blobs.png -o OUT --what color --overlay IN", "cells.png", "svg"),
    *_cases("tessellate --files-from IN --table OUT", "list.txt", "csv", "json"),
    *_cases("delaunay IN -o OUT", "dots.csv", "csv", "json", "geojson", "npz", "svg", "png", "obj"),
    *_cases("delaunay IN -o OUT --what triangles", "dots.csv", "ele", "npz"),
    *_cases("delaunay IN -o OUT --what cells", "blobs.png", "geojson", "wkt"),
    *_cases("delaunay dots.csv -o OUT --what cells --clip IN", "two-shapes.json", "geojson"),
    *_cases("alphashape IN -o OUT -r 10 --what edges", "dot-pattern.csv", "csv", "npz", "svg", "html"),
    *_cases("alphashape IN -o OUT -r 10 --what polygons", "dot-pattern.csv", "geojson", "wkt", "png"),
    *_cases("skeleton-approx IN -o OUT --step 4", "two-shapes.json", "json", "csv", "png", "npz"),
    *_cases("skeleton-exact IN -o OUT", "two-shapes.json", "json", "csv", "geojson", "npz", "svg", "png", "graphml"),
    *_cases("skeleton-exact IN -o OUT --what table", "blobs.png", "csv", "json"),
    *_cases("draw IN -o OUT", "labels.tif", "png", "svg"),
]


def write_inputs(folder: Path) -> None:
    """Put all inputs in a folder."""
    import numpy as np
    import tifffile

    for name in ("six-seeds.csv", "blobs.png", "cells.png", "dots.csv", "two-shapes.json", "dot-pattern.csv"):
        (folder / name).write_bytes((DATA / name).read_bytes())
    labels = np.zeros((40, 50), np.uint16)
    labels[5:9, 5:12], labels[20:30, 30:35], labels[33:36, 2:9] = 300, 7, 9
    tifffile.imwrite(folder / "labels.tif", labels, rowsperstrip=8, compression="zlib")
    np.save(folder / "labels.npy", labels)
    (folder / "list.txt").write_text("six-seeds.csv\nblobs.png\n")


class Expected:
    """What each case gives from a file to a file: made once, when it is asked for."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._made: dict[Case, bytes] = {}
        self._lock = threading.Lock()
        write_inputs(folder)

    def of(self, case: Case) -> bytes:
        """Bytes of the output."""
        with self._lock:
            if case not in self._made:
                arguments = case.arguments(case.source, "expected")
                subprocess.run(_vorotool(arguments), cwd=self.folder, check=True, timeout=PATIENCE)
                self._made[case] = (self.folder / "expected").read_bytes()
                (self.folder / "expected").unlink()
            return self._made[case]


def _vorotool(arguments: list[str]) -> list[str]:
    return [sys.executable, "-m", "vorotool", *arguments]


def fault(expected: Expected, case: Case, given: str, left: str, folder: Path) -> str | None:
    """Run a case, and say what is wrong, if anything; the folder is empty and is used for this alone."""
    write_inputs(folder)
    if given == "fifo":  # with the name of the file, as its extension may tell what is in it
        (folder / case.source).unlink()
    whole, before = expected.of(case), {path.name for path in folder.iterdir()}
    source, output = _Input(expected.folder / case.source, given, folder), _Output(left, folder)
    with source.opened(), output.opened():
        child = subprocess.Popen(
            _vorotool(case.arguments(source.name, output.name)),
            cwd=folder,
            stdin=source.stdin,
            stdout=output.stdout,
            stderr=subprocess.PIPE,
            pass_fds=(*source.passed, *output.passed),
        )
        source.close_theirs()
        output.close_theirs()
        try:
            _, said = child.communicate(timeout=PATIENCE)
        except subprocess.TimeoutExpired:
            child.kill()
            child.communicate()
            return "it hangs"
    names = {path.name for path in folder.iterdir()} - before - {source.name, output.name, "log"}
    return f"{sorted(names)} is left" if names else _judged(child.returncode, said.decode(), output, whole)


def _judged(code: int, said: str, output: _Output, whole: bytes) -> str | None:
    """What is wrong with how a process has ended, and with what it has written."""
    wanted = {"broken": 141, "full": 4}.get(output.way, 0)
    if code != wanted:
        return f"exit code {code}, not {wanted}: {said}"
    if bool(said) != (code == 4):
        return f"it says {said!r}"
    content = HEADER + whole + FOOTER if output.is_shared else whole
    if code == 0 and output.content() != content:
        return f"{len(output.content())} bytes that differ from the {len(content)} of a file"
    return None


class _Input:
    """A file as it is given to a process."""

    def __init__(self, file: Path, given: str, folder: Path) -> None:
        self._file, self._given, self._folder = file, given, folder
        self.name, self.stdin, self.passed = file.name, subprocess.DEVNULL, ()
        self._theirs: list[int] = []
        self._thread: threading.Thread | None = None

    @contextmanager
    def opened(self) -> Iterator[None]:
        """Begin to write what the process will read."""
        if self._given in ("redirected", "descriptor"):
            number = os.open(self._file, os.O_RDONLY)
            self._take(number, "redirected")
        elif self._given in ("-", "/dev/stdin", "substitution"):
            number, ours = os.pipe()
            self._take(number, "-", "/dev/stdin")
            self._write(lambda: ours)
        elif self._given == "fifo":
            path = self._folder / self.name
            os.mkfifo(path)
            self._write(lambda: os.open(path, os.O_WRONLY))
        try:
            yield
        finally:
            self.close_theirs()
            if self._thread is not None:
                _release(self._folder / self.name if self._given == "fifo" else None)
                self._thread.join(PATIENCE)

    def _take(self, number: int, *standard: str) -> None:
        self._theirs.append(number)
        if self._given in standard:
            self.stdin, self.name = number, "/dev/stdin" if self._given == "redirected" else self._given
        else:
            self.passed, self.name = (number,), f"/dev/fd/{number}"

    def _write(self, opened) -> None:
        data = self._file.read_bytes()

        def write() -> None:
            with suppress(BrokenPipeError), os.fdopen(opened(), "wb", buffering=0) as pipe:
                pipe.write(data[:3])
                time.sleep(0.005)  # whoever takes one read for all of it is found out
                rest = memoryview(data)[3:]
                while rest:
                    rest = rest[pipe.write(rest) :]

        self._thread = threading.Thread(target=write, daemon=True)
        self._thread.start()

    def close_theirs(self) -> None:
        """Close what the process has now."""
        while self._theirs:
            os.close(self._theirs.pop())


class _Output:
    """A place for what a process writes."""

    def __init__(self, left: str, folder: Path) -> None:
        self.way = left.removesuffix(" -")
        self.is_shared = left in SHARED
        self._left, self._folder = left, folder
        self.name, self.stdout, self.passed = "out", subprocess.DEVNULL, ()
        self._theirs: list[int] = []
        self._parts: list[bytes] = []
        self._thread: threading.Thread | None = None

    @contextmanager
    def opened(self) -> Iterator[None]:
        """Begin to read what the process will write."""
        if self._left in ("-", "/dev/stdout", "descriptor"):
            ours, number = os.pipe()
            self._take(number)
            self._read(lambda: ours)
        elif self.way == "broken":
            ours, number = os.pipe()
            os.close(ours)
            self._take(number)
        elif self._left == "full":
            self._take(os.open("/dev/full", os.O_WRONLY))
        elif self.is_shared:
            (self._folder / "log").write_bytes(HEADER)
            self._take(os.open(self._folder / "log", os.O_WRONLY | (os.O_APPEND if self.way == "appended" else 0)))
            os.lseek(self._theirs[0], 0, os.SEEK_END)
        elif self._left == "fifo":
            os.mkfifo(self._folder / self.name)
            self._read(lambda: os.open(self._folder / self.name, os.O_RDONLY))
        footer = os.dup(self._theirs[0]) if self.is_shared else None
        try:
            yield
        finally:
            self.close_theirs()
            if footer is not None:
                os.write(footer, FOOTER)
                os.close(footer)
            if self._thread is not None:
                _release(self._folder / self.name if self._left == "fifo" else None)
                self._thread.join(PATIENCE)

    def _take(self, number: int) -> None:
        self._theirs.append(number)
        if self._left == "descriptor":
            self.passed, self.name = (number,), f"/dev/fd/{number}"
        else:
            self.stdout, self.name = number, "-" if self._left.endswith("-") else "/dev/stdout"

    def _read(self, opened) -> None:
        def read() -> None:
            with os.fdopen(opened(), "rb") as pipe:
                self._parts.append(pipe.read())

        self._thread = threading.Thread(target=read, daemon=True)
        self._thread.start()

    def close_theirs(self) -> None:
        """Close what the process has now."""
        while self._theirs:
            os.close(self._theirs.pop())

    def content(self) -> bytes:
        """What was written."""
        if self.is_shared or self._left == "file":
            return (self._folder / ("log" if self.is_shared else "out")).read_bytes()
        return b"".join(self._parts)


def _release(pipe: Path | None) -> None:
    """Let whoever still waits for the other end of a named pipe go on."""
    if pipe is not None:
        os.close(os.open(pipe, os.O_RDWR | os.O_NONBLOCK))
