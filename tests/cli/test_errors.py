"""What goes wrong, and what is said: exit codes 2 to 5, signals and pipes (one test a row of the contract)."""

import json
import os
import resource
import signal
import struct
import subprocess
import sys
import time
import zlib
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parent))
from conftest import leftovers


def png_header(width, height, depth=16):
    header = struct.pack(">IIBBBBB", width, height, depth, 0, 0, 0, 0)
    chunk = struct.pack(">I", 13) + b"IHDR" + header + struct.pack(">I", zlib.crc32(b"IHDR" + header))
    return b"\x89PNG\r\n\x1a\n" + chunk


def npy_header(text):
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(text)) + text.encode()


def pickled(folder):
    path = folder / "made.npy"
    np.save(path, np.array([{"a": 1}], dtype=object), allow_pickle=True)
    return path.read_bytes()


BAD_INPUTS = {
    # name: (bytes, exit code, what the message says)
    "nan.csv": (b"x,y\n1,2\nnan,4\n", 3, ["nan.csv", "line 3", "nan"]),
    "inf.csv": (b"1,2\n-inf,4\n", 3, ["line 2", "inf"]),
    "word.csv": (b"x,y\n1,2\n3,abc\n", 3, ["line 3", "abc"]),
    "ragged.csv": (b"x,y\n1,2\n3\n", 3, ["line 3"]),
    "empty.csv": (b"", 3, ["no seeds"]),
    "header.csv": (b"x,y\n", 3, ["no seeds"]),
    "three.csv": (b"1,2,3\n4,5,6\n", 3, ["--columns"]),
    "negative.csv": (b"-3,1\n12,2\n", 3, ["points span x -3..12", "--window", "delaunay --what cells"]),
    "huge.csv": (b"1e300,0\n", 3, ["2^44"]),
    "no-name.csv": (b"x,y\n", 3, ["no-name.csv: there are no seeds"]),
    "label.npy": (
        npy_header("{'descr': '<i2', 'fortran_order': False, 'shape': (2, 3), }\n")
        + struct.pack("<6h", 1, 2, 2, 0, 3, -7),
        3,
        ["label.npy: the image holds the value -7 in row 1, column 2"],
    ),
    "label.csv": (b"x,y,label\n1,2,0\n", 3, ["label", "0"]),
    "deep.json": (b"[" * 100_000, 3, ["nested"]),
    "deep.wkt": (b"GEOMETRYCOLLECTION(" * 5000, 3, ["nested"]),
    "cut.json": (b"[[1, 2], [3", 3, ["cut.json"]),
    "table.json": (
        b'[{"label_a":1,"label_b":4,"length":2.5}]',
        3,
        ["the header names no known pair of coordinates", "label_a", "--columns"],
    ),
    "shapes.json": (b'{"polygons":[]}', 3, ["shapes.json holds polygons", "skeleton-exact reads it"]),
    "polygon.geojson": (b'{"type": "Polygon", "coordinates": [[[0,0],[1,0],[1,1],[0,0]]]}', 3, ["Polygon"]),
    "binary.csv": (bytes(range(256)) * 4, 3, ["binary.csv"]),
    "cut.png": (png_header(20, 20) + b"\x00\x00\x10\x00IDATxx", 3, ["cut.png"]),
    "bomb.png": (png_header(60_000, 60_000), 5, ["60000", "--max-pixels"]),
    "bomb.npy": (npy_header("{'descr': '<f8', 'fortran_order': False, 'shape': (100000000000, 2), }\n"), 5, ["--max"]),
    "cut.npy": (npy_header("{'descr': '<f8', 'fortran_order': False, 'shape': (100, 2), }\n") + b"123", 3, ["cut.npy"]),
}


@pytest.mark.parametrize("name", BAD_INPUTS)
def test_bad_input(run, folder, name):
    data, code, words = BAD_INPUTS[name]
    (folder / name).write_bytes(data)
    for options in ([name, "-o", "out.tif"], [name, "--what", "table"]):
        done = run("tessellate", *options)
        assert done.code == code, done.err
        assert done.out == ""
        message = [line for line in done.err.splitlines() if not line.startswith(("note:", "warning:"))]
        assert len(message) == 1
        assert message[0].startswith("error: ")
        assert all(word in message[0] for word in words), message
    assert not (folder / "out.tif").exists()
    assert leftovers(folder) == []


def test_pickled_npy_is_never_unpickled(run, folder):
    (folder / "pickled.npy").write_bytes(pickled(folder))
    done = run("tessellate", "pickled.npy", "-o", "out.png")
    assert done.code == 3
    assert "object" in done.err or "pickle" in done.err


def test_a_photograph_is_not_taken_for_labels(run, folder):
    from PIL import Image

    noise = np.random.default_rng(0).integers(0, 256, (80, 90), dtype=np.uint8)
    Image.fromarray(noise).save(folder / "photo.png")
    done = run("tessellate", "photo.png", "-o", "out.png")
    assert done.code == 3
    assert "a photograph? use --threshold otsu" in done.err
    assert run("tessellate", "photo.png", "-o", "out.png", "--threshold", "otsu").code == 0
    assert run("tessellate", "photo.png", "-o", "out.png", "--threshold", "250").code == 0
    Image.fromarray(np.stack([noise, noise.T[:80, :80].repeat(2, 1)[:, :90], noise], axis=2)).save(folder / "rgb.png")
    done = run("tessellate", "rgb.png", "-o", "out.png")
    assert done.code == 3
    assert "--threshold" in done.err
    assert run("tessellate", "rgb.png", "-o", "out.png", "--threshold", "otsu").code == 0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["tessellate"], ["0 inputs"]),
        (["tessellate", "dots.csv", "mask.pbm", "-o", "a.png"], ["2 inputs"]),
        (["tessellate", "dots.csv"], ["-o", "-f"]),
        (["tessellate", "dots.csv", "--what", "lables"], ["'lables'", "labels"]),
        (["tessellate", "dots.csv", "-o", "a.xyz"], [".xyz", "png"]),
        (["tessellate", "dots.csv", "-o", "a.csv"], ["labels cannot be written as csv"]),
        (["tessellate", "dots.csv", "-f", "bmp"], ["bmp"]),
        (["tessellate", "dots.csv", "--what", "distance", "-o", "a.png"], ["distance cannot be written as png"]),
        (["tessellate", "dots.csv", "--what", "labels,table"], ["-o STEM"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--out-dir", "."], ["not both"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--size", "0x5"], ["'0x5'", "640x480"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--size", "big"], ["'big'"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--window", "1,2,3"], ["'1,2,3'"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--window", "1,2,3,0"], ["at least 1"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--size", "5x5", "--window", "0,0,5,5"], ["not both"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--max-distance", "x"], ["'x'"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--max-distance", "-1"], ["max_distance is -1"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--threshold", "x"], ["'x'"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--passes", "1"], ["--method propagation"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--method", "propagation", "--max-distance", "3"], ["exact"]),
        (["tessellate", "dots.csv", "--method", "propagation", "--what", "distance", "-o", "a.tif"], ["exact"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--seeds", "pixels"], ["--seeds is for images"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--page", "0"], ["--page is for images"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--threshold", "0"], ["--threshold is for images"]),
        (["tessellate", "mask.pbm", "-o", "a.png", "--threshold", "nan"], ["'nan' is no threshold"]),
        (["tessellate", "mask.pbm", "-o", "a.png", "--columns", "1,2"], ["--columns"]),
        (["tessellate", "mask.pbm", "-o", "a.png", "--size", "4x4"], ["--size"]),
        (["tessellate", "dots.csv", "-f", "text", "--stats", "-"], ["--stats -"]),
        (["tessellate", "dots.csv", "-o", "dots.csv", "-f", "text"], ["dots.csv", "input"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--layers", "roads"], ["'roads'"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--layers", "cells"], ["--layers is for pictures"]),
        (["tessellate", "dots.csv", "-o", "a.npy", "--what", "diagram", "--layers", "cells"], ["--layers is for"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--threads", "-1"], ["-1"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--threads", "1025"], ["1025"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--size", "9" * 5000 + "x1"], ["is no size"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--window", "9" * 5000 + ",1,1,1"], ["is no window"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--max-distance", "1e999999999"], ["is no number"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--connectivity", "8"], ["--connectivity is for images"]),
        (["tessellate", "mask.pbm", "-o", "a.png", "--connectivity", "4", "--seeds", "pixels"], ["for components"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--passes", "2"], ["--method propagation"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--dtype", "uint32"], ["--dtype is for labels in TIFF, NPY"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--chunk", "64x64"], ["--chunk is for Zarr stores"]),
        (["tessellate", "dots.csv", "-f", "zarr"], ["a Zarr store is a folder"]),
        (["tessellate", "dots.csv", "-o", "a.tif", "--what", "diagram", "--dtype", "uint8"], ["--dtype is for labels"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--what", "colour", "--width", "99"], ["--width is for SVG"]),
        (["tessellate", "dots.csv", "-o", "a.npy", "--width", "99"], ["--width is for SVG"]),
        (["draw", "mask.pbm", "-o", "a.png", "--width", "99"], ["--width is for SVG"]),
        (["tessellate", "dots.csv", "-o", "a.npy", "--precision", "3"], ["--precision is for tables"]),
        (["tessellate", "dots.csv", "--what", "table", "-f", "npz", "-o", "a", "--precision", "3"], ["--precision"]),
        (
            ["tessellate", "missing.csv", "-o", "a.svg", "--layers", "diagram"],
            ["--layers diagram: a picture in SVG has cells, labels, seeds"],
        ),
        (
            ["tessellate", "dots.csv", "-o", "a.png", "--input-format", "xyz"],
            ["'xyz' is no format of inputs: use one of csv, tsv, txt, node, npy, npz, geojson, wkt, json, png, tiff"],
        ),
        (
            ["draw", "mask.pbm", "-o", "a.png", "--input-format", "xyz"],
            ["'xyz' is no format of inputs: use one of png, tiff, tif, pnm, pbm, pgm, ppm, npy"],
        ),
        (["paint"], ["paint"]),
        (["--colour"], ["--colour"]),
    ],
)
def test_usage(run, folder, arguments, words):
    done = run(*arguments)
    assert done.code == 2, done.err
    assert all(word in done.err for word in words), done.err
    assert (folder / "dots.csv").read_text().startswith("x,y,name")


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("delauney", "there is no command 'delauney': did you mean delaunay?"),
        ("skeleton_exact", "did you mean skeleton-exact"),
        ("Tesselate", "did you mean tessellate?"),
        ("voronoise", "use one of tessellate, delaunay,"),
    ],
)
def test_a_mistyped_command(run, name, words):
    done = run(name, "dots.csv")
    assert (done.code, done.out) == (2, "")
    assert words in done.err


def test_missing_input(run):
    assert "name of the input is empty" in run("tessellate", "", "-o", "a.png").err
    done = run("tessellate", "nowhere.csv", "-o", "a.png")
    assert done.code == 3
    assert "nowhere.csv" in done.err
    assert run("tessellate", ".", "-o", "a.png").code == 2


def test_limits_are_known_before_memory_is_taken(run, folder):
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    done = run("tessellate", "dots.csv", "--size", "60000x60000", "--what", "table")
    assert done.code == 5
    assert "--max-pixels" in done.err
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 200_000  # kilobytes
    assert run("tessellate", "dots.csv", "--max-sites", "2", "-o", "a.png").code == 5
    assert run("tessellate", "dots.csv", "--size", "2000x2000", "-f", "svg").code == 5
    assert run("tessellate", "mask.pbm", "--max-pixels", "31", "-o", "a.png").code == 5
    assert run("tessellate", "dots.csv", "--size", "10x10", "--max-pixels", "9", "-o", "a.png").code == 0  # streamed


def test_outputs_that_cannot_be_written(run, folder):
    assert "'' is no name: name a file" in run("tessellate", "dots.csv", "-f", "png", "-o", "").err
    assert run("tessellate", "dots.csv", "-o", "no/such/a.png").code == 4
    assert run("tessellate", "dots.csv", "-o", "/dev/full", "-f", "npy").code == 4
    assert run("tessellate", "dots.csv", "-o", "a.png", "--stats", "no/such/s.json").code == 4
    (folder / "old.png").write_text("old")
    done = run("tessellate", "dots.csv", "-o", "old.png", "--no-clobber")
    assert done.code == 4
    assert (folder / "old.png").read_text() == "old"
    assert leftovers(folder) == []


def test_full_device_on_standard_output(process, folder):
    with Path("/dev/full").open("wb") as full:
        done = subprocess.run(
            [sys.executable, "-m", "vorotool", "tessellate", "dots.csv", "-f", "text"],
            cwd=folder, stdout=full, stderr=subprocess.PIPE, check=False,
        )  # fmt: skip
    assert done.returncode == 4
    assert b"Traceback" not in done.stderr
    assert b"error: standard output cannot be written" in done.stderr


def test_failed_write_leaves_the_older_file(run, folder, monkeypatch):
    (folder / "old.tif").write_text("old")

    def fail(*_args, **_options):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("vorotool.formats.tiff.write_tiff", fail)
    monkeypatch.setattr("vorotool.formats.label_images.write_tiff", fail)
    done = run("tessellate", "dots.csv", "-o", "old.tif")
    assert done.code == 4
    assert "No space left" in done.err
    assert (folder / "old.tif").read_text() == "old"
    assert leftovers(folder) == []


def test_strict_refuses_repairs(run, folder):
    (folder / "fine.csv").write_text("x,y\n0.1,2\n")
    (folder / "twice.csv").write_text("x,y\n1,2\n1,2\n")
    assert run("tessellate", "fine.csv", "-o", "a.png").code == 0
    for name in ("fine.csv", "twice.csv"):
        done = run("tessellate", name, "-o", "a.png", "--strict")
        assert done.code == 3
        assert "--strict" in done.err


def test_binary_never_goes_to_a_terminal(folder):
    import pty

    master, slave = pty.openpty()
    done = subprocess.run(
        [sys.executable, "-m", "vorotool", "tessellate", "dots.csv", "-f", "png"],
        cwd=folder, stdout=slave, stderr=subprocess.PIPE, check=False,
    )  # fmt: skip
    os.close(slave)
    os.close(master)
    assert done.returncode == 2
    assert b"-o" in done.stderr


def test_binary_goes_through_a_pipe(process, folder):
    one = process("tessellate", "dots.csv", "-f", "png", "-o", "-")
    png, _ = one.communicate()
    assert png.startswith(b"\x89PNG")
    two = process("draw", "-", "-f", "svg", stdin=subprocess.PIPE)
    svg, _ = two.communicate(png)
    assert b"</svg>" in svg


def test_broken_pipe_is_quiet(folder):
    np.savetxt(folder / "many.csv", np.random.default_rng(0).integers(0, 3000, (2000, 2)), fmt="%d", delimiter=",")
    script = (
        f"{sys.executable} -m vorotool tessellate many.csv --size 1000x1000 -f text | head -1; echo ${{PIPESTATUS[0]}}"
    )
    done = subprocess.run(["bash", "-c", script], cwd=folder, capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "141"
    assert "error" not in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGHUP, 129)])
def test_interrupt_in_the_kernel(process, folder, number, code):
    np.savetxt(folder / "many.csv", np.random.default_rng(0).integers(0, 60000, (20000, 2)), fmt="%d", delimiter=",")
    (folder / "out.npy").write_text("old")
    child = process("tessellate", "many.csv", "--size", "60000x60000", "--threads", "1", "-q", "-o", "out.npy")
    deadline = time.monotonic() + 30
    while not leftovers(folder) and time.monotonic() < deadline:  # the kernel runs once the output is open
        time.sleep(0.05)
    assert leftovers(folder), "the output was never opened"
    time.sleep(0.3)
    sent = time.monotonic()
    child.send_signal(number)
    out, err = child.communicate(timeout=30)
    assert child.returncode == code
    assert (out, err) == (b"", b"")
    assert time.monotonic() - sent < 5  # 0.2 s is the aim; a loaded machine must not fail the test
    assert (folder / "out.npy").read_text() == "old"
    assert leftovers(folder) == []


DEAF = """
import time, click
from vorotool.cli import main
class Sleeper:
    def __del__(self):
        print("asleep", flush=True)
        time.sleep(60)
@click.command()
def deaf():
    Sleeper()
    time.sleep(60)
main.LazyGroup.get_command = lambda *_: deaf
main.main(["deaf"])
"""


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_an_interrupt_ends_quietly_where_exceptions_are_swallowed(number, code):
    child = subprocess.Popen([sys.executable, "-c", DEAF], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert child.stdout.readline() == b"asleep\n"
    child.send_signal(number)
    assert child.communicate(timeout=30) == (b"", b"")
    assert child.returncode == code


def test_version(run):
    done = run("--version")
    assert done.code == 0
    assert "vorotool" in done.out


def test_stats_are_one_json_object(run, folder):
    run("tessellate", "dots.csv", "-o", "a.png", "--stats", "s.json")
    assert json.loads((folder / "s.json").read_text())["command"] == "tessellate"


@pytest.mark.parametrize("command", [["tessellate", "dots.csv", "-f", "npy"], ["draw", "mask.pbm", "-f", "png"]])
def test_statistics_replace_neither_input_nor_output(run, folder, command):
    source = folder / command[1]
    before = source.read_bytes()
    os.link(source, folder / "same")
    for name in (source.name, "same", "out", "./out"):
        done = run(*command, "-o", "out", "--stats", name)
        assert done.code == 2
        assert name in done.err
        assert not (folder / "out").exists()
    assert source.read_bytes() == before
    (folder / "old.json").write_text("old")
    done = run(*command, "-o", "out", "--stats", "old.json", "--no-clobber")
    assert done.code == 4
    assert (folder / "old.json").read_text() == "old"
    assert run(*command, "-o", os.devnull, "--stats", os.devnull).code == 0


def test_standard_input_is_not_replaced_either(process, folder):
    before = (folder / "dots.csv").read_bytes()
    with (folder / "dots.csv").open("rb") as stdin:
        done = process("tessellate", "-", "-o", "dots.csv", "-f", "npy", stdin=stdin)
        _, err = done.communicate(timeout=30)
    assert done.returncode == 2
    assert b"also an input" in err
    assert (folder / "dots.csv").read_bytes() == before


@pytest.mark.parametrize(
    ("command", "code", "message"),
    [
        ("tessellate dots.csv -o out.png >&-", 0, ""),
        ("tessellate dots.csv -o out.png 2>&-", 0, ""),
        ("tessellate dots.csv -o out.png <&- >&- 2>&-", 0, ""),
        ("tessellate missing.csv -o out.png >&- 2>&-", 3, ""),
        ("tessellate missing.csv -o out.png 2>/dev/full", 3, ""),
        ("paint 2>/dev/full", 2, ""),
        ("tessellate dots.csv --what table >&-", 4, "error: standard output cannot be written: Bad file descriptor"),
        ("tessellate - -o out.png <&-", 3, "error: standard input is closed"),
        ("--help >&-", 4, "Bad file descriptor"),
        ("--version >/dev/full", 4, "No space left on device"),
        ("tessellate --help >/dev/full", 4, "No space left on device"),
        ("--help | true; exit ${PIPESTATUS[0]}", 141, ""),
        ("tessellate --help | true; exit ${PIPESTATUS[0]}", 141, ""),
    ],
)
def test_closed_and_full_streams(folder, command, code, message):
    script = f"{sys.executable} -m vorotool {command}"
    done = subprocess.run(["bash", "-c", script], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == code, done.stderr
    assert done.stdout == ""
    assert message in done.stderr
    assert len(done.stderr.splitlines()) == bool(message)
    if code == 0:
        assert (folder / "out.png").read_bytes().startswith(b"\x89PNG")


def write_labels(folder, largest):
    image = np.ones((40, 50), np.uint32)
    image[:, 25:] = largest
    np.save(folder / "labels.npy", image)


def test_failures_are_known_before_the_first_output(run, folder):
    write_labels(folder, 70_000)
    (folder / "b.labels.png").write_text("old")
    (folder / "plain").write_text("a file")
    for arguments, code, words in [
        (["labels.npy", "--what", "table,labels", "-o", "a"], 5, "do not fit in a 16-bit PNG"),
        (["dots.csv", "--size", "1001x1000", "--what", "table,labels", "-o", "a", "-f", "svg"], 2, "table"),
        (["dots.csv", "--what", "table,labels", "-o", "b", "--no-clobber"], 4, "b.labels.png exists already"),
        (["dots.csv", "--what", "table", "-o", "a.csv", "--stats", "no/such/s.json"], 4, "no/such/s.json"),
        (["dots.csv", "--what", "table", "-o", "a.csv", "--stats", "plain/s.json"], 4, "plain/s.json"),
        (["dots.csv", "--what", "table,labels", "--out-dir", "plain/in"], 4, "plain/in"),
        (["missing.csv", "--what", "table,labels", "--out-dir", "new"], 3, "missing.csv"),
    ]:
        done = run("tessellate", *arguments)
        assert done.code == code, done.err
        assert words in done.err
        assert {path.name for path in folder.iterdir()} == {
            *("dots.csv", "mask.pbm", "labels.npy", "b.labels.png", "plain")
        }
    assert run("draw", "mask.pbm", "-o", "a.png", "--stats", "no/such/s.json").code == 4
    assert not (folder / "a.png").exists()


def test_the_folder_of_outputs_is_made(run, folder):
    done = run("tessellate", "dots.csv", "--out-dir", "new/deep", "--what", "table", "--stats", "new/deep/s.json")
    assert done.code == 0, done.err
    assert {path.name for path in (folder / "new/deep").iterdir()} == {"dots.csv", "s.json"}
    assert run("draw", "mask.pbm", "--out-dir", "other/deep").code == 0
    assert (folder / "other/deep/mask.png").exists()


def test_a_folder_without_permission(run, folder, monkeypatch):
    (folder / "locked").mkdir()
    monkeypatch.setattr("os.access", lambda path, mode, **_: "locked" not in str(path))  # root writes anywhere
    for options in (["-o", "locked/a.png"], ["--out-dir", "locked/in"], ["-o", "a.png", "--stats", "locked/s.json"]):
        done = run("tessellate", "dots.csv", *options)
        assert done.code == 4
        assert not (folder / "a.png").exists()


def test_quiet_wins(run, folder):
    assert run("tessellate", "mask.pbm", "-o", "a.png", "-q", "-v").err == ""
    assert run("tessellate", "mask.pbm", "-o", "a.png", "-v").err != ""


@pytest.mark.parametrize("name", ["tif", "TIFF", "pgm", "ppm"])
def test_names_of_formats(run, folder, name):
    from PIL import Image

    kind = "TIFF" if name[0] in "tT" else "PPM"
    Image.fromarray(np.eye(4, dtype=np.uint8)).save(folder / "image", format=kind)
    assert run("tessellate", "image", "--input-format", name, "-o", "a.png").code == 0
    assert run("draw", "image", "--input-format", name, "-o", "a.svg").code == 0


def test_layers_are_those_that_are_drawn():
    from vorotool.cli.targets import PICTURE_LAYERS
    from vorotool.render import label_png, label_svg

    assert {"png": set(label_png.LAYERS), "svg": set(label_svg.LAYERS)} == {
        fmt: set(layers) for fmt, layers in PICTURE_LAYERS.items()
    }


@pytest.mark.parametrize("command", ["tessellate", "delaunay", "alphashape", "skeleton-exact"])
def test_a_direction_is_for_pictures(run, folder, command):
    source = "mask.pbm" if command == "skeleton-exact" else "dots.csv"
    done = run(command, source, "--y-up", "-o", "out.json", *(["--what", "table"] if command == "tessellate" else []))
    assert done.code == 2
    assert "--y-up and --y-down are for pictures" in done.err


def test_a_plot_has_no_y_of_the_input(run, folder):
    done = run("alphashape", "dots.csv", "--what", "curves", "--y-down", "-o", "a.svg")
    assert (done.code, "curves are a plot: leave them out" in done.err) == (2, True)
    assert run("alphashape", "dots.csv", "--what", "curves,edges", "--y-down", "-f", "svg", "-o", "a").code == 0
    assert not (folder / "out.json").exists()


@pytest.mark.parametrize("kind", ["npy", "tif", "zarr"])
def test_labels_that_do_not_fit_the_type_are_a_limit(run, folder, kind):
    (folder / "many.csv").write_text("".join(f"{i},0\n" for i in range(300)))
    done = run("tessellate", "many.csv", "-o", f"a.{kind}", "--dtype", "uint8")
    assert (done.code, done.err) == (5, "error: labels up to 300 do not fit uint8: use --dtype uint32\n")


@pytest.mark.parametrize(
    ("command", "threshold"),
    [("tessellate", 9), ("delaunay", 9), ("alphashape", 9), ("skeleton-exact", 9), ("skeleton-approx --step 1", 9)],
)
def test_the_threshold_is_said_and_counted(run, folder, command, threshold):
    values = np.array([[9, 3, 3, 9, 3], [3, 200, 200, 200, 9], [3, 200, 210, 200, 9], [3, 9, 220, 9, 200]], np.uint8)
    np.save(folder / "grey.npy", values)
    common = (*command.split(), "grey.npy", "--what", "table", "--stats", "s.json", "-o", "a.json")
    common = tuple(word for word in common if command != "alphashape" or word not in ("--what", "table"))
    done = run(*common, "--threshold", "otsu")
    assert done.code in (0, 3)
    assert f"note: threshold {threshold}, by Otsu's method" in done.err
    if done.code == 0:
        assert json.loads((folder / "s.json").read_text())["threshold"] == threshold
    done = run(*common, "--threshold", "4.5")
    assert "Otsu" not in done.err
    if done.code == 0:
        assert json.loads((folder / "s.json").read_text())["threshold"] == 4.5
