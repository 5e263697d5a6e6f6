"""JSON lines: the features of a collection, or the rows of a table, one object a line."""

from __future__ import annotations

from typing import BinaryIO

from vorotool.formats.text.tables import json_text

_FEATURE = b'{"type":"Feature",'


class JsonLines:
    r"""A file that takes a list in JSON or a collection in GeoJSON, and passes its items on, one a line.

    JSON has no line break within a string, and our lists have them in three places: after the opening, after the comma
    behind each item, and before the closing and behind it. A ``crs`` member of the collection goes to each feature,
    which stands for itself then.

    Parameters
    ----------
    out : binary file object
        Need not be seekable; some items are in memory at a time.

    Examples
    --------
    >>> import io
    >>> out = io.BytesIO()
    >>> lines = JsonLines(out)
    >>> for part in (b'[\n{"a":1', b'},\n{"a":2}\n', b"]\n"):
    ...     _ = lines.write(part)
    >>> out.getvalue()
    b'{"a":1}\n{"a":2}\n'
    """

    def __init__(self, out: BinaryIO) -> None:
        self._out = out
        self._begun: list[bytes] = []  # the parts of a line that has no end yet
        self._last = b""  # a whole line, which may be the closing
        self._opening: bytes | None = None

    def write(self, data: bytes) -> int:
        """Take some text; the last line is the closing, which goes nowhere."""
        lines, end, begun = data.rpartition(b"\n")
        if end:
            self._take(b"".join([*self._begun, lines, end]))
            self._begun = []
        self._begun.append(begun)
        return len(data)

    def _take(self, lines: bytes) -> None:
        """Pass whole lines on but the last, and but the first of all, the opening."""
        if self._opening is None:
            self._opening, _, lines = lines.partition(b"\n")
        lines = self._last + lines
        place = lines.rfind(b"\n", 0, -1) + 1
        self._last = lines[place:]
        if place:
            items = lines[:place].replace(b",\n", b"\n")
            self._out.write(self._with_crs(items))

    def _with_crs(self, items: bytes) -> bytes:
        import orjson

        assert self._opening is not None
        opening = orjson.loads(self._opening + b"]}") if self._opening.startswith(b"{") else {}
        if "crs" not in opening:
            return items
        member = f'"crs":{json_text(opening["crs"])},'.encode()
        return (b"\n" + items).replace(b"\n" + _FEATURE, b"\n" + _FEATURE + member)[1:]
