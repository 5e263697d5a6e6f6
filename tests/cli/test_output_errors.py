"""Outputs that cannot be written, streams that are closed, and statistics: nothing is replaced or half written."""

import os

import numpy as np
import pytest

from support.processes.ended import ended_bash
from support.processes.leftovers import contents, leftovers


def test_outputs_that_cannot_be_written(run, folder):
    (folder / "old.png").write_text("old")
    for line in ("tessellate dots.csv -o /dev/full -f npy", "tessellate dots.csv -o old.png --no-clobber"):
        run(line, code=4)
    run("tessellate dots.csv -f png -o", "", code=4)
    for fmt in ("csv", "npz"):
        run(f"delaunay dots.csv -o /dev/full -f {fmt}", code=4)
    assert (folder / "old.png").read_text() == "old"
    assert leftovers(folder) == []


def test_binary_goes_through_a_pipe(run, process, folder):
    png, _ = process("tessellate", "dots.csv", "-f", "png", "-o", "-").communicate()
    assert png.startswith(b"\x89PNG")
    assert "</svg>" in run("draw - -f svg", data=png).out


@pytest.mark.parametrize("command", [["tessellate", "dots.csv", "-f", "npy"], ["draw", "mask.pbm", "-f", "png"]])
def test_statistics_replace_neither_input_nor_output(run, folder, command):
    source = folder / command[1]
    before = source.read_bytes()
    os.link(source, folder / "same")
    for name in (source.name, "same", "out", "./out"):
        run(*command, "-o", "out", "--stats", name, code=2, says=name)
        assert not (folder / "out").exists()
    assert source.read_bytes() == before
    (folder / "old.json").write_text("old")
    run(*command, "-o", "out", "--stats", "old.json", "--no-clobber", code=4)
    assert (folder / "old.json").read_text() == "old"
    run(*command, "-o", os.devnull, "--stats", os.devnull)


def test_standard_input_is_not_replaced_either(process, folder):
    before = (folder / "dots.csv").read_bytes()
    with (folder / "dots.csv").open("rb") as stdin:
        done = process("tessellate", "-", "-o", "dots.csv", "-f", "npy", stdin=stdin)
        _, err = done.communicate(timeout=600)
    assert done.returncode == 2
    assert b"also an input" in err
    assert (folder / "dots.csv").read_bytes() == before


@pytest.mark.parametrize(
    ("command", "code", "message"),
    [
        ("tessellate dots.csv -o out.png <&- >&- 2>&-", 0, ""),
        ("tessellate missing.csv -o out.png >&- 2>&-", 3, ""),
        ("paint 2>/dev/full", 2, ""),
        ("tessellate dots.csv --what table >&-", 4, "error: standard output cannot be written: Bad file descriptor"),
        ("tessellate dots.csv -f text >/dev/full", 4, "error: standard output cannot be written"),
        ("tessellate - -o out.png <&-", 3, "error: standard input is closed"),
        ("--help >&-", 4, "Bad file descriptor"),
        ("tessellate --help >/dev/full", 4, "No space left on device"),
        ("tessellate --help | true; exit ${PIPESTATUS[0]}", 141, ""),
        ("tessellate dots.csv --size 1000x1000 -q -f text | true; exit ${PIPESTATUS[0]}", 141, ""),
    ],
)
def test_closed_and_full_streams(folder, command, code, message):
    done = ended_bash(f"vorotool {command}", folder)
    assert done.returncode == code, done.stderr
    assert done.stdout == ""
    assert message in done.stderr
    assert len(done.stderr.splitlines()) == bool(message)
    if code == 0:
        assert (folder / "out.png").read_bytes().startswith(b"\x89PNG")


def test_failures_are_known_before_the_first_output(run, folder):
    np.save(folder / "labels.npy", np.full((40, 50), 70_000, np.uint32) * (np.arange(50) > 24))
    (folder / "b.labels.png").write_text("old")
    (folder / "plain").write_text("a file")
    before = contents(folder)
    for line, code, words in [
        ("labels.npy --seeds labels --what table,labels -o a", 5, "do not fit in a 16-bit PNG"),
        ("dots.csv --size 1001x1000 --what table,labels -o a -f svg", 2, "table"),
        ("dots.csv --what table,labels -o b --no-clobber", 4, "b.labels.png already exists"),
        ("dots.csv --what table -o a.csv --stats no/such/s.json", 4, "no/such/s.json"),
        ("dots.csv --what table -o a.csv --stats plain/s.json", 4, "plain/s.json"),
        ("dots.csv --what table,labels --out-dir plain/in", 4, "plain/in"),
        ("missing.csv --what table,labels --out-dir new", 3, "missing.csv"),
    ]:
        run(f"tessellate {line}", code=code, says=words)
        assert contents(folder) == before
    run("draw mask.pbm -o a.png --stats no/such/s.json", code=4)
    assert contents(folder) == before


def test_the_folder_of_outputs_is_made(run, folder):
    run("tessellate dots.csv --out-dir new/deep --what table --stats new/deep/s.json")
    assert {path.name for path in (folder / "new/deep").iterdir()} == {"dots.csv", "s.json"}


def test_a_folder_without_permission(run, folder, monkeypatch):
    (folder / "locked").mkdir()
    monkeypatch.setattr("os.access", lambda path, mode, **_: "locked" not in str(path))  # root writes anywhere
    for options in (["-o", "locked/a.png"], ["--out-dir", "locked/in"], ["-o", "a.png", "--stats", "locked/s.json"]):
        run("tessellate dots.csv", *options, code=4)
        assert not (folder / "a.png").exists()
