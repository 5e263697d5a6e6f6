"""What was done already: a file of JSON lines beside the outputs, to which a line is added for each input."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO

from vorotool import __version__
from vorotool.batch.tasks import INPUT, Outcome, Task
from vorotool.errors import OutputError
from vorotool.formats.outputs import make_folder


def digest_of_values(values: Any) -> str:
    """SHA-256 of what JSON can say; other values count by their text.

    Examples
    --------
    >>> digest_of_values({"what": ["table"], "r": None})[:8]
    'd830804b'
    """
    return hashlib.sha256(json.dumps(values, sort_keys=True, default=str).encode()).hexdigest()


@dataclass(frozen=True)
class History:
    """What manifests say.

    Parameters
    ----------
    runs : list of str
        Tags of temporary files of earlier runs.
    done : dict of str to dict
        The last line of each input, if it says that it was done.
    """

    runs: list[str] = field(default_factory=list)
    done: dict[str, dict[str, Any]] = field(default_factory=dict)


def read_history(paths: Iterable[str | os.PathLike[str]]) -> History:
    """Read manifests; a line that is torn or damaged says nothing, so that its input is done again.

    Parameters
    ----------
    paths : iterable of paths
        Those that do not exist are left out.

    Raises
    ------
    OutputError
        If one cannot be read.
    """
    history = History()
    for path in map(Path, paths):
        try:
            data = path.read_bytes()
        except FileNotFoundError:
            continue
        except OSError as error:
            raise OutputError(f"the manifest {path} cannot be read: {error.strerror}; leave out --resume") from None
        for line in data.split(b"\n"):
            _take(history, line)
    return history


def _take(history: History, line: bytes) -> None:
    try:
        record = json.loads(line)
        if "run" in record:
            history.runs.append(str(record["run"]))
        elif record["status"] != "done":
            history.done.pop(record["input"], None)
        else:
            outputs = {str(path): str(digest) for path, digest in record["outputs"].items()}
            history.done[record["input"]] = {
                "options": record["options"], "sha256": record["sha256"], "outputs": outputs
            }  # fmt: skip
    except (ValueError, TypeError, KeyError, AttributeError):
        return


class Manifest:
    """The record of a batch while it runs: a line is handed to the system as soon as an input is done or failed.

    Parameters
    ----------
    path : path
        The file, which only grows.
    options : str
        Digest of the options that decide on the outputs.
    folder : path
        That of the outputs, to which their paths in the file are relative.

    Raises
    ------
    OutputError
        If it cannot be written.
    """

    def __init__(self, path: str | os.PathLike[str], options: str, folder: str | os.PathLike[str]) -> None:
        self.path, self.options, self.folder = Path(path), options, Path(folder)
        self._file: BinaryIO | None = None

    def __enter__(self) -> Manifest:
        """Open the file; what a killed run has left of a line is ended."""
        make_folder(self.folder)
        try:
            self._file = self.path.open("a+b", buffering=0)
            if self._file.seek(0, os.SEEK_END):
                self._file.seek(-1, os.SEEK_END)
                if self._file.read(1) != b"\n":
                    self._file.write(b"\n")
        except OSError as error:
            raise self._failure(error) from error
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close the file."""
        if self._file is not None:
            self._file.close()

    def done_before(self, source: str, history: History) -> dict[str, str] | None:
        """Digests of an input (at `INPUT`) and of its outputs by their paths, if it was done with the same options."""
        record = history.done.get(source)
        if record is None or record["options"] != self.options:
            return None
        outputs = {str(self.folder / path): digest for path, digest in record["outputs"].items()}
        return {INPUT: record["sha256"], **outputs}

    def begin(self, run: str, command: str, inputs: int) -> None:
        """Say that a run begins, and by which tag its temporary files are known."""
        self._add({"run": run, "command": command, "version": __version__, "inputs": inputs})

    def add(self, task: Task, outcome: Outcome) -> None:
        """Tell what became of an input; of one that was kept there is a line already."""
        if outcome.kept:
            return
        record: dict[str, Any] = {"input": task.source, "status": "failed" if outcome.code else "done"}
        if outcome.code:
            record |= {"exit": outcome.code, "error": outcome.message}
        record |= {"options": self.options, "sha256": outcome.digest}
        if not outcome.code:
            above = f"{self.folder}{os.sep}"
            record["outputs"] = {path.removeprefix(above): digest for path, digest in outcome.outputs.items()}
        said = {"warnings": outcome.warnings, "notes": outcome.notes}
        self._add(record | {name: texts for name, texts in said.items() if texts})

    def _add(self, record: Mapping[str, Any]) -> None:
        assert self._file is not None
        try:
            self._file.write(json.dumps(record).encode() + b"\n")
        except OSError as error:
            raise self._failure(error) from error

    def _failure(self, error: OSError) -> OutputError:
        return OutputError(f"the manifest {self.path} cannot be written: {error.strerror}; choose another --out-dir")
