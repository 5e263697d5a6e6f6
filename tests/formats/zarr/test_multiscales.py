"""OME-Zarr of both versions, as the zarr package writes it: images and labels in and out, with sizes of pixels."""

from fractions import Fraction

import numpy as np
import pytest
import zarr

import vorotool
from support.refusals import refused
from vorotool.errors import InputError
from vorotool.types.pixels import PixelGrid

LABELS = np.zeros((40, 50), np.uint16)
LABELS[5:15, 5:20], LABELS[20:35, 30:45] = 3, 8
AXES = [{"name": name, "type": kind} for name, kind in (("t", "time"), ("c", "channel"), ("z", "space"))]
PLANE = [{"name": name, "type": "space", "unit": "micrometer"} for name in "yx"]


def write(path, version, values=LABELS, *, axes=None, scale=(0.5, 0.5), labels=False):
    """A pyramid of two levels."""
    axes = [*AXES, *PLANE][5 - values.ndim :] if axes is None else axes
    group = zarr.open_group(path, mode="w", zarr_format=2 if version == "0.4" else 3)
    datasets = []
    for level in (0, 1):
        part = values[..., :: 2**level, :: 2**level]
        chunks = (1,) * (values.ndim - 2) + (16, 16)
        group.create_array(str(level), shape=part.shape, dtype=part.dtype, chunks=chunks)[:] = part
        factors = [1.0] * (values.ndim - 2) + [side * 2**level for side in scale]
        datasets.append({"path": str(level), "coordinateTransformations": [{"type": "scale", "scale": factors}]})
    about = {"multiscales": [{"version": version, "axes": axes, "datasets": datasets}]}
    if labels:
        about["image-label"] = {"version": version}
    group.attrs.update(about if version == "0.4" else {"ome": {"version": version, **about}})
    return group


@pytest.mark.parametrize("version", ["0.4", "0.5"])
@pytest.mark.parametrize("shape", [(40, 50), (1, 40, 50), (1, 1, 1, 40, 50)])
def test_the_largest_image_is_read(tmp_path, version, shape):
    write(tmp_path / "a.zarr", version, LABELS.reshape(shape), labels=True)
    raster = vorotool.read(tmp_path / "a.zarr")
    np.testing.assert_array_equal(raster.values, LABELS)
    assert raster.grid == PixelGrid(Fraction(1, 2), Fraction(1, 2), "µm", "ome")


@pytest.mark.parametrize("version", ["0.4", "0.5"])
def test_labels_of_an_image(tmp_path, version):
    group = write(tmp_path / "a.zarr", version, np.ones((3, 40, 50), np.uint16))
    names = group.create_group("labels")
    names.attrs.update({"labels": ["nuclei"]} if version == "0.4" else {"ome": {"labels": ["nuclei"]}})
    write(tmp_path / "a.zarr/labels/nuclei", version, labels=True)
    raster = vorotool.read(tmp_path / "a.zarr/labels/nuclei")
    np.testing.assert_array_equal(raster.values, LABELS)
    refused(InputError, r"a.zarr", vorotool.read, tmp_path / "a.zarr")
    write(tmp_path / "b.zarr", version).create_group("labels").attrs.update(dict(names.attrs))
    notes = []
    vorotool.read(tmp_path / "b.zarr", note=notes.append)
    assert notes == [f"{tmp_path}/b.zarr has label images: {tmp_path}/b.zarr/labels/nuclei names one"]


def test_scales_of_all_levels_are_multiplied(tmp_path):
    group = write(tmp_path / "a.zarr", "0.5", scale=(0.5, 0.25))
    ome = group.attrs["ome"]
    ome["multiscales"][0]["coordinateTransformations"] = [{"type": "scale", "scale": [2, 4]}]
    group.attrs["ome"] = ome
    assert vorotool.read(tmp_path / "a.zarr").grid == PixelGrid(Fraction(1), Fraction(1), "µm", "ome")
    write(tmp_path / "b.zarr", "0.5", axes=[{"name": "y"}, {"name": "x"}])
    assert vorotool.read(tmp_path / "b.zarr").grid is None


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"datasets": []}, "not metadata of OME-Zarr"),
        ({"datasets": 5}, "not metadata of OME-Zarr"),
        ({"axes": None}, "not metadata of OME-Zarr"),
        ({"datasets": [{"path": "../../etc"}]}, "which is not in the store"),
        ({"datasets": [{"path": "/etc"}]}, "which is not in the store"),
        ({"datasets": [{"path": "9"}]}, "holds no Zarr array"),
        ({"axes": [{"name": "x"}, {"name": "y"}]}, "has the axes x, y"),
        ({"datasets": [{"path": "0", "coordinateTransformations": [{"type": "scale", "scale": "a"}]}]}, "not metadata"),
        ({"coordinateTransformations": [{"type": "scale", "scale": [1e300, 1e-300]}] * 4_000}, "not metadata"),
        ({"axes": [{"name": "y"}] * 4_000}, "not metadata"),
    ],
)
def test_damaged_metadata(tmp_path, change, words):
    group = write(tmp_path / "a.zarr", "0.5")
    ome = group.attrs["ome"]
    ome["multiscales"][0].update(change)
    group.attrs["ome"] = ome
    refused(InputError, words, vorotool.read, tmp_path / "a.zarr")
