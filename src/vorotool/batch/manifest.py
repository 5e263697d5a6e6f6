"""The record of work that is done: a file of JSON lines beside the outputs, to which a line is added for each input."""

from __future__ import annotations

import errno
import hashlib
import json
import os
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path, PurePath
from typing import Any, BinaryIO

from vorotool import __version__
from vorotool.batch.workers import Outcome, Task
from vorotool.errors import OutputError
from vorotool.formats.io.atomic_output import explained, make_folder

RECORD_ENDING = ".manifest.jsonl"
"""Ends the names of records, which begin with the command."""

LONGEST_LINE = 2**24
"""Bytes of a line that is read; ours have hundreds, and thousands where there are many warnings."""

History = dict[str, dict[str, Any]]
"""The last line of each input, if it says that it was done: all of it is text that anybody may have written."""


def digest_of_values(values: Any) -> str:
    """Return the SHA-256 of values; what JSON does not have counts by its text."""
    return hashlib.sha256(json.dumps(values, sort_keys=True, default=str).encode()).hexdigest()


def read_history(paths: Iterable[str | os.PathLike[str]]) -> History:
    """Read manifests; a line that is torn or damaged says nothing, so that its input is done again."""
    history: History = {}
    for path in filter(Path.is_file, map(Path, paths)):
        try:
            with path.open("rb") as file:
                for line in _lines(file):
                    _take(history, line)
        except OSError as error:
            raise OutputError(f"the manifest {path} cannot be read: {error.strerror}; leave out --resume") from None
    return history


def _lines(file: BinaryIO) -> Iterator[bytes]:
    """Yield lines; those that are longer than ours can be are left out."""
    while line := file.readline(LONGEST_LINE):
        if len(line) < LONGEST_LINE:
            yield line
        while len(line) == LONGEST_LINE and line[-1:] != b"\n":
            line = file.readline(LONGEST_LINE)


def _take(history: History, line: bytes) -> None:
    """Take what a line says of an input; the lines of runs are for people."""
    try:
        record = json.loads(line)
        source, status = record["input"], record["status"]
    except (ValueError, TypeError, KeyError, RecursionError):
        return
    if isinstance(source, str) and status != "done":
        history.pop(source, None)
    elif isinstance(source, str) and _is_ours(record):
        history[source] = record


def _is_ours(record: Mapping[str, Any]) -> bool:
    """Return whether a line has digests, and no output outside the folder."""
    outputs = record.get("outputs")
    if not isinstance(outputs, dict) or any(
        PurePath(path).is_absolute() or ".." in PurePath(path).parts for path in outputs
    ):
        return False
    texts = (record.get("options"), record.get("sha256"), record.get("unit"), *outputs.values())
    return all(isinstance(text, str) for text in texts)


class Manifest:
    """The record of a batch while it runs: a line is handed to the system as soon as an input is done or failed."""

    def __init__(self, folder: str | os.PathLike[str], command: str, options: str, shard: str = "") -> None:
        self.folder, self.command, self.options = Path(folder), command, options
        self.path = self.folder / f"{command}{shard}{RECORD_ENDING}"
        self._file: BinaryIO | None = None

    def __enter__(self) -> Manifest:
        """Open the file; end a line that a killed run began."""
        make_folder(self.folder)
        with explained(str(self.path), "--out-dir"):
            self._file = self.path.open("a+b", buffering=0)
            if self._file.seek(0, os.SEEK_END):
                self._file.seek(-1, os.SEEK_END)
                if self._file.read(1) != b"\n":
                    self._file.write(b"\n")
        return self

    def __exit__(self, *_: object) -> None:
        """Close the file."""
        if self._file is not None:
            self._file.close()

    def done_before(self, source: str, history: History) -> Outcome | None:
        """Return the outcome of an input if it was done with the same options."""
        record = history.get(source)
        if record is None or record["options"] != self.options:
            return None
        outputs = {str(self.folder / path): digest for path, digest in record["outputs"].items()}
        return Outcome(digest=record["sha256"], outputs=outputs, unit=record["unit"])

    def begin(self, run: str, inputs: int) -> None:
        """Add the line of a run; its name is in the names of its temporary files."""
        self._add({"run": run, "command": self.command, "version": __version__, "inputs": inputs})

    def add(self, task: Task, outcome: Outcome) -> None:
        """Add the line of an input; one that was kept has a line already."""
        if outcome.kept:
            return
        record: dict[str, Any] = {"input": task.source, "status": outcome.status}
        if outcome.code:
            record |= {"exit": outcome.code, "error": outcome.message}
        record |= {"options": self.options, "sha256": outcome.digest}
        if not outcome.code:
            outputs = outcome.outputs.items()
            record["outputs"] = {str(PurePath(path).relative_to(self.folder)): digest for path, digest in outputs}
            record["unit"] = outcome.unit
        texts = {"warnings": outcome.warnings, "notes": outcome.notes}
        self._add(record | {name: lines for name, lines in texts.items() if lines})

    def _add(self, record: Mapping[str, Any]) -> None:
        assert self._file is not None
        line = json.dumps(record).encode() + b"\n"
        with explained(str(self.path), "--out-dir"):  # in one piece, so that lines of two processes do not mix
            if self._file.write(line) != len(line):
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
