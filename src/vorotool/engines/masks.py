"""Distance transforms, medial axes, thickness and larger labels of masks; arguments as in scipy and scikit-image."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any, Literal, overload

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.images import as_raster
from vorotool.convert.spacings import asked_sides
from vorotool.convert.volumes import is_volume
from vorotool.engines.from_skeleton.points_along import points_along
from vorotool.engines.from_skeleton.thickness import thickness_of_pixels
from vorotool.engines.label_images.outlines import outlines
from vorotool.engines.pruning.pruning import default_pruning_for_masks, prune
from vorotool.engines.skeleton_api import skeleton_exact
from vorotool.engines.tessellation.cleaned_masks import reaches_border
from vorotool.engines.tessellation.frames import frame_at, require_memory
from vorotool.engines.tessellation.raster_objects import label_values, numbered_components
from vorotool.engines.tessellation.tessellator import Tessellator, surrounded
from vorotool.errors import InputError, LimitError, UsageError, option
from vorotool.numeric.checks import MAX_PIXELS, checked_flag
from vorotool.numeric.numbers import real_number, shown_number
from vorotool.numeric.parallel import Progress
from vorotool.types.images import Raster
from vorotool.types.pixels import Frame, PixelSides, as_decimal
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.volumes.volume import VolumeSeeds

if TYPE_CHECKING:
    from vorotool.typing import ImageLike, OutlineKind, Spacing


@overload
def distance_transform(
    mask: ImageLike,
    *,
    spacing: Spacing | None = ...,
    return_distances: Literal[True] = ...,
    return_indices: Literal[False] = ...,
    threads: int = ...,
    max_pixels: int = ...,
) -> NDArray[np.float64]: ...
@overload
def distance_transform(
    mask: ImageLike,
    *,
    spacing: Spacing | None = ...,
    return_distances: Literal[False],
    return_indices: Literal[True],
    threads: int = ...,
    max_pixels: int = ...,
) -> NDArray[np.int32]: ...
@overload
def distance_transform(
    mask: ImageLike,
    *,
    spacing: Spacing | None = ...,
    return_distances: Literal[True] = ...,
    return_indices: Literal[True],
    threads: int = ...,
    max_pixels: int = ...,
) -> tuple[NDArray[np.float64], NDArray[np.int32]]: ...
def distance_transform(
    mask: ImageLike,
    *,
    spacing: Spacing | None = None,
    return_distances: bool = True,
    return_indices: bool = False,
    threads: int = 0,
    max_pixels: int = MAX_PIXELS,
) -> NDArray[np.float64] | NDArray[np.int32] | tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Compute the distance of each nonzero pixel or voxel to the nearest zero one, and its indices.

    As `scipy.ndimage.distance_transform_edt`, between centers. Squared distances are exact integers, whose roots are
    rounded once. Of several nearest pixels it is the first one, row by row, that the indices name; SciPy names any.

    Parameters
    ----------
    mask : (H, W) or (D, H, W) array
        Nonzero pixels or voxels are foreground.
    spacing : float, (height, width) or (depth, height, width), or "auto", optional
        Sides of a pixel or voxel, by default 1; SciPy's ``sampling``. A float is the decimal number that it is written
        as.
    return_distances, return_indices : bool
        Which results to return.
    threads : int
        Number of threads; 0 uses all.
    max_pixels : int
        Larger images are refused before memory is allocated.

    Returns
    -------
    distances : float64 array of the shape of the mask
        0 at zero pixels.
    indices : (2, H, W) or (3, D, H, W) int32 array
        Row and column, or slice, row and column, from 0, of the nearest zero pixel; alone if distances are not wanted.

    Raises
    ------
    InputError
        If the mask is no image, or has no zero pixel: there are no distances then.
    LimitError
        If it has more than `max_pixels` pixels.
    UsageError
        If nothing is wanted, or the spacing is none.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 2.2.

    Examples
    --------
    >>> distance_transform([[0, 1, 1, 1], [1, 1, 1, 1]])[1].tolist()
    [1.0, 1.4142135623730951, 2.23606797749979, 3.1622776601683795]
    >>> distance_transform([[[0, 1, 1]], [[1, 1, 1]]], spacing=(3, 1, 2)).tolist()
    [[[0.0, 2.0, 4.0]], [[3.0, 3.605551275463989, 5.0]]]
    >>> distance_transform([[0, 1, 0]], return_distances=False, return_indices=True)[1].tolist()
    [[0, 0, 2]]
    """
    return_distances = checked_flag(return_distances, "return_distances")
    return_indices = checked_flag(return_indices, "return_indices")
    if not (return_distances or return_indices):
        raise UsageError("return_distances and return_indices are both False: set at least one of them")
    is_solid = is_volume(mask)
    values = volume(mask, "mask", max_pixels) if is_solid else plane(mask, "mask")
    sweep = _Background.of(values, asked_sides(mask, spacing, 3 if is_solid else 2), threads, max_pixels)
    if not return_indices:
        return _roots(sweep, values.shape)
    indices = np.zeros((values.ndim, *values.shape), np.int32) if sweep is None else sweep.nearest()
    return (_roots(sweep, values.shape), indices) if return_distances else indices


class _Background(Tessellator):
    """The tessellation whose seeds are the zero pixels or voxels, of which those at the foreground are enough."""

    def __init__(self, background: NDArray[np.bool_], sides: PixelSides, threads: int) -> None:
        self.is_seed = background
        self.places = np.argwhere(background & ~surrounded(background))
        labels = np.arange(1, len(self.places) + 1, dtype=np.uint32)
        super().__init__(bare_seeds(self.places, labels, background.shape), sides=sides, threads=threads)

    @classmethod
    def of(cls, values: NDArray[Any], sides: PixelSides, threads: int, max_pixels: int) -> _Background | None:
        """None of an image or a volume without pixels."""
        if not values.size:
            return None
        require_memory(frame_at((0,) * values.ndim, values.shape[::-1]), max_pixels)
        background = values == 0
        if not background.any():
            raise InputError(
                "invalid mask: expected at least one zero pixel to measure distances to, but all are nonzero"
            )
        return cls(background, sides, threads)

    def squared_distances(
        self,
        first: int = 0,
        count: int | None = None,
        *,
        dtype: np.dtype[Any] | None = None,
        out: NDArray[Any] | None = None,
    ) -> NDArray[Any]:
        """Those of the sweep, and 0 where a seed is that it was not told of."""
        squares = super().squared_distances(first, count, dtype=dtype, out=out)
        squares[self.is_seed[first : first + len(squares)]] = 0
        return squares

    def nearest(self) -> NDArray[np.int32]:
        """Row and column, or slice, row and column, of the nearest zero pixel or voxel, by axis."""
        seed = self.labels(dtype=np.uint32).astype(np.int64) - 1
        own = np.nonzero(self.is_seed)
        indices = np.empty((self.axes, *self.frame.shape), np.int32)
        for axis in range(self.axes):
            indices[axis] = self.places[:, axis][seed]
            indices[axis][own] = own[axis]
        return indices


def _roots(sweep: _Background | None, shape: tuple[int, ...]) -> NDArray[np.float64]:
    """Roots of squared distances, in the unit of the spacing."""
    if sweep is None:
        return np.zeros(shape)
    squares = sweep.squared_distances().astype(np.float64)
    if sweep.step != 1:
        squares *= float(sweep.step * sweep.step)
    return np.sqrt(squares)


def expand_labels(
    labels: ImageLike,
    distance: float | Fraction = 1,
    *,
    spacing: Spacing | None = None,
    threads: int = 0,
    max_pixels: int = MAX_PIXELS,
) -> NDArray[Any]:
    """Expand labels into the background, up to a distance.

    As `skimage.segmentation.expand_labels`: labels do not grow into each other. Whether a pixel is within the distance
    is decided exactly, and of several labels at one distance the smallest has the pixel; scikit-image compares rounded
    distances, and gives a tie to any of them.

    Parameters
    ----------
    labels : (H, W) or (D, H, W) array of integers or booleans
        0 is background. Labels are from 1 to 4294967295.
    distance : float or Fraction
        How far labels grow, between centers of pixels or voxels, this distance included; ``inf`` fills all the
        background.
    spacing : float, (height, width) or (depth, height, width), or "auto", optional
        Sides of a pixel or voxel in the unit of `distance`, by default 1. With it floats are the decimal numbers that
        they are written as: three pixels of 0.1 are within 0.3.
    threads : int
        Number of threads; 0 uses all.
    max_pixels : int
        Larger images are refused before memory is allocated.

    Returns
    -------
    array of the shape and the type of the input
        Labels.

    Raises
    ------
    InputError
        If the labels are no image, not integers, or out of range.
    LimitError
        If the image has more than `max_pixels` pixels.
    UsageError
        If the distance is negative or NaN, or the spacing is invalid.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 2.1.

    Examples
    --------
    >>> expand_labels([[7, 0, 0, 0, 2]]).tolist(), expand_labels([[7, 0, 0, 0, 2]], 2).tolist()
    ([[7, 7, 0, 2, 2]], [[7, 7, 2, 2, 2]])
    """
    is_solid = is_volume(labels)
    values = volume(labels, "labels", max_pixels) if is_solid else plane(labels, "labels")
    sides = asked_sides(labels, spacing, 3 if is_solid else 2)
    limit = real_number(distance, "distance")
    if not limit >= 0:
        raise UsageError(f"invalid distance {shown_number(distance)}: expected a number from 0")
    if values.dtype.kind == "f":
        raise InputError(f"invalid labels: expected integers or booleans, but got {values.dtype}; round them first")
    if not values.size or not values.any():
        return values.copy()
    exact = Fraction if spacing is None else as_decimal
    most = None if limit == float("inf") else exact(limit)
    require_memory(frame_at((0,) * values.ndim, values.shape[::-1]), max_pixels)
    outer = (values != 0) & ~surrounded(values)  # the others have their labels
    seeds = bare_seeds(np.argwhere(outer), label_values(values)[outer].astype(np.uint32), values.shape)
    grown = Tessellator(seeds, max_distance=most, sides=sides, threads=threads).labels(dtype=np.uint32)
    made = grown.astype(values.dtype)
    np.copyto(made, values, where=values != 0)
    return made


def volume(values: Any, name: str, max_pixels: int) -> NDArray[Any]:
    """Give a volume as a 3-D array of booleans or numbers."""
    if np.ma.isMaskedArray(values) and np.ma.getmaskarray(values).any():
        raise InputError(f"invalid {name}: expected a value in each voxel, but some are masked; fill them first")
    array = np.asarray(values)
    if array.dtype.kind not in "buif":
        raise InputError(f"invalid {name}: expected booleans or numbers, but got {array.dtype}")
    if array.size > real_number(max_pixels, "max_pixels"):
        sides, most = " x ".join(map(str, array.shape)), option(f"--max-pixels {shown_number(max_pixels)}")
        raise LimitError(f"the volume has {sides} = {array.size} voxels, more than {most}")
    return array


def bare_seeds(places: NDArray[np.int64], labels: NDArray[np.uint32], shape: tuple[int, ...]) -> SeedSet | VolumeSeeds:
    """Give pixels or voxels as seeds of which no sites are wanted, which take time to find."""
    known: Any = {"frame": frame_at((0,) * len(shape), shape[::-1]), "site_labels": np.empty(0, np.uint32)}
    if len(shape) == 2:
        y, x = places.T
        return SeedSet(x, y, labels, sites=np.empty((0, 2)), **known)
    return VolumeSeeds(np.asfortranarray(places[:, ::-1]), labels, sites=np.empty((0, 3)), **known)


def plane(values: ImageLike, name: str) -> NDArray[Any]:
    """Give an image as a 2-D array of booleans or numbers."""
    shape = getattr(values, "shape", None)
    if isinstance(shape, tuple) and len(shape) == 2 and 0 in shape:
        return np.asarray(values)
    image = as_raster(values, name, is_gray=True)
    if image.is_color:
        raise InputError(f"invalid {name}: expected one value in each pixel, but it is a color image")
    if image.mask is not None and image.mask.any():
        raise InputError(f"invalid {name}: expected a value in each pixel, but some are masked; fill them first")
    return image.values


_STEP = 0.125
"""Between the places along the skeleton whose pixels are marked: an arc marks each pixel in which it is this long."""


@overload
def medial_axis(mask: ImageLike, *, return_distance: Literal[False] = ..., threads: int = ...) -> NDArray[np.bool_]: ...
@overload
def medial_axis(
    mask: ImageLike, *, return_distance: Literal[True], threads: int = ...
) -> tuple[NDArray[np.bool_], NDArray[np.float64]]: ...
def medial_axis(
    mask: ImageLike, *, return_distance: bool = False, threads: int = 0
) -> NDArray[np.bool_] | tuple[NDArray[np.bool_], NDArray[np.float64]]:
    """Mark the pixels that the exact skeleton of a mask passes through.

    The skeleton is that of the outline of the pixels (`skeleton_exact` of `outlines`), pruned as that of a mask is by
    default, so that no branch goes to each corner of a pixel. Every object has one 8-connected part of it, with the
    holes of the object and no others: pixels that branches enclose between them are marked, too. It is not
    `skimage.morphology.medial_axis`, which thins pixels in an order that chance decides in part: that axis is one pixel
    wide and has branches to corners of the outline, while this one may be two pixels wide, since it has all pixels
    that the skeleton passes through, and takes the border of the image for a part of the outline.

    Parameters
    ----------
    mask : (H, W) array
        Nonzero pixels are foreground.
    return_distance : bool
        Return the distances to the background as well.
    threads : int
        Number of threads; 0 uses all.

    Returns
    -------
    axis : (H, W) bool array
        The pixels.
    distance : (H, W) float64 array
        As of `distance_transform`, between centers of pixels: only with `return_distance`.

    Raises
    ------
    InputError
        If the mask is no image; or has no zero pixel, with `return_distance`.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 3.2.

    Examples
    --------
    >>> medial_axis(np.ones((3, 9))).astype(int).tolist()
    [[0, 0, 0, 0, 0, 0, 0, 0, 0], [0, 1, 1, 1, 1, 1, 1, 1, 0], [0, 0, 0, 0, 0, 0, 0, 0, 0]]
    """
    return_distance = checked_flag(return_distance, "return_distance")
    foreground = plane(mask, "mask") != 0
    axis = np.zeros(foreground.shape, np.bool_)
    if foreground.any():
        skeleton = skeleton_exact(outlines(foreground, threads=threads), threads=threads)
        limits: dict[str, Any] = dict([default_pruning_for_masks()])
        pruned = prune(skeleton, threads=threads, **limits)
        x, y = np.floor(points_along(pruned, every=_STEP).xy + 0.5).astype(np.int64).T
        axis[y, x] = True
        axis &= foreground
        axis |= _false_holes(axis, foreground)
    return (axis, distance_transform(foreground, threads=threads)) if return_distance else axis


def _false_holes(axis: NDArray[np.bool_], foreground: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return the pixels that an axis encloses without any background: two branches beside each other may."""
    components = numbered_components(~axis, 4)
    is_true = reaches_border(components)
    is_true[components[~foreground]] = True
    return ~(is_true[components] | axis)


def local_thickness(
    mask: ImageLike,
    *,
    outline: OutlineKind = "crack",
    connectivity: int = 8,
    spacing: Spacing | None = None,
    threads: int = 0,
    max_pixels: int = MAX_PIXELS,
    progress: Progress = None,
) -> NDArray[np.float64]:
    """Compute for each pixel of an object the diameter of the largest inscribed disc that covers it.

    That is the local thickness of bone and pore analysis, of each component of a mask, or of each label, by itself.
    The discs are inside the outline of the object (see :func:`vorotool.outlines`), and their centers are all places of
    its exact skeleton: no set of radii is chosen, and no distance is counted in pixels. Values are exact but for
    rounding. Discs are closed: a pixel whose center is on the rim is covered, and to see that in spite of rounding a
    disc covers what is at most 64 units in the last place of the image's larger side beyond it.

    Parameters
    ----------
    mask : (H, W) array
        Nonzero pixels are foreground. With several values, or one that is none of a mask, these are labels.
    outline : {"crack", "contour"}
        Around the pixels, or half-way between the centers of pixels inside and outside.
    connectivity : {8, 4}
        Of the pixels of an object.
    spacing : float, (height, width) or "auto", optional
        Sides of a pixel, by default 1. A float is the decimal number that it is written as.
    threads : int
        Number of threads; 0 uses all. The result does not depend on it.
    max_pixels : int
        Larger images are refused before memory is allocated.
    progress : callable, optional
        Called with the fraction done of each step.

    Returns
    -------
    (H, W) float64 array
        In the unit of the spacing; 0 at pixels without an object.

    Raises
    ------
    InputError
        If the mask is no image.
    LimitError
        If it has more than `max_pixels` pixels.
    UsageError
        If an option is invalid.

    References
    ----------
    Hildebrand and Rüegsegger, "A new method for the model-independent assessment of thickness in three-dimensional
    images", Journal of Microscopy 185, 1997.

    Examples
    --------
    >>> local_thickness([[1, 1, 1, 0, 0], [1, 1, 1, 1, 1], [1, 1, 1, 0, 0]])[1].tolist()
    [3.0, 3.0, 3.0, 1.0, 1.0]
    """
    values = plane(mask, "mask")
    sides = asked_sides(mask, spacing)
    height, width = values.shape
    require_memory(Frame(0, 0, max(width, 1), max(height, 1)), max_pixels)
    if not values.any():
        return np.zeros(values.shape)
    shapes = outlines(Raster(values), outline=outline, connectivity=connectivity, threads=threads, progress=progress)
    if sides.units != (1, 1):
        from dataclasses import replace

        shapes = replace(shapes, xy=shapes.xy * (sides.x, sides.y), frame=None)
    skeleton = skeleton_exact(shapes, threads=threads, progress=progress)
    made = thickness_of_pixels(skeleton, values.shape, sides=(sides.y, sides.x), threads=threads, progress=progress)
    return made if sides.step == 1 else made * sides.step.numerator / sides.step.denominator
