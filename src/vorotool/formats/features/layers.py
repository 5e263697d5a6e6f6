"""Layers of files of maps: which one is read."""

from __future__ import annotations

from collections.abc import Sequence

from vorotool.errors import InputError, option
from vorotool.formats.io.sources import STANDARD_INPUT, Source


def chosen_layer(source: Source, layers: Sequence[tuple[str, str | None]]) -> int:
    """Give the number of the layer that is wanted, or of the only one that has geometry."""
    named = {name: number for number, (name, kind) in enumerate(layers) if kind is not None}
    held = ", ".join(named) or "none"
    if source.layer is not None:
        if source.layer not in named:
            fault = "has no geometry" if source.layer in dict(layers) else "does not exist"
            raise InputError(
                f"the layer {source.layer!r} of {source.name} {fault}: the layers with geometry are {held}"
            )
        return named[source.layer]
    if not named:
        raise InputError(f"{source.name} holds no layer with geometry: name another file")
    if len(named) > 1:
        how = f"as {source.name}:{next(iter(named))}"
        if source.name == STANDARD_INPUT:
            how = f"by {option('--input-layer', 'layer=...')}"
        raise InputError(f"{source.name} holds {len(named)} layers: choose one of {held}, {how}")
    return next(iter(named.values()))
