"""What goes wrong with inputs, and what is said: exit codes 3 to 5, limits and signals (a test each)."""

import resource
import signal
import struct
import subprocess
import sys
import time
import zlib

import numpy as np
import pytest

from support.processes.leftovers import leftovers, wait_until
from support.readers.written import bytes_of


def png_header(width, height, depth=16):
    header = struct.pack(">IIBBBBB", width, height, depth, 0, 0, 0, 0)
    chunk = struct.pack(">I", 13) + b"IHDR" + header + struct.pack(">I", zlib.crc32(b"IHDR" + header))
    return b"\x89PNG\r\n\x1a\n" + chunk


BAD_INPUTS = {
    # name: (bytes, exit code, what the message says); readers are tested in tests/formats
    "nan.csv": (b"x,y\n1,2\nnan,4\n", 3, ["nan.csv", "line 3", "nan"]),
    "header.csv": (b"x,y\n", 3, ["no seeds"]),
    "three.csv": (b"1,2,3\n4,5,6\n", 3, ["--columns"]),
    "negative.csv": (b"-3,1\n12,2\n", 3, ["x from -3 to 12", "--window", "delaunay --what cells"]),
    "huge.csv": (b"1e300,0\n", 3, ["2^44"]),
    "label.npy": (
        bytes_of(np.save, [[1, 2, 2], [0, 3, -7]]),
        3,
        ["label.npy: ", "-7 in row 1, column 2"],
    ),
    "pickled.npy": (bytes_of(np.save, [[{}]]), 3, ["pickled"]),
    "deep.wkt": (b"GEOMETRYCOLLECTION(" * 5000, 3, ["nested"]),
    "table.json": (b'[{"label_a":1,"length":2.5}]', 3, ["no coordinate columns", "label_a", "--columns"]),
    "shapes.json": (b'{"polygons":[]}', 3, ["shapes.json holds polygons", "skeleton-exact reads it"]),
    "polygon.wkt": (b"POLYGON ((0 0, 1 0, 1 1, 0 0))", 3, ["polygon.wkt, line 1: a Polygon is not a point"]),
    "cut.png": (png_header(20, 20) + b"\x00\x00\x10\x00IDATxx", 3, ["cut.png"]),
    "bomb.png": (png_header(60_000, 60_000), 5, ["60000", "--max-pixels"]),
}


@pytest.mark.parametrize("name", BAD_INPUTS)
def test_bad_input(run, folder, name):
    data, code, words = BAD_INPUTS[name]
    (folder / name).write_bytes(data)
    for options in (["-o", "out.tif"], ["--what", "table"]):
        done = run("tessellate", name, *options, code=code)
        (message,) = [line for line in done.err.splitlines() if not line.startswith(("note:", "warning:"))]
        assert (done.out, message[:7]) == ("", "error: ")
        assert all(word in message for word in words), message
    assert not (folder / "out.tif").exists()
    assert leftovers(folder) == []


def test_limits_are_known_before_memory_is_taken(run, folder):
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    run("delaunay dots.csv --size 60000x60000 --method digital-valid", code=5, says="--max-pixels")
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 200_000  # kilobytes
    run("tessellate dots.csv --size 10x10 --max-pixels 9 -o a.png")  # streamed


def test_strict_refuses_repairs(run, folder):
    (folder / "fine.csv").write_text("x,y\n0.1,2\n")
    (folder / "twice.csv").write_text("x,y\n1,2\n1,2\n")
    run("tessellate fine.csv -o a.png")
    for name in ("fine.csv", "twice.csv"):
        run(f"tessellate {name} -o a.png --strict", code=3, says="--strict")


KERNEL = ("tessellate", "--size", "60000x60000", "-f", "npy")


@pytest.mark.parametrize(
    ("number", "code", "command"),
    [
        *((signal.SIGINT, 130, KERNEL), (signal.SIGTERM, 143, KERNEL), (signal.SIGHUP, 129, KERNEL)),
        (signal.SIGINT, 130, ("delaunay", "-f", "geojson")),  # which is writing
    ],
)
def test_an_interrupt_of_what_takes_long(process, folder, number, code, command):
    count = 20_000 if command is KERNEL else 400_000
    np.save(folder / "many.npy", np.random.default_rng(0).integers(0, 60000, (count, 2)).astype(float))
    (folder / "out").write_text("old")
    child = process(command[0], "many.npy", *command[1:], "--threads", "1", "-q", "-o", "out")
    wait_until(lambda: leftovers(folder), child)  # the kernel runs once the output is open
    time.sleep(0.3 if command is KERNEL else 0)
    child.send_signal(number)
    out, err = child.communicate(timeout=600)
    assert child.returncode == code
    assert (out, err) == (b"", b"")
    assert (folder / "out").read_text() == "old"
    assert leftovers(folder) == []


DEAF = """
import time, click
from vorotool.cli import main
class Sleeper:
    def __del__(self):
        print("asleep", flush=True)
        time.sleep(600)
@click.command()
def deaf():
    Sleeper()
    time.sleep(600)
main.LazyGroup.get_command = lambda *_: deaf
main.main(["info"])
"""


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_an_interrupt_ends_quietly_where_exceptions_are_swallowed(number, code):
    child = subprocess.Popen([sys.executable, "-c", DEAF], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert child.stdout.readline() == b"asleep\n"
    child.send_signal(number)
    assert child.communicate(timeout=600) == (b"", b"")
    assert child.returncode == code


@pytest.mark.parametrize("kind", ["npy", "zarr"])
def test_labels_that_do_not_fit_the_type_are_a_limit(run, folder, kind):
    (folder / "many.csv").write_text("".join(f"{i},0\n" for i in range(300)))
    run(f"tessellate many.csv -o a.{kind} --dtype uint8", code=5, says="--dtype")


def test_a_failure_leaves_standard_output_as_it_is(run, folder, monkeypatch):
    with (folder / "said").open("w") as said:
        monkeypatch.setattr("sys.stdout", said)
        run("delaunay dots.csv -o no/such/a.csv", code=4)
        said.write("and on")
    assert (folder / "said").read_text() == "and on"
