"""Outputs appear whole or not at all, and never replace an input."""

import errno
import io
import os
import stat
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from support.refusals import refused
from vorotool.errors import OutputError, UsageError
from vorotool.formats.io.atomic_output import check_output, open_output
from vorotool.formats.zarr.store import check_store


def write(path, data=b"new", **options):
    with open_output(path, **options) as out:
        out.write(data)


def files_in(directory):
    return sorted(path.name for path in directory.iterdir())


def error_of(kind, path, **options):
    return refused(kind, "", write, path, **options)


@pytest.fixture
def old(tmp_path):
    path = tmp_path / "out.csv"
    path.write_bytes(b"old")
    return path


def test_a_new_file_has_the_permissions_of_the_umask(tmp_path):
    umask = os.umask(0o027)
    try:
        write(tmp_path / "out.csv")
    finally:
        os.umask(umask)
    assert (tmp_path / "out.csv").read_bytes() == b"new"
    assert stat.S_IMODE((tmp_path / "out.csv").stat().st_mode) == 0o640
    assert files_in(tmp_path) == ["out.csv"]


def test_a_replaced_file_keeps_its_permissions(old):
    old.chmod(0o604)
    write(old)
    assert old.read_bytes() == b"new"
    assert stat.S_IMODE(old.stat().st_mode) == 0o604


def test_the_old_file_stays_until_the_end(old):
    with open_output(old) as out:
        out.write(b"...")
        out.seek(0)
        out.write(b"new")
        out.flush()
        out.seek(0)
        assert (out.read(), old.read_bytes()) == (b"new", b"old")
    assert old.read_bytes() == b"new"


def fail_halfway(path, failure):
    with open_output(path) as out:
        out.write(b"half")
        raise failure


FULL = OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


@pytest.mark.parametrize(
    "failure", [ValueError(), KeyboardInterrupt(), SystemExit(), BrokenPipeError(), FULL], ids=repr
)
def test_a_failure_leaves_nothing_behind(old, failure):
    kind, words = (OutputError, f"{old}.*{FULL.strerror}") if failure is FULL else (type(failure), "")
    refused(kind, words, fail_halfway, old, failure)
    assert old.read_bytes() == b"old"
    assert files_in(old.parent) == ["out.csv"]


def test_a_link_stays_a_link(old):
    link = old.with_name("link.csv")
    link.symlink_to(old)
    write(link)
    assert link.is_symlink()
    assert old.read_bytes() == b"new"


@pytest.mark.parametrize("name", [".", "sub/"])
def test_a_directory(tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    assert repr(name) in error_of(OutputError, name)


def test_an_impossible_name(tmp_path):
    assert "the name of the output is empty" in error_of(OutputError, "")
    assert error_of(OutputError, tmp_path / ("x" * 300)).count("x" * 300) == 1
    assert repr("a\0b") in error_of(OutputError, "a\0b")
    assert files_in(tmp_path) == []


def test_an_unwritable_directory():
    assert "cannot be written" in error_of(OutputError, "/proc/out.csv")


def test_a_write_protected_file(old, monkeypatch):
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    assert "write-protected" in error_of(OutputError, old)
    assert old.read_bytes() == b"old"


def test_no_clobber(old):
    message = error_of(OutputError, old, no_clobber=True)
    assert message.startswith(str(old))
    assert "no_clobber" in message
    write(old.with_name("other.csv"), no_clobber=True)
    assert old.read_bytes() == b"old"


def test_no_clobber_of_a_file_that_appears_meanwhile(tmp_path):
    path = tmp_path / "out.csv"
    with pytest.raises(OutputError, match="no_clobber"), open_output(path, no_clobber=True):
        path.write_bytes(b"other")
    assert path.read_bytes() == b"other"
    assert files_in(tmp_path) == ["out.csv"]


def test_an_input_is_never_replaced(old, monkeypatch):
    link = old.with_name("link.csv")
    link.hardlink_to(old)
    for name in (old, link, old.parent / "." / old.name):
        assert str(name) in error_of(UsageError, name, inputs=["-", old.with_name("gone"), old])
    with old.open() as file:
        monkeypatch.setattr(sys, "stdin", file)
        assert str(old) in error_of(UsageError, old, inputs=["-"])
    assert old.read_bytes() == b"old"


def test_devices_are_written_directly(tmp_path):
    write("/dev/null", inputs=["/dev/null"], no_clobber=True)
    message = error_of(OutputError, "/dev/full")
    assert "/dev/full" in message
    assert stat.S_ISCHR(Path("/dev/null").stat().st_mode)


def test_a_named_pipe(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    received = []
    reader = threading.Thread(target=lambda: received.append(pipe.read_bytes()))
    reader.start()
    write(pipe)
    reader.join(10)
    assert received == [b"new"]
    assert files_in(tmp_path) == ["pipe"]


class Terminal(io.TextIOWrapper):
    def isatty(self):
        return True


def test_standard_output(monkeypatch):
    buffer = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", Terminal(buffer, write_through=True))
    write("-")
    assert buffer.getvalue() == b"new"
    assert "path=" in error_of(UsageError, "-", binary=True)
    assert buffer.getvalue() == b"new"


def test_what_is_open_already_is_gone_on_with(old):
    for mode in ("ab", "r+b"):
        old.write_bytes(b"old")
        with old.open(mode) as file:
            file.seek(0, os.SEEK_END)
            name = f"/dev/fd/{file.fileno()}"
            check_output(name, binary=True, no_clobber=True, inputs=[old])
            write(name, no_clobber=True, inputs=[old])
            write(f"/proc/self/fd/{file.fileno()}")
            os.write(file.fileno(), b"end")
        assert old.read_bytes() == b"oldnewnewend"
    assert files_in(old.parent) == ["out.csv"]


def test_a_descriptor_that_cannot_be_written(old):
    with old.open("rb") as file:
        numbers = [file.fileno(), 250]
        messages = [error_of(OutputError, f"/dev/fd/{number}") for number in numbers]
        for number in numbers:
            refused(OutputError, "Bad file descriptor", check_output, f"/dev/fd/{number}")
    for number, message in zip(numbers, messages, strict=True):
        assert message.startswith(f"/dev/fd/{number} ")
        assert os.strerror(errno.EBADF) in message
    assert old.read_bytes() == b"old"


def test_a_link_to_a_descriptor_stays_one(old):
    with old.open("ab") as file:
        link = old.with_name("link.csv")
        link.symlink_to(f"/proc/self/fd/{file.fileno()}")
        write(link)
    assert link.is_symlink()
    assert old.read_bytes() == b"oldnew"


def test_a_descriptor_of_another_process(old):
    with old.open("ab") as file:
        child = subprocess.Popen(["sleep", "60"], stdout=file)
    try:
        message = error_of(OutputError, f"/proc/{child.pid}/fd/1")
    finally:
        child.kill()
        child.wait()
    assert f"/proc/{child.pid}/fd/1" in message
    assert old.read_bytes() == b"old"


def test_links_that_lead_back_to_themselves(tmp_path):
    one, two = tmp_path / "one.csv", tmp_path / "two.csv"
    one.symlink_to(two)
    two.symlink_to(one)
    message = f"{one} cannot be written: its links lead back to themselves; choose another name"
    assert error_of(OutputError, one) == message
    refused(OutputError, "lead back", check_output, one)
    refused(OutputError, "lead back", check_store, one)
    assert one.is_symlink()
    link = tmp_path / "new.csv"
    link.symlink_to(tmp_path / "there.csv")  # which is yet to be made
    write(link)
    assert (link.is_symlink(), (tmp_path / "there.csv").read_bytes()) == (True, b"new")


def test_a_terminal_by_its_name_gets_no_binary_output():
    import pty

    master, slave = pty.openpty()
    try:
        for name in (os.ttyname(slave), f"/dev/fd/{slave}"):
            assert "path=" in error_of(UsageError, name, binary=True)
            write(name, b"text")
            assert os.read(master, 10) == b"text"
    finally:
        os.close(slave)
        os.close(master)
