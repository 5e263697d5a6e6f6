"""Libraries that not every user needs: imported when they are used, named with the way to get them where they lack."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from vorotool.errors import UsageError


def needed(module: str, extra: str, purpose: str) -> Any:
    """Import a library of one of the extras of the package."""
    try:
        return import_module(module)
    except ImportError:
        package = module.partition(".")[0]
        raise UsageError(f"{purpose} need the package {package}: pip install 'vorotool[{extra}]'") from None
