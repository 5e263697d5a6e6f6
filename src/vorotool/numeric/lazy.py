"""Shapely, which is imported when it is first used: a job that needs none of it does not wait for it."""

from __future__ import annotations

from importlib import import_module
from typing import Any


class _Shapely:
    """Looks like the module."""

    def __getattr__(self, name: str) -> Any:
        return getattr(import_module("shapely"), name)


shapely: Any = _Shapely()
