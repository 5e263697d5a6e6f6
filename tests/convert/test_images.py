"""Images from whatever callers hold, and what tells them from points."""

from fractions import Fraction

import dask.array
import numpy as np
import pandas as pd
import pytest
import xarray
import zarr
from PIL import Image

import vorotool
from support.few import few
from vorotool import InputError, LabelImage, LimitError, Raster, UsageError
from vorotool.convert.images import as_label_image, as_raster, is_image
from vorotool.engines.tessellation.raster_objects import numbered_components
from vorotool.types.box import as_box, as_extent

LABELS = np.array([[0, 1, 1, 0, 5], [0, 0, 1, 0, 5], [3, 0, 0, 0, 5], [3, 3, 0, 0, 0]])
MASK = LABELS > 0


class Foreign:
    """An array whose type of numbers NumPy does not know, as those of PyTorch."""

    def __init__(self, values):
        self.values, self.shape, self.dtype = values, values.shape, "foreign"

    def __array__(self, dtype=None, copy=None):
        return self.values


def in_zarr(values):
    """A Zarr array in memory."""
    made = zarr.create_array({}, shape=values.shape, dtype=values.dtype.newbyteorder("="), chunks=(2, 2))
    made[:] = values
    return made


@pytest.mark.parametrize("dtype", few(["bool", ">u2", "int64", "uint8"], 2))
@pytest.mark.parametrize(
    "form",
    [
        np.asarray,
        np.asfortranarray,
        lambda values: np.repeat(values, 2, axis=1)[:, ::2],
        np.ma.array,
        dask.array.from_array,
        in_zarr,
        xarray.DataArray,
        Raster,
        memoryview,
    ],
    ids=["array", "fortran", "strided", "masked", "dask", "zarr", "xarray", "raster", "memoryview"],
)
def test_all_forms_have_the_same_values(dtype, form):
    values = LABELS.astype(dtype)
    made = as_raster(form(values), "image")
    assert made.values.tolist() == values.tolist()
    assert made.values.dtype.kind == values.dtype.kind


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        (MASK, True),
        (MASK[:, :2], True),
        (MASK[:, :3], True),
        (LABELS, True),
        (LABELS[:, :2], False),
        (LABELS[:, :3], False),
        (LABELS[:, :1], True),
        (LABELS[:0], False),
        (LABELS[:, :2].astype(float), False),
        (LABELS[:, :2].tolist(), False),
        (LABELS.tolist(), False),
        (np.zeros((4, 5, 3), np.uint8), True),
        (dask.array.from_array(LABELS), True),
        (dask.array.from_array(LABELS[:, :2]), False),
        (xarray.DataArray(MASK), True),
        (xarray.DataArray(MASK, dims=("rows", "columns"), coords={"columns": range(5)}), True),
        (Image.fromarray(MASK), True),
        (Image.fromarray(LABELS.astype(np.uint8)), True),
        (Foreign(MASK), True),
        (Foreign(LABELS[:, :2]), False),
        (pd.DataFrame(LABELS), False),
        (Raster(LABELS[:, :2]), True),
        (LabelImage(LABELS), True),
        (None, False),
        (np.zeros((2, 9)), False),
        (np.zeros((0, 9)), False),
    ],
    ids=lambda value: type(value).__name__,
)
def test_what_is_an_image(source, expected):
    assert is_image(source, "seeds") is expected
    if not isinstance(source, Raster | LabelImage):
        assert is_image(source, "seeds", True) is True
        assert is_image(source, "seeds", False) is False


@pytest.mark.parametrize(
    ("source", "message"),
    [
        (None, "None"),
        ("a.png", r"vorotool.read\('a.png'\)"),
        ([[1, 2], [3]], "expected an image: .* but got a list"),
        (LABELS[0], r"but got an array of int64 and shape \(5,\)"),
        (LABELS.astype(float), r"seeds_from_raster\(mask, threshold=…\)"),
        (LABELS.astype(str), "expected an image: .* but got an array of <U21"),
        (np.zeros((4, 5, 3), np.uint8), r"a color image, .* give vorotool.seeds_from_raster\(mask, threshold=…\)"),
        (np.zeros((6, 9, 9), np.uint8), r"a stack of 6 images, .* give one of them, mask\[0\]"),
        (pd.DataFrame({"x": [1], "y": [2]}), "DataFrame"),
        (np.zeros((0, 5), bool), "the image is empty"),
    ],
)
def test_what_is_refused_names_the_parameter(source, message):
    with pytest.raises(InputError, match=f"^invalid mask: .*{message}"):
        as_raster(source, "mask")
    with pytest.raises(InputError, match=f"^invalid mask: .*{message}"):
        as_label_image(source, "mask", numbered_components)


def test_what_is_not_in_memory_is_not_read_if_it_is_too_large():
    def refuse(*_):
        raise AssertionError("it was read")

    lazy = dask.array.from_array(LABELS).map_blocks(refuse, dtype=LABELS.dtype)
    with pytest.raises(LimitError, match="max_pixels 19"):
        as_raster(lazy, "seeds", max_pixels=19)
    with pytest.raises(LimitError, match="more than max_pixels"):
        vorotool.tessellate(dask.array.zeros((10**6, 10**6), dtype=np.uint8))
    for function in (vorotool.tessellate, vorotool.repair_digital, vorotool.compare_digital):
        with pytest.raises(LimitError, match="max_pixels 19"):
            function(lazy, max_pixels=19)


# ---- axes with coordinates ---------------------------------------------------------------------------
def with_axes(values, x, y, **attributes):
    """An array of xarray; attributes are those of both axes."""
    axes = {"y": ("y", y, attributes), "x": ("x", x, attributes)}
    return xarray.DataArray(values, dims=("y", "x"), coords=axes)


def test_coordinates_are_the_grid():
    image = with_axes(LABELS, 2600000.25 + 0.5 * np.arange(5), 1200000 - 2.0 * np.arange(4), units="metre")
    image.coords["spatial_ref"] = xarray.DataArray(0, attrs={"crs_wkt": "EPSG:2056"})
    grid = as_raster(image, "image").grid
    assert (grid.width, grid.height, grid.unit) == (Fraction(1, 2), 2, "m")
    assert grid.transform == (0.5, 0, 2600000, 0, -2, 1200001)
    assert grid.is_north_up
    assert grid.crs["properties"]["name"] == "urn:ogc:def:crs:EPSG::2056"
    assert vorotool.tessellate(image, spacing=1).grid == grid
    assert vorotool.region_table(image)["area"].tolist() == [3, 3, 3]


def test_grids_of_other_directions_and_units():
    steps = 0.1 * np.arange(5), 0.1 * np.arange(4)  # not even to the last digit
    grid = as_raster(with_axes(LABELS, *steps, units="um"), "image").grid
    assert (grid.unit, grid.transform, float(grid.width)) == ("µm", None, pytest.approx(0.1))
    centered = as_raster(with_axes(LABELS, 0.25 + np.arange(5) / 2, 0.5 + np.arange(4)), "image").grid
    assert (centered.width, centered.height, centered.transform) == (Fraction(1, 2), 1, None)
    assert as_raster(with_axes(LABELS, *steps, units="degrees_east"), "image").grid.unit is None
    moved = as_raster(with_axes(LABELS, 7 + np.arange(5), 30 * np.arange(4)), "image").grid
    assert (moved.transform, moved.is_north_up) == ((1, 0, 6.5, 0, 30, -15), False)
    assert as_raster(xarray.DataArray(LABELS), "image").grid is None


@pytest.mark.parametrize(
    ("image", "message"),
    [
        (with_axes(LABELS, [0, 1, 2, 4, 5], np.arange(4)), "the coordinates of x are not evenly spaced: .* 1 to 2"),
        (with_axes(LABELS, np.arange(5), [0, 0, 0, 0]), "the coordinates of y are not evenly spaced"),
        (with_axes(LABELS, list("abcde"), np.arange(4)), "the coordinates of x are not numbers"),
        (with_axes(LABELS, [0, 1, np.nan, 3, 4], np.arange(4)), "the coordinates of x are not numbers"),
        (with_axes(LABELS, np.arange(5), np.arange(4)).transpose(), "its dimensions are x, y: transpose it"),
    ],
)
def test_axes_that_are_no_grid(image, message):
    with pytest.raises(InputError, match=f"^invalid image: {message}"):
        as_raster(image, "image")


@pytest.mark.parametrize("frame", [1, "abcd", (1, 2, 3), (1, 2, 3, "a"), (1, 2, 3, np.inf), [[1, 2, 3, 4]], None])
def test_what_is_no_box(frame):
    with pytest.raises(InputError, match=r"^invalid frame .*: expected a Box or four finite numbers"):
        as_box(frame, "frame")
    with pytest.raises(UsageError, match=r"^invalid frame .*: expected a Box or four finite numbers"):
        as_extent(frame, "frame")
