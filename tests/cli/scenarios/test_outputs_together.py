"""All outputs of a run are replaced, or none is."""

import os

import pytest

from support.processes.leftovers import contents

SEVERAL = ("--what", "cells,triangles,table", "-o", "o.shp", "--stats", "s.json")
OUTPUTS = sorted(
    [f"o.{what}{part}" for what in ("cells", "triangles") for part in (".shp", ".shx", ".dbf", ".cpg")]
    + ["o.table.csv", "s.json"]
)


@pytest.fixture
def older(run, folder):
    assert run("delaunay", "dots.csv", *SEVERAL).code == 0
    assert sorted(set(contents(folder)) - {"dots.csv", "mask.pbm"}) == OUTPUTS
    (folder / "dots.csv").write_text("x,y\n2,1\n7,5\n1,6\n8,8\n")
    return folder


@pytest.mark.parametrize("refused", OUTPUTS)
def test_one_that_cannot_be_replaced_keeps_all(run, older, monkeypatch, refused):
    before, rename = contents(older), os.replace

    def refuse(source, target, **options):
        if os.fspath(target).endswith(f"/{refused}") and ".vorotool" in os.fspath(source):
            monkeypatch.undo()
            raise OSError(5, "broken")
        return rename(source, target, **options)

    monkeypatch.setattr(os, "replace", refuse)
    monkeypatch.chdir(older)
    done = run("delaunay", "dots.csv", *SEVERAL)
    assert done.code == 4
    assert refused in done.err
    assert contents(older) == before


def test_an_unwritable_place_of_the_statistics_keeps_the_results(run, older):
    before = contents(older)
    done = run("delaunay", "dots.csv", *SEVERAL[:-1], "/dev/full")
    assert done.code == 4
    assert "/dev/full" in done.err
    assert contents(older) == before


def test_an_input_whose_parts_have_other_letters_is_not_replaced(run, folder):
    assert run("delaunay", "dots.csv", "--what", "cells", "-o", "a.shp").code == 0
    for part in folder.glob("a.*"):
        part.rename(part.with_suffix(part.suffix.upper()))
    before = contents(folder)
    done = run("voronoi", "a.SHP", "-o", "a.shp")
    assert done.code == 2
    assert "a.SHP is also an input" in done.err
    assert contents(folder) == before


@pytest.mark.parametrize("older", ["a.shx", "a.PRJ", "a.qix"])
def test_no_clobber_holds_for_all_parts(run, folder, older):
    (folder / older).write_text("mine")
    before = contents(folder)
    done = run("delaunay", "dots.csv", "--what", "cells", "-o", "a.shp", "--no-clobber")
    assert done.code == 4
    assert older in done.err
    assert contents(folder) == before
