"""Values that carry a size: warned of once, measured in with ``spacing="auto"``, in the plane and in space."""

import numpy as np
import pytest
import tifffile
import xarray

import vorotool
from vorotool import UsageError, VorotoolWarning
from vorotool.engines import masks

LABELS = np.zeros((6, 8), np.uint8)
LABELS[1, 2], LABELS[4, 6] = 1, 2
SOLID = np.stack([LABELS, np.zeros_like(LABELS), LABELS[::-1]])


def raster(tmp_path):
    sizes = {"PhysicalSizeX": 0.25, "PhysicalSizeY": 0.5, "PhysicalSizeXUnit": "µm", "PhysicalSizeYUnit": "µm"}
    tifffile.imwrite(tmp_path / "in.tif", LABELS, ome=True, metadata={"axes": "YX", **sizes})
    return vorotool.read(tmp_path / "in.tif")


def plane(_=None):
    coords = {
        "y": ("y", 0.5 * np.arange(6), {"units": "um"}),
        "x": ("x", 0.25 * np.arange(8), {"units": "um"}),
    }
    return xarray.DataArray(LABELS, dims=("y", "x"), coords=coords)


def solid(_=None):
    coords = {
        "z": ("z", 2000 * np.arange(3), {"units": "nm"}),
        "y": ("y", 0.5 * np.arange(6), {"units": "um"}),
        "x": ("x", 0.25 * np.arange(8), {"units": "um"}),
    }
    return xarray.DataArray(SOLID, dims=("z", "y", "x"), coords=coords)


SIDES = {raster: (0.5, 0.25), plane: (0.5, 0.25), solid: (2, 0.5, 0.25)}
FUNCTIONS = {
    "tessellate": lambda value, **more: vorotool.tessellate(value, **more).labels,
    "expand_labels": lambda value, **more: masks.expand_labels(value, 1.1, **more),
    "distance_transform": lambda value, **more: masks.distance_transform(value == 0, **more),
    "local_thickness": vorotool.local_thickness,
}


NEITHER = {("local_thickness", solid), ("distance_transform", raster)}
"""The one is of the plane, the other compares a Raster with 0."""
CASES = [
    pytest.param(name, make, id=f"{name} {make.__name__}")
    for name in FUNCTIONS
    for make in SIDES
    if (name, make) not in NEITHER
]


@pytest.mark.parametrize(("name", "make"), CASES)
def test_auto_is_what_would_be_typed(tmp_path, name, make):
    value, call = make(tmp_path), FUNCTIONS[name]
    auto, typed, plain = (call(value, spacing=spacing) for spacing in ("auto", SIDES[make], 1))
    assert np.array_equal(auto, typed)
    assert not np.array_equal(auto, plain)
    with pytest.warns(VorotoolWarning, match=r"spacing='auto'") as told:
        assert np.array_equal(call(value), plain)
    assert len(told) == 1
    assert "0.25 x 0.5" in str(told[0].message)


@pytest.mark.parametrize("value", [LABELS, SOLID])
def test_auto_needs_a_size(value):
    with pytest.raises(UsageError, match=r"spacing='auto' needs an image that states the size"):
        vorotool.tessellate(value, spacing="auto")
    with pytest.raises(UsageError, match=r"invalid spacing 'um'"):
        vorotool.tessellate(value, spacing="um")
