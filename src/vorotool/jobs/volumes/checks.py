"""Options of ``tessellate`` that go together where the input is a volume."""

from __future__ import annotations

from collections.abc import Sequence

from vorotool.errors import UsageError
from vorotool.jobs.inputs import check_components, refuse
from vorotool.jobs.options import Options
from vorotool.jobs.targets import Target, check_picture_options, check_precision
from vorotool.products.registry import VOLUME_PRODUCTS

_CONNECTIVITY = {False: ("8", "4"), True: ("26", "6")}
"""Of images, and of volumes."""

_PICTURES = ("png", "svg")


def check_image_options(o: Options) -> None:
    """Refuse what means something for volumes only."""
    check_connectivity(o, is_volume=False)
    if o.slice is not None:
        raise UsageError("--slice is for volumes: use --volume, or leave it out")
    if o.levels is not None:
        raise UsageError("--levels is for volumes in OME-Zarr: use --volume, or leave it out")
    if o.chunk is not None and len(o.chunk) == 3:
        raise UsageError(f"--chunk {_size(o.chunk)} has a depth, but chunks of images have columns x rows: 2048x512")


def check_volume_options(o: Options, targets: list[Target]) -> None:
    """Refuse what means nothing for volumes, and what no output would show."""
    _check_frame(o)
    check_connectivity(o, is_volume=True)
    check_components(o)
    _check_other_options(o)
    check_precision(o, {what: each.formats for what, each in VOLUME_PRODUCTS.items()}, targets)
    _check_outputs(o, targets)


def check_volume_units(o: Options) -> None:
    """Refuse the size of a pixel."""
    if o.pixel_size is not None:
        raise UsageError("--pixel-size is for images: use --spacing SX,SY,SZ for a volume, such as 0.325,0.325,1.5um")


def check_connectivity(o: Options, *, is_volume: bool) -> None:
    """Refuse the connectivity of images for volumes, and the other way round."""
    allowed = _CONNECTIVITY[is_volume]
    if o.connectivity is None or o.connectivity in allowed:
        return
    both = " or ".join(allowed)
    if is_volume:
        raise UsageError(f"--connectivity {o.connectivity} is for images: voxels have {both}")
    raise UsageError(f"--connectivity {o.connectivity} is for volumes: pixels have {both}, and --volume reads a volume")


def _check_frame(o: Options) -> None:
    if o.size is not None and o.window is not None:
        raise UsageError("give --size or --window, not both")
    if o.size is not None and len(o.size) == 2:
        raise UsageError(f"--size {_size(o.size)} has no depth: give --size WxHxD for a volume")
    if o.window is not None and len(o.window) == 4:
        raise UsageError("--window has four numbers: give six for a volume, X,Y,Z,W,H,D")
    if o.chunk is not None and len(o.chunk) == 2:
        raise UsageError(f"--chunk {_size(o.chunk)} has no depth: give --chunk WxHxD for a volume, such as 256x256x64")


def _check_other_options(o: Options) -> None:
    """Refuse options of images and of maps."""
    if o.method != "exact":
        raise UsageError("--method propagation is for images: volumes are tessellated exactly, leave it out")
    if o.page is not None:
        raise UsageError("--page chooses a page of a stack, and --volume takes them all: leave one of the two out")
    of_images = {
        "passes": o.passes,
        "tiled": o.tiled,
        "like": o.like,
        "overlay": o.overlay,
        "y-down" if o.y_up is False else "y-up": o.y_up is not None,
        "animate": o.animate,
        "frames": o.frames,
        "fps": o.fps,
    }
    refuse(of_images, "is for images: leave it out with a volume")
    of_maps = {"cell-size": o.cell_size, "input-layer": o.input_layer, "input-crs": o.input_crs, "crs": o.crs}
    refuse(of_maps, "is for maps: leave it out with a volume")


def _check_outputs(o: Options, targets: Sequence[Target]) -> None:
    """Refuse options that no output would show."""
    outputs = {(target.what, target.fmt) for target in targets}
    formats = {fmt for _, fmt in outputs}
    if o.dtype is not None and not outputs & {("labels", fmt) for fmt in ("tiff", "npy", "zarr")}:
        raise UsageError("--dtype is for labels in TIFF, NPY and Zarr: use --what labels, or leave it out")
    if o.chunk is not None and "zarr" not in formats:
        raise UsageError("--chunk is for Zarr stores: use -f zarr, or leave it out")
    if o.levels is not None and not any(_is_ome_zarr(target) for target in targets):
        raise UsageError("--levels is for OME-Zarr: use -o NAME.ome.zarr, or leave it out")
    pictures = [fmt for fmt in _PICTURES if ("color", fmt) in outputs]
    if o.layers is not None and not pictures:
        raise UsageError("--layers is for pictures: use --what color as PNG or SVG, or leave it out")
    if o.slice is not None and not pictures:
        raise UsageError("--slice is for pictures: use --what color as PNG or SVG, or leave it out")
    check_picture_options(o, pictures, VOLUME_PRODUCTS["color"].layers)


def _is_ome_zarr(target: Target) -> bool:
    return target.fmt == "zarr" and target.path.lower().endswith(".ome.zarr")


def _size(sides: Sequence[int]) -> str:
    return "x".join(map(str, sides))
