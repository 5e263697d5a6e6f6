"""The library of DXF, imported without the settings files that it looks for."""

from __future__ import annotations

import logging
import sys
from configparser import ConfigParser
from typing import Any

from vorotool.convert.extras import needed


def ezdxf_module(module: str = "ezdxf") -> Any:
    """Import ezdxf, or a module of it."""
    if "ezdxf" in sys.modules:
        return needed(module, "cad", "DXF drawings")
    logger = logging.getLogger("ezdxf")
    if not logger.handlers:  # without one, what it ignores in damaged drawings goes to standard error
        logger.addHandler(logging.NullHandler())
    own = ConfigParser.read
    try:
        ConfigParser.read = lambda *_, **__: []  # type: ignore[method-assign]
        return needed(module, "cad", "DXF drawings")
    finally:
        ConfigParser.read = own  # type: ignore[method-assign]
