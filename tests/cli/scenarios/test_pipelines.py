"""What one command writes to a pipe another reads from it: the same as through a file."""

import shutil
from pathlib import Path

import pytest

from support.processes.ended import ended_bash

DATA = Path(__file__).parents[3] / "data"

PIPELINES = {
    "table to Delaunay": ("tessellate six-seeds.csv --what table", "csv", "delaunay IN --columns x,y,label", "csv"),
    "labels to cells": ("tessellate blobs.png", "png", "delaunay IN --what cells", "geojson"),
    "labels to skeletons": ("tessellate six-seeds.csv", "tif", "skeleton-exact IN", "svg"),
    "labels to a picture": ("tessellate six-seeds.csv", "npy", "draw IN", "svg"),
    "shape to exact skeleton": ("alphashape dot-pattern.csv -r 10", "geojson", "skeleton-exact IN", "svg"),
    "shape to skeleton": ("alphashape dot-pattern.csv -r 10", "wkt", "skeleton-approx IN --step 4", "json"),
    "shape to cells": (
        *("alphashape dot-pattern.csv -r 10", "geojson"),
        *("delaunay dot-pattern.csv --what cells --clip IN", "geojson"),
    ),
    "points to tessellation": ("delaunay dots.csv --what table", "csv", "tessellate IN --size 300x300", "png"),
    "cells to skeletons": ("delaunay six-seeds.csv --what cells", "geojson", "skeleton-exact IN --what table", "csv"),
    "skeleton to a picture": ("skeleton-exact two-shapes.json", "json", "draw IN", "png"),
}


@pytest.mark.parametrize("name", PIPELINES)
def test_a_pipe_is_as_good_as_a_file(run, tmp_path, name):
    first, between, second, fmt = PIPELINES[name]
    for file in ("six-seeds.csv", "dots.csv", "dot-pattern.csv", "blobs.png", "two-shapes.json"):
        shutil.copy(DATA / file, tmp_path)
    assert run(*first.split(), "-q", "-o", f"between.{between}").code == 0
    assert run(*second.replace("IN", f"between.{between}").split(), "-q", "-o", f"expected.{fmt}").code == 0
    forms = {"tif": "tiff"}
    command = (
        f"vorotool {first} -q -f {forms.get(between, between)} -o - | "
        f"vorotool {second.replace('IN', '-')} -q -f {fmt} -o - > piped"
    )
    done = ended_bash(command, tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert Path("piped").read_bytes() == Path(f"expected.{fmt}").read_bytes()
    assert Path("piped").stat().st_size > 100
