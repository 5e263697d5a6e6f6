"""Inputs that gzip has packed, and inputs with nothing in them."""

import gzip
import io
import re
import sys

import geopandas
import numpy as np
import pytest
import rasterio

from vorotool.formats.io import sources

POINTS = b"x,y\n2,1\n7,5\n1,6\n"
LINES = b"LINESTRING (0 0, 9 4)\n"
COMMANDS = {
    "tessellate --size 9x9 -f text": POINTS,
    "tessellate --size 9x9x9 --volume -o v.tif": None,
    "delaunay": POINTS,
    "alphashape": POINTS,
    "voronoi": POINTS,
    "skeleton-approx --step 1 --side both": LINES,
    "skeleton-exact --side both": LINES,
    "draw -f svg": LINES,
    "distance other.wkt": LINES,
    "info": POINTS,
}


def feed(monkeypatch, data):
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(data)))


@pytest.mark.parametrize(("command", "data"), [*((each, b"") for each in COMMANDS), ("delaunay", b" \r\n\t")])
def test_empty_standard_input_is_an_error_everywhere(run, tmp_path, monkeypatch, command, data):
    (tmp_path / "other.wkt").write_bytes(LINES)
    feed(monkeypatch, data)
    run(command, "-", code=3, says="standard input")


@pytest.mark.parametrize("command", [name for name, data in COMMANDS.items() if data])
def test_packed_inputs_give_what_the_others_give(run, tmp_path, monkeypatch, command):
    data = COMMANDS[command]
    ending = "csv" if data is POINTS else "wkt"
    (tmp_path / "other.wkt").write_bytes(LINES)
    (tmp_path / f"a.{ending}").write_bytes(data)
    (tmp_path / f"a.{ending}.gz").write_bytes(gzip.compress(data[:9]) + gzip.compress(data[9:]))
    plain = run(command, f"a.{ending}")
    assert run(command, f"a.{ending}.gz").out.replace(".gz", "") == plain.out
    feed(monkeypatch, gzip.compress(data))
    assert run(command, "-").out.partition("\n")[2] == plain.out.partition("\n")[2]


def test_outputs_of_packed_inputs_have_plain_names(run, tmp_path):
    (tmp_path / "in").mkdir()
    (tmp_path / "in/a.csv.gz").write_bytes(gzip.compress(POINTS))
    for name in ("in", "in/a.csv.gz"):
        run(f"delaunay {name} --out-dir out -f json -q")
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["a.json", "delaunay.manifest.jsonl"]


@pytest.mark.parametrize("through", ["name", "standard input"])
def test_what_unpacks_to_too_much_is_a_limit(run, tmp_path, monkeypatch, through):
    monkeypatch.setattr(sources, "MOST_OF_GZIP", 2**20)
    packed = gzip.compress(b"1,2\n" * 2**18 + b"3,4\n")
    (tmp_path / "bomb.csv.gz").write_bytes(packed)
    feed(monkeypatch, packed)
    run("delaunay", "bomb.csv.gz" if through == "name" else "-", code=5)
    (tmp_path / "fits.csv.gz").write_bytes(gzip.compress(b"1,2\n3,4\n9,9\n"))
    run("delaunay fits.csv.gz --max-sites 2", code=5)


@pytest.mark.parametrize("data", [gzip.compress(POINTS, mtime=0)[:-12], b"\x1f\x8b\x08" + b"\xff" * 40])
def test_damaged_packing_names_the_file(run, tmp_path, data):
    (tmp_path / "a.csv.gz").write_bytes(data)
    run("delaunay a.csv.gz", code=3, says="a.csv.gz")


EMPTY_FILES = {
    "e.csv": b"",
    "e.wkt": b"\n",
    "e": b" \r\n",
    "h.csv": b"x,y\n",
    "e.json": b"[]",
    "e.geojson": b'{"type":"FeatureCollection","features":[]}',
    "null.geojson": b'{"type":"FeatureCollection","features":[{"type":"Feature","properties":{},"geometry":null}]}',
}
EMPTY_RESULTS = {
    "tessellate --size 4x2 -f text": "0 0 0 0\n0 0 0 0\n",
    "tessellate --window -1,-1,3,1 -f text --method propagation": "0 0 0\n",
    "tessellate --cell-size 5 --window 0,0,15,5 -f text --max-distance 2": "0 0 0\n",
    "tessellate --size 4x2 --what neighbors": "label_a,label_b,border_length,centroid_distance\n",
    "delaunay -f geojson": '{"type":"FeatureCollection","features":[]}\n',
    "delaunay --method digital": None,
    "alphashape -f geojson --verify": '{"type":"FeatureCollection","features":[]}\n',
    "alphashape --method digital -r 3": None,
    "alphashape -r 3 --what general -f wkt": "",
    "voronoi -f wkt": None,
    "skeleton-exact --what shape -f wkt": "",
    "skeleton-exact --side exterior --what branches": None,
    "skeleton-approx --step 1 -f wkt": "",
    "distance -f geojson other.wkt": None,
    "distance --what smallest -f wkt other.wkt": "",
}


@pytest.mark.parametrize(
    ("command", "name"),
    [
        *(("delaunay -f geojson", name) for name in EMPTY_FILES),
        *((command, "e") for command in EMPTY_RESULTS),
    ],
)
def test_a_file_with_nothing_in_it_is_a_warning(run, tmp_path, command, name):
    (tmp_path / name).write_bytes(EMPTY_FILES[name])
    (tmp_path / "other.wkt").write_bytes(LINES)
    before, *options = command.split()
    done = run(before, name, *options)
    assert [line[:9] for line in done.err.splitlines() if line[:5] != "note:"] == ["warning: "]
    if EMPTY_RESULTS[command] is not None and "null" not in name:
        assert re.sub('"(crs|y_axis)":[^,]*,', "", done.out) == EMPTY_RESULTS[command]
    run(before, name, *options, "--strict", code=3, says="--strict")


@pytest.mark.parametrize("name", ["e.wkt", "null.geojson"])
def test_the_picture_of_an_empty_file_is_empty(run, tmp_path, name):
    (tmp_path / name).write_bytes(EMPTY_FILES[name])
    assert run(f"draw {name} -o a.svg").err.count("warning: ") == 1
    assert b"<path" not in (tmp_path / "a.svg").read_bytes()
    run(f"info {name} --json")


@pytest.mark.parametrize("command", ["draw -o a.png", "voronoi", "info"])
def test_an_empty_layer_is_as_an_empty_file(run, tmp_path, command):
    nothing = geopandas.GeoDataFrame({"n": []}, geometry=geopandas.GeoSeries([], crs=2056))
    nothing.to_file(tmp_path / "a.gpkg", layer="none")
    begin, *options = command.split()
    assert run(begin, "a.gpkg", *options).err.count("warning: ") == (command != "info")


def test_a_tessellation_of_nothing_needs_a_frame(run, tmp_path):
    (tmp_path / "e.csv").write_bytes(b"")
    for options in (["-o", "a.png"], ["--cell-size", "2", "-o", "a.png"], ["--volume", "-o", "a.npy"]):
        done = run("tessellate e.csv", *options, code=3)
        assert (done.err.startswith("error: e.csv: "), "--size" in done.err) == (True, True)
    assert [path.name for path in tmp_path.iterdir()] == ["e.csv"]
    assert run("tessellate e.csv --size 2x3x4 --volume -o a.npy --verify").err.count("warning: ") == 1
    labels = np.load(tmp_path / "a.npy")
    assert (labels.shape, labels.any()) == ((4, 3, 2), False)
    run("tessellate e.csv --size 4x3 --what distance -o d.npy", code=3, says="e.csv")


@pytest.mark.parametrize("frame", ["--size 8x8", "--volume --size 8x8x8", "--cell-size 1 --window 0,0,8,8"])
def test_the_table_of_nothing_has_all_columns(run, tmp_path, frame):
    """Tables of many inputs are joined by their columns."""
    (tmp_path / "e.csv").write_text("x,y,z,name\n")
    (tmp_path / "a.csv").write_text("x,y,z,name\n1,2,3,a\n")
    columns = run(f"tessellate a.csv --what table {frame} -q").out.splitlines()[0]
    assert columns.endswith(",name")
    assert run(f"tessellate e.csv --what table {frame} -q").out.splitlines() == [columns]


def test_a_map_of_nothing_lies_where_its_window_is(run, tmp_path):
    (tmp_path / "e.csv").write_bytes(b"")
    frame = ("--cell-size", "5", "--window", "100,200,15,10", "--input-crs", "EPSG:2056")
    run("tessellate e.csv", *frame, "-o", "a.tif")
    with rasterio.open(tmp_path / "a.tif") as file:
        assert (file.shape, tuple(file.bounds), file.read().any()) == ((2, 3), (100, 200, 115, 210), False)


@pytest.mark.parametrize("name", ["e.qgz", "e.qgs", "e.roi"])
def test_files_of_other_programs_are_not_taken_for_tables(run, tmp_path, name):
    (tmp_path / name).write_bytes(b"")
    run(f"info {name}", code=3, says=name)


@pytest.mark.parametrize(
    "header",
    ["long,lat", "E,N", "Location_Center_X,Location_Center_Y", "POSITION_X,POSITION_Y", "Centroid X µm,Centroid Y µm"],
)
def test_columns_of_other_programs(run, tmp_path, header):
    x, y = header.split(",")
    (tmp_path / "a.csv").write_text(f"name,{y},{x}\na,1,2\nb,5,7\nc,6,1\n", encoding="utf-8")
    (tmp_path / "b.csv").write_text("name,y,x\na,1,2\nb,5,7\nc,6,1\n")
    assert run("delaunay a.csv -q").out == run("delaunay b.csv -q").out
