"""Animations as GIF, APNG and WebP, by Pillow: frames of one size, shown for equal times, again and again."""

from __future__ import annotations

import io
from collections.abc import Iterable
from typing import TYPE_CHECKING, BinaryIO

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from PIL import Image

COLORS = 256
"""Of a GIF: where all frames have no more together, each keeps its own."""


def write_animation(out: BinaryIO, frames: Iterable[NDArray[np.uint8]], *, fmt: str, fps: float) -> None:
    """Write frames; frames that are the same as the one before lengthen its time."""
    from PIL import Image

    images = [Image.fromarray(frame) for frame in frames]
    options: dict[str, object] = {"duration": round(1000 / fps), "loop": 0, "save_all": True}
    if fmt == "gif":
        images = _with_one_palette(images)
        options |= {"optimize": False, "disposal": 1}
    elif fmt == "webp":
        options |= {"lossless": True, "quality": 20, "method": 0}
    made = io.BytesIO()
    name = {"gif": "GIF", "apng": "PNG", "webp": "WEBP"}[fmt]
    images[0].save(made, name, append_images=images[1:], **options)
    out.write(made.getvalue())


def _with_one_palette(images: list[Image.Image]) -> list[Image.Image]:
    """Give images with one palette: of all their colors where these fit, else of those that a few images need."""
    from PIL import Image

    packed = [_packed(image) for image in images]
    colors = np.unique(np.concatenate([np.unique(each) for each in packed]))
    if len(colors) > COLORS:
        chosen = [images[k] for k in dict.fromkeys((0, len(images) // 2, len(images) - 1))]
        sheet = Image.new("RGB", (chosen[0].width, sum(image.height for image in chosen)))
        for number, image in enumerate(chosen):
            sheet.paste(image, (0, number * image.height))
        palette = sheet.quantize(COLORS)
        return [image.quantize(palette=palette, dither=Image.Dither.NONE) for image in images]
    table = np.stack([colors >> 16, colors >> 8 & 255, colors & 255], axis=1).astype(np.uint8)
    made = []
    for each in packed:
        indexed = Image.fromarray(np.searchsorted(colors, each).astype(np.uint8), "P")
        indexed.putpalette(table.tobytes())
        made.append(indexed)
    return made


def _packed(image: Image.Image) -> NDArray[np.uint32]:
    """(H, W) one number a color."""
    red, green, blue = np.moveaxis(np.asarray(image).astype(np.uint32), 2, 0)
    packed: NDArray[np.uint32] = red << 16 | green << 8 | blue
    return packed
