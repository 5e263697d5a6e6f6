"""Inputs named FILE:LAYER: the file, and the layer of it."""

from __future__ import annotations

import os
import re
from pathlib import Path

from vorotool.errors import UsageError, option

_SHORTEST = 2
"""Characters of a file before a colon: a single one is a drive letter."""
_NOT_IN_NAMES = re.compile(r'[<>:"/\\|?*\x00-\x1f]')
"""Characters that file names cannot have somewhere."""


def split_layer(name: str) -> tuple[str, str | None]:
    """Split FILE:LAYER at its last colon; the layer is None where the name is that of a file, or of nothing."""
    file, _, layer = name.rpartition(":")
    if not layer or len(file) < _SHORTEST or os.path.lexists(name) or not _is_file(file):
        return name, None
    return file, layer


def file_of(name: str) -> str:
    """Return the file of FILE:LAYER, or of a name without a layer."""
    return split_layer(name)[0]


def file_and_layer(name: str, layer: str | None) -> tuple[str, str | None]:
    """Split FILE:LAYER, and refuse a layer that is given in addition."""
    file, named = split_layer(name)
    if named is not None and layer is not None:
        given = option("--input-layer", "layer")
        raise UsageError(f"{name} names the layer {named!r}, and {given} the layer {layer!r}: leave out one of them")
    return file, layer if named is None else named


def output_name(name: str) -> str:
    """Return the name that outputs of an input are named after: ``x.roads.gpkg`` for ``folder/x.gpkg:roads``."""
    file, layer = split_layer(name)
    if layer is None:
        return Path(name).name
    path = Path(file[: -len(".gz")] if file.lower().endswith(".gz") else file)
    return f"{path.stem}.{_NOT_IN_NAMES.sub('_', layer)}{path.suffix or '.layer'}"


def _is_file(path: str) -> bool:
    """Return whether something is there that is no folder."""
    try:
        return Path(path).exists() and not Path(path).is_dir()
    except (OSError, ValueError):
        return False
