"""A signal ends the process quietly, whenever it comes: while modules are imported, before and after the work."""

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import pytest

from support.few import few
from support.processes.leftovers import leftovers
from support.refusals import refused
from vorotool import signals

HERE = "import os; import vorotool.__main__ as entry; os.write(1, b'.'); entry.main()"
"""Says when the first line of ours is done; from there on nothing of Python's own is to be seen."""

ENTRIES = {
    "module": [sys.executable, "-m", "vorotool"],
    "command": [str(Path(sys.executable).with_name("vorotool"))],
}
CODES = {signal.SIGINT: 130, signal.SIGTERM: 143, signal.SIGHUP: 129}
PYTHON_ENDS = (-signal.SIGINT, 1)
"""Before our first line Python tells of an interrupt as it likes: by the signal itself, or as a fault of its start."""

COMMAND = ["tessellate", "dots.csv", "--what", "labels,table,color", "-o", "out"]


def started(folder, arguments):
    return subprocess.Popen(arguments, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def halves(values):
    """Every second moment of each, beginning with the first or the second in turn; the moments between are more."""
    first = [(value, number % 2) for number, value in enumerate(values)]
    return few([*first, *((value, 1 - begin) for value, begin in first)], len(first))


@pytest.mark.slow
@pytest.mark.parametrize(("number", "begin"), halves(CODES))
def test_a_signal_ends_quietly_from_our_first_line_on(folder, number, begin):
    ended = set()
    for step in range(begin, 24, 2):
        child = started(folder, [sys.executable, "-c", HERE, *COMMAND, "-q"])
        assert child.stdout.read(1) == b"."
        time.sleep(step * 0.0125)
        child.send_signal(number)
        out, err = child.communicate(timeout=600)
        assert (out, err) == (b"", b"")
        # when Python has taken its handlers down again, at the very end, the system ends the process itself
        assert child.returncode in (CODES[number], 0, -number)
        ended.add(child.returncode)
        assert leftovers(folder) == []
    assert CODES[number] in ended


@pytest.mark.slow
@pytest.mark.parametrize(("entry", "begin"), halves(ENTRIES))
def test_an_interrupt_during_the_start_shows_nothing_of_ours(folder, entry, begin):
    for step in range(begin, 20, 2):
        child = started(folder, [*ENTRIES[entry], *COMMAND, "-q"])
        time.sleep(step * 0.015)
        child.send_signal(signal.SIGINT)
        _, err = child.communicate(timeout=600)
        assert child.returncode in (130, 0, *PYTHON_ENDS)
        if child.returncode == 130:
            assert err == b""
        files = b" ".join(re.findall(rb'File "([^"]*)"', err))  # of frames: an editable install quotes all our paths
        for ours in (b"vorotool/cli", b"vorotool/signals", b"vorotool/formats", b"vorotool/__main__", b"/click/"):
            assert ours not in files
        assert leftovers(folder) == []


def test_an_interrupt_while_nobody_writes_into_a_pipe(folder):
    os.mkfifo(folder / "pipe.csv")
    child = started(folder, [*ENTRIES["module"], "tessellate", "pipe.csv", "-o", "out.npy"])
    with (folder / "pipe.csv").open("wb"):  # which waits until it is read
        child.send_signal(signal.SIGINT)
        assert child.communicate(timeout=600) == (b"", b"")
    assert child.returncode == 130
    assert not (folder / "out.npy").exists()


SWALLOWED = """
import os, signal, vorotool.__main__ as entry
from vorotool.jobs import job as recipes
def swallow(*_):
    from vorotool.signals import end_by_exceptions
    end_by_exceptions()
    try:
        os.kill(os.getpid(), signal.SIGINT)
    except BaseException as error:
        {then}
recipes.check_targets = swallow
entry.main()
"""


@pytest.mark.parametrize("then", ["pass", "raise ImportError('numpy cannot be imported') from error"])
def test_an_interrupt_that_is_swallowed_or_turned_into_an_error(folder, then):
    child = started(folder, [sys.executable, "-c", SWALLOWED.format(then=then), *COMMAND, "-q"])
    assert child.communicate(timeout=600) == (b"", b"")
    assert child.returncode == 130


def test_an_interrupt_that_is_ignored_stays_so(folder):
    script = f"trap '' INT; {sys.executable} -c \"{HERE}\" tessellate dots.csv -o out.npy -q"
    child = subprocess.Popen(
        ["bash", "-c", script], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, process_group=0
    )
    assert child.stdout.read(1) == b"."
    os.killpg(child.pid, signal.SIGINT)
    assert child.communicate(timeout=600) == (b"", b"")
    assert (child.returncode, (folder / "out.npy").exists()) == (0, True)


def test_an_end_that_was_swallowed_does_not_come_after_the_run(monkeypatch):
    monkeypatch.setattr(sys, "unraisablehook", sys.unraisablehook)
    before = signal.getsignal(signal.SIGALRM)
    try:
        signals.insist_on_the_end()
        sys.unraisablehook(SimpleNamespace(exc_value=SystemExit(143)))
        assert signals.settled(3) == 3
        time.sleep(50 * signals.MOMENT)
        sys.unraisablehook(SimpleNamespace(exc_value=SystemExit(143)))
        refused(SystemExit, "143", time.sleep, 50 * signals.MOMENT)
    finally:
        signals.settled(0)
        signal.signal(signal.SIGALRM, before)
