"""The Makefile of the documents: a first build, a build after a change, and one that fails."""

import os
import shutil

import pytest

from support.documents import ROOT
from support.processes.ended import ended

pytestmark = pytest.mark.skipif(shutil.which("make") is None, reason="make is not there")


@pytest.fixture
def make(tmp_path, warm):
    """Run make in a folder with two lists of points and a mask; gives what it has run, and the exit code."""
    for folder, names in (("points", ("six-seeds.csv", "dots.csv")), ("masks", ("blobs.png",))):
        (tmp_path / folder).mkdir()
        for name in names:
            shutil.copy(ROOT / "data" / name, tmp_path / folder)

    def run(*arguments):
        makefile = ROOT / "docs/pipeline/Makefile"
        done = ended("make", "-f", makefile, "-j", "2", "SIZE=400x400", *arguments, cwd=tmp_path, env=warm)
        commands = [line.split()[1:3] for line in done.stdout.splitlines() if line.startswith("vorotool ")]
        return sorted(commands), done.returncode, done.stderr

    return run


def test_only_what_has_changed_is_made_again(make, tmp_path):
    commands, code, messages = make()
    assert (len(commands), code, messages) == (11, 0, "")
    made = {path.name for path in (tmp_path / "out").iterdir()}
    assert {"dots.labels.png", "dots.table.csv", "six-seeds.shape.svg", "blobs.skeleton.svg", "widths.csv"} <= made
    assert make() == ([], 0, "")
    os.utime(tmp_path / "points/dots.csv", (2**32, 2**32))
    assert make("-n")[0] == [
        ["alphashape", "points/dots.csv"],
        ["draw", "out/dots.labels.png"],
        ["skeleton-exact", "out/dots.shape.geojson"],
        ["tessellate", "points/dots.csv"],
    ]


def test_a_list_that_is_damaged_leaves_no_half_result(make, tmp_path):
    targets = ["out/six-seeds.labels.png", "out/six-seeds.table.csv"]
    assert make(*targets)[1] == 0
    before = {path.name: path.read_bytes() for path in (tmp_path / "out").iterdir()}
    assert len(before) == 2
    (tmp_path / "points/six-seeds.csv").write_text("x,y\n1,2\n3\n")
    os.utime(tmp_path / "points/six-seeds.csv", (2**32, 2**32))
    _, code, messages = make(*targets)
    assert code == 2
    assert "points/six-seeds.csv, line 3" in messages
    for path in (tmp_path / "out").iterdir():
        assert path.read_bytes() == before[path.name]
