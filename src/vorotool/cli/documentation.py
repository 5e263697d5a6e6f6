"""Find the manual pages and the documents that are installed with the package."""

from __future__ import annotations

import sys
from importlib import metadata
from pathlib import Path

MANUAL, DOCUMENTS = "share/man/man1/vorotool.1", "share/doc/vorotool/README.md"
"""Ends of the paths of the first manual page and of the first document."""


def places() -> list[tuple[str, str]]:
    """Return what there is to read and where, as rows of the help; nothing for what is not installed."""
    rows = []
    manual, documents = _installed(MANUAL), _installed(DOCUMENTS)
    if manual is not None:
        rows.append(("man vorotool, man vorotool-COMMAND", f"in {_printable(manual.parents[1])}"))
    if documents is not None:
        rows.append((_printable(documents), "the README, and the documents that it links to"))
    return rows


def _installed(end: str) -> Path | None:
    """Return the path of a file of the package outside the folder of its modules."""
    try:
        files = metadata.files("vorotool") or []
    except metadata.PackageNotFoundError:
        return None
    found = (Path(str(file.locate())).resolve() for file in files if file.as_posix().endswith(end))
    return next((path for path in found if path.is_file()), None)


def _printable(path: Path) -> str:
    """Escape what standard output cannot show."""
    encoding = sys.stdout.encoding or "ascii"
    return str(path).encode(encoding, "backslashreplace").decode(encoding)
