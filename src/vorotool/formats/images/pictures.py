"""Pictures to look at: JPEG, BMP, GIF, WebP and AVIF are read by imageio, animations written by Pillow."""

from __future__ import annotations

import io
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, Message, option
from vorotool.formats.images.tiff_layout import TiffLayout
from vorotool.formats.io.sources import Source, check_pixels, decoding, interruptible
from vorotool.formats.recognition import PICTURES, format_of

if TYPE_CHECKING:
    from PIL import Image

_ANIMATED = ("gif", "webp", "avif")
_HUFFMAN = (0xC0, 0xC1, 0xC2)
_MOST_EXPANSION = 512  # of Huffman codes: a bit a block of 8 x 8 pixels at the least
_PLAIN = {"CMYK": "RGB", "YCbCr": "RGB", "LAB": "RGB", "HSV": "RGB", "RGBX": "RGB", "La": "LA", "RGBa": "RGBA"}
_LIMITS = threading.Lock()


def is_lossy(data: bytes, kind: str) -> bool:
    """Whether values are not exact, so that they are no labels; of WebP what is not plainly lossless."""
    return kind in ("jpeg", "avif") or (kind == "webp" and data[12:16] != b"VP8L" and b"VP8L" not in _chunks(data))


def _chunks(data: bytes) -> set[bytes]:
    """The kinds of chunks of a WebP file."""
    kinds, at = set(), 12
    while at + 8 <= len(data):
        kinds.add(data[at : at + 4])
        size = int.from_bytes(data[at + 4 : at + 8], "little")
        at += 8 + size + size % 2
    return kinds


def read_picture_file(
    source: Source, kind: str, *, page: int | None, max_pixels: int, note: Callable[[str], None] | None = None
) -> NDArray[Any]:
    """Return what is seen: (H, W) or (H, W, C) values of 8 bits, turned upright where the file says how."""
    with _opened(source, kind) as file:
        height, width = file.properties(index=0).shape[:2]
        check_pixels(source.name, width, height, max_pixels)
        _check_jpeg(source, kind)
        count = interruptible(lambda: file.properties(index=...).n_images) if kind in _ANIMATED else 1
        if not 0 <= (page or 0) < count:
            pictures = "a single page" if count == 1 else f"{count} pages, counted from 0"
            raise InputError(f"{source.name} has {pictures}: {option(f'--page {page}')} does not exist")
        if count > 1 and page is None and note is not None:
            other = option("--page", "page=...")
            note(Message(f"{source.name} has {count} pictures: the first one is read; choose another with {other}"))
        return interruptible(lambda: _decoded(file, page or 0))


def picture_pages(source: Source, kind: str) -> int:
    """Count the pictures of an animation; others hold one."""
    if kind not in _ANIMATED:
        return 1
    with _opened(source, kind) as file:
        return int(interruptible(lambda: file.properties(index=...).n_images))


@contextmanager
def _opened(source: Source, kind: str) -> Iterator[Any]:
    """Open a file by its header."""
    name = PICTURES[kind]
    if format_of(source.data) != kind:
        raise InputError(f"{source.name} does not begin as a {name} image: is it damaged, or another format?")
    from imageio.v3 import imopen
    from PIL import Image

    if f".{kind}" not in Image.registered_extensions():
        raise InputError(f"{source.name} is {name}, which this Pillow does not read: install a newer one, or use PNG")
    with decoding(source.name, name):
        with _LIMITS:  # of sizes, which are judged here
            before, Image.MAX_IMAGE_PIXELS = Image.MAX_IMAGE_PIXELS, None
            try:
                file = imopen(io.BytesIO(source.data), "r", plugin="pillow")
            except OSError:  # which says nothing but that
                raise InputError(f"{source.name} cannot be read as {name}: is the file damaged or cut off?") from None
            finally:
                Image.MAX_IMAGE_PIXELS = before
        with file:
            yield file


def _decoded(file: Any, index: int) -> NDArray[Any]:
    """Decode one picture."""
    about = file.metadata(index=index, exclude_applied=False)
    mode = _PLAIN.get(about["mode"])
    if "transparency" in about:
        mode = {"P": "RGBA", "L": "LA", "RGB": "RGBA"}.get(about["mode"], mode)
    return file.read(index=index, mode=mode, rotate=True, writeable_output=False)


def _check_jpeg(source: Source, kind: str) -> None:
    """Refuse a file whose data cannot be a whole image, before memory is taken: what lacks would be gray."""
    marker, width, height = jpeg_frame(source.data) if kind == "jpeg" else (0, 0, 0)
    if marker in _HUFFMAN and len(source.data) * _MOST_EXPANSION < width * height:
        raise InputError(
            f"{source.name} is damaged: its {len(source.data)} bytes cannot hold {width} x {height} pixels"
        )


# ---- sizes of JPEG pictures ----------------------------------------------------------------------
_LARGEST_UNIT = 32
"""Pixels: 8 x 8 values, of up to 4 x 4 pixels each; a picture is filled up to whole units."""


def check_jpegs(layout: TiffLayout, data: bytes) -> None:
    """Refuse pictures that are larger than the strip or tile that they fill."""
    wide, high = (-(-side // _LARGEST_UNIT) * _LARGEST_UNIT for side in (layout.columns, layout.rows))
    for index, (offset, count) in enumerate(zip(layout.offsets, layout.counts, strict=True)):
        _, width, height = jpeg_frame(data[offset : offset + count])
        if width > wide or height > high:
            raise InputError(
                f"{layout.name} is damaged: {layout.kind} {index} holds a JPEG of {width} x {height} pixels, but has "
                f"room for {layout.columns} x {layout.rows}"
            )


def jpeg_frame(data: bytes) -> tuple[int, int, int]:
    """Marker, width and height of the first frame header; zeros if there is none."""
    at = 2
    while at + 9 <= len(data) and data[at] == 0xFF:
        marker = data[at + 1]
        if marker == 0xFF:  # fills
            at += 1
        elif 0xC0 <= marker <= 0xCF and marker not in (0xC4, 0xC8, 0xCC):
            return marker, int.from_bytes(data[at + 7 : at + 9], "big"), int.from_bytes(data[at + 5 : at + 7], "big")
        else:
            at += 2 + int.from_bytes(data[at + 2 : at + 4], "big")
    return 0, 0, 0


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
    return red << 16 | green << 8 | blue
