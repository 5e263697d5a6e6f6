"""What every reader asks first, and what lets signals through."""

import hashlib
import os
import signal
import threading

from support.refusals import refused
from vorotool.formats.io.sources import interruptible


class EndedError(Exception):
    pass


def test_a_signal_does_not_wait_for_a_library():
    def end(number, frame):
        raise EndedError

    begun, done = threading.Event(), threading.Event()

    def work():
        begun.set()
        hashlib.pbkdf2_hmac("sha256", b"", b"", 500_000)  # one call of a third of a second, which sees no signal
        done.set()

    threading.Thread(target=lambda: (begun.wait(), os.kill(os.getpid(), signal.SIGUSR1)), daemon=True).start()
    before = signal.signal(signal.SIGUSR1, end)
    try:
        refused(EndedError, "", interruptible, work)
        assert not done.is_set()
        assert done.wait(60)
    finally:
        signal.signal(signal.SIGUSR1, before)


def test_results_and_errors_are_those_of_the_work():
    assert interruptible(lambda: "made") == "made"
    refused(KeyError, "missing", interruptible, lambda: {}["missing"])
    found = []
    thread = threading.Thread(target=lambda: found.append(interruptible(threading.current_thread)))
    thread.start()
    thread.join()
    assert found == [thread]  # only the first thread handles signals
