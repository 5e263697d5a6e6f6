"""Writing volumes of the library: stacks, arrays and stores."""

from __future__ import annotations

from collections.abc import Mapping

from vorotool.errors import UsageError
from vorotool.formats.io.atomic_output import open_output
from vorotool.formats.volumes.writer import write_volume
from vorotool.formats.zarr.volumes import write_zarr_volume
from vorotool.types.volumes.label_volume import LabelVolume
from vorotool.types.volumes.volume import Volume

_FORMATS = ("tiff", "npy", "zarr")


def write_volume_value(
    value: LabelVolume | Volume, path: str, fmt: str, options: Mapping[str, object], threads: int
) -> None:
    """Write a volume that is held."""
    name = type(value).__name__
    if fmt not in _FORMATS:
        raise UsageError(f"a {name} cannot be written as {fmt!r}: use one of {', '.join(_FORMATS)}")
    for option, given in options.items():
        if given is not None:
            raise UsageError(f"{option} is not for volumes: leave it out with a {name}")
    is_labels = isinstance(value, LabelVolume)
    values = value.labels if isinstance(value, LabelVolume) else value.values
    if fmt == "zarr":
        write_zarr_volume(path, values, grid=value.grid, is_labels=is_labels, threads=threads)
        return
    with open_output(path, binary=True) as out:
        write_volume(
            out,
            [values],
            shape=value.shape,
            dtype=values.dtype,
            fmt=fmt,  # type: ignore[arg-type]  # it is one of these
            grid=value.grid,
            threads=threads,
        )
