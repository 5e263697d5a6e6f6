"""Reading inputs whole, and counting brackets before a parser sees them."""

import json
import os
import sys

import pytest

from support.readers.sources import bands_of
from support.refusals import refused
from vorotool.batch.workers import digest_of
from vorotool.errors import InputError
from vorotool.formats.io.sources import Source, check_nesting, read_source


def error_of(function, *arguments, **options):
    return refused(InputError, "", function, *arguments, **options)


def test_a_file(tmp_path):
    path = tmp_path / "seeds.CSV"
    path.write_bytes(b"1,2\n")
    assert read_source(path) == Source(str(path), b"1,2\n")
    assert read_source(str(path)).suffix == ".csv"


def test_closed_standard_input(monkeypatch):
    monkeypatch.setattr(sys, "stdin", None)
    assert "standard input" in error_of(read_source, "-")


def test_what_is_open_already_is_read_from_where_it_stands(tmp_path):
    (tmp_path / "seeds.csv").write_bytes(b"x,y\n1,2\n")
    with (tmp_path / "seeds.csv").open("rb", buffering=0) as file:
        file.read(4)
        name = f"/dev/fd/{file.fileno()}"
        assert read_source(name) == Source(name, b"1,2\n")
        assert read_source(name) == Source(name, b"")
    assert error_of(read_source, name).startswith(name)


def test_what_is_in_the_buffer_of_standard_input_is_read_too(tmp_path, monkeypatch):
    (tmp_path / "seeds.csv").write_bytes(b"x,y\n1,2\n")
    with (tmp_path / "seeds.csv").open() as file:
        monkeypatch.setattr(sys, "stdin", file)
        assert file.buffer.peek(4).startswith(b"x,y")
        assert read_source(f"/dev/fd/{file.fileno()}").data == b"x,y\n1,2\n"


@pytest.mark.parametrize("input_format", [None, "tiff"])
def test_a_pipe_is_not_opened_to_look_at_it(tmp_path, input_format):
    os.mkfifo(tmp_path / "image.tif")
    assert bands_of(tmp_path / "image.tif", input_format=input_format) is None  # else it waits for a writer
    assert digest_of(str(tmp_path / "image.tif")) == ""


def test_a_directory(tmp_path):
    assert str(tmp_path) in error_of(read_source, tmp_path)


@pytest.mark.parametrize("name", ["a\0b", "x" * 5000])
def test_an_impossible_name(name):
    assert name[0] in error_of(read_source, name)


def test_an_empty_name():
    assert error_of(read_source, "")


def test_a_file_that_is_not_ours_to_read(tmp_path):
    path = tmp_path / "seeds.csv"
    path.write_bytes(b"1,2\n")
    path.chmod(0)
    try:
        path.read_bytes()
    except PermissionError:
        assert str(path) in error_of(read_source, path)


@pytest.mark.parametrize("text", ["[" * 100 + "]" * 100, json.dumps({"a": "[[" * 200}), "POINT (1 2)" * 500])
def test_nesting_that_is_accepted(text):
    check_nesting(text)
    check_nesting(text.encode())


@pytest.mark.parametrize("bracket", ["(", "[", "{", '[{"a":'])
def test_nesting_that_is_refused(bracket):
    message = error_of(check_nesting, "\n\n" + bracket * 100000, name="deep.json")
    assert message.startswith("deep.json, line 3: ")
    assert "5" in error_of(check_nesting, b"[" * 6, 5)
