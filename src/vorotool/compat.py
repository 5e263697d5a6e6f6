"""Functions with the names, parameters, order and defaults of other libraries, over our engines.

What differs from the originals is one table in the documents: ties are decided by a rule, and limits exactly.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vorotool.convert.polygons import as_polygons
from vorotool.engines import masks
from vorotool.engines.delaunay import cells
from vorotool.engines.voronoi.voronoi import voronoi
from vorotool.errors import InputError, UsageError
from vorotool.numeric.numbers import shown_number

if TYPE_CHECKING:
    import geopandas
    import shapely

__all__ = ["distance_transform_edt", "expand_labels", "medial_axis", "morphological_tessellation", "voronoi_polygons"]

Sides = float | Sequence[float]
MOST_AXES = 3


def distance_transform_edt(
    input: ArrayLike,  # as SciPy calls it
    sampling: Sides | None = None,
    return_distances: bool = True,
    return_indices: bool = False,
    distances: NDArray[np.float64] | None = None,
    indices: NDArray[np.int32] | None = None,
) -> Any:
    """Compute the distance of each nonzero element to the nearest zero one, as `scipy.ndimage` has it.

    Parameters
    ----------
    input : array
        Of one to three axes; nonzero elements are foreground.
    sampling : float or sequence, optional
        Sides of an element along each axis, by default 1.
    return_distances, return_indices : bool
        Which results to compute.
    distances : float64 array, optional
        Where distances are written to; they are not returned then.
    indices : int32 array, optional
        Where indices are written to, of the shape of the input after the number of its axes; not returned then.

    Returns
    -------
    array, tuple of arrays, or None
        Distances and indices, as far as they are computed and no array is given for them.

    Raises
    ------
    InputError
        If there is no zero element, or an array is of another shape or type.
    UsageError
        If nothing is to be computed, or an array is given for what is not computed.

    Examples
    --------
    >>> distance_transform_edt([0, 1, 1, 0, 1]).tolist()
    [0.0, 1.0, 1.0, 0.0, 1.0]
    """
    if not (return_distances or return_indices):
        raise UsageError("at least one of return_distances and return_indices must be True")
    if distances is not None and not return_distances:
        raise UsageError("return_distances must be True if distances is given")
    if indices is not None and not return_indices:
        raise UsageError("return_indices must be True if indices is given")
    values = _elements(input, "input")
    _check_output(distances, "distances", np.float64, values.shape)
    _check_output(indices, "indices", np.int32, (values.ndim, *values.shape))
    found: dict[str, Any] = {}
    made = masks.distance_transform(
        _of_two_axes(values),
        spacing=_spacing(sampling, values.ndim, "sampling"),
        return_distances=bool(return_distances),  # type: ignore[call-overload]
        return_indices=bool(return_indices),
    )
    both = made if return_distances and return_indices else (made,)
    names = [name for name, wanted in (("d", return_distances), ("i", return_indices)) if wanted]
    found = dict(zip(names, both, strict=True))
    returned = []
    if return_distances:
        returned += _given(distances, found["d"].reshape(values.shape))
    if return_indices:
        returned += _given(indices, found["i"][-values.ndim :].reshape(values.ndim, *values.shape))
    return tuple(returned) if len(returned) > 1 else returned[0] if returned else None


def expand_labels(label_image: ArrayLike, distance: float = 1, spacing: Sides = 1) -> NDArray[Any]:
    """Expand labels into the background without overlap, as `skimage.segmentation` has it.

    Parameters
    ----------
    label_image : array of integers or booleans
        Of one to three axes; 0 is background.
    distance : float
        How far labels grow, this distance included.
    spacing : float or sequence
        Sides of an element along each axis.

    Returns
    -------
    array
        Labels, of the shape and the type of the input.

    Raises
    ------
    InputError
        If the labels are not integers from 0.
    UsageError
        If the distance is negative or NaN, or the spacing is invalid.

    Examples
    --------
    >>> expand_labels([0, 0, 4, 0, 0, 0, 0, 2, 0, 0], 3).tolist()
    [4, 4, 4, 4, 4, 2, 2, 2, 2, 2]
    """
    values = _elements(label_image, "label_image")
    sides = None if np.ndim(spacing) == 0 and spacing == 1 else _spacing(spacing, values.ndim, "spacing")
    return masks.expand_labels(_of_two_axes(values), distance, spacing=sides).reshape(values.shape)


def medial_axis(
    image: ArrayLike,
    mask: ArrayLike | None = None,
    return_distance: bool = False,
    *,
    rng: Any = None,
) -> Any:
    """Mark the pixels of the medial axis of a mask, as `skimage.morphology` has it.

    Parameters
    ----------
    image : (H, W) array
        Nonzero pixels are foreground.
    mask : (H, W) array of booleans, optional
        Pixels that count; the others are returned as they are.
    return_distance : bool
        Return the distances to the background, too.
    rng : optional
        Not used: nothing is chosen at random.

    Returns
    -------
    array of booleans, or a pair with float64 distances
        The axis.

    Raises
    ------
    InputError
        If the image has not two axes, or the mask another shape.

    Examples
    --------
    >>> medial_axis(np.ones((3, 9))).sum()
    np.int64(7)
    """
    foreground = np.asarray(image) != 0
    if foreground.ndim != 2:
        raise InputError(f"invalid image: expected two axes, but got {foreground.ndim}")
    used = foreground
    if mask is not None:
        chosen = np.asarray(mask).astype(bool)
        if chosen.shape != foreground.shape:
            raise InputError(f"invalid mask: expected the shape {foreground.shape}, but got {chosen.shape}")
        used = foreground & chosen
    axis = masks.medial_axis(used)
    if mask is not None:
        axis = np.where(chosen, axis, foreground)
    return (axis, distance_transform_edt(used)) if return_distance else axis


def morphological_tessellation(
    geometry: geopandas.GeoSeries | geopandas.GeoDataFrame,
    clip: Literal["bounding_box", "convex_hull"] | Any | None = "bounding_box",
    shrink: float = 0.4,
    segment: float = 0.5,
    simplify: bool = True,
    n_jobs: int = -1,
) -> geopandas.GeoDataFrame:
    """Return the cells of buildings, as `momepy` has them; geopandas must be installed.

    Parameters
    ----------
    geometry : GeoSeries or GeoDataFrame
        Buildings, or other features.
    clip : {"bounding_box", "convex_hull"}, polygon, or None
        What cells end at: the bounds of the features, their convex hull, a polygon, or the usual frame.
    shrink, segment, simplify, n_jobs : optional
        Not used: nothing is sampled.

    Returns
    -------
    GeoDataFrame
        One cell a feature, with its index and the coordinate reference system.

    Raises
    ------
    UsageError
        If the clip is a text that is none of these.

    Examples
    --------
    >>> import geopandas, shapely
    >>> houses = geopandas.GeoSeries([shapely.box(0, 0, 2, 2), shapely.box(6, 0, 8, 2)])
    >>> morphological_tessellation(houses).area.tolist()
    [8.0, 8.0]
    """
    import geopandas
    import shapely

    shapes = geopandas.GeoSeries(geometry.geometry)
    limits: dict[str, Any] = {}
    if isinstance(clip, str) and clip == "bounding_box":
        left, bottom, right, top = (float(side) for side in shapes.total_bounds)
        limits["frame"] = (left, bottom, right - left, top - bottom)
    elif isinstance(clip, str) and clip == "convex_hull":
        limits["clip"] = shapely.convex_hull(shapely.union_all(shapes.to_numpy()))
    elif isinstance(clip, str):
        raise UsageError(f"invalid clip {clip!r}: expected bounding_box, convex_hull, a polygon or None")
    elif clip is not None:
        as_polygons(clip, "clip")
        limits["clip"] = clip
    cells = voronoi(shapes, **limits).to_shapely()
    return geopandas.GeoDataFrame(geometry=geopandas.GeoSeries(cells, index=shapes.index, crs=shapes.crs))


def voronoi_polygons(
    geometry: Any,
    tolerance: float = 0.0,
    extend_to: Any = None,
    only_edges: bool = False,
    ordered: bool = False,
) -> shapely.GeometryCollection:
    """Return the Voronoi cells of the vertices of a geometry, as `shapely` has them, always in their order.

    Parameters
    ----------
    geometry : geometry of shapely
        Whose vertices are the sites.
    tolerance : float
        Not used: each vertex is a site.
    extend_to : geometry of shapely, optional
        The cells fill its bounds, too.
    only_edges : bool
        Not known here: it must be false.
    ordered : bool
        Not used: cells are in the order of the vertices.

    Returns
    -------
    shapely.GeometryCollection
        One polygon a vertex; that of a vertex which lies on an earlier one is empty.

    Raises
    ------
    InputError
        If it has no vertices that are finite.
    UsageError
        If edges alone are asked for.

    Examples
    --------
    >>> import shapely
    >>> [cell.wkt for cell in voronoi_polygons(shapely.MultiPoint([[0, 0], [2, 0]])).geoms]
    ['POLYGON ((-2 -2, 1 -2, 1 2, -2 2, -2 -2))', 'POLYGON ((1 -2, 4 -2, 4 2, 1 2, 1 -2))']
    """
    import shapely

    if only_edges:
        raise UsageError("only_edges is not supported: use vorotool.voronoi(points).edges for the borders of cells")
    return cells.voronoi_polygons(shapely.get_coordinates(geometry), extend_to=extend_to)


def _elements(values: Any, name: str) -> NDArray[Any]:
    """Return an array of one to three axes."""
    array = np.asarray(values)
    if not 1 <= array.ndim <= MOST_AXES:
        raise InputError(f"invalid {name}: expected one to three axes, but got {array.ndim}")
    return array


def _of_two_axes(values: NDArray[Any]) -> NDArray[Any]:
    """Return a list as an image of one row; images and volumes as they are."""
    return values[None] if values.ndim == 1 else values


def _spacing(sides: Sides | None, axes: int, name: str) -> Any:
    """Return the sides of elements along the axes that are computed with; None for 1."""
    if sides is None:
        return None
    each = [sides] * axes if np.ndim(sides) == 0 else list(np.asarray(sides).tolist())
    if len(each) != axes:
        raise UsageError(f"invalid {name} {shown_number(sides)}: expected one number, or one for each of {axes} axes")
    return (1, *each) if axes == 1 else tuple(each)


def _check_output(array: Any, name: str, dtype: Any, shape: tuple[int, ...]) -> None:
    """Refuse an array that results do not fit in."""
    if array is None:
        return
    if not isinstance(array, np.ndarray) or array.dtype != dtype or array.shape != shape:
        expected = f"an array of {np.dtype(dtype)} of shape {shape}"
        raise InputError(f"invalid {name}: expected {expected}")


def _given(out: NDArray[Any] | None, made: NDArray[Any]) -> list[NDArray[Any]]:
    """Write a result to where it is wanted, else return it."""
    if out is None:
        return [made]
    out[...] = made
    return []
