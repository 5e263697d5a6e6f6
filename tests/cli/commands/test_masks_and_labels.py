"""Masks, label images and images without foreground on the command line; frames that nobody gave."""

import json

import numpy as np
import pytest

from support.readers.written import rows_of

NO_FOREGROUND = "warning: the image has no foreground: use --invert or --threshold"


@pytest.fixture
def fields(folder):
    """Images of one label, of two, and of none."""
    two = np.zeros((20, 30), np.uint16)
    two[2:5, 3:8] = 7
    two[12:15, 20:24] = 7
    np.save(folder / "empty.npy", 0 * two)
    np.save(folder / "one.npy", two)
    two[8:10, 10:14] = 9
    np.save(folder / "two.npy", two)
    return folder


def labels_of(table):
    return [row["label"] for row in rows_of(table)]


def test_the_only_label_of_a_field_stays(run, fields):
    done = run("tessellate one.npy --what table")
    assert labels_of(done.out) == ["7"]
    note = "note: 7 is the only value besides 0, and read as a label: for a mask use --seeds components\n"
    assert done.err == note
    assert labels_of(run("tessellate two.npy --what table").out) == ["7", "9"]
    done = run("tessellate one.npy --what table --seeds components")
    assert (labels_of(done.out), done.err) == (["1", "2"], "")
    for command, column in (("delaunay", "label"), ("skeleton-exact", "id")):
        done = run(command, "one.npy", "--what", "table", "--seeds", "labels")
        known = {row[column] for row in done.rows}
        again = run(command, "one.npy", "--what", "table")
        assert (known, again.out, note in again.err) == ({"7"}, done.out, True)


def test_a_batch_of_fields_goes_on_without_foreground(run, fields):
    names = ["empty.npy", "one.npy", "two.npy"]
    done = run("tessellate", *names, "--out-dir", "out", "-f", "npy", "--table", "all.csv")
    assert f"warning: empty.npy: {NO_FOREGROUND.removeprefix('warning: ')}" in done.err.splitlines()
    assert not np.load(fields / "out/empty.npy").any()
    rows = rows_of((fields / "all.csv").read_text())
    assert [(row["input"], row["label"]) for row in rows] == [("one.npy", "7"), ("two.npy", "7"), ("two.npy", "9")]
    run("tessellate", *names, "--out-dir", "strict", "-f", "npy", "--strict", "--keep-going", code=6)


@pytest.mark.parametrize("what", ["distance", "distance2", "labels,distance"])
def test_distances_to_nothing_do_not_exist(run, fields, what):
    words = "error: empty.npy: the image has no foreground"
    run(f"tessellate empty.npy --what {what} --out-dir out -f npy", code=3, says=words)
    assert not list(fields.rglob("out/*.npy"))


@pytest.mark.parametrize(
    "arguments",
    [
        ("delaunay", "--what", "cells", "-f", "geojson"),
        ("alphashape", "-r", "4", "--verify"),
        ("alphashape", "--what", "curves"),
        ("alphashape", "-f", "html"),
        ("skeleton-exact", "--what", "table", "--verify"),
        ("skeleton-exact", "--what", "centerline"),
        ("skeleton-approx", "--step", "1", "--verify"),
    ],
    ids=" ".join,
)
def test_what_follows_from_an_image_without_foreground_is_empty(run, fields, arguments):
    command, *options = arguments
    options += ["-o", "page.html"] if "html" in options else []
    done = run(command, "empty.npy", *options, "--stats", "stats.json")
    lines = done.err.splitlines()
    assert lines[0] == NO_FOREGROUND
    assert all(line.startswith("warning: ") for line in lines)
    assert lines[0].removeprefix("warning: ") in json.loads((fields / "stats.json").read_text())["warnings"]
    run(command, "empty.npy", *options, "--strict", code=3, says="the image has no foreground")
