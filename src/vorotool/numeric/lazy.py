"""Libraries that are imported when they are first used: a job that needs none does not wait for them."""

from __future__ import annotations

from importlib import import_module
from typing import Any


class _Library:
    """Looks like a module."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __getattr__(self, name: str) -> Any:
        return getattr(import_module(self._name), name)


shapely: Any = _Library("shapely")
