"""Images as they were read, and label images."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.frozen import frozen
from vorotool.numeric.arrays import mask_of
from vorotool.numeric.checks import is_masked_array
from vorotool.products.formats import resolved
from vorotool.types import fields as f
from vorotool.types.fields import DOWN, YAxis, record
from vorotool.types.pixels import SQUARE, Frame, PixelGrid, PixelSides
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.values import Geometric, Graph, Pixels, Tabular, Value, counted

if TYPE_CHECKING:
    from vorotool.types.features import Rows

COUNTED = 1 << 24
"""Labels of images of more pixels are not counted to describe one."""


@frozen(eq=False, repr=False)
class LabelImage(Pixels, Value, Tabular, Geometric, Graph):
    """Labels of the pixels of a frame.

    Parameters
    ----------
    labels : (H, W) array of uint8, uint16, uint32 or int32
        Label of each pixel; 0 where there is none.
    frame : Frame, optional
        Where the pixels lie; by default pixel (0, 0) is at the origin.
    seeds : SeedSet, optional
        The seeds that the labels come from.
    grid : PixelGrid, optional
        Sides and places of the pixels in units of the world; by default those of the image that the seeds come from.
    sides : PixelSides
        Sides of a pixel, in whose unit distances and tables are.

    Examples
    --------
    >>> LabelImage(np.array([[1, 1, 2]], dtype=np.uint16)).frame.shape
    (1, 3)
    """

    maker = "tessellate"

    labels: NDArray[Any]
    frame: Frame = f.filled_in()
    seeds: SeedSet | None = None
    grid: PixelGrid | None = None
    sides: PixelSides = SQUARE

    def __post_init__(self) -> None:
        check_labels(self, 2, Frame)

    @property
    def y_axis(self) -> YAxis:
        """Direction of y: that of the seeds; without any rows go down."""
        return DOWN if self.seeds is None else self.seeds.y_axis

    def flipped(self) -> LabelImage:
        """The image with its rows in reverse order, for pictures with y upwards; its seeds move along.

        Examples
        --------
        >>> LabelImage(np.array([[1, 1], [2, 2]], dtype=np.uint16)).flipped().labels.tolist()
        [[2, 2], [1, 1]]
        """
        seeds, frame = self.seeds, self.frame
        if seeds is not None:
            last = 2 * frame.y + frame.height - 1  # y of a seed becomes last - y
            seeds = replace(seeds, y=last * seeds.scale - seeds.y)
        return LabelImage(self.labels[::-1], frame, seeds, sides=self.sides)

    def _array(self) -> NDArray[Any]:
        return self.labels

    def _rows(self, _what: str | None = None) -> Rows:
        return resolved("engines.label_images.features:region_rows")(self)

    def _features(self, _what: str | None = None, _flatten: float | None = None) -> Rows:
        return resolved("engines.label_images.features:region_features")(self)

    def _summary(self) -> str:
        height, width = self.shape
        size = "" if self.grid is None else f", pixels of {self.grid.size_text()}"
        if self.sides != SQUARE:
            size = f", spacing {self.sides.text()}"
        return f"{width} x {height}, {self._label_count()}, {self.labels.dtype}{size}"

    def _label_count(self) -> str:
        """Words for the labels that occur, where they are counted soon."""
        largest = int(self.labels.max(initial=0))
        if max(self.labels.size, largest) > COUNTED:
            return f"labels up to {largest}"
        occurs = mask_of(np.maximum(self.labels, 0), largest + 1)
        return counted(int(np.count_nonzero(occurs[1:])), "label")


def check_labels(value: Any, axes: int, frame_of: Callable[..., Any]) -> None:
    """Refuse labels that are no integers, or not of the frame; what is not given follows from labels and seeds."""
    labels = value.labels.filled(0) if is_masked_array(value.labels) else np.asarray(value.labels)
    if labels.ndim != axes or labels.dtype.kind not in "ui":
        raise InputError(f"labels must be a {axes}-D integer array, but are {labels.ndim}-D of type {labels.dtype}")
    object.__setattr__(value, "labels", labels)
    if value.frame is None:
        object.__setattr__(value, "frame", frame_of(*(0 for _ in labels.shape), *reversed(labels.shape)))
    elif value.frame.shape != labels.shape:
        raise InputError(f"labels have shape {labels.shape}, but the frame {value.frame.shape}")
    if value.grid is None and value.seeds is not None and value.seeds.frame == value.frame:
        object.__setattr__(value, "grid", value.seeds.grid)


@record
class Raster(Pixels, Value):
    """A single-channel image, or a color image that still has to be thresholded.

    Parameters
    ----------
    values : (H, W) or (H, W, C) array
        Truth values, integers or floats. PBM: 1 is foreground. Palette images: the indices.
    grid : PixelGrid, optional
        Sides and places of the pixels, where the file says them.
    mask : (H, W) bool array, optional
        Pixels that are background whatever their values, as those of a masked array are.
    is_lossy : bool
        The file keeps values nearly, as JPEG does: they are no labels, and no mask until there is a threshold.
    y_axis : {"down", "up", "none"}
        Direction of y: "down" unless the first row is the lowest one.

    Raises
    ------
    InputError
        If the array has another number of axes, no pixels, or no numbers.

    Examples
    --------
    >>> Raster(np.eye(3, dtype=np.uint8)).is_color
    False
    """

    values: NDArray[Any]
    grid: PixelGrid | None = None
    mask: NDArray[np.bool_] | None = None
    is_lossy: bool = False
    y_axis: YAxis = f.y_axis(default=DOWN)

    def __post_init__(self) -> None:
        if is_masked_array(self.values):
            mask = np.ma.getmaskarray(self.values)
            object.__setattr__(self, "mask", mask.any(axis=2) if mask.ndim == 3 else mask)
            object.__setattr__(self, "values", self.values.filled(0))
        values = np.asarray(self.values)
        if values.ndim not in (2, 3):
            raise InputError(f"an image must have shape (H, W) or (H, W, C), but has shape {values.shape}")
        if values.dtype.kind not in "biuf":
            raise InputError(f"an image must hold numbers, but has type {values.dtype}")
        if values.size == 0:
            raise InputError(f"the image is empty: its shape is {values.shape}")
        object.__setattr__(self, "values", values)

    @property
    def is_color(self) -> bool:
        """Whether the image has channels."""
        return self.values.ndim == 3

    def _array(self) -> NDArray[Any]:
        return self.values

    def _summary(self) -> str:
        height, width = self.shape
        channels = f" x {self.values.shape[2]}" if self.is_color else ""
        size = "" if self.grid is None else f", pixels of {self.grid.size_text()}"
        return f"{width} x {height}{channels}, {self.values.dtype}{size}"
