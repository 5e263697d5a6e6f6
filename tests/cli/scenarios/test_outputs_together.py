"""All outputs of a run are replaced, or none is."""

import os
import resource

import pytest

from support.processes.leftovers import contents

LIMIT = 10_000
"""Bytes that a file may have, as if the disk were full then."""

SEVERAL = ("--what", "cells,triangles,table", "-o", "o.shp", "--stats", "s.json")
OUTPUTS = sorted(
    [f"o.{what}{part}" for what in ("cells", "triangles") for part in (".shp", ".shx", ".dbf", ".cpg")]
    + ["o.table.csv", "s.json"]
)


@pytest.fixture
def older(run, folder):
    run("delaunay dots.csv", *SEVERAL)
    assert sorted(set(contents(folder)) - {"dots.csv", "mask.pbm"}) == OUTPUTS
    (folder / "dots.csv").write_text("x,y\n2,1\n7,5\n1,6\n8,8\n")
    return folder


@pytest.mark.parametrize("refused", OUTPUTS[::4])
def test_one_that_cannot_be_replaced_keeps_all(run, older, monkeypatch, refused):
    before, rename = contents(older), os.replace

    def refuse(source, target, **options):
        if os.fspath(target).endswith(f"/{refused}") and ".vorotool" in os.fspath(source):
            monkeypatch.undo()
            raise OSError(5, "broken")
        return rename(source, target, **options)

    monkeypatch.setattr(os, "replace", refuse)
    run("delaunay dots.csv", *SEVERAL, code=4, says=refused)
    assert contents(older) == before


def test_an_unwritable_place_of_the_statistics_keeps_the_results(run, older):
    before = contents(older)
    run("delaunay dots.csv", *SEVERAL[:-1], "/dev/full", code=4, says="/dev/full")
    assert contents(older) == before


def test_an_input_whose_parts_have_other_letters_is_not_replaced(run, folder):
    run("delaunay dots.csv --what cells -o a.shp")
    for part in folder.glob("a.*"):
        part.rename(part.with_suffix(part.suffix.upper()))
    before = contents(folder)
    run("voronoi a.SHP -o a.shp", code=2, says="a.SHP")
    assert contents(folder) == before


@pytest.mark.parametrize("older", ["a.shx", "a.PRJ"])
def test_no_clobber_holds_for_all_parts(run, folder, older):
    (folder / older).write_text("mine")
    before = contents(folder)
    run("delaunay dots.csv --what cells -o a.shp --no-clobber", code=4, says=older)
    assert contents(folder) == before


@pytest.mark.parametrize(("part", "is_device"), [(".shp", True), (".cpg", False)])
def test_no_part_of_a_shapefile_is_a_stream(run, folder, part, is_device):
    if is_device:
        (folder / f"a{part}").symlink_to(os.devnull)
    else:
        os.mkfifo(folder / f"a{part}")
    run("delaunay dots.csv --what cells -o a.shp", code=2, says=f"a{part}")
    assert [path.name for path in folder.glob("a.*")] == [f"a{part}"]


def test_two_results_are_not_links_to_one_file(run, folder):
    (folder / "one.csv").write_text("mine")
    for what in ("cells", "table"):
        (folder / f"a.{what}.csv").symlink_to("one.csv")
    run("delaunay dots.csv --what cells,table -o a.csv", code=2, says=["a.cells.csv", "a.table.csv"])
    assert (folder / "one.csv").read_text() == "mine"


@pytest.mark.parametrize("fmt", ["csv", "gpkg"])
def test_a_disk_that_is_full_keeps_the_older_outputs(run, folder, fmt):
    options = ("--what", "cells,table", "-o", f"o.{fmt}", "--stats", "s.json")
    assert run("delaunay dots.csv", *options).err == ""
    rows = "".join(f"{k},{k * k % 997}\n" for k in range(400))
    (folder / "more.csv").write_text(f"x,y\n{rows}")
    before = contents(folder)
    usual = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (LIMIT, usual[1]))
    try:
        run("delaunay more.csv", *options, code=4)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, usual)
    assert contents(folder) == before
