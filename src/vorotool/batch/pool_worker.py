"""A worker process: does the tasks that come through a socket, one after the other, until the socket is closed."""

from __future__ import annotations

import os
import select
import signal
import sys
import threading
from multiprocessing.connection import Connection
from typing import NoReturn

from vorotool.batch.tasks import Process, Task, carry_out
from vorotool.signals import insist_on_the_end


def main(descriptor: int) -> None:
    """Do tasks and send back what became of them."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent decides
    signal.signal(signal.SIGTERM, _end)
    insist_on_the_end()
    threading.Thread(target=_end_with_parent, args=(descriptor,), daemon=True).start()
    connection = Connection(descriptor)
    try:
        process: Process = connection.recv()
        while True:
            task: Task = connection.recv()
            connection.send(carry_out(process, task))
    except (EOFError, ConnectionError):  # the parent has gone, and nothing is left to do or to remove
        signal.signal(signal.SIGTERM, signal.SIG_IGN)


def _end(number: int, _frame: object) -> NoReturn:
    """End as an exception does: temporary files are removed. A second signal does not disturb this."""
    signal.signal(number, signal.SIG_IGN)
    sys.exit(128 + number)


def _end_with_parent(descriptor: int) -> None:
    """End as soon as the other end of the socket is closed, in the middle of a task, too."""
    closed = select.poll()
    closed.register(descriptor, 0)
    closed.poll()
    os.kill(os.getpid(), signal.SIGTERM)
