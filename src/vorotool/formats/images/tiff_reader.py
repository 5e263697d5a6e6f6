"""Reading one page of a TIFF: its tags by tifffile, its pixels as they are checked, pictures within it by Pillow."""

from __future__ import annotations

import io
import struct
from dataclasses import replace
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import AS_VOLUME, InputError, LimitError, option
from vorotool.formats.images.image_grids import PageGrid, grid_of
from vorotool.formats.images.pictures import check_jpegs
from vorotool.formats.images.tiff_layout import JPEGS, TiffLayout, decode_image, is_decoded_here, layout_of
from vorotool.formats.io.sources import Source, check_pixels, decoding, interruptible

_MOST_CHANNELS = 4
_WHITE_IS_ZERO, _PALETTE = 0, 3
"""Values of PhotometricInterpretation."""

_PILLOW_MODES = {"1", "L", "P", "LA", "RGB", "RGBA", "I;16", "I;16B"}


def count_pages(file: Any) -> int:
    """Count the pages of a file; if all others are smaller copies or masks of the first, it has one."""
    count = len(file.pages)
    return 1 if count > 1 and all(int(file.pages[k].subfiletype) & (_COPY | _MASK) for k in range(1, count)) else count


_COPY, _MASK = 1, 4
"""Bits of the tag NewSubfileType."""


def read_tiff(source: Source, *, page: int | None, max_pixels: int) -> tuple[NDArray[Any], PageGrid]:
    """Return the stored values, (H, W) or (H, W, C), and what the file says of its pixels."""
    with opened_tiff(source.name, io.BytesIO(source.data)) as file:
        chosen = page_of(file, source.name, page)
        layout = page_layout(source.name, len(source.data), chosen)
        check_pixels(source.name, layout.width, layout.height, max_pixels)
        if layout.width * layout.height * layout.samples > _MOST_CHANNELS * max_pixels:
            raise LimitError(
                f"{source.name} has {layout.samples} values per pixel: with {layout.width} x {layout.height} pixels "
                f"these are more than {_MOST_CHANNELS} x {option(f'--max-pixels {max_pixels}')}"
            )
        with decoding(source.name, "TIFF"):
            about = page_grid(source.name, file, chosen)
            if is_decoded_here(layout):
                values = decode_image(layout, source.data)
            else:
                values = interruptible(lambda: _by_library(source, chosen, layout))
    if values.dtype.kind not in "buif" or not 2 <= values.ndim <= 3:
        raise InputError(f"{source.name} holds {values.dtype} of shape {values.shape}: an image of numbers is expected")
    return values, about


def page_grid(name: str, file: Any, page: Any) -> PageGrid:
    """Read what a page says of its pixels, and note that values are those stored where a screen inverts them."""
    about = grid_of(name, file, page)
    if page.photometric != _WHITE_IS_ZERO or about.note:
        return about
    note = (
        f"{name} states that 0 is shown as white (WhiteIsZero): the stored values are used, so dark places are the "
        f"foreground of a mask; {option('--invert', 'invert=True')} swaps foreground and background"
    )
    return replace(about, note=note)


def shown_colors(source: Source, page: int | None) -> tuple[int | None, NDArray[np.uint8] | None, bool]:
    """Give the page, None of the only one, the (n, 3) colors of its indices, and whether a screen inverts values."""
    with opened_tiff(source.name, io.BytesIO(source.data)) as file, decoding(source.name, "TIFF"):
        page = None if count_pages(file) == 1 else page
        chosen = page_of(file, source.name, page)
        colors = chosen.colormap if chosen.photometric == _PALETTE else None
    palette = None if colors is None else np.ascontiguousarray((colors.T >> 8).astype(np.uint8))
    return page, palette, chosen.photometric == _WHITE_IS_ZERO


def page_layout(name: str, size: int, page: Any) -> TiffLayout:
    """Check a page of a file of so many bytes: see `layout_of`."""
    with decoding(name, "TIFF"):
        return layout_of(name, size, page)


def opened_tiff(name: str, file: str | BinaryIO) -> Any:
    """Open a file by its path, or its content."""
    import logging

    import tifffile

    # what tifffile would log is either raised below or does not matter; without a handler it goes to standard
    # error
    logger = logging.getLogger("tifffile")
    if not logger.handlers:
        logger.addHandler(logging.NullHandler())
    with decoding(name, "TIFF"):
        if isinstance(file, str):
            with Path(file).open("rb") as tags:
                check_tags(name, tags)
        else:
            check_tags(name, file)
        return tifffile.TiffFile(file, is_ndpi=False)  # whose pages would be chained in another way


def page_of(file: Any, name: str, page: int | None) -> Any:
    """Choose a page of a file; without a number there must be one only."""
    with decoding(name, "TIFF"):
        count = len(file.pages)
        if 0 <= (page or 0) < count and (page is not None or count_pages(file) == 1):
            return file.pages[page or 0]
    if page is None and count > 1:
        one = option(f"--page 0 to --page {count - 1}, or --page all", f"page=0 to page={count - 1}")
        more = f", or read them as a volume with {AS_VOLUME}" if _may_be_a_volume(name, file, count) else ""
        raise InputError(f"{name} has {count} pages: choose one with {one}{more}")
    if count == 0:
        raise InputError(f"{name} is damaged: it begins as a TIFF, but holds no image")
    raise InputError(
        f"{name} has {count} page{'s' * (count != 1)}, counted from 0: {option(f'--page {page}')} does not exist"
    )


def _may_be_a_volume(name: str, file: Any, count: int) -> bool:
    """Whether the file states no channels, time steps or other axes, which a volume does not have."""
    from vorotool.formats.volumes.tiff_stack import stack_axes

    try:
        axes = stack_axes(name, file, count)
    except InputError:
        return False
    return axes.pages is not None or axes.slices in (None, count)


def _by_library(source: Source, page: Any, layout: TiffLayout) -> NDArray[Any]:
    """Decode what other libraries know: JPEG, fax and further pictures within TIFF."""
    import tifffile

    if layout.compression in JPEGS:
        check_jpegs(layout, source.data)
    if layout.compression not in tifffile.TIFF.DECOMPRESSORS:
        return _by_pillow(source, page)
    if page.dtype is None:  # by its version the library refuses such a page, or reads it as an empty one
        raise InputError(
            f"{source.name} has {layout.bits} bits per sample, which is not supported: is the file damaged? If not, "
            "save it with samples of 8, 16 or 32 bits"
        )
    values = np.asarray(page.asarray())
    if values.ndim == 3 and page.planarconfig == 2 and page.samplesperpixel == values.shape[0]:
        values = np.moveaxis(values, 0, 2)
    return values


def _by_pillow(source: Source, page: Any) -> NDArray[Any]:
    from PIL.TiffImagePlugin import TiffImageFile

    compression = getattr(page.compression, "name", str(page.compression))
    with TiffImageFile(io.BytesIO(source.data)) as image:
        image.seek(page.index)
        if image.size != (page.imagewidth, page.imagelength):
            raise InputError(f"{source.name} is damaged: its size is stated twice, the second time as {image.size}")
        if image.mode not in _PILLOW_MODES:
            raise InputError(
                f"{source.name} has {compression} compression of {page.dtype} pixels: "
                "install imagecodecs, or save it with deflate or no compression"
            )
        values = np.asarray(image)
        if page.photometric == _WHITE_IS_ZERO and image.mode in ("1", "L"):  # which Pillow gives as they are seen
            return ~values
        return values


# ---- tags, before tifffile reads them ------------------------------------------------------------
_NUMBERS = {
    256: "ImageWidth",
    257: "ImageLength",
    259: "Compression",
    262: "PhotometricInterpretation",
    266: "FillOrder",
    277: "SamplesPerPixel",
    284: "PlanarConfiguration",
    317: "Predictor",
    322: "TileWidth",
    323: "TileLength",
    32997: "ImageDepth",
    32998: "TileDepth",
}
"""Tags of one whole number."""

_WHOLE = {1, 3, 4, 6, 8, 9, 13, 16, 17, 18}
"""Types of whole numbers: BYTE, SHORT, LONG, those with a sign, those of 8 bytes, and offsets."""

_SIZES = {1: 1, 2: 1, 3: 2, 4: 4, 5: 8, 6: 1, 7: 1, 8: 2, 9: 4, 10: 8, 11: 4, 12: 8, 13: 4, 16: 8, 17: 8, 18: 8}
"""Bytes of a value of each type."""

_READ_AT_ONCE = {258, 270, 273, 277, 279, 282, 283, 305, 324, 325, 330, 338, 339, 347, 513, 514, 530}
_READ_AT_ONCE |= {33628, 42113, 50838, 50839}
"""Tags whose values tifffile reads with the page, wherever they are in the file."""

_UIC1, _UIC2 = 33628, 33629
"""Tags of MetaMorph: of each value of the first one there may be as many as the second one counts."""

_MOST_TAGS = 4096
"""Of a page; tifffile takes one with more for the end of the pages."""

MOST_ENTRIES = 2**21
"""Pages and tags of a file: of each tifffile makes an object."""

_SPARE = 2**24
"""Bytes that may be read from the tags of any file, beyond four times its size: pages may share values."""

_FIRST_BYTES = {b"II*\0": "<", b"MM\0*": ">", b"II+\0": "<", b"MM\0+": ">"}


class _Walk:
    """The chain of the pages of a file, as tifffile follows it."""

    def __init__(self, name: str, file: BinaryIO, order: str, *, is_big: bool) -> None:
        self.name, self.file = name, file
        self.size = file.seek(0, io.SEEK_END)
        self.count_form, entry_form, self.next_form = (
            struct.Struct(order + form) for form in (("Q", "HHQ8x", "Q") if is_big else ("H", "HHI4x", "I"))
        )
        self.entry_form = entry_form
        self.stated = 0  # bytes that are read with the pages so far
        self.entries = 0

    def follow(self, place: int) -> None:
        """Go from page to page, and check the tags of each."""
        seen: dict[int, int] = {}
        while place:
            page = len(seen)
            if place in seen:
                raise InputError(
                    f"{self.name} is damaged: its pages form a cycle, since page {page - 1} is followed by page "
                    f"{seen[place]}; save it again with the program that wrote it"
                )
            if place >= self.size:
                raise InputError(f"{self.name} is cut off after {self.size} bytes: page {page} begins at byte {place}")
            seen[place] = page
            place = self._check_page(place, page)

    def _check_page(self, place: int, page: int) -> int:
        """Check the tags of a page; where the next page begins, 0 behind the last."""
        form = self.entry_form
        self.file.seek(place)
        head = self.file.read(self.count_form.size)
        count = self.count_form.unpack(head)[0] if len(head) == self.count_form.size else 0
        if count > _MOST_TAGS:
            return 0
        length = count * form.size + self.next_form.size
        data = self.file.read(length)
        if len(head) + len(data) < self.count_form.size + length:
            raise InputError(f"{self.name} is cut off after {self.size} bytes, within the tags of page {page}")
        tags = list(form.iter_unpack(data[: count * form.size]))
        for tag, kind, values in tags:
            if tag in _NUMBERS and (values != 1 or kind not in _WHOLE):
                raise InputError(
                    f"{self.name} is damaged: its {_NUMBERS[tag]} has {values} values of type {kind}, which are not "
                    "one integer"
                )
        self.entries += 1 + count
        self.stated += length + self._value_bytes(tags)
        self._check_totals(page)
        return int(self.next_form.unpack_from(data, count * form.size)[0])

    def _value_bytes(self, tags: list[tuple[int, int, int]]) -> int:
        """Count the bytes that are read elsewhere in the file with a page; what ends behind the file is not read."""
        sizes = [(tag, values * _SIZES.get(kind, 1)) for tag, kind, values in tags if tag in _READ_AT_ONCE]
        planes = max((values for tag, _, values in tags if tag == _UIC2), default=0)
        return sum(size * (1 + planes * (tag == _UIC1)) for tag, size in sizes if size <= self.size)

    def _check_totals(self, page: int) -> None:
        if self.entries > MOST_ENTRIES:
            raise LimitError(
                f"{self.name} has more than {page} pages, and their tags are more than {MOST_ENTRIES}: "
                "split it into files of fewer pages"
            )
        if self.stated > 4 * self.size + _SPARE:
            raise InputError(
                f"{self.name} is damaged: it has {self.size} bytes, but the tags of its first {page + 1} pages refer "
                f"to {self.stated}"
            )


def check_tags(name: str, file: BinaryIO) -> None:
    """Follow the chain of pages before tifffile does; the file is left at its beginning."""
    head = file.read(16).ljust(16, b"\0")
    order = _FIRST_BYTES.get(head[:4])
    if order is not None:
        is_big = b"+" in head[2:4]
        place = struct.unpack_from(f"{order}{'Q' if is_big else 'I'}", head, 8 if is_big else 4)[0]
        _Walk(name, file, order, is_big=is_big).follow(place)
    file.seek(0)
