"""``--spacing``: distances, lengths and results in the unit of rectangular pixels."""

import json

import numpy as np
import pytest
import tifffile

import vorotool
from vorotool.engines.tessellation.tessellator import Tessellator

X, Y = np.array([2, 9, 4, 15]), np.array([3, 4, 12, 9])
MASK = np.zeros((24, 32), np.uint8)
MASK[3:9, 4:11] = MASK[12:20, 15:30] = 255
FRAME = ["--size", "20x15"]


@pytest.fixture
def dots(tmp_path):
    lines = ["x,y,name", *(f"{x},{y},p{x}" for x, y in zip(X, Y, strict=True))]
    (tmp_path / "dots.csv").write_text("\n".join(lines))
    return tmp_path


def tessellated(spacing, **options):
    return vorotool.tessellate(np.stack([X, Y], axis=1), shape=(15, 20), spacing=spacing, **options)


def test_labels_and_distances(run, dots):
    image = tessellated((0.5, 0.325))
    sweep = Tessellator(image.seeds, image.frame, sides=image.sides)
    for what, right in (
        ("labels", image.labels),
        ("distance", sweep.distances()),
        ("distance2", sweep.squared_distances()),
    ):
        done = run(
            "tessellate", "dots.csv", *FRAME, "--spacing", "0.325,0.5", "--what", what, "-o", "a.npy", "--verify"
        )
        assert done.code == 0
        assert np.array_equal(np.load(dots / "a.npy"), right)
    assert "note: squared distances are in squares of a step of 1/40" in done.err


@pytest.mark.parametrize("limit", ["1.5", "1500nm"])
def test_bare_lengths_are_in_the_unit_of_the_spacing(run, dots, limit):
    args = ["--spacing", "0.325,0.5um", "--max-distance", limit, "-o", "a.npy", "--verify"]
    assert run("tessellate", "dots.csv", *FRAME, *args).code == 0
    assert np.array_equal(np.load(dots / "a.npy"), tessellated((0.5, 0.325), max_distance=1.5).labels)


def test_tables_are_in_the_unit_which_they_name(run, dots):
    rows = run("tessellate", "dots.csv", *FRAME, "--spacing", "0.325,0.5um", "--what", "table").rows
    image = tessellated((0.5, 0.325))
    squares = Tessellator(image.seeds, image.frame, sides=image.sides).squared_distances()
    table = vorotool.region_table(image, distance2=squares)
    assert list(rows[0]) == [*table, "name", "unit"]
    for name in table:
        assert [float(row[name]) for row in rows] == table[name].tolist()
    assert {row["unit"] for row in rows} == {"um"}
    rows = run("tessellate", "dots.csv", *FRAME, "--spacing", "0.325,0.5um", "--what", "neighbors").rows
    borders = vorotool.neighbor_table(image)
    assert [float(row["border_length"]) for row in rows] == borders["border_length"].tolist()
    assert [float(row["centroid_distance"]) for row in rows] == borders["centroid_distance"].tolist()


def test_statistics_name_the_step_and_the_arithmetic(run, dots):
    run("tessellate", "dots.csv", *FRAME, "--spacing", "0.325,0.5um", "-o", "a.npy", "--stats", "s.json")
    stats = json.loads((dots / "s.json").read_text())
    assert (stats["spacing"], stats["unit"]) == ([0.325, 0.5], "um")
    assert (stats["distance2_step"], stats["arithmetic"]) == ("1/40", "float64")
    run("tessellate", "dots.csv", *FRAME, "--spacing", "1,2000001", "-o", "a.npy", "--stats", "s.json")
    assert json.loads((dots / "s.json").read_text())["arithmetic"] == "float64 with int128"


@pytest.mark.parametrize("form", ["0.325um,0.5um", "325nm,0.5um", "0.325, 0.5 um", "3.25e-1,.5um"])
def test_forms(run, dots, form):
    plain = run("tessellate", "dots.csv", *FRAME, "--what", "table", "--spacing", "0.325,0.5um").out
    assert run("tessellate", "dots.csv", *FRAME, "--what", "table", "--spacing", form).out == plain != ""


@pytest.mark.parametrize("side", ["0.5um", "3", "0.3"])
def test_squares_of_a_spacing_have_the_table_of_a_pixel_size(run, dots, side):
    spaced = run("tessellate", "dots.csv", *FRAME, "--what", "table", "--spacing", f"{side},{side}").rows
    sized = run("tessellate", "dots.csv", *FRAME, "--what", "table", "--pixel-size", side).rows
    for one, other in zip(spaced, sized, strict=True):
        for name, text in one.items():
            assert text == other[name] or float(text) == pytest.approx(float(other[name]), rel=1e-15)


MALFORMED = [
    ("0,1", "'0,1'"),
    ("1", "'1'"),
    ("-1,1", "'-1,1'"),
    ("1e-9,1", "expected sides of at most 2097152 times"),
    ("1um,1", "'1um,1'"),
    ("1furlong,1um", "expected one unit for all sides"),
]


@pytest.mark.parametrize(("form", "message"), MALFORMED)
def test_malformed_ones_are_refused(run, dots, form, message):
    done = run("tessellate", "dots.csv", *FRAME, "--spacing", form, "-o", "a.png")
    assert done.code == 2
    assert message in done.err
    assert not (dots / "a.png").exists()


REFUSED = [
    (["--spacing", "1,2,3"], "--spacing"),
    (["--spacing", "1,2", "--pixel-size", "3"], "--pixel-size"),
    (["--spacing", "1,2", "--method", "propagation"], "--spacing"),
    (["--spacing", "auto"], "--spacing"),
    (["--spacing", "1,2", "--max-distance", "3um"], "--max-distance 3um"),
]


@pytest.mark.parametrize(("options", "message"), REFUSED)
def test_what_does_not_go_together_is_refused(run, dots, options, message):
    done = run("tessellate", "dots.csv", *FRAME, *options, "-o", "a.png")
    assert (done.code, message in done.err) == (2, True)


def test_cells_of_a_map_are_squares(run, dots):
    done = run("tessellate", "dots.csv", "--cell-size", "2", "--spacing", "1,2", "-o", "a.png")
    assert (done.code, "--cell-size" in done.err) == (2, True)


def test_too_large_a_range_is_refused_before_work(run, dots):
    done = run(
        "tessellate", "dots.csv", "--size", "4000x2500", "--spacing", "1,1999999", "--what", "distance2", "-o", "a.npy"
    )
    assert (done.code, "squared distances of this frame may exceed 64 bits" in done.err) == (5, True)
    window = "1000000,1000000,5,5"
    done = run("tessellate", "dots.csv", "--window", window, "--spacing", "1,1999999", "-o", "a.npy")
    assert (done.code, "is too far from the frame" in done.err) == (3, True)


# ---- images --------------------------------------------------------------------------------------
def write(path, kind, sides=(0.325, 0.5)):
    x, y = sides
    if kind == "ome":
        sizes = {"PhysicalSizeX": x, "PhysicalSizeY": y, "PhysicalSizeXUnit": "µm", "PhysicalSizeYUnit": "µm"}
        tifffile.imwrite(path, MASK, ome=True, metadata={"axes": "YX", **sizes})
    else:
        tifffile.imwrite(path, MASK, imagej=True, resolution=(1 / x, 1 / y), metadata={"unit": "um"})


@pytest.mark.parametrize("kind", ["ome", "imagej"])
def test_auto_takes_what_the_file_says(run, tmp_path, kind):
    write(tmp_path / "in.tif", kind)
    plain = run("tessellate", "in.tif", "--what", "table")
    assert "--spacing" in plain.err
    auto = run("tessellate", "in.tif", "--what", "table", "--spacing", "auto", "--stats", "s.json")
    typed = run("tessellate", "in.tif", "--what", "table", "--spacing", "0.325,0.5µm")
    assert (auto.code, auto.err, auto.out) == (0, "", typed.out) != (0, "", plain.out)
    assert json.loads((tmp_path / "s.json").read_text())["spacing"] == [0.325, 0.5]
    refused = run("tessellate", "in.tif", "--what", "table", "--pixel-size", "auto")
    assert (refused.code, "--spacing" in refused.err) == (3, True)
    run("tessellate", "in.tif", "-o", "a.npy", "--spacing", "auto", "--max-distance", "2um")
    right = vorotool.tessellate(MASK, spacing=(0.5, 0.325), max_distance=2).labels
    assert np.array_equal(np.load(tmp_path / "a.npy"), right)


@pytest.mark.parametrize("large", [2**24, 100])
@pytest.mark.parametrize("name", ["dots.csv", "in.tif"])
def test_images_that_are_written_say_the_spacing(run, dots, monkeypatch, name, large):
    monkeypatch.setattr("vorotool.jobs.tessellation.LARGE", large)
    write(dots / "in.tif", "ome", (2, 2))
    frame = FRAME if name == "dots.csv" else []
    for end in (".tif", ".ome.zarr"):
        assert run("tessellate", name, *frame, "--spacing", "0.325,0.5um", "-q", "-o", f"out{end}").code == 0
        args = ["tessellate", f"out{end}", "--what", "table", "--stats", "s.json"]
        assert run(*args, "--spacing", "auto").code == 0
        stats = json.loads((dots / "s.json").read_text())
        assert (stats["spacing"], stats["unit"].replace("µ", "u")) == ([0.325, 0.5], "um")


def test_auto_needs_a_file_that_says_it(run, tmp_path):
    np.save(tmp_path / "in.npy", MASK)
    done = run("tessellate", "in.npy", "--spacing", "auto", "-o", "a.png")
    assert (done.code, "--spacing" in done.err) == (3, True)
    write(tmp_path / "in.tif", "ome", (0.32512345, 1.2345678))
    done = run("tessellate", "in.tif", "--spacing", "auto", "-o", "a.png")
    assert (done.code, "no common step that is coarse enough" in done.err) == (3, True)


def test_a_map_with_pixels_that_are_no_squares(run, tmp_path):
    rasterio = pytest.importorskip("rasterio")
    transform = rasterio.transform.Affine(30, 0, 2600000, 0, -25, 1200000)
    about = {"driver": "GTiff", "count": 1, "height": 24, "width": 32, "dtype": "uint8"}
    with rasterio.open(tmp_path / "in.tif", "w", **about, crs="EPSG:2056", transform=transform) as file:
        file.write(MASK, 1)
    asked = run("tessellate", "in.tif", "--what", "table", "--pixel-size", "auto")
    assert (asked.code, "--pixel-size 1" in asked.err) == (3, True)
    rows = run("tessellate", "in.tif", "--what", "table", "--spacing", "auto").rows
    # 42 pixels in columns 4 to 10 and rows 3 to 8: center (7, 5.5)
    assert (float(rows[0]["x"]), float(rows[0]["y"])) == (2600000 + 7.5 * 30, 1200000 - 6 * 25)
    assert float(rows[0]["object_area"]) == 42 * 750
    for row, mask in zip(
        rows, vorotool.tessellate(MASK, spacing=(25, 30)).labels == np.array([1, 2])[:, None, None], strict=True
    ):
        y, x = np.nonzero(mask)
        assert float(row["bbox_x"]) == 2600000 + x.min() * 30
        assert float(row["bbox_y"]) == 1200000 - (y.max() + 1) * 25
    typed = run("tessellate", "in.tif", "--what", "table", "--spacing", "30,25m").rows
    assert (float(typed[0]["x"]), float(typed[0]["y"])) == (7 * 30, 5.5 * 25)


@pytest.mark.parametrize("options", [["--seeds", "labels"], ["--seeds", "pixels"], ["--seeds", "components"], []])
@pytest.mark.parametrize("what", ["labels", "distance", "distance2", "table", "neighbors"])
def test_images_that_pass_by_have_the_same_bytes(run, tmp_path, monkeypatch, what, options):
    labels = np.kron(np.random.default_rng(2).random((40, 30)) < 0.05, np.ones((3, 2))).astype(np.uint8) * 7
    tifffile.imwrite(tmp_path / "in.tif", labels, rowsperstrip=8)
    args = ["tessellate", "in.tif", "--what", what, "--spacing", "0.325,0.5um", "-q", *options]
    limit = ["--max-distance", "2"] if not what.startswith("distance") else []
    is_table = what in ("table", "neighbors")
    end = "csv" if is_table else "npy"
    assert run(*args, *limit, "-o", f"held.{end}").code == 0
    monkeypatch.setattr("vorotool.jobs.tessellation.LARGE", 100)
    monkeypatch.setattr("vorotool.engines.tessellation.streamed_image.SWEEP_PIXELS", 60 * 7)
    monkeypatch.setattr("vorotool.engines.tessellation.frames.BAND_PIXELS", 60 * 11)
    done = run(*args, *limit, "-o", f"passed.{end}", "--stats", "s.json", "--chunk", "60x8")
    assert done.code == 2  # chunks are for stores
    assert run(*args, *limit, "-o", f"passed.{end}", "--stats", "s.json").code == 0
    assert (tmp_path / f"passed.{end}").read_bytes() == (tmp_path / f"held.{end}").read_bytes()
    stats = json.loads((tmp_path / "s.json").read_text())
    assert stats["spacing"] == [0.325, 0.5]
    assert (stats["distance2_step"], stats["arithmetic"], "labels" in stats) == ("1/40", "float64", is_table)


@pytest.mark.parametrize("fmt", ["svg", "png", "html", "gif"])
def test_pictures(run, dots, fmt):
    options = ["--animate", "--frames", "3"] if fmt == "gif" else [] if fmt == "html" else ["--scale-bar"]
    args = ["tessellate", "dots.csv", *FRAME, "--what", "color", *options]
    assert run(*args, "--spacing", "0.325,0.65um", "-o", f"a.{fmt}").code == 0
    if fmt == "svg":
        text = (dots / "a.svg").read_text()
        assert 'width="1000" height="1472"' in text  # 20 columns of 1 and 15 rows of 2, and a margin
        assert ">1 µm<" in text
    if fmt == "html":
        assert "um" in (dots / "a.html").read_text()


def test_batches_have_one_table_in_one_unit(run, dots):
    (dots / "more.csv").write_text((dots / "dots.csv").read_text())
    args = ["tessellate", "dots.csv", "more.csv", *FRAME, "--spacing", "0.325,0.5um"]
    assert run(*args, "--table", "all.csv", "--out-dir", "out", "--what", "labels").code == 0
    rows = (dots / "all.csv").read_text().splitlines()
    assert len(rows) == 9
    assert rows[1].endswith(",um")
    again = run(*args, "--table", "all.csv", "--out-dir", "out", "--what", "labels", "--resume")
    assert again.code == 0
