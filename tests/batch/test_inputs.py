"""Which inputs names, folders, patterns and lists stand for."""

import gzip
import io
import os
import socket
import sys

import pytest

from support.refusals import refused
from vorotool import InputError, UsageError
from vorotool.batch.inputs import Input, expand_inputs, read_names
from vorotool.jobs.inputs import is_several


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
    found = expanded("b/2.csv", "a/notes.md", "missing")
    assert found == [("b/2.csv", "2.csv"), ("a/notes.md", "notes.md"), ("missing", "missing")]


def test_folders_are_searched_and_mirrored(folder):
    assert expanded("b", "a") == [("b/2.csv", "2.csv"), ("b/c/1.CSV", "c/1.CSV"), ("a/1.csv", "1.csv")]
    assert expanded(".", without="out") == [(name, name) for name in ("a/1.csv", "b/2.csv", "b/c/1.CSV", "z.csv")]
    assert ("out/1.csv", "out/1.csv") in expanded(".", without="elsewhere")


LINKED = [("a/1.csv", "1.csv"), ("a/elsewhere/b/2.csv", "elsewhere/b/2.csv")]


@pytest.fixture
def linked(folder):
    """Links to the folder that they are in, to each other, to files, and to a folder elsewhere."""
    for name, target in (("back", "."), ("top", "../a"), ("self", "self"), ("elsewhere", "../.elsewhere")):
        (folder / "a" / name).symlink_to(target)
    elsewhere = folder / ".elsewhere"
    (elsewhere / "b").mkdir(parents=True)
    (elsewhere / "b/2.csv").write_text("x")
    (elsewhere / "again").symlink_to(folder / "a")
    return folder


@pytest.mark.parametrize("name", ["a", "a/**/*.csv", "a/**/**/[!n]*.csv"])
def test_links_to_folders_are_followed_on_request_each_folder_once(linked, name):
    notes = []
    assert expanded(name, note=notes.append) == LINKED[:1]
    said = " ".join(notes)
    assert "3 links" in said
    assert all(f"a/{each}" in said for each in ("back", "top", "elsewhere"))
    assert expanded(name, follow=True) == LINKED


def test_a_link_that_is_named_is_followed(linked):
    found = expanded("a/elsewhere", "a/elsewhere/b/*.csv")
    assert found == [("a/elsewhere/b/2.csv", "b/2.csv"), ("a/elsewhere/b/2.csv", "2.csv")]


def test_a_pattern_for_folders_matches_links_on_request(linked):
    notes = []
    refused(InputError, "3 links to folders", expanded, "a/*/b/*.csv", note=notes.append)
    assert expanded("a/*/b/*.csv", follow=True) == LINKED[1:]


def test_links_to_files_are_followed(linked):
    (linked / "a/3.csv").symlink_to("../b/2.csv")
    assert expanded("a") == [*LINKED[:1], ("a/3.csv", "3.csv")]


def test_many_links_between_folders_take_no_time(folder):
    for number in range(30):
        place = folder / f"deep/{number}"
        place.mkdir(parents=True)
        (place / "0.csv").write_text("x")
        for other in range(30):
            (place / f"to{other}").symlink_to(f"../{other}")
    for name in ("deep", "deep/**/*.csv"):
        assert len(expanded(name, follow=True)) == 30


@pytest.mark.parametrize(
    ("text", "is_read"),
    [
        ("1 2\n3 4\n", True),
        ("x;y;name\n1,5;2,5;a\n", True),
        ("# dots of a microscope, version 3\n1\t2\n", True),
        ("a 1 2\nb -.5 1e3\n", True),
        ("POLYGON ((0 0, 1 0, 1 1, 0 0))\n", True),
        ('[{"x": 1, "y": 2}]', True),
        ("", True),
        ("Dots of 12 fields.\n\nTaken on 2024-05-01 by nobody.\nSee the paper.\n", False),
        ("BSD 3-Clause License\n\nCopyright 2020\n", False),
        ("\0\1\2", False),
    ],
)
def test_text_in_folders_is_read_where_it_holds_numbers_or_geometry(folder, text, is_read):
    (folder / "b/readme.txt").write_text(text)
    notes = []
    found = expand_inputs(["b"], extensions=["csv", "txt"], note=notes.append)
    assert ("readme.txt" in [each.name for each in found]) is is_read
    assert any("b/readme.txt" in note for note in notes) is not is_read


def test_packed_text_in_folders_is_told_apart_as_other_text_is(folder):
    for name, text in (("readme", b"Dots of 12 fields.\n\nTaken on a Monday.\n"), ("dots", b"1 2\n3 4\n")):
        (folder / f"b/{name}.txt.gz").write_bytes(gzip.compress(text))
    (folder / "b/torn.txt.gz").write_bytes(gzip.compress(b"Dots of 12 fields.\n")[:8])  # whoever reads it says so
    found = expand_inputs(["b"], extensions=["csv", "txt"])
    assert [each.name for each in found] == ["2.csv", "c/1.CSV", "dots.txt.gz", "torn.txt.gz"]


def test_files_that_are_not_read_are_said_with_a_count_but_not_companions(folder):
    for name in ("b/2.prj", "b/2.csv.aux.xml", "b/.hidden", "b/x.manifest.jsonl", *(f"b/c/{i}.pdf" for i in range(11))):
        (folder / name).write_text("x")
    (folder / "b/c/1.CSV").rename(folder / "b/c/z.CSV")
    notes = []
    assert expanded("b", note=notes.append) == [("b/2.csv", "2.csv"), ("b/c/z.CSV", "c/z.CSV")]
    (note,) = notes
    assert "11 files" in note
    assert "b/c/0.pdf" in note
    assert "prj" not in note
    assert "xml" not in note


def test_patterns_are_matched_below_their_fixed_part(folder):
    assert expanded("*/1.csv") == [("a/1.csv", "a/1.csv"), ("out/1.csv", "out/1.csv")]
    assert expanded("b/**/*.[cC]*") == [("b/2.csv", "2.csv"), ("b/c/1.CSV", "c/1.CSV")]
    assert expanded("a/*") == [("a/1.csv", "1.csv"), ("a/notes.md", "notes.md")]
    (folder / "odd[1].csv").write_text("x")
    assert expanded("odd[1].csv") == [("odd[1].csv", "odd[1].csv")]


def test_what_stands_for_several(folder):
    (folder / "odd[1].csv").write_text("x")
    names = ("a", "*.csv", "odd[1].csv", "z.csv", "-", "", "missing")
    assert [name for name in names if is_several(name)] == ["a", "*.csv"]


def test_nothing_is_said_in_words(folder):
    (folder / "empty").mkdir()
    for name, words in (("empty", "empty holds no file in a supported format (csv)"), ("x*", "no file matches x*")):
        refused(InputError, words, expanded, name)
    refused(UsageError, "standard input", expanded, "a", "-")


def test_what_is_no_file_is_left_out_and_said(folder):
    os.mkfifo(folder / "a/0.csv")
    with socket.socket(socket.AF_UNIX) as bound:
        bound.bind("a/2.csv")
    (folder / "a/3.csv").symlink_to("/dev/null")
    words = ["a/0.csv is a pipe: skipped", "a/2.csv is a socket: skipped", "a/3.csv is a device: skipped"]
    for name in ("a", "a/*.csv"):
        notes = []
        assert expanded(name, note=notes.append) == [("a/1.csv", "1.csv")]
        assert notes[:3] == words
    for name in ("a/0.csv", "/dev/stdin"):
        refused(UsageError, name, expanded, name, "b")


def test_a_list_that_comes_through_a_pipe(folder):
    reading, writing = os.pipe()
    os.write(writing, b"z.csv\n")
    os.close(writing)
    try:
        assert read_names(f"/dev/fd/{reading}") == ["z.csv"]
    finally:
        os.close(reading)


def test_a_folder_without_permission(folder, monkeypatch):
    def listdir(path):
        raise PermissionError(13, "Permission denied", path)

    monkeypatch.setattr("os.listdir", listdir)
    refused(InputError, "the folder a cannot be read: Permission denied", expanded, "a")


def test_lists_of_names(folder, monkeypatch):
    (folder / "list").write_bytes(b"a/1.csv\r\n\nb/2.csv")
    assert read_names("list") == ["a/1.csv", "b/2.csv"]
    (folder / "list0").write_bytes(b"two\nlines\0\xff.csv\0")
    assert read_names("list0", null=True) == ["two\nlines", "\udcff.csv"]
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(b"z.csv\n")))
    assert read_names("-") == ["z.csv"]
    refused(InputError, "the list missing cannot be read", read_names, "missing")
    refused(InputError, "give -0", read_names, "list0")
    assert expand_inputs(["z.csv"], extensions=[]) == [Input("z.csv", "z.csv")]
