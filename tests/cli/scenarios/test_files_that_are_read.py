"""Files that are read are never replaced, and records of batches neither."""

import errno
import os

import pytest

from vorotool.formats.zarr.store import is_folder, is_store

SQUARE = "POLYGON ((0 0, 9 0, 9 9, 0 9, 0 0))\n"


@pytest.fixture
def read(folder):
    """What is there before, by its name."""
    (folder / "clip.wkt").write_text(SQUARE)
    (folder / "list.csv").write_text("dots.csv\n")
    return {name: (folder / name).read_bytes() for name in ("dots.csv", "mask.pbm", "clip.wkt", "list.csv")}


@pytest.mark.parametrize(
    "line",
    [
        "delaunay dots.csv --clip clip.wkt --what cells -o x.json --stats clip.wkt",
        "delaunay dots.csv --clip clip.wkt --what cells -f wkt -o clip.wkt",
        "tessellate dots.csv --what color --overlay mask.pbm -o x.png --stats mask.pbm",
        "delaunay mask.pbm dots.csv --clip clip.wkt --what cells --out-dir out --stats clip.wkt",
        "tessellate --files-from list.csv --table x.csv --stats list.csv",
        "tessellate --files-from list.csv --table list.csv",
        "tessellate --files-from list.csv --what table --out-dir out --stats out/tessellate.manifest.jsonl",
    ],
)
def test_what_is_read_is_never_replaced(run, folder, read, line):
    done = run(*line.split())
    assert done.code == 2, done.err
    assert "choose another" in done.err or "named twice" in done.err
    assert {name: (folder / name).read_bytes() for name in read} == read


def test_a_list_of_names_is_no_output(run, folder):
    (folder / "out").mkdir()
    (folder / "out/dots.png").write_text("dots.csv\n")
    done = run("tessellate", "--files-from", "out/dots.png", "--out-dir", "out")
    assert (done.code, (folder / "out/dots.png").read_text()) == (2, "dots.csv\n")
    assert "--files-from" in done.err


@pytest.mark.parametrize(("device", "fmt"), [("/dev/null", "tiff"), ("/dev/zero", "npy")])
def test_devices_are_written_in_order(run, folder, device, fmt):
    done = run("tessellate", "dots.csv", "-f", fmt, "-o", device)
    assert (done.code, done.err) == (0, "")


def test_what_must_not_be_looked_at_is_no_folder_and_no_store(run, folder, monkeypatch):
    look = os.stat

    def sealed(path, **options):
        if "sealed" in str(path).split("/"):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
        return look(path, **options)

    (folder / "sealed").mkdir()
    (folder / "sealed/dots.csv").write_bytes((folder / "dots.csv").read_bytes())
    monkeypatch.setattr(os, "stat", sealed)
    assert not is_folder("sealed/a")
    assert not is_store("sealed")
    done = run("tessellate", "sealed/dots.csv", "--what", "table")
    assert (done.code, done.err) == (0, "")  # what can be read is read
    done = run("tessellate", "dots.csv", "-o", "sealed/x.png")
    assert (done.code, "sealed/x.png" in done.err) == (4, True)
