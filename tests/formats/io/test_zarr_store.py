"""Stores appear whole or not at all, and replace nothing but stores."""

import os
import signal

import pytest

from support.processes.ended import ended_python
from support.refusals import refused
from vorotool.errors import OutputError, UsageError
from vorotool.formats.zarr.store import check_store, is_array, is_store, open_store


def make(folder, text, kind="array"):
    folder.mkdir()
    (folder / "zarr.json").write_text(f'{{"node_type": "{kind}", "text": "{text}"}}')
    return folder


def write(path, text, **options):
    with open_store(path, **options) as folder:
        (folder / "c").mkdir()
        (folder / "zarr.json").write_text(f'{{"node_type": "array", "text": "{text}"}}')


def names(folder):
    return [path.name for path in folder.iterdir()]


def text_of(folder):
    return (folder / "zarr.json").read_text()


def test_a_store_is_told_from_other_folders(tmp_path):
    assert not is_store(tmp_path)
    assert not is_array(tmp_path)
    group = make(tmp_path / "group", "", "group")
    assert is_store(group)
    assert not is_array(group)
    assert is_array(make(tmp_path / "array", ""))
    (tmp_path / "zarr.json").write_text("[")
    assert is_store(tmp_path)
    assert not is_array(tmp_path)


@pytest.mark.parametrize("failure", [KeyboardInterrupt(), ValueError(), OSError(28, "No space left on device")])
def test_a_failure_leaves_nothing_behind(tmp_path, failure):
    old = make(tmp_path / "a.zarr", "old")

    def fail():
        with open_store(old) as folder:
            (folder / "c").mkdir()
            (folder / "c/0").write_text("chunk")
            raise failure

    refused((type(failure), OutputError), "", fail)
    assert "old" in text_of(old)
    assert names(tmp_path) == ["a.zarr"]


def test_the_older_store_comes_back_when_the_new_one_cannot_move_in(tmp_path):
    old = make(tmp_path / "a.zarr", "old")
    with pytest.raises(OutputError, match=r"a\.zarr"), open_store(old) as folder:
        folder.rmdir()
    assert "old" in text_of(old)
    assert names(tmp_path) == ["a.zarr"]


def test_what_is_not_replaced(tmp_path):
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").write_text("")
    group = make(tmp_path / "group", "", "group")
    array = make(tmp_path / "array", "")
    for path in (tmp_path / "folder", tmp_path / "file", group):
        refused(OutputError, "is not a Zarr array", check_store, path)
    refused(OutputError, "no_clobber", check_store, array, no_clobber=True)
    for source in (array, array / "c" / "0"):
        refused(UsageError, "also an input", check_store, array, inputs=[source])
    refused(OutputError, "create the directory first", check_store, tmp_path / "none" / "a.zarr")
    assert check_store(tmp_path / "none" / "a.zarr", makes_folder=True).endswith("a.zarr")
    refused(UsageError, "standard output", check_store, "-")


def test_a_link_to_a_store_stays_a_link(tmp_path):
    old = make(tmp_path / "a.zarr", "old")
    (tmp_path / "link.zarr").symlink_to(old)
    write(tmp_path / "link.zarr", "new")
    assert (tmp_path / "link.zarr").is_symlink()
    assert "new" in text_of(old)


def test_one_that_comes_meanwhile_is_not_clobbered(tmp_path):
    with pytest.raises(OutputError, match="no_clobber"), open_store(tmp_path / "a.zarr", no_clobber=True):
        make(tmp_path / "a.zarr", "other")
    assert "other" in text_of(tmp_path / "a.zarr")
    assert names(tmp_path) == ["a.zarr"]


@pytest.mark.parametrize("can_exchange", [True, False])
def test_an_older_store_with_and_without_exchange(tmp_path, monkeypatch, can_exchange):
    if not can_exchange:
        monkeypatch.setattr("vorotool.formats.io.temporaries._exchange", lambda one, other: False)
    old = make(tmp_path / "a.zarr", "old")
    (old / "chunk").write_text("old")
    write(old, "new")
    assert "new" in text_of(old)
    assert names(tmp_path) == ["a.zarr"]
    assert names(old) == ["c", "zarr.json"] or names(old) == ["zarr.json", "c"]


def test_the_older_store_comes_back_after_an_interrupt_between_the_moves(tmp_path, monkeypatch):
    old = make(tmp_path / "a.zarr", "old")
    monkeypatch.setattr("vorotool.formats.io.temporaries._exchange", lambda one, other: False)

    replace = os.replace

    def interrupt(path, target):
        assert not old.exists()
        if path.endswith(".tmp"):
            raise KeyboardInterrupt
        replace(path, target)

    monkeypatch.setattr(os, "replace", interrupt)
    refused(KeyboardInterrupt, "", write, old, "new")
    assert "old" in text_of(old)
    assert names(tmp_path) == ["a.zarr"]


def test_the_older_store_comes_back_after_a_kill_between_the_moves(tmp_path):
    old = make(tmp_path / "a.zarr", "old")
    script = (
        "import os, signal\nfrom vorotool.formats.io import temporaries\n"
        "from vorotool.formats.zarr import store as stores\n"
        "temporaries._exchange = lambda one, other: False\n"
        "os.replace = lambda path, target: os.kill(os.getpid(), signal.SIGKILL)\n"
        "with stores.open_store('a.zarr') as folder:\n    (folder / 'zarr.json').write_text('{}')\n"
    )
    assert ended_python("-c", script, cwd=tmp_path).returncode == -signal.SIGKILL
    assert not old.exists()
    write(tmp_path / "b.zarr", "other")
    assert "old" in text_of(old)
    assert sorted(names(tmp_path)) == ["a.zarr", "b.zarr"]


@pytest.mark.parametrize("kind", ["folder", "file"])
def test_what_comes_meanwhile_and_is_no_store_stays(tmp_path, kind):
    def come():
        with open_store(tmp_path / "a.zarr"):
            (tmp_path / "a.zarr").mkdir() if kind == "folder" else (tmp_path / "a.zarr").write_text("mine")

    refused(OutputError, "is not a Zarr array", come)
    assert names(tmp_path) == ["a.zarr"]
    assert (tmp_path / "a.zarr").is_dir() == (kind == "folder")
