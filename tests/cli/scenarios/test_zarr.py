"""Zarr stores: the pixels and the bytes that every band height, chunk, thread and machine gives."""

import json
import signal

import numpy as np
import pytest
import tifffile
import zarr

from support.processes.leftovers import contents, wait_until
from support.processes.peak_memory import peak_memory
from vorotool.engines.tessellation.tessellate import tessellate
from vorotool.engines.tessellation.tessellator import Tessellator

SHAPE = (60, 80)


@pytest.fixture
def seeds(tmp_path):
    xy = np.random.default_rng(5).integers(-10, 90, (60, 2))
    np.savetxt(tmp_path / "seeds.csv", xy, fmt="%d", delimiter=",", header="x,y", comments="")
    return xy


def pixels(folder):
    return zarr.open_array(folder, mode="r")[:]


def make(run, name, *options):
    done = run(f"tessellate seeds.csv --size 80x60 -q -o {name}", *options)
    assert (done.out, done.err) == ("", "")


@pytest.mark.parametrize("what", ["labels", "distance", "distance2"])
def test_pixels_are_those_of_every_format(run, tmp_path, seeds, what):
    make(run, "a.tif", "--what", what)
    expected = tifffile.imread(tmp_path / "a.tif")
    for chunk in ("80x60", "32x32", "33x7", "9999x1"):
        make(run, f"{chunk}.zarr", "--what", what, "--chunk", chunk)
        np.testing.assert_array_equal(pixels(tmp_path / f"{chunk}.zarr"), expected)
    if what == "labels":
        np.testing.assert_array_equal(expected, tessellate(seeds, shape=SHAPE).labels)


def test_bytes_depend_on_chunks_alone(run, tmp_path, seeds, monkeypatch):
    options = ("--chunk", "64x32", "--max-distance", "9", "--dtype", "int32")
    make(run, "a.zarr", *options, "--threads", "1")
    make(run, "b.zarr", *options, "--threads", "3")
    monkeypatch.setenv("VOROTOOL_SIMD", "portable")
    make(run, "b.zarr", *options)  # replaces it
    assert contents(tmp_path / "a.zarr") == contents(tmp_path / "b.zarr")
    assert pixels(tmp_path / "a.zarr").dtype == np.int32


def test_many_inputs_give_many_stores(run, tmp_path, seeds):
    (tmp_path / "in").mkdir()
    for name in "ab":
        (tmp_path / f"in/{name}.csv").write_bytes((tmp_path / "seeds.csv").read_bytes())
    options = ("tessellate", "in", "--size", "80x60", "--out-dir", "out", "-f", "zarr", "-q")
    run(*options)
    assert contents(tmp_path / "out/a.zarr") == contents(tmp_path / "out/b.zarr")
    (tmp_path / "out/b.zarr/zarr.json").write_text("{}")
    assert run(*options, "--resume", "--dry-run").out.count("kept") == 1


def test_limits_are_known_before(run, tmp_path, seeds, monkeypatch):
    run("tessellate seeds.csv --size 80x60 -o a.zarr --max-pixels 1000", code=5, says="--max-pixels 1000")
    make(run, "a.zarr", "--chunk", "50x2", "--max-pixels", "1000")
    monkeypatch.setattr("vorotool.formats.io.descriptors._free_on_disk", lambda folder: 1000)
    for name in ("b.zarr", "b.npy", "b.tif", "b.txt"):
        run(f"tessellate seeds.csv --size 400x300 -o {name}", code=4, says=f"{name} takes about")
        assert not (tmp_path / name).exists()
    make(run, "b.zarr", "--size", "400x300", "--max-distance", "0")  # compressed there is room


@pytest.mark.slow
def test_memory_is_that_of_a_row_of_chunks(tmp_path):
    """Of 0.5 GB of labels, in a process of its own; windows are those of the engine in memory."""
    xy = np.random.default_rng(2).integers(0, 16384, (20_000, 2))
    np.save(tmp_path / "seeds.npy", xy)
    arguments = ["tessellate", "seeds.npy", "--size", "16384x16384", "-o", "a.zarr", "-q"]
    assert peak_memory(arguments, tmp_path) < 300e6
    labels = zarr.open_array(tmp_path / "a.zarr", mode="r")
    for x, y in ((0, 0), (16384 - 200, 16384 - 150), (2000, 450), (8150, 8170)):
        found = labels[y : y + 150, x : x + 200]
        np.testing.assert_array_equal(found, tessellate(xy, window=(x, y, 200, 150)).labels)


def test_an_interrupt_leaves_nothing(process, tmp_path, seeds):
    child = process("tessellate", "seeds.csv", "--size", "20000x400000", "-o", "a.zarr", "--chunk", "2048x64", "-q")
    wait_until(lambda: len(list(tmp_path.glob(".vorotool-*.tmp/c/*"))) >= 3, child)
    child.send_signal(signal.SIGTERM)
    out, err = child.communicate(timeout=600)
    assert (child.returncode, out, err) == (143, b"", b"")
    assert [path.name for path in tmp_path.iterdir()] == ["seeds.csv"]


def test_a_failure_leaves_the_older_store(run, tmp_path, seeds, monkeypatch):
    make(run, "a.zarr")
    before = contents(tmp_path / "a.zarr")
    rows = Tessellator.labels

    def fail(self, first=0, *arguments, **options):
        if first > 20:
            raise OSError(28, "No space left on device")
        return rows(self, first, *arguments, **options)

    monkeypatch.setattr(Tessellator, "labels", fail)
    run("tessellate seeds.csv --size 80x60 -o a.zarr --chunk 16x16", code=4, says="a.zarr")
    assert contents(tmp_path / "a.zarr") == before
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.zarr", "seeds.csv"]


# ---- images as seeds -------------------------------------------------------------------------------------------


@pytest.fixture
def tiles(tmp_path, monkeypatch):
    """A mask in tiles, of which some rows are read and fewer are labelled at a time."""
    monkeypatch.setattr("vorotool.jobs.tessellation.LARGE", 1000)
    monkeypatch.setattr("vorotool.engines.tessellation.streamed_image.BAND_PIXELS", 37 * 200)
    monkeypatch.setattr("vorotool.engines.tessellation.streamed_image.SWEEP_PIXELS", 16 * 200)
    mask = (np.random.default_rng(3).random((150, 200)) < 0.02).astype(np.uint8)
    zarr.create_array(tmp_path / "seeds.zarr", data=mask, chunks=(64, 64))
    tifffile.imwrite(tmp_path / "seeds.tif", mask, tile=(32, 32))
    np.save(tmp_path / "seeds.npy", mask)  # which is held
    return mask


@pytest.mark.parametrize(
    ("source", "options"),
    [("seeds.zarr", ()), ("seeds.tif", ("--seeds", "pixels")), ("seeds.tif", ("--what", "distance2"))],
)
def test_tiles_give_what_an_image_gives(run, tmp_path, tiles, source, options):
    run("tessellate seeds.npy", *options, "-o", "held.tif", "-q")
    expected = tifffile.imread(tmp_path / "held.tif")
    for name in ("a.zarr", "b.tif", "c.npy"):
        assert run(f"tessellate {source}", *options, "-o", name, "-q", "--stats", "s.json").err == ""
    assert json.loads((tmp_path / "s.json").read_text())["seeds"] == tiles.sum()
    np.testing.assert_array_equal(pixels(tmp_path / "a.zarr"), expected)
    assert (tmp_path / "b.tif").read_bytes() == (tmp_path / "held.tif").read_bytes()
    np.testing.assert_array_equal(np.load(tmp_path / "c.npy"), expected)


def test_bad_tiles_are_bad_input(run, tmp_path, tiles):
    chunk = tmp_path / "seeds.zarr/c/1/1"
    chunk.write_bytes(chunk.read_bytes()[:9])
    run("tessellate seeds.tif -o a.svg", code=2, says="too large for a picture")
    for options, code, words in (
        (("-o", "a.zarr"), 3, "seeds.zarr cannot be read as Zarr"),
        (("-o", "seeds.zarr"), 2, "also an input"),
        (("-o", "a.zarr", "--size", "9x9"), 2, "--size applies to lists of points"),
        (("-o", "a.zarr", "--page", "2"), 3, "--page 2"),
    ):
        run("tessellate seeds.zarr", *options, code=code, says=words)
    assert not (tmp_path / "a.zarr").exists()
