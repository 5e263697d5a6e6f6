"""Names of what is open already, or passes by once."""

import io
import os
import threading
import time

import pytest

from support.refusals import refused
from vorotool.formats.io.descriptors import (
    descriptor_of,
    input_identity,
    is_same_output,
    open_input,
    open_output_descriptor,
)


@pytest.mark.parametrize(
    ("name", "number"),
    [
        ("/dev/stdin", 0),
        ("/dev/stdout", 1),
        ("/dev/stderr", 2),
        ("/dev/fd/63", 63),
        ("/proc/self/fd/1", 1),
        ("/proc/thread-self/fd/1", 1),
        ("//dev/../dev//fd/7", 7),
        ("/dev/fd/", None),
        ("/dev/fd/x", None),
        ("/dev/fd/1/a", None),
        ("/dev/null", None),
        ("1", None),
        ("", None),
        ("a\0b", None),
        ("-", None),
    ],
)
def test_descriptors(name, number):
    assert descriptor_of(name) == number
    assert descriptor_of(name, of_others=True) is None


def test_links_to_descriptors(tmp_path, monkeypatch):
    (tmp_path / "one").symlink_to("/dev/stdout")
    (tmp_path / "two").symlink_to("one")
    (tmp_path / "loop").symlink_to("loop")
    monkeypatch.chdir(tmp_path)
    assert [descriptor_of(name) for name in ("one", "two", f"{tmp_path}/two", "loop")] == [1, 1, 1, None]
    assert descriptor_of(f"/proc/{os.getpid()}/fd/1") == 1
    assert descriptor_of(f"/proc/{os.getppid()}/fd/1") is None
    assert descriptor_of(f"/proc/{os.getppid()}/fd/1", of_others=True) == 1


def test_two_names_of_one_stream(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "link").symlink_to("pipe")
    names = [str(tmp_path / name) for name in ("pipe", "link")]
    assert input_identity(names[0]) == input_identity(names[1]) is not None
    assert is_same_output(*names)
    reading, writing = os.pipe()
    again = os.dup(reading)
    try:
        assert input_identity(f"/dev/fd/{reading}") == input_identity(f"/dev/fd/{again}")
        assert not is_same_output(f"/dev/fd/{reading}", f"/dev/fd/{again}")
    finally:
        for number in (reading, writing, again):
            os.close(number)
    assert input_identity("/dev/null") is None
    assert not is_same_output("/dev/null", "/dev/null")
    (tmp_path / "a").touch()
    (tmp_path / "b").hardlink_to(tmp_path / "a")
    assert is_same_output(str(tmp_path / "a"), str(tmp_path / "b"))
    assert is_same_output(str(tmp_path / "new"), f"{tmp_path}/./new")
    with (tmp_path / "a").open("wb") as out:
        assert is_same_output(f"/dev/fd/{out.fileno()}", str(tmp_path / "b"))


def test_a_file_is_read_from_where_it_stands(tmp_path):
    (tmp_path / "a").write_bytes(b"header\nrest")
    number = os.open(tmp_path / "a", os.O_RDONLY)
    try:
        assert os.read(number, 7) == b"header\n"
        with open_input(number) as file:
            assert file.read() == b"rest"
        assert os.read(number, 1) == b""
        refused(OSError, "Bad file descriptor: it is closed, or open for reading only", open_output_descriptor, number)
    finally:
        os.close(number)
    refused(OSError, "it is closed, or open for writing only", open_input, number)


@pytest.mark.parametrize("mode", [os.O_APPEND, 0])
def test_a_file_is_written_from_where_it_stands_and_never_sought(tmp_path, mode):
    (tmp_path / "a").write_bytes(b"header\n")
    number = os.open(tmp_path / "a", os.O_RDWR | mode)
    os.lseek(number, 0, os.SEEK_END)
    with open_output_descriptor(number) as out:
        assert not out.seekable()
        for function in (out.tell, lambda: out.seek(0)):
            refused(io.UnsupportedOperation, "", function)
        out.write(b"new\n")
    os.write(number, b"footer")
    os.close(number)
    assert (tmp_path / "a").read_bytes() == b"header\nnew\nfooter"


def test_pipes_that_do_not_wait_are_waited_for():
    reading, writing = os.pipe()
    data = bytes(range(256)) * 4096  # 16 times what a pipe holds
    os.set_blocking(reading, False)
    os.set_blocking(writing, False)

    def write():
        with open_output_descriptor(writing) as out:
            os.close(writing)
            for part in (data[:3], data[3:]):
                out.write(part)
                out.flush()
                time.sleep(0.05)

    writer = threading.Thread(target=write)
    writer.start()
    with open_input(reading) as file:
        assert file.read() == data
    writer.join(30)
    os.close(reading)
