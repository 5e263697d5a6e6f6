"""TIFF stacks: what tifffile writes is read, what is written tifffile reads, and damage is refused by name."""

import io
import json
import pickle
from contextlib import contextmanager, suppress
from fractions import Fraction

import numpy as np
import pytest
import tifffile

import vorotool
from support.families.tiff_files import grey, tiff_file
from support.few import few
from support.readers.written import bytes_of
from support.refusals import refused
from vorotool.errors import InputError, LimitError, UsageError
from vorotool.formats.images import tiff_writer as writer
from vorotool.formats.images.tiff_writer import write_volume
from vorotool.formats.volumes.opening import open_volume, read_volume
from vorotool.formats.volumes.tiff_stack import ome_stack
from vorotool.jobs.description import describe_inputs
from vorotool.jobs.options import Options
from vorotool.types.volumes.volume import VoxelGrid

VALUES = np.random.default_rng(3).integers(0, 200, (5, 40, 30))
SIDES = (Fraction(13, 40), Fraction(1, 4), Fraction(3, 2))


def stack(path, values, **options):
    tifffile.imwrite(path, values, photometric="minisblack", **options)
    return path


def check(path, expected):
    source = pickle.loads(pickle.dumps(open_volume(path)))
    assert (source.shape, source.dtype) == (expected.shape, expected.dtype)
    for first, count in ((0, len(expected)), (len(expected) // 2, (len(expected) + 1) // 2), (len(expected) - 1, 1)):
        np.testing.assert_array_equal(source.slices(first, count), expected[first : first + count])
        assert source.slices(first, count).dtype == expected.dtype
    return source


@pytest.mark.parametrize("dtype", few([bool, ">u2", np.float32, np.uint8, np.int16, np.float64, np.uint64], 3))
@pytest.mark.parametrize(
    "layout",
    [
        *({}, {"bigtiff": True, "rowsperstrip": 7}, {"tile": (16, 16)}),
        *({"compression": "zlib"}, {"compression": "zlib", "predictor": True}),
    ],
)
def test_stacks_of_tifffile(tmp_path, dtype, layout):
    values = VALUES > 100 if dtype is bool else VALUES.astype(dtype)
    if layout.get("predictor") and (values.dtype.kind in "bf" or values.dtype.itemsize > 4):
        layout = {"compression": "zlib"}
    stack(tmp_path / "a.tif", values, byteorder=">" if dtype == ">u2" else "<", **layout)
    expected = values.astype(np.uint8) if dtype is bool else values.astype(values.dtype.newbyteorder("="))
    source = check(tmp_path / "a.tif", expected)
    assert source.grid is None
    np.testing.assert_array_equal(vorotool.read(tmp_path / "a.tif", geometry="volume").values, expected)


def test_what_imagej_says(tmp_path):
    said = {"axes": "ZYX", "spacing": 1.5, "unit": "um"}
    options = {"imagej": True, "resolution": (1 / 0.325, 4.0)}
    stack(tmp_path / "a.tif", VALUES.astype(np.uint16), metadata=said, **options)
    assert open_volume(tmp_path / "a.tif").grid.size_text() == "0.325 x 0.25 x 1.5 µm"
    stack(tmp_path / "a.tif", VALUES.astype(np.uint16), metadata=said, truncate=True, **options)  # one page for all
    check(tmp_path / "a.tif", VALUES.astype(np.uint16))
    data = (tmp_path / "a.tif").read_bytes()
    (tmp_path / "a.tif").write_bytes(data[:-1])
    refused(InputError, r"a.tif", read_volume, tmp_path / "a.tif")
    stack(tmp_path / "a.tif", VALUES.astype(np.uint8), imagej=True, metadata={"axes": "ZYX", "spacing": 3})
    assert open_volume(tmp_path / "a.tif").grid == VoxelGrid(Fraction(1), Fraction(1), Fraction(3), None, "imagej")
    stack(tmp_path / "a.tif", VALUES.astype(np.uint8), imagej=True, metadata={"axes": "ZYX"})
    assert open_volume(tmp_path / "a.tif").grid is None


@pytest.mark.parametrize(
    ("said", "expected"),
    [
        ({"PhysicalSizeX": 0.325, "PhysicalSizeY": 0.25, "PhysicalSizeZ": 1.5}, "0.325 x 0.25 x 1.5 µm"),
        ({"PhysicalSizeX": 3, "PhysicalSizeXUnit": "nm", "PhysicalSizeY": 1, "PhysicalSizeZ": 2}, "3 x 1000 x 2000 nm"),
        ({"PhysicalSizeX": 2, "PhysicalSizeY": 2}, None),
        ({"PhysicalSizeX": 2, "PhysicalSizeY": 2, "PhysicalSizeZ": 1, "PhysicalSizeZUnit": "reference frame"}, None),
        ({}, None),
    ],
)
def test_what_ome_says(tmp_path, said, expected):
    stack(tmp_path / "a.ome.tif", VALUES.astype(np.uint16), ome=True, metadata={"axes": "ZYX", **said})
    source = check(tmp_path / "a.ome.tif", VALUES.astype(np.uint16))
    assert (None if source.grid is None else source.grid.size_text()) == expected
    assert ("no PhysicalSizeZ" in source.note) == (set(said) == {"PhysicalSizeX", "PhysicalSizeY"})


def ome(pixels, planes):
    return f'<?xml version="1.0"?><OME><Image><Pixels {pixels}>{planes}</Pixels></Image></OME>'.encode()


def test_planes_that_are_stated_again_and_again():
    """The time is that of their number and of the slices: 2^14 of each would take minutes."""
    once = '<TiffData FirstZ="0" IFD="0" PlaneCount="16384"/>'
    stack = ome_stack(f'<OME><Image><Pixels SizeZ="16384">{once * 2}</Pixels></Image></OME>')
    assert stack.pages("a.tif", 2**14) == tuple(range(2**14))
    stack = ome_stack(f'<OME><Image><Pixels SizeZ="16384">{once * 2**14}</Pixels></Image></OME>')
    refused(InputError, r"a\.tif.* 16384 TiffData", stack.pages, "a.tif", 2**14)


@pytest.mark.parametrize(
    ("description", "words"),
    [
        (ome('SizeZ="5" SizeC="2"', ""), r"has 2 channels: a volume has one of each.*page=N"),
        (ome('SizeZ="5" SizeC="2" SizeT="3"', ""), "has 2 channels and 3 time steps"),
        (ome('SizeZ="6"', ""), "has 5 pages, but its XML states 6 slices"),
        (ome('SizeZ="5"', '<TiffData IFD="0" FirstZ="1"/>'), "slice 0"),
        (ome('SizeZ="5"', '<TiffData IFD="7"/>'), "slice 0"),
        (ome('SizeZ="five"', ""), "'five'"),
        (ome('SizeZ="0"', ""), "SizeZ"),
        (ome(f'SizeZ="{"9" * 50}"', ""), "not an integer"),
        (ome('SizeZ="5"', "".join(f'<TiffData><UUID FileName="{name}"/></TiffData>' for name in "ab")), "2 files"),
        (b"<OME><Image><Pixels/></Image><Image><Pixels/></Image></OME>", "holds 2 images"),
        (b"ImageJ=1.54f\nimages=10\nchannels=2\nslices=5\n", "has 2 channels"),
        (b"ImageJ=1.54f\nimages=5\nframes=5\n", r"has 5 time steps \(frames\)"),
        (b"ImageJ=1.54f\nimages=7\nslices=7\n", "has 5 pages, but its description states 7 slices"),
        (b"ImageJ=1.54f\nimages=-7\n", "images=-7"),
        (b"ImageJ=1.54f\nimages=x\n", "images="),
    ],
)
def test_what_is_no_stack_of_slices(tmp_path, description, words):
    about = {"description": description, "metadata": None}
    refused(InputError, [words, "a.tif"], open_volume, stack(tmp_path / "a.tif", VALUES.astype(np.uint8), **about))


def test_axes_that_tifffile_names(tmp_path):
    values = VALUES.astype(np.uint8).reshape(5, 1, 40, 30)
    check(stack(tmp_path / "a.tif", values), VALUES.astype(np.uint8))
    stack(tmp_path / "a.tif", values.reshape(5, 2, 20, 30))
    refused(InputError, r"\(5, 2, 20", open_volume, tmp_path / "a.tif")
    stack(tmp_path / "a.tif", values, metadata={"axes": "TZYX"})
    refused(InputError, "has 5 time steps", open_volume, tmp_path / "a.tif")


def test_smaller_copies_are_left_out(tmp_path):
    with tifffile.TiffWriter(tmp_path / "a.tif") as out:
        for image in VALUES.astype(np.uint8):
            out.write(image, metadata=None)
        out.write(VALUES[0, ::2, ::2].astype(np.uint8), metadata=None, subfiletype=1)
    check(tmp_path / "a.tif", VALUES.astype(np.uint8))


def test_damage(tmp_path):
    path = tmp_path / "a.tif"
    whole = stack(path, VALUES.astype(np.uint16), compression="zlib").read_bytes()
    for length in [*range(0, 600, 37), *range(600, len(whole), len(whole) // 23)]:
        path.write_bytes(whole[:length])
        refused(InputError, r"a\.tif", read_volume, path)
    generator = np.random.default_rng(5)
    for _ in range(120):  # anything but another exception
        torn = bytearray(whole)
        for place in generator.integers(0, len(whole), 6):
            torn[place] = generator.integers(0, 256)
        path.write_bytes(torn)
        with suppress(LimitError), naming("a.tif"):
            read_volume(path, max_voxels=10**6)


@contextmanager
def naming(name):
    """An input is refused with its name, or read."""
    try:
        yield
    except InputError as error:
        if name not in str(error):
            raise AssertionError(name) from error


def test_limits(tmp_path):
    path = stack(tmp_path / "a.tif", VALUES.astype(np.uint8))
    refused(LimitError, r"max_pixels=5999", vorotool.read, path, geometry="volume", max_pixels=5999)
    huge = {256: (4, [2**31 - 1]), 257: (4, [2**31 - 1]), 278: (4, [2**31 - 1])}
    (tmp_path / "b.tif").write_bytes(tiff_file(grey(8, 8, 8) | huge, [bytes(64)]))
    refused(InputError, r"b.tif", read_volume, tmp_path / "b.tif")
    refused(UsageError, "page does not apply to a volume", vorotool.read, path, geometry="volume", page=1)


def made(values, slabs=1, **options):
    parts = np.array_split(values, slabs)
    return bytes_of(write_volume, parts, shape=values.shape, dtype=values.dtype, fmt="tiff", **options)


@pytest.mark.parametrize("dtype", few([np.uint8, np.float32, np.uint16, np.uint32, np.int32, np.uint64], 2))
@pytest.mark.parametrize("form", [None, "imagej", "ome", "zarr", "tiff"])
def test_what_is_written_tifffile_reads(tmp_path, dtype, form):
    values = VALUES.astype(dtype)
    grid = None if form is None else VoxelGrid(*SIDES, "um", form)
    data = made(values, grid=grid, threads=1)
    assert data == made(values, 3, grid=grid, threads=2) == made(values, 5, grid=grid)
    path = tmp_path / "a.tif"
    path.write_bytes(data)
    source = check(path, values)
    with tifffile.TiffFile(path) as file:
        series = file.series[0]
        np.testing.assert_array_equal(series.asarray(), values)
        in_imagej = form in (None, "imagej") and dtype in (np.uint8, np.uint16, np.float32)
        is_plain = form == "tiff" or dtype == np.uint64
        assert series.kind == ("generic" if is_plain else "imagej" if in_imagej else "ome")
        assert is_plain or series.axes == "ZYX"
        if in_imagej and form:
            assert (file.imagej_metadata["spacing"], file.imagej_metadata["unit"]) == (1.5, "um")
            assert file.pages[0].tags["XResolution"].value == (40, 13)
        if series.kind == "ome" and form:
            assert 'PhysicalSizeZ="1.5" PhysicalSizeZUnit="µm"' in file.ome_metadata.replace("&#181;", "µ")
    if form and not is_plain:
        assert source.grid == VoxelGrid(*SIDES, "um", "imagej" if in_imagej else "ome")


@pytest.mark.parametrize("form", ["imagej", "ome"])
def test_sides_without_a_unit(tmp_path, form):
    grid = VoxelGrid(Fraction(1), Fraction(2), Fraction(7, 2), None, form)
    vorotool.write(vorotool.LabelVolume(VALUES.astype(np.uint8), grid=grid), tmp_path / "a.tif")
    assert vorotool.read(tmp_path / "a.tif", geometry="volume").grid == grid


def test_large_stacks_are_bigtiff_and_ome(monkeypatch):
    monkeypatch.setattr(writer, "CLASSIC_LIMIT", 1000)
    data = made(VALUES.astype(np.uint8))
    with tifffile.TiffFile(io.BytesIO(data)) as file:
        assert (file.is_bigtiff, file.series[0].kind, file.series[0].axes) == (True, "ome", "ZYX")
        np.testing.assert_array_equal(file.asarray(), VALUES)


def test_edges_of_shapes(tmp_path):
    for shape in ((1, 3, 2), (2, 3, 1), (1, 1, 1), (3, 1, 1)):
        values = np.arange(np.prod(shape), dtype=np.uint16).reshape(shape)
        for name in ("a.tif", "a.npy"):
            vorotool.write(vorotool.Volume(values), tmp_path / name)
            np.testing.assert_array_equal(vorotool.read(tmp_path / name, geometry="volume").values, values)
    with pytest.raises(ValueError, match="have 1 rows, not 2"):
        write_volume(io.BytesIO(), [np.zeros((1, 2, 2), np.uint8)], shape=(2, 2, 2), dtype=np.uint8, fmt="npy")
    wide = np.full((1, 2, 2), 300)
    refused(LimitError, "does not fit", write_volume, io.BytesIO(), [wide], shape=(1, 2, 2), dtype=np.uint8, fmt="tiff")
    refused(UsageError, "'png'", vorotool.write, vorotool.Volume(values), tmp_path / "a.png")
    with pytest.raises(UsageError, match="width does not apply to volumes"):
        vorotool.write(vorotool.Volume(values), tmp_path / "a.tif", width=9)


def test_what_info_tells(tmp_path, capsysbinary):
    grid = VoxelGrid(*SIDES, "um")
    vorotool.write(vorotool.Volume(VALUES.astype(np.uint16), grid), tmp_path / "a.tif")
    describe_inputs(Options("info", inputs=(str(tmp_path / "a.tif"),), json=True))
    told = json.loads(capsysbinary.readouterr().out)
    assert (told["kind"], told["voxel_size"], told["unit"]) == ("volume", [0.325, 0.25, 1.5], "µm")
    assert [told[name] for name in ("slices", "width", "height")] == [5, 30, 40]
