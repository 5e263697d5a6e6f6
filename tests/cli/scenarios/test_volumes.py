"""Volumes on the command line: what the library makes of them, whatever the format, slabs, chunks and threads."""

import json
import signal

import numpy as np
import pytest
import tifffile
import zarr
from scipy import ndimage

import vorotool
from support.processes.leftovers import contents, wait_until
from support.processes.peak_memory import peak_memory
from support.readers.written import rows_of
from vorotool.engines.tessellation import frames as volume_frames
from vorotool.engines.tessellation.tessellator import Tessellator

MASK = np.zeros((7, 9, 11), np.uint8)
MASK[1:4, 1:5, 1:4] = MASK[4:6, 5:9, 6:11] = MASK[0, 0, 9] = 255
SPACING = (1.5, 0.325, 0.325)
"""Along z, y and x."""

ABOUT = {"spacing": SPACING[0], "unit": "um", "axes": "ZYX"}
PLACES = np.array([[1, 2, 0], [8, 3, 4], [5, 7, 6], [8, 3, 4], [2.5, 0, 3.5]])


@pytest.fixture
def stack(tmp_path):
    """A stack as ImageJ writes it, and the same as NPY."""
    steps = (1 / SPACING[2], 1 / SPACING[1])
    tifffile.imwrite(tmp_path / "stack.tif", MASK, imagej=True, resolution=steps, metadata=ABOUT)
    np.save(tmp_path / "stack.npy", MASK)
    return tmp_path


@pytest.fixture
def points(tmp_path):
    lines = [",".join(map(str, place)) for place in PLACES.tolist()]
    (tmp_path / "points.csv").write_text("\n".join(["x,y,z", *lines, ""]))
    return tmp_path


def written(path):
    if path.suffix == ".npy":
        return np.load(path)
    if path.suffix == ".zarr":
        found = zarr.open(path, mode="r")
        return (found["0"] if isinstance(found, zarr.Group) else found)[...]
    return tifffile.imread(path)


# ---- what is written is what the library gives ---------------------------------------------------
@pytest.mark.parametrize(
    ("what", "spacing"), [("labels", None), ("distance", SPACING), ("distance2", None), ("diagram", SPACING)]
)
def test_every_volume_that_is_written(run, stack, what, spacing):
    given = [] if spacing is None else ["--spacing", "auto"]
    result = vorotool.tessellate(MASK != 0, spacing=spacing)
    mask, sides = MASK != 0, [1, 1, 1] if spacing is None else [60, 13, 13]
    places = np.argwhere(mask)
    voxels = np.indices(MASK.shape).reshape(3, -1).T
    squares = (((voxels[:, None] - places) * sides) ** 2).sum(axis=-1).min(axis=1).reshape(MASK.shape)
    expected = {
        "labels": result.labels,
        "distance": (np.sqrt(squares) * (1 if spacing is None else 1 / 40)).astype(np.float32),
        "distance2": squares,
        "diagram": vorotool.voronoi_diagram(result),
    }[what]
    for name in ("out.tif", "out.npy", "out.zarr", "out.ome.zarr"):
        source = "stack.npy" if (name, spacing) == ("out.npy", None) else "stack.tif"
        assert run(f"tessellate --volume {source} --what {what} -o {name} -q", *given).err == ""
        found = written(stack / name)
        np.testing.assert_allclose(found, expected, rtol=1e-7 if what == "distance" else 0)


def test_points_of_space(run, points):
    with pytest.warns(vorotool.VorotoolWarning, match="on another seed"):
        expected = vorotool.tessellate(PLACES, shape=(7, 8, 9), spacing=(2, 1, 1))
    run("tessellate points.csv --size 9x8x7 --spacing 1,1,2 -o out.npy", says="warning")
    np.testing.assert_array_equal(np.load(points / "out.npy"), expected.labels)
    run("tessellate points.csv --window -2,-1,-3,12,11,13 -o window.npy -q")
    run("tessellate points.csv --volume -o usual.npy -q")
    window = np.load(points / "window.npy")
    usual = np.load(points / "usual.npy")
    assert usual.shape == (7, 8, 9)
    np.testing.assert_array_equal(window[3:10, 1:9, 2:11], usual)


def test_columns_are_chosen(run, points):
    (points / "named.csv").write_text("height;east;north;name\n0;1;2;a\n4;8;3;b\n")
    np.save(points / "array.npy", PLACES)
    run("tessellate points.csv --size 9x8x7 -o a.npy -q")
    run("tessellate array.npy --columns 1,2,z=3 --size 9x8x7 -o b.npy -q")
    np.testing.assert_array_equal(np.load(points / "a.npy"), np.load(points / "b.npy"))
    done = run("tessellate named.csv --columns east,north,z=height --what table -q")
    assert ["".join(row[name] for name in ("x", "y", "z", "name")) for row in done.rows] == ["120a", "834b"]


def test_labels_stay_and_values_are_cut(run, tmp_path):
    values = MASK.astype(np.uint16)
    values[MASK > 0] = 7
    values[0, 0, 9] = 300
    np.save(tmp_path / "labels.npy", values)
    run("tessellate --volume labels.npy -o out.npy -q")
    np.testing.assert_array_equal(np.load(tmp_path / "out.npy"), vorotool.tessellate(values).labels)
    run("tessellate --volume labels.npy --threshold 7 --stats s.json -o cut.npy -q")
    assert (np.load(tmp_path / "cut.npy") == 1).all()
    assert json.loads((tmp_path / "s.json").read_text())["threshold"] == 7
    run("tessellate --volume labels.npy --threshold otsu --stats s.json -o otsu.npy -q")
    assert json.loads((tmp_path / "s.json").read_text())["threshold"] in (0, 7)


def test_the_largest_distance_leaves_objects_whole(run, stack):
    solid = np.zeros((9, 9, 9), np.uint8)
    solid[1:8, 1:8, 1:8] = 1
    np.save(stack / "solid.npy", solid)
    run("tessellate --volume solid.npy --max-distance 0 -o out.tif -q")
    np.testing.assert_array_equal(tifffile.imread(stack / "out.tif"), solid)
    options = ["--volume", "stack.tif", "--spacing", "auto", "-q"]
    run("tessellate", *options, "--max-distance", "0.7um", "-o", "out.tif")
    expected = vorotool.tessellate(MASK != 0, spacing=SPACING, max_distance=0.7)
    np.testing.assert_array_equal(tifffile.imread(stack / "out.tif"), expected.labels)


# ---- tables --------------------------------------------------------------------------------------
@pytest.mark.parametrize("what", ["table", "neighbors"])
def test_tables_are_those_of_the_library_in_the_unit_of_the_spacing(run, stack, what):
    result = vorotool.tessellate(vorotool.read(stack / "stack.tif", geometry="volume"), spacing=SPACING)
    squares = Tessellator(result.seeds, result.frame, sides=result.sides).squared_distances()
    table = vorotool.region_table(result, distance2=squares) if what == "table" else vorotool.neighbor_table(result)
    rows = run(f"tessellate --volume stack.tif --spacing auto --what {what} -q").rows
    for name in table:
        found = [float(row[name]) if row[name] else np.nan for row in rows]
        np.testing.assert_allclose(found, np.ma.filled(np.ma.asarray(table[name], float), np.nan), err_msg=name)
    assert {row["unit"] for row in rows} == {"um"}


@pytest.mark.parametrize("what", ["table", "neighbors"])
def test_tables_are_streamed(run, points, monkeypatch, what):
    options = ["points.csv", "--size", "40x30x50", "--spacing", "1,1,2.5", "--what", what, "-q"]
    expected = run("tessellate", *options).out
    seen = []

    def counted(method):
        def give(sweep, first=0, slices=None, **rest):
            seen.append(slices)
            return method(sweep, first, slices, **rest)

        return give

    monkeypatch.setattr(Tessellator, "labels", counted(Tessellator.labels))
    monkeypatch.setattr(Tessellator, "squared_distances", counted(Tessellator.squared_distances))
    monkeypatch.setattr(volume_frames, "BAND_PIXELS", 40 * 30 * 3)
    assert run("tessellate", *options, "--max-pixels", "1200").out == expected
    passes = 2 if what == "table" else 1
    assert sorted(seen) == [2] * passes + [3] * 16 * passes
    run("tessellate", *options[:-3], "--what", f"{what},color", "-o", "both", "-q")  # a picture holds the volume
    assert (points / f"both.{what}.csv").read_text(encoding="utf-8") == expected


# ---- files say how large voxels are --------------------------------------------------------------
def test_a_stack_carries_its_spacing_on(run, stack):
    for options in ([], ["--spacing", "auto"]):
        run("tessellate --volume stack.tif -o out.tif -q", *options)
        with tifffile.TiffFile(stack / "out.tif") as file:
            about, tag = file.imagej_metadata, file.pages[0].tags["XResolution"].value
            assert (about["spacing"], about["slices"], tag[0] / tag[1]) == (1.5, 7, pytest.approx(1 / 0.325))
        run("tessellate --volume stack.tif -o out.ome.zarr -q", *options)
        ome = json.loads((stack / "out.ome.zarr/zarr.json").read_text())["attributes"]["ome"]
        (scale,) = ome["multiscales"]
        assert [axis["name"] for axis in scale["axes"]] == ["z", "y", "x"]
        assert scale["datasets"][0]["coordinateTransformations"][0]["scale"] == list(SPACING)


def test_what_the_file_says_is_told(run, stack):
    run("tessellate --volume stack.tif -o out.tif", says="--spacing")
    stats = json.loads(run("tessellate --volume stack.tif --spacing auto -o out.tif --stats -").out)
    assert (stats["spacing"], stats["unit"], stats["unit_of_distance2"]) == ([0.325, 0.325, 1.5], "um", "(1/40 um)²")
    assert (stats["frame"], stats["voxels"], stats["labels"]) == ([0, 0, 0, 11, 9, 7], 693, 3)
    assert stats["arithmetic"].startswith("float64")


def test_coarser_copies(run, tmp_path):
    values = np.random.default_rng(1).integers(0, 4, (3, 300, 290)).astype(np.uint16)
    np.save(tmp_path / "labels.npy", values)
    options = ["tessellate", "--volume", "labels.npy", "--seeds", "labels", "-q", "-o", "out.ome.zarr"]
    run(*options, "--levels", "auto")
    assert sorted(path.name for path in (tmp_path / "out.ome.zarr").iterdir()) == ["0", "1", "zarr.json"]
    run(*options, "--levels", "2")  # replaces it
    whole = vorotool.tessellate(vorotool.seeds_from_volume(values, mode="labels")).labels
    for level in range(3):
        step = 2**level
        found = zarr.open_array(tmp_path / f"out.ome.zarr/{level}", mode="r")[...]
        np.testing.assert_array_equal(found, whole[::step, ::step, ::step])


# ---- slabs, chunks, threads, workers -------------------------------------------------------------
def test_bytes_depend_neither_on_slabs_nor_threads(run, stack, monkeypatch):
    options = ["tessellate", "--volume", "stack.tif", "--spacing", "auto", "-q"]
    chunks = ["--chunk", "4x4x2"]
    for what in ("labels", "diagram", "distance"):
        monkeypatch.undo()
        monkeypatch.chdir(stack)
        run(*options, "--what", what, "-o", "a.tif")
        run(*options, "--what", what, "-o", "a.zarr", *chunks)
        monkeypatch.setattr("vorotool.engines.tessellation.frames.BAND_PIXELS", 2 * 9 * 11)
        monkeypatch.setattr("vorotool.engines.tessellation.frames._VOXELS_A_SEED", 0)
        for threads in ("1", "3"):
            run(*options, "--what", what, "-o", "b.tif", "--threads", threads)
            assert (stack / "b.tif").read_bytes() == (stack / "a.tif").read_bytes()
            run(*options, "--what", what, "-o", "b.zarr", *chunks, "--threads", threads)
            assert contents(stack / "a.zarr") == contents(stack / "b.zarr")


@pytest.mark.slow
@pytest.mark.parametrize("what", ["labels", "diagram", "distance", "distance2"])
def test_a_cluster_writes_the_same_store(run, stack, what):
    options = ["tessellate", "--volume", "stack.tif", "--what", what, "--spacing", "auto", "--chunk", "4x4x2", "-q"]
    options += ["--max-distance", "1.5um"] if what == "labels" else []
    run(*options, "-o", "a.ome.zarr", "--levels", "1")
    assert run(*options, "-o", "b.ome.zarr", "--levels", "1", "--cluster", "local", "-j", "2").err == ""
    made = [contents(stack / name) for name in ("a.ome.zarr", "b.ome.zarr")]
    assert {each.pop("zarr.json") for each in made}
    assert made[0] == made[1]


@pytest.mark.slow
def test_memory_does_not_grow_with_the_depth(tmp_path):
    np.save(tmp_path / "points.npy", np.random.default_rng(3).integers(0, 512, (200, 3)))
    frame = ["points.npy", "--columns", "1,2,z=3", "-q"]
    low, high = (
        peak_memory(["tessellate", *frame, "--size", f"512x512x{depth}", "-o", f"{depth}.zarr"], tmp_path)
        for depth in (128, 512)
    )
    assert high < low + 60e6


def test_an_interrupt_leaves_nothing(process, tmp_path):
    np.save(tmp_path / "points.npy", np.random.default_rng(3).integers(0, 2000, (20000, 3)))
    options = ["--columns", "1,2,z=3", "--size", "2000x2000x2000", "-o", "out.npy"]
    running = process("tessellate", "points.npy", *options)
    wait_until(lambda: list(tmp_path.glob(".vorotool-*")) or running.poll() is not None)
    running.send_signal(signal.SIGINT)
    assert running.communicate(timeout=600) == (b"", b"")
    assert running.returncode == 130
    assert [path.name for path in tmp_path.iterdir()] == ["points.npy"]


# ---- streams and batches -------------------------------------------------------------------------
def test_streams(run, process, stack):
    data = (stack / "stack.tif").read_bytes()
    running = process("tessellate", "--volume", "-", "-f", "tiff", "-o", "-", "-q", stdin=-1)
    out, err = running.communicate(data)
    assert (running.returncode, err) == (0, b"")
    run("tessellate --volume stack.tif -o out.tif -q")
    assert out == (stack / "out.tif").read_bytes()


def test_a_folder_of_stacks(run, tmp_path):
    (tmp_path / "stacks").mkdir()
    for number in range(3):
        tifffile.imwrite(tmp_path / f"stacks/s{number}.tif", np.roll(MASK, number, axis=2), photometric="minisblack")
    tifffile.imwrite(tmp_path / "stacks/rgb.tif", np.zeros((5, 5, 3), np.uint8), photometric="rgb")
    options = ["tessellate", "--volume", "stacks", "--out-dir", "out", "--what", "labels,table", "-q"]
    run(*options, "--keep-going", code=6, says="stacks/rgb.tif")
    names = sorted(path.name for path in (tmp_path / "out").iterdir())
    made = [f"s{number}.{what}" for number in range(3) for what in ("labels.tif", "table.csv")]
    assert names == [*made, "tessellate.manifest.jsonl"]
    np.testing.assert_array_equal(
        tifffile.imread(tmp_path / "out/s1.labels.tif"), vorotool.tessellate(np.roll(MASK, 1, axis=2) != 0).labels
    )
    (tmp_path / "stacks/rgb.tif").unlink()
    plan = [json.loads(line) for line in run(*options, "--resume", "--dry-run").out.splitlines()]
    assert [each["status"] for each in plan] == ["kept"] * 3
    assert run(*options[:-3], "--table", "all.csv", "-j", "2", "-q", "--what", "labels").err == ""
    assert len(rows_of((tmp_path / "all.csv").read_text())) == 11


# ---- pictures ------------------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("fmt", "options"),
    [("png", ["--slice", "2"]), ("svg", ["--layers", "cells,labels"]), ("png", ["--scale-bar", "--legend"])],
)
def test_pictures(run, stack, fmt, options):
    for number in "31":
        line = f"tessellate --volume stack.tif --spacing auto --what color -q -o {number}.{fmt} --threads {number}"
        run(line, *options)
    assert (stack / f"3.{fmt}").read_bytes() == (stack / f"1.{fmt}").read_bytes()


def test_the_page(run, stack):
    run("tessellate --volume stack.tif --spacing auto --what labels -q -o a.html")
    page = (stack / "a.html").read_text(encoding="utf-8")
    assert '"depth":7' in page
    assert '"name":"volume"' in page
    assert '"name":"unit","values":["\\u00b5m","\\u00b5m","\\u00b5m"]' in page


# ---- checks --------------------------------------------------------------------------------------
def test_the_result_is_checked(run, stack, monkeypatch):
    options = ["tessellate", "--volume", "stack.tif", "--spacing", "auto", "-o", "out.tif", "--verify", "-q"]
    run(*options)
    run(*options, "--max-distance", "1um")
    right = Tessellator.labels

    def wrong(self, *given, **more):
        labels = right(self, *given, **more)
        labels[-1, -1, -1] = 1
        return labels

    monkeypatch.setattr(Tessellator, "labels", wrong)
    run(*options, code=1)


def test_nothing_in_a_volume(run, tmp_path):
    np.save(tmp_path / "none.npy", np.zeros((3, 4, 5), np.uint8))
    run("tessellate --volume none.npy -o out.npy", says="no foreground")
    assert not np.load(tmp_path / "out.npy").any()
    run("tessellate --volume none.npy -o out.npy --strict", code=3)
    run("tessellate --volume none.npy --what distance -o out.npy -q", code=3)
    assert run("tessellate --volume none.npy --what table -q").out.count("\n") == 1


@pytest.mark.parametrize("area", ["2", "4.5 um^3"])
def test_volumes_are_cleaned_as_by_scipy(run, tmp_path, area):
    noise = ndimage.gaussian_filter(np.random.default_rng(4).random((14, 40, 42)), 1)
    mask = noise > np.quantile(noise, np.linspace(0.3, 0.9, 42))
    mask[3:10, 8:16, 2:10] = True
    mask[5:7, 10:13, 4:7] = False
    tifffile.imwrite(tmp_path / "mask.tif", mask.astype(np.uint8) * 255)
    numbers, _ = ndimage.label(~mask)
    holes = ndimage.binary_fill_holes(mask) & ~mask & (np.bincount(numbers.ravel())[numbers] <= 2)
    clean, _ = ndimage.label(mask | holes, np.ones((3, 3, 3)))
    areas = np.bincount(clean.ravel())
    assert 0 < holes.sum() < (ndimage.binary_fill_holes(mask) & ~mask).sum()
    assert (areas[1:] < 40).any()
    tifffile.imwrite(tmp_path / "clean.tif", ((clean > 0) & (areas[clean] >= 40)).astype(np.uint8) * 255)
    spacing = ["--spacing", "1,1,2um", "-q"]
    for what in ("labels", "distance"):
        options = [*spacing, "--what", what, "-o", "made.npy", "--fill-holes", area, "--min-area", "40", "--verify"]
        run("tessellate --volume mask.tif", *options, "--stats", "s.json")
        run("tessellate --volume clean.tif", *spacing, "--what", what, "-o", "clean.npy")
        assert (tmp_path / "made.npy").read_bytes() == (tmp_path / "clean.npy").read_bytes()
        stats = json.loads((tmp_path / "s.json").read_text())
        assert (stats["filled_voxels"], stats["small_objects"]) == (holes.sum(), (areas[1:] < 40).sum())
