"""JSON lines: the features of a collection, or the rows of a table, one object a line."""

from __future__ import annotations

from typing import BinaryIO

from vorotool.formats.text.json_items import JsonItems
from vorotool.formats.text.tables import json_text
from vorotool.numeric.coordinate_grid import record_system_unread

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
