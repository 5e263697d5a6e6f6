"""Inputs that gzip has packed, and inputs with nothing in them."""

import gzip
import io
import sys

import pytest

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


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("data", [b"", b"\n", b" \r\n\t"])
def test_empty_standard_input_is_an_error_everywhere(run, tmp_path, monkeypatch, command, data):
    if "--volume" in command and data:
        return
    (tmp_path / "other.wkt").write_bytes(LINES)
    feed(monkeypatch, data)
    done = run(*command.split(), "-")
    assert (done.code, done.out) == (3, "")
    assert "standard input" in done.err


@pytest.mark.parametrize("command", [name for name, data in COMMANDS.items() if data])
def test_packed_inputs_give_what_the_others_give(run, tmp_path, monkeypatch, command):
    data = COMMANDS[command]
    ending = "csv" if data is POINTS else "wkt"
    (tmp_path / "other.wkt").write_bytes(LINES)
    (tmp_path / f"a.{ending}").write_bytes(data)
    (tmp_path / f"a.{ending}.gz").write_bytes(gzip.compress(data[:9]) + gzip.compress(data[9:]))
    plain = run(*command.split(), f"a.{ending}")
    packed = run(*command.split(), f"a.{ending}.gz")
    assert packed.code == plain.code == 0
    assert packed.out.replace(".gz", "") == plain.out
    feed(monkeypatch, gzip.compress(data))
    assert run(*command.split(), "-").out.partition("\n")[2] == plain.out.partition("\n")[2]


def test_outputs_of_packed_inputs_have_plain_names(run, tmp_path):
    (tmp_path / "in").mkdir()
    (tmp_path / "in/a.csv.gz").write_bytes(gzip.compress(POINTS))
    for name in ("in", "in/a.csv.gz"):
        assert run("delaunay", name, "--out-dir", "out", "-f", "json", "-q").code == 0
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["a.json", "delaunay.manifest.jsonl"]


@pytest.mark.parametrize("through", ["name", "standard input"])
def test_what_unpacks_to_too_much_is_a_limit(run, tmp_path, monkeypatch, through):
    monkeypatch.setattr(sources, "MOST_UNPACKED", 2**20)
    packed = gzip.compress(b"1,2\n" * 2**18 + b"3,4\n")
    (tmp_path / "bomb.csv.gz").write_bytes(packed)
    feed(monkeypatch, packed)
    done = run("delaunay", "bomb.csv.gz" if through == "name" else "-")
    assert done.code == 5
    (tmp_path / "fits.csv.gz").write_bytes(gzip.compress(b"1,2\n3,4\n9,9\n"))
    assert run("delaunay", "fits.csv.gz", "--max-sites", "2").code == 5


@pytest.mark.parametrize("data", [gzip.compress(POINTS, mtime=0)[:-12], b"\x1f\x8b\x08" + b"\xff" * 40])
def test_damaged_packing_names_the_file(run, tmp_path, data):
    (tmp_path / "a.csv.gz").write_bytes(data)
    done = run("delaunay", "a.csv.gz")
    assert done.code == 3
    assert "a.csv.gz" in done.err


def test_a_file_with_nothing_in_it_is_a_warning(run, tmp_path):
    (tmp_path / "e.csv").write_bytes(b"")
    for command in ("voronoi", "delaunay"):
        done = run(command, "e.csv")
        assert done.code == 0
        assert done.err.startswith("warning: ")


@pytest.mark.parametrize("name", ["e.qgz", "e.qgs", "e.roi"])
def test_files_of_other_programs_are_not_taken_for_tables(run, tmp_path, name):
    (tmp_path / name).write_bytes(b"")
    done = run("info", name)
    assert (done.code, done.out) == (3, "")
    assert name in done.err


@pytest.mark.parametrize(
    "header",
    ["long,lat", "E,N", "Location_Center_X,Location_Center_Y", "POSITION_X,POSITION_Y", "Centroid X µm,Centroid Y µm"],
)
def test_columns_of_other_programs(run, tmp_path, header):
    x, y = header.split(",")
    (tmp_path / "a.csv").write_text(f"name,{y},{x}\na,1,2\nb,5,7\nc,6,1\n", encoding="utf-8")
    (tmp_path / "b.csv").write_text("name,y,x\na,1,2\nb,5,7\nc,6,1\n")
    assert run("delaunay", "a.csv", "-q").out == run("delaunay", "b.csv", "-q").out
