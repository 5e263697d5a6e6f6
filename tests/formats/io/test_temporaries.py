"""Temporaries of the dead are removed, those of the living and of other machines never."""

import errno
import fcntl
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from support.refusals import refused
from vorotool.errors import OutputError
from vorotool.formats.io import temporaries
from vorotool.formats.io.atomic_output import open_output
from vorotool.formats.io.temporaries import (
    new_file,
    new_folder,
    remove_left,
    tagged_temporaries,
    temporary_beside,
)
from vorotool.formats.zarr.store import open_store

BOOT, MACHINE = temporaries._host()
OTHER = 12 * "f"


@pytest.fixture(autouse=True)
def forget(monkeypatch):
    """As in a new process."""
    monkeypatch.setattr(temporaries, "_SEEN", set())


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def left(folder, host=BOOT + MACHINE, tag="", ending=".tmp", number=0, *, is_folder=False):
    """What somebody has left."""
    path = folder / f".vorotool-{host}{'-' * bool(host)}{tag}{number:016x}{ending}"
    if is_folder:
        (path / "c").mkdir(parents=True)
        (path / "c/0").write_text("chunk")
    else:
        path.write_text("half")
    return path


def write(path):
    with open_output(path) as out:
        out.write(b"new")


def write_store(path):
    with open_store(path) as folder:
        (folder / "zarr.json").write_text('{"node_type": "array"}')


@pytest.mark.parametrize("is_folder", [False, True])
@pytest.mark.parametrize("tag", ["", "0a1b2c3d-12-"])
@pytest.mark.parametrize("host", [BOOT + MACHINE, BOOT + OTHER, OTHER + MACHINE])
def test_those_of_the_dead_of_this_machine_are_removed(tmp_path, host, tag, is_folder):
    left(tmp_path, host, tag, is_folder=is_folder)
    write(tmp_path / "a.csv")
    assert names(tmp_path) == ["a.csv"]


@pytest.mark.parametrize("is_folder", [False, True])
@pytest.mark.parametrize("host", [OTHER + OTHER, 24 * "0", "", "0a1b2c3d-1", OTHER])
def test_those_of_whom_nothing_is_proved_stay(tmp_path, monkeypatch, host, is_folder):
    """Of other machines, of systems that do not know theirs, and of version 0.1.0."""
    monkeypatch.setattr(temporaries, "_host", lambda: (BOOT, "0" * 12))
    path = left(tmp_path, host, is_folder=is_folder)
    write(tmp_path / "a.csv")
    assert names(tmp_path) == [path.name, "a.csv"]


def test_other_things_stay(tmp_path):
    (tmp_path / "victim").write_text("x")
    start = f".vorotool-{BOOT}{MACHINE}-"
    os.mkfifo(tmp_path / f"{start}{0:016x}.tmp")
    (tmp_path / f"{start}{1:016x}.tmp").symlink_to("victim")
    for name in (f"{start}x.tmp", f"{start}{2:016x}", f"x{start}{2:016x}.tmp", f"{start}{2:016x}.tmp.bak"):
        (tmp_path / name).write_text("x")
    before = names(tmp_path)
    write(tmp_path / "a.csv")
    assert names(tmp_path) == [*before[:-1], "a.csv", *before[-1:]] or set(names(tmp_path)) == {*before, "a.csv"}
    assert (tmp_path / "victim").read_text() == "x"


@pytest.mark.parametrize("make", [new_file, new_folder])
def test_those_of_the_living_stay(tmp_path, make):
    with temporary_beside(tmp_path / "a", make) as temporary:
        for _ in range(3):
            remove_left([tmp_path])
        assert Path(temporary.path).exists()
        assert temporary.is_at(temporary.path)
    assert names(tmp_path) == []


@pytest.mark.parametrize("store", [False, True])
def test_a_killed_process(tmp_path, store):
    """While it writes nobody else takes its temporary; when it is dead the next one removes it."""
    write_one = write_store if store else write
    script = (
        "import sys, time\nfrom vorotool.formats.io.atomic_output import open_output\n"
        "from vorotool.formats.zarr.store import open_store\n"
        f"with {'open_store' if store else 'open_output'}('a'):\n    print(flush=True)\n    time.sleep(600)\n"
    )
    child = subprocess.Popen([sys.executable, "-c", script], cwd=tmp_path, stdout=subprocess.PIPE)
    assert child.stdout.readline() == b"\n"
    write_one(tmp_path / "b")
    begun = [name for name in names(tmp_path) if name != "b"]
    assert len(begun) == 1
    child.send_signal(signal.SIGKILL)
    child.communicate()
    assert begun[0] in names(tmp_path)
    temporaries._SEEN.clear()
    write_one(tmp_path / "b")
    assert names(tmp_path) == ["b"]


@pytest.mark.parametrize("make", [new_file, new_folder])
@pytest.mark.parametrize("steps", [1, 2])
def test_one_that_is_taken_for_a_dead_ones_before_it_is_locked(tmp_path, monkeypatch, make, steps):
    """Another process that looks just then removes it, or is about to: the next name is tried."""
    lock, seen = fcntl.flock, []

    def meanwhile(descriptor, operation):
        seen.append(descriptor)
        if len(seen) == 1:
            (path,) = tmp_path.iterdir()
            other = os.open(path, os.O_RDONLY)
            lock(other, fcntl.LOCK_EX)
            if steps == 2:
                temporaries._discard(str(path))
                os.close(other)
        return lock(descriptor, operation)

    monkeypatch.setattr(fcntl, "flock", meanwhile)
    with temporary_beside(tmp_path / "a", make) as temporary:
        assert temporary.is_at(temporary.path)
        assert len(seen) == 2
    assert names(tmp_path) == []


def test_a_folder_that_is_removed_before_it_is_opened(tmp_path, monkeypatch):
    real, times = os.open, []

    def vanish(path, *arguments, **options):
        if not times:
            times.append(Path(path).rmdir())
        return real(path, *arguments, **options)

    monkeypatch.setattr(os, "open", vanish)
    with temporary_beside(tmp_path / "a", new_folder) as temporary:
        assert temporary.is_at(temporary.path)
    assert names(tmp_path) == []


def test_a_file_system_without_locks(tmp_path, monkeypatch):
    """What cannot be proved dead later has no HOST in its name, and stays."""

    def refuse(*_):
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr("fcntl.flock", refuse)
    with tagged_temporaries("0a1b2c3d-1-"), temporary_beside(tmp_path / "a", new_file) as temporary:
        assert Path(temporary.path).name.startswith(".vorotool-0a1b2c3d-1-")
        assert Path(temporary.path).exists()
        remove_left([tmp_path])
        assert Path(temporary.path).exists()
    assert names(tmp_path) == []
    path = left(tmp_path)
    remove_left([tmp_path])
    assert names(tmp_path) == [path.name]


def test_those_of_one_batch_are_removed_wherever_they_were_written(tmp_path):
    for number, host in enumerate((BOOT + MACHINE, OTHER + OTHER, "")):
        left(tmp_path, host, "0a1b2c3d-1-", number=number)
        left(tmp_path, host, "0a1b2c3d-12-", number=number)
        left(tmp_path, host, "1a1b2c3d-1-", number=number)
    remove_left([tmp_path, tmp_path / "missing"], "0a1b2c3d-1-")
    assert sum("0a1b2c3d-12-" in name for name in names(tmp_path)) == 3
    remove_left([tmp_path], "0a1b2c3d-")
    assert len(names(tmp_path)) == 3
    assert all("-1a1b2c3d-" in name for name in names(tmp_path))


def test_a_file_that_was_removed_meanwhile_is_an_error(tmp_path):
    def lose():
        with open_output(tmp_path / "a") as out:
            out.write(b"new")
            next(tmp_path.iterdir()).unlink()

    refused(OutputError, "cannot be written", lose)
    assert names(tmp_path) == []


def test_the_lock_is_held_until_the_file_has_its_name(tmp_path, monkeypatch):
    """Between the last byte and the renaming another process may look."""
    replace = os.replace

    def look(path, target):
        remove_left([tmp_path])
        replace(path, target)

    monkeypatch.setattr(os, "replace", look)
    write(tmp_path / "a.csv")
    assert names(tmp_path) == ["a.csv"]


def test_an_interrupt_while_it_is_removed_has_to_wait(tmp_path, monkeypatch):
    discard, times = temporaries._discard, []

    def interrupted(path):
        times.append(path)
        if len(times) == 1:
            raise KeyboardInterrupt
        discard(path)

    def fail():
        with temporary_beside(tmp_path / "a", new_folder):
            raise ValueError

    monkeypatch.setattr(temporaries, "_discard", interrupted)
    refused(KeyboardInterrupt, "", fail)
    assert names(tmp_path) == []
