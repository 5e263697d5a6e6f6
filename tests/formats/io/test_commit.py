"""Outputs that belong together take their places together, or none of them does."""

import errno
import os
import signal
from functools import partial
from pathlib import Path

import pytest

from support.few import few
from support.processes.ended import ended_python
from support.processes.leftovers import contents
from support.refusals import refused
from vorotool.errors import OutputError
from vorotool.formats.io import temporaries
from vorotool.formats.io.atomic_output import explained, open_output
from vorotool.formats.io.temporaries import Placement, committed_together
from vorotool.formats.zarr.store import open_store

OUTPUTS = ("a.shp", "b.zarr", "sub/c.dbf", "new.csv")


@pytest.fixture
def folder(tmp_path):
    """Older outputs, one of which is a store and one of which is going to be removed."""
    (tmp_path / "sub").mkdir()
    for name in ("a.shp", "sub/c.dbf", "sub/gone.qix"):
        (tmp_path / name).write_text(f"old {name}")
    write_store(tmp_path / "b.zarr", "old")
    return tmp_path


def write_store(path, text):
    with open_store(path) as store:
        (store / "zarr.json").write_text('{"node_type": "array"}')
        (store / text).write_text(text)


def write_file(path, text):
    with open_output(path) as out:
        out.write(text.encode())


def write_all(folder, *, last=lambda: None):
    """Replace all, write a new one, and remove one."""
    with committed_together() as commit:
        gone = str(folder / "sub/gone.qix")
        commit.placements[gone] = Placement(None, partial(explained, gone))
        for name in OUTPUTS:
            if name.endswith(".zarr"):
                write_store(folder / name, "new")
            else:
                write_file(folder / name, f"new {name}")
        last()


WRITTEN = {
    "a.shp": b"new a.shp",
    "b.zarr/new": b"new",
    "b.zarr/zarr.json": b'{"node_type": "array"}',
    "new.csv": b"new new.csv",
    "sub/c.dbf": b"new sub/c.dbf",
}


class Failing:
    """Counts the steps of commits, and raises something before or after one of them."""

    def __init__(self, monkeypatch, at, error, *, after, links=True, exchanges=True):
        self.count, self.at, self.error, self.after = 0, at, error, after
        for name in ("rename", "replace", "link"):
            self.wrap(monkeypatch, os, name)
        if not links:
            monkeypatch.setattr(os, "link", refuse)
        if not exchanges:
            monkeypatch.setattr(temporaries, "_exchange", lambda one, other: False)

    def wrap(self, monkeypatch, owner, name):
        function = getattr(owner, name)

        def call(*arguments):
            number, self.count = self.count, self.count + 1
            if number == self.at and not self.after:
                raise self.error
            result = function(*arguments)
            if number == self.at:
                raise self.error
            return result

        monkeypatch.setattr(owner, name, call)


def failure_of(folder):
    try:
        write_all(folder)
    except (OutputError, KeyboardInterrupt) as error:
        return error
    return None


def refuse(*_):
    raise OSError(errno.EPERM, "no such links here")


@pytest.mark.parametrize("kind", few([OSError, KeyboardInterrupt], 1))
@pytest.mark.parametrize("links", [True, False])
@pytest.mark.parametrize("after", [True, False])
@pytest.mark.parametrize("at", range(8))
def test_one_that_fails_brings_all_back(folder, monkeypatch, at, after, links, kind):
    before = contents(folder)
    error = OSError(errno.EIO, "broken") if kind is OSError else kind()
    with monkeypatch.context() as patches:
        steps = Failing(patches, at, error, after=after, links=links)
        failed = failure_of(folder)
    if failed is None:  # a link that cannot be made is a rename
        assert kind is OSError
        assert contents(folder) == WRITTEN
        return
    assert isinstance(failed, OutputError if kind is OSError else KeyboardInterrupt)
    assert ("broken" in str(failed)) == (kind is OSError)
    assert steps.count > at
    assert contents(folder) == before


def test_an_error_while_the_last_is_written_replaces_none(folder):
    before = contents(folder)

    def fail():
        raise OutputError("full")

    refused(OutputError, "full", write_all, folder, last=fail)
    assert contents(folder) == before


def test_what_comes_meanwhile_stays(folder):
    def come():
        with committed_together():
            write_file(folder / "a.shp", "new")
            with open_output(folder / "late.csv", no_clobber=True):
                (folder / "late.csv").write_text("mine")

    before = contents(folder)
    refused(OutputError, r"late\.csv already exists", come)
    assert contents(folder) == before | {"late.csv": b"mine"}


def test_a_folder_in_the_place_of_a_file_stays(folder):
    def come():
        with committed_together():
            write_file(folder / "new.csv", "new")
            write_file(folder / "a.shp", "new")
            (folder / "new.csv").mkdir()
            (folder / "new.csv/mine").write_text("mine")

    before = contents(folder)
    refused(OutputError, r"new\.csv", come)
    assert contents(folder) == before | {"new.csv/mine": b"mine"}


def test_permissions_are_those_of_the_older_files_after_a_failure_too(folder, monkeypatch):
    (folder / "a.shp").chmod(0o604)
    number = (folder / "a.shp").stat().st_ino
    replace = os.replace

    def fail(path, target):
        if Path(target).name == "new.csv":
            raise OSError(errno.EIO, "broken")
        replace(path, target)

    monkeypatch.setattr(os, "replace", fail)
    refused(OutputError, "", write_all, folder)
    assert ((folder / "a.shp").stat().st_ino, (folder / "a.shp").stat().st_mode & 0o777) == (number, 0o604)


@pytest.mark.parametrize("at", few((1, 3, 0, 2), 2))
def test_after_a_kill_between_two_renames_each_is_old_or_new(folder, at):
    before = contents(folder)
    script = (
        "import os, signal, sys\n"
        "from pathlib import Path\n"
        "sys.path.insert(0, sys.argv[1])\n"
        "from formats.io.test_commit import write_all\n"
        "count, replace = [], os.replace\n"
        "def move(path, target):\n"
        "    if len(count) == int(sys.argv[2]):\n"
        "        os.kill(os.getpid(), signal.SIGKILL)\n"
        "    count.append(target)\n"
        "    replace(path, target)\n"
        "os.replace = move\n"
        "write_all(Path())\n"
    )
    tests = str(Path(__file__).parents[2])
    done = ended_python("-c", script, tests, at, cwd=folder)
    assert done.returncode == -signal.SIGKILL
    for place in ("next.csv", "sub/next.csv"):
        line = f"from formats.io.test_commit import *; write_file({place!r}, 'next')"
        ended_python("-c", line, cwd=folder, env=os.environ | {"PYTHONPATH": tests}, check=True)
    held = contents(folder)
    assert not [name for name in held if ".vorotool" in name]
    for name in ("a.shp", "sub/c.dbf"):
        assert held[name] in (before[name], WRITTEN[name])
    assert ("b.zarr/old" in held) != ("b.zarr/new" in held)
