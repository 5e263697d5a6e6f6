"""What one command writes to a pipe another reads from it: the same as through a file."""

import io
import shutil
import sys
from pathlib import Path

import pytest

from support.documents import DATA
from support.processes.ended import ended_bash

PIPELINES = {
    "table to Delaunay": ("tessellate six-seeds.csv --what table", "csv", "delaunay IN --columns x,y,label", "csv"),
    "labels to skeletons": ("tessellate six-seeds.csv", "tif", "skeleton-exact IN", "svg"),
    "labels to a picture": ("tessellate six-seeds.csv", "npy", "draw IN", "svg"),
    "shape to skeleton": ("alphashape dot-pattern.csv -r 10", "wkt", "skeleton-approx IN --step 4", "json"),
    "shape to cells": (
        *("alphashape dot-pattern.csv -r 10", "geojson"),
        *("delaunay dot-pattern.csv --what cells --clip IN", "geojson"),
    ),
    "points to tessellation": ("delaunay dots.csv --what table", "csv", "tessellate IN --size 300x300", "png"),
    "cells to skeletons": ("delaunay six-seeds.csv --what cells", "geojson", "skeleton-exact IN --what table", "csv"),
    "skeleton to a picture": ("skeleton-exact two-shapes.json", "json", "draw IN", "png"),
}


def expected(run, folder, name):
    """What a pipeline gives through a file."""
    first, between, second, fmt = PIPELINES[name]
    for file in ("six-seeds.csv", "dots.csv", "dot-pattern.csv", "blobs.png", "two-shapes.json"):
        shutil.copy(DATA / file, folder)
    run(first, "-q", "-o", f"between.{between}")
    run(*second.replace("IN", f"between.{between}").split(), "-q", "-o", f"expected.{fmt}")
    return Path(f"expected.{fmt}").read_bytes()


def commands(name):
    first, between, second, fmt = PIPELINES[name]
    between = {"tif": "tiff"}.get(between, between)
    return f"{first} -q -f {between} -o -", f"{second.replace('IN', '-')} -q -f {fmt} -o -"


@pytest.mark.parametrize("name", PIPELINES)
def test_a_stream_is_as_good_as_a_file(run, tmp_path, monkeypatch, name):
    wanted, data = expected(run, tmp_path, name), b""
    for command in commands(name):
        out = io.BytesIO()
        with monkeypatch.context() as patched:
            patched.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(data)))
            patched.setattr(sys, "stdout", io.TextIOWrapper(out))
            done = run(command)
            sys.stdout.detach()
        assert (done.code, done.err) == (0, "")
        data = out.getvalue()
    assert data == wanted
    assert len(data) > 100


@pytest.mark.parametrize("name", ["shape to cells"])
def test_a_pipe_is_as_good_as_a_file(run, tmp_path, name):
    wanted = expected(run, tmp_path, name)
    done = ended_bash("vorotool {} | vorotool {} > piped".format(*commands(name)), tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert Path("piped").read_bytes() == wanted
