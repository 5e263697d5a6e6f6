"""Volumes as NPY and Zarr arrays: read slice by slice as NumPy and the zarr package do, written so that they do."""

import os
import pickle
import threading
from fractions import Fraction

import numpy as np
import pytest
import zarr

import vorotool
from support.few import few
from support.readers.written import bytes_of
from support.refusals import refused
from vorotool.errors import InputError, OutputError, UsageError
from vorotool.formats.volumes.opening import open_volume, read_volume
from vorotool.formats.zarr.store import check_store, open_store
from vorotool.formats.zarr.writer import (
    add_levels,
    array_folder,
    chunks_of,
    create_array,
    usual_levels,
    write_chunks,
)
from vorotool.types.volumes.volume import VoxelGrid

VALUES = np.random.default_rng(4).integers(0, 200, (11, 40, 33))
GRID = VoxelGrid(Fraction(13, 40), Fraction(1, 4), Fraction(3, 2), "um", "zarr")


def check(path, expected):
    source = pickle.loads(pickle.dumps(open_volume(path)))
    assert (source.shape, source.dtype) == (expected.shape, expected.dtype)
    for first, count in ((0, 11), (0, 1), (10, 1), (3, 5)):
        found = source.slices(first, count)
        assert found.dtype == expected.dtype
        np.testing.assert_array_equal(found, expected[first : first + count])
    np.testing.assert_array_equal(read_volume(path).values, expected)
    return source


@pytest.mark.parametrize("dtype", few([bool, ">u2", np.uint64, np.uint8, np.int32, ">f8", np.float32], 3))
@pytest.mark.parametrize("order", ["C", "F"])
def test_npy(tmp_path, dtype, order):
    values = VALUES > 100 if dtype is bool else VALUES.astype(dtype)
    np.save(tmp_path / "a.npy", np.asarray(values, order=order))
    expected = values.astype(np.uint8) if dtype is bool else values.astype(values.dtype.newbyteorder("="))
    source = check(tmp_path / "a.npy", expected)
    assert ("Fortran" in source.note) == (order == "F")


def test_npy_that_is_no_volume(tmp_path):
    path = tmp_path / "a.npy"
    np.save(path, VALUES[0])
    refused(InputError, r"a.npy", open_volume, path)
    np.save(path, VALUES)
    whole = path.read_bytes()
    for length in (0, 3, 7, 60, 128, len(whole) - 1):
        path.write_bytes(whole[:length])
        refused(InputError, r"a\.npy", read_volume, path)
    np.save(path, VALUES.astype(complex))
    refused(InputError, "holds complex128, not numbers", open_volume, path)
    np.save(path, np.zeros((3, 0, 2)))
    refused(InputError, "is 2 x 0 x 3 voxels: a volume needs at least 1 x 1 x 1", open_volume, path)
    about = {"descr": "<u2", "fortran_order": False, "shape": (2**20,) * 3}
    path.write_bytes(bytes_of(np.lib.format.write_array_header_1_0, about) + bytes(100))
    refused(InputError, "is cut off", open_volume, path)
    with pytest.raises(InputError, match='is not a tiff file, it begins as npy: use input_format="npy"'):
        open_volume(path, input_format="tiff")
    refused(UsageError, "input_format", open_volume, path, input_format="csv")
    (tmp_path / "a.csv").write_text("x,y\n")
    refused(InputError, r"a.csv", open_volume, tmp_path / "a.csv")
    refused(InputError, "there is no such file", open_volume, tmp_path / "b.tif")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no pipes with a name")
def test_a_pipe(tmp_path):
    np.save(tmp_path / "a.npy", VALUES)
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    writer = threading.Thread(target=lambda: pipe.write_bytes((tmp_path / "a.npy").read_bytes()))
    writer.start()
    np.testing.assert_array_equal(vorotool.read(pipe, geometry="volume").values, VALUES)
    writer.join()


@pytest.mark.parametrize("dtype", [bool, np.uint8, np.int16, np.uint64, np.float32])
@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize("leading", [(1, 1), pytest.param((), marks=pytest.mark.more)])
def test_zarr(tmp_path, dtype, version, leading):
    values = VALUES > 100 if dtype is bool else VALUES.astype(dtype)
    chunks = (*leading, 4, 16, 20)
    data = values.reshape(leading + VALUES.shape)
    zarr.create_array(tmp_path / "a.zarr", data=data, chunks=chunks, zarr_format=version)
    source = check(tmp_path / "a.zarr", values.astype(np.uint8) if dtype is bool else values)
    assert (source.chunk_depth, source.grid) == (4, None)


def pyramid(path, values, version="0.5", *, axes="tczyx", scale=(1, 1, 1.5, 0.25, 0.325), units=("micrometer",) * 3):
    group = zarr.open_group(path, mode="w", zarr_format=2 if version == "0.4" else 3)
    chunks = (1,) * (values.ndim - 2) + (16, 16)
    group.create_array("0", shape=values.shape, dtype=values.dtype, chunks=chunks)[:] = values
    told = [{"name": axis} | ({"unit": units["zyx".index(axis)]} if axis in "zyx" else {}) for axis in axes]
    changes = [{"type": "scale", "scale": scale[-len(axes) :]}]
    about = {"multiscales": [{"axes": told, "datasets": [{"path": "0", "coordinateTransformations": changes}]}]}
    group.attrs.update(about if version == "0.4" else {"ome": {"version": version, **about}})
    return group


@pytest.mark.parametrize("version", ["0.4", "0.5"])
@pytest.mark.parametrize("axes", few(["tczyx", "zyx", "czyx"], 1))
def test_ome_zarr(tmp_path, version, axes):
    values = VALUES.astype(np.uint16).reshape((1,) * (len(axes) - 3) + VALUES.shape)
    group = pyramid(tmp_path / "a.zarr", values, version, axes=axes)
    assert check(tmp_path / "a.zarr", VALUES.astype(np.uint16)).grid == GRID
    names = group.create_group("labels")
    names.attrs.update({"labels": ["cells"]} if version == "0.4" else {"ome": {"labels": ["cells"]}})
    pyramid(tmp_path / "a.zarr/labels/cells", values[..., ::-1], version, axes=axes)
    check(tmp_path / "a.zarr/labels/cells", VALUES[..., ::-1].astype(np.uint16))
    assert "has label images" in open_volume(tmp_path / "a.zarr").note


@pytest.mark.parametrize(
    ("units", "expected"),
    [
        (("nanometer", "micrometer", "micrometer"), "0.325 x 0.25 x 0.0015 µm"),
        ((None, None, None), "0.325 x 0.25 x 1.5"),
        ((None, "micrometer", "micrometer"), None),
        (("parsec", "micrometer", "micrometer"), None),
    ],
)
def test_units_of_ome_zarr(tmp_path, units, expected):
    pyramid(tmp_path / "a.zarr", VALUES, axes="zyx", units=units)
    grid = open_volume(tmp_path / "a.zarr").grid
    assert (None if grid is None else grid.size_text()) == expected


@pytest.mark.parametrize(
    ("axes", "shape", "words"),
    [
        ("czyx", (2, 3, 4, 5), "has 2 steps along the axis c: a volume has z, y and x"),
        ("tczyx", (3, 1, 3, 4, 5), "has 3 steps along the axis t"),
        ("xyz", (3, 4, 5), "has the axes x, y, z: a volume has z, y and x for the last ones"),
        ("cyx", (3, 4, 5), "has the axes c, y, x"),
        ("yx", (4, 5), r"has 2 axes, shape \(4, 5\): a volume has three"),
    ],
)
def test_axes_that_are_no_volume(tmp_path, axes, shape, words):
    pyramid(tmp_path / "a.zarr", np.zeros(shape, np.uint8), axes=axes)
    refused(InputError, f"a.zarr {words}", open_volume, tmp_path / "a.zarr")


def test_stores_that_are_damaged(tmp_path):
    vorotool.write(vorotool.Volume(VALUES.astype(np.uint16)), tmp_path / "a.zarr")
    chunk = tmp_path / "a.zarr/c/0/0/0"
    chunk.write_bytes(chunk.read_bytes()[:-5])
    refused(InputError, r"a\.zarr", read_volume, tmp_path / "a.zarr")
    (tmp_path / "a.zarr/zarr.json").write_text("{")
    refused(InputError, r"a\.zarr", open_volume, tmp_path / "a.zarr")
    (tmp_path / "b.zarr").mkdir()
    refused(InputError, r"b\.zarr", open_volume, tmp_path / "b.zarr")
    refused(InputError, "is a directory", open_volume, tmp_path)


def test_chunks():
    for shape in ((512, 512, 512), (1024, 4096, 4096), (5, 30000, 40000), (100000, 3, 2), (1, 1, 1)):
        for dtype in (np.uint8, np.uint16, np.uint32, np.uint64):
            chunks, size = chunks_of(shape, dtype), np.dtype(dtype).itemsize
            assert np.prod(chunks) * size <= 2**22
            assert chunks[0] == 1 or chunks[0] * shape[1] * shape[2] * size <= 2**28
            assert all(1 <= chunk <= side for chunk, side in zip(chunks, shape, strict=True))
    assert chunks_of((9, 9, 9), np.uint8, (4, 5, 10)) == (4, 5, 9)


@pytest.mark.parametrize("threads", [1, 3])
def test_stores_do_not_depend_on_slabs(tmp_path, threads):
    values = VALUES.astype(np.uint32)
    written = []
    for name, step in (("a", 4), ("b", 8), ("c", 12)):
        array = create_array(tmp_path / name, values.shape, dtype=np.uint32, chunks=(4, 16, 16))
        for first in range(0, 11, step):
            write_chunks(array, first, values[first : first + step], threads=threads)
        files = sorted(path for path in (tmp_path / name).rglob("*") if path.is_file())
        written.append([(str(path.relative_to(tmp_path / name)), path.read_bytes()) for path in files])
        np.testing.assert_array_equal(zarr.open(tmp_path / name)[:], values)
    assert written[0] == written[1] == written[2]
    refused(ValueError, "are not those of chunks of 4", write_chunks, array, 0, values[:3])


def write_copies(path, values, levels, grid=None):
    """Write an array with coarser copies of it."""
    with open_store(path) as store:
        folder = array_folder(store, path, values.ndim, grid=grid, is_labels=True)
        chunks = chunks_of(values.shape, values.dtype)
        write_chunks(create_array(folder, values.shape, dtype=values.dtype, chunks=chunks), 0, values)
        add_levels(store, levels)


def test_coarser_copies(tmp_path):
    values = VALUES.astype(np.uint16)
    path = tmp_path / "a.ome.zarr"
    for _ in range(2):  # what is written here may be replaced
        write_copies(path, values, 4, GRID)
    image = zarr.open_group(path).attrs["ome"]["multiscales"][0]
    for level, dataset in enumerate(image["datasets"]):
        step = 2**level
        np.testing.assert_array_equal(zarr.open(path / dataset["path"])[:], values[::step, ::step, ::step])
        assert dataset["coordinateTransformations"][0]["scale"] == [1.5 * step, 0.25 * step, 0.325 * step]
    assert [axis["name"] for axis in image["axes"]] == ["z", "y", "x"]
    assert len(image["datasets"]) == 5
    source = check(path, values)
    assert source.grid == GRID
    (path / "notes.txt").write_text("of somebody")
    refused(OutputError, "is not replaced", check_store, path)
    assert usual_levels((11, 40, 33)) == 0
    flat = values[:1, :1]
    write_copies(tmp_path / "flat.ome.zarr", flat, 2)
    last = zarr.open_group(tmp_path / "flat.ome.zarr").attrs["ome"]["multiscales"][0]["datasets"][2]
    assert last["coordinateTransformations"][0]["scale"] == [1.0, 1.0, 4.0]
    np.testing.assert_array_equal(zarr.open(tmp_path / "flat.ome.zarr/2")[:], flat[:, :, ::4])


def test_the_library_writes_and_reads_labels(tmp_path):
    labels = vorotool.LabelVolume(VALUES.astype(np.uint16), grid=GRID)
    for name in ("a.tif", "a.npy", "a.zarr", "a.ome.zarr"):
        vorotool.write(labels, tmp_path / name)
        read = vorotool.read(tmp_path / name, geometry="volume")
        np.testing.assert_array_equal(read.values, VALUES)
        assert (read.grid is not None) == (name in ("a.tif", "a.ome.zarr"))
    assert zarr.open_group(tmp_path / "a.ome.zarr").attrs["ome"]["image-label"] == {}
    for name in ("a.npy", "a.zarr", "a.ome.zarr"):
        refused(InputError, 'geometry="volume"', vorotool.read, tmp_path / name)
