"""Applications of dot patterns on the command line: proximity graphs, statistics of cells, persistence of regions."""

from pathlib import Path

import numpy as np

import vorotool

DATA = Path(__file__).parents[3] / "data"
DOTS = DATA / "dots.csv"


def test_persistence_is_that_of_the_library(run, folder):
    found = vorotool.persistence(vorotool.read(DOTS))
    done = run(f"alphashape {DOTS} --what persistence --verify")
    assert done.err == "note: 3 regions stand out, apart below r = 64.49413399086379\n"
    assert [float(row["birth"]) for row in done.rows] == found.birth.tolist()
    assert [row["into"] for row in done.rows] == [str(k + 1) if k >= 0 else "" for k in found.into.tolist()]
    assert run(f"alphashape {DOTS} --what persistence -o p.svg -q").err == ""
    assert (folder / "p.svg").read_text().count("<rect") == min(len(found), 40) + 1
    words = f"apart below r = {2 * found.apart_until!r}"
    scaled = run(f"alphashape {DOTS} --what persistence --pixel-size 2mm", says=words)
    assert [float(row["birth"]) for row in scaled.rows] == (2 * found.birth).tolist()


def test_one_cluster_and_none(run, folder):
    np.savetxt("dots.csv", np.random.default_rng(1).random((300, 2)), delimiter=",")
    assert run("alphashape dots.csv --what persistence").err == "note: 1 region stands out\n"
    Path("line.csv").write_text("0,0\n1,1\n2,2\n")
    done = run("alphashape line.csv --what persistence -f svg")
    assert done.err == "note: the shapes have no regions\n"
    assert "there are no regions" in done.out
