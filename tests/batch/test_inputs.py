"""Which inputs names, folders, patterns and lists stand for."""

import io
import os
import socket
import sys

import pytest

from vorotool import InputError, UsageError
from vorotool.batch.inputs import Input, expand_inputs, is_several, read_names


@pytest.fixture
def folder(tmp_path, monkeypatch):
    for name in ("b/2.csv", "b/c/1.CSV", "a/1.csv", "a/.hidden.csv", ".git/x.csv", "a/notes.md", "out/1.csv", "z.csv"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("x")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def expanded(*names, **options):
    return [(each.source, each.name) for each in expand_inputs(names, extensions=["csv"], **options)]


def test_files_keep_their_names_and_the_order(folder):
    assert expanded("b/2.csv", "a/notes.md", "missing") == [
        *(("b/2.csv", "2.csv"), ("a/notes.md", "notes.md"), ("missing", "missing"))
    ]


def test_folders_are_searched_and_mirrored(folder):
    assert expanded("b", "a") == [("b/2.csv", "2.csv"), ("b/c/1.CSV", "c/1.CSV"), ("a/1.csv", "1.csv")]
    assert expanded(".", without="out") == [
        *(("a/1.csv", "a/1.csv"), ("b/2.csv", "b/2.csv"), ("b/c/1.CSV", "b/c/1.CSV"), ("z.csv", "z.csv"))
    ]
    assert ("out/1.csv", "out/1.csv") in expanded(".", without="elsewhere")


def test_links_to_folders_are_not_followed(folder):
    (folder / "a/back").symlink_to(folder)
    assert expanded("a") == [("a/1.csv", "1.csv")]


def test_patterns_are_matched_below_their_fixed_part(folder):
    assert expanded("*/1.csv") == [("a/1.csv", "a/1.csv"), ("out/1.csv", "out/1.csv")]
    assert expanded("b/**/*.[cC]*") == [("b/2.csv", "2.csv"), ("b/c/1.CSV", "c/1.CSV")]
    assert expanded("a/*") == [("a/1.csv", "1.csv"), ("a/notes.md", "notes.md")]
    (folder / "odd[1].csv").write_text("x")
    assert expanded("odd[1].csv") == [("odd[1].csv", "odd[1].csv")]


def test_what_stands_for_several(folder):
    (folder / "odd[1].csv").write_text("x")
    assert [is_several(name) for name in ("a", "*.csv", "odd[1].csv", "z.csv", "-", "", "missing")] == [
        *(True, True, False, False, False, False, False)
    ]


def test_nothing_is_said_in_words(folder):
    (folder / "empty").mkdir()
    for name, words in (("empty", "empty holds no file that is read here (csv)"), ("x*", "no file matches x*")):
        with pytest.raises(InputError) as caught:
            expanded(name)
        assert words in str(caught.value)
    with pytest.raises(UsageError, match="standard input"):
        expanded("a", "-")


def test_what_is_no_file_is_left_out_and_said(folder):
    os.mkfifo(folder / "a/0.csv")
    with socket.socket(socket.AF_UNIX) as bound:
        bound.bind("a/2.csv")
    (folder / "a/3.csv").symlink_to("/dev/null")
    words = ["a/0.csv is a pipe: left out", "a/2.csv is a socket: left out", "a/3.csv is a device: left out"]
    for name in ("a", "a/*.csv"):
        notes = []
        assert expanded(name, note=notes.append) == [("a/1.csv", "1.csv")]
        assert notes == words
    for name, kind in (("a/0.csv", "a pipe"), ("/dev/stdin", "an open descriptor")):
        with pytest.raises(UsageError, match=f"{name} is {kind}, which this process alone can read"):
            expanded(name, "b")


def test_a_list_that_comes_through_a_pipe(folder):
    reading, writing = os.pipe()
    os.write(writing, b"z.csv\n")
    os.close(writing)
    try:
        assert read_names(f"/dev/fd/{reading}") == ["z.csv"]
    finally:
        os.close(reading)


def test_a_folder_without_permission(folder, monkeypatch):
    def walk(path, onerror):
        onerror(PermissionError(13, "Permission denied", path))
        return iter(())

    monkeypatch.setattr("os.walk", walk)
    with pytest.raises(InputError, match="the folder a cannot be read: Permission denied"):
        expanded("a")


def test_lists_of_names(folder, monkeypatch):
    (folder / "list").write_bytes(b"a/1.csv\r\n\nb/2.csv")
    assert read_names("list") == ["a/1.csv", "b/2.csv"]
    (folder / "list0").write_bytes(b"two\nlines\0\xff.csv\0")
    assert read_names("list0", null=True) == ["two\nlines", "\udcff.csv"]
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(b"z.csv\n")))
    assert read_names("-") == ["z.csv"]
    with pytest.raises(InputError, match="the list missing cannot be read"):
        read_names("missing")
    with pytest.raises(InputError, match="give -0"):
        read_names("list0")
    assert expand_inputs(["z.csv"], extensions=[]) == [Input("z.csv", "z.csv")]
