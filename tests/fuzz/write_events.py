"""What happens inside writes, step by step: something can be done at any step, in this process.

Steps are told by wrappers around the functions of `vorotool.formats` that make, write, move and remove temporaries, and
by Python's audit events where Zarr opens the files of a store.
"""

import io
import itertools
import os
import select
import signal
import sys
import threading
import time
from pathlib import Path

from vorotool.formats.io import temporaries

WRITES = frozenset({"write", "half", "chunk"})
"""Steps in which bytes go out."""

PATIENCE = 20.0
"""Seconds that a process waits for a signal in the middle of a step."""


SIGNALLED = []
"""A pipe that can be read when this process has got a signal."""


class Steps:
    """Counts steps, and does something at one of them.

    Parameters
    ----------
    at : int
        Number of the step; -1 for none.
    act : callable
        ``act(name)`` may raise what the step raises then.
    kinds : set of str, optional
        Which steps count.
    """

    def __init__(self, at=-1, act=lambda name: None, kinds=None):
        self.at, self.act, self.kinds = at, act, kinds
        self._numbers, self.count, self._lock = itertools.count(), 0, threading.Lock()

    def __call__(self, name):
        if self.kinds is not None and name not in self.kinds:
            return
        with self._lock:
            number = next(self._numbers)
            self.count = number + 1
        if number == self.at:
            self.act(name)


class Raw(io.FileIO):
    """A file whose writes have a middle."""

    def __init__(self, descriptor, steps):
        super().__init__(descriptor, "w+b")
        self._steps = steps

    def write(self, data):
        self._steps("write")
        view = memoryview(data).cast("B")
        done = super().write(view[: len(view) // 2]) if len(view) > 1 else 0
        self._steps("half")
        return done + super().write(view[done:])


def install(steps):
    """Tell the steps of all writes of this process from now on."""
    SIGNALLED[:] = os.pipe()
    os.set_blocking(SIGNALLED[1], False)
    signal.set_wakeup_fd(SIGNALLED[1])
    wrap(temporaries.fcntl, "flock", "made", "locked", steps)
    wrap(temporaries, "_discard", "discarding", "discarded", steps)
    wrap(os, "replace", "moving", "moved", steps)
    wrap(temporaries, "_exchange", "exchanging", "exchanged", steps)
    temporaries.Temporary.opened = lambda self: io.BufferedRandom(Raw(os.dup(self.descriptor), steps))

    def hear(event, arguments):
        if event == "open" and isinstance(arguments[0], str) and "/.vorotool-" in arguments[0]:
            path, _, flags = arguments
            if isinstance(flags, int) and flags & (os.O_WRONLY | os.O_RDWR) and not path.endswith(".tmp"):
                steps("chunk")

    sys.addaudithook(hear)


def wrap(owner, name, before, after, steps):
    """Tell a step before and one after each call of a function."""
    function = getattr(owner, name)

    def call(*arguments):
        steps(before)
        result = function(*arguments)
        steps(after)
        return result

    setattr(owner, name, call)


def announce(path, *, wait=True):
    """What is done at a step to be killed in it: say so to who reads a pipe, and wait, or go on."""

    def act(name):
        with Path(path).open("wb", buffering=0) as pipe:
            pipe.write(f"{os.getpid()} {name}\n".encode())
        if wait and threading.current_thread() is threading.main_thread():
            time.sleep(PATIENCE)  # which a signal ends
        elif wait:  # the main thread gets the signal, and waits for this one
            select.select([SIGNALLED[0]], [], [], PATIENCE)

    return act


def install_from_environment():
    """In a process of a batch: which step, and which pipe."""
    if "FAULTS_PIPE" in os.environ:
        wait = os.environ["FAULTS_WAIT"] == "1"
        install(Steps(int(os.environ["FAULTS_AT"]), announce(os.environ["FAULTS_PIPE"], wait=wait)))
