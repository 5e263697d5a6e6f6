"""The items of a list in JSON, or of a collection in GeoJSON, taken from the text as it is written."""

from __future__ import annotations

from types import TracebackType
from typing import Any, BinaryIO, Self

from vorotool.formats.text.tables import json_text
from vorotool.numeric.coordinates import record_system_unread
from vorotool.types.fields import MEMBER


class JsonItems:
    """A file that takes a list in JSON or a collection in GeoJSON, and passes its items on, some at a time."""

    def __init__(self) -> None:
        self._begun: list[bytes] = []  # the parts of a line that has no end yet
        self._last = b""  # a whole line, which may be the closing
        self._opening: bytes | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is None:
            self.finish()

    def write(self, data: bytes) -> int:
        """Take some text; the last line is the closing, which goes nowhere."""
        lines, end, begun = data.rpartition(b"\n")
        if end:
            self._take_lines(b"".join([*self._begun, lines, end]))
            self._begun = []
        self._begun.append(begun)
        return len(data)

    def take(self, items: bytes) -> None:
        """Take whole items, each on a line."""
        raise NotImplementedError

    def finish(self) -> None:
        """Know that there are no more."""

    @property
    def crs(self) -> Any:
        """The ``crs`` member of a collection; None where there is none."""
        return self.members.get("crs")

    @property
    def members(self) -> dict[str, Any]:
        """What a collection says of all its features, beside them."""
        import orjson

        opening = self._opening or b""
        # of an empty list the closing follows the opening at once
        text = opening.removesuffix(b"\n").removesuffix(b"]}") + b"]}" if opening.startswith(b"{") else b"{}"
        opening_members = orjson.loads(text)
        return {
            name: opening_members[name] for name in ("crs", "unit", MEMBER) if opening_members.get(name) is not None
        }

    def _take_lines(self, lines: bytes) -> None:
        """Pass whole lines on but the last, and but the first of all, the opening."""
        if self._opening is None:
            self._opening, _, lines = lines.partition(b"\n")
        lines = self._last + lines
        place = lines.rfind(b"\n", 0, -1) + 1
        self._last = lines[place:]
        if place:
            self.take(lines[:place].replace(b",\n", b"\n"))


_FEATURE = b'{"type":"Feature",'


class JsonLines(JsonItems):
    """A file that takes a list in JSON or a collection in GeoJSON, and passes its items on, one a line."""

    def __init__(self, out: BinaryIO, what: str = "", path: str = "") -> None:
        super().__init__()
        self._out = out

    def take(self, items: bytes) -> None:
        """Write some items."""
        members = self.members
        record_system_unread(members.get("crs"))
        if members:
            member = json_text(members)[1:-1].encode() + b","
            items = (b"\n" + items).replace(b"\n" + _FEATURE, b"\n" + _FEATURE + member)[1:]
        self._out.write(items)
