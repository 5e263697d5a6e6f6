"""Signals end the process quietly wherever they come.

As long as nothing is begun that must be undone, the process ends at once: no exception runs through imports and
libraries, some of which swallow it or turn it into another. From then on a signal is an exception, which runs through
the code that removes what was begun.
"""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterable
from typing import NoReturn

MOMENT = 0.001
"""Seconds after which an end that was swallowed comes again."""

_ENDINGS = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]
"""What ends a process by default; terminals of Windows hang up otherwise."""


class _End:
    """Handlers of signals, and the exit code of the last one that came."""

    is_exception = True
    code = 0
    comes_again = False


def end_at_once() -> None:
    """Let signals end the process at once, from its first line on; those that are ignored stay so."""
    _End.is_exception = False
    handle_termination((signal.SIGINT, *_ENDINGS))


def end_by_exceptions() -> None:
    """Let signals run through the code that removes what was begun: called before anything is."""
    _End.is_exception = True


def handle_termination(numbers: Iterable[signal.Signals] = tuple(_ENDINGS)) -> None:
    """Let what ends a process by default be an exit; interrupts stay as they are."""
    for number in numbers:
        if signal.getsignal(number) is not signal.SIG_IGN:  # under nohup a hang-up ends nothing
            signal.signal(number, _end)


def settled(code: int) -> int:
    """Give the exit code once nothing is left to be undone: that of a signal, if one came; the next ends at once."""
    _End.is_exception = signal.getsignal(signal.SIGINT) is not _end
    received, _End.code = _End.code, 0
    if _End.comes_again:
        signal.setitimer(signal.ITIMER_REAL, 0)
        _End.comes_again = False
    return received or code


def ignore_interrupts() -> None:
    """Let an interrupt change nothing any more: Python gives it its default effect while it shuts down."""
    if signal.getsignal(signal.SIGINT) is _end:
        signal.signal(signal.SIGINT, signal.SIG_IGN)


def received() -> int:
    """Exit code of a signal that came, which may have been swallowed or turned into another exception; 0 if none."""
    return _End.code


def _end(number: int, _frame: object) -> NoReturn:
    _End.code = 128 + number
    if not _End.is_exception:
        os._exit(_End.code)
    if number == signal.SIGINT:
        raise KeyboardInterrupt
    sys.exit(_End.code)


def insist_on_the_end() -> None:
    """Let an interrupt come again if it comes where exceptions are swallowed, such as in ``__del__``."""
    tell = sys.unraisablehook

    def come_again(swallowed: sys.UnraisableHookArgs) -> None:
        error = swallowed.exc_value
        if not isinstance(error, KeyboardInterrupt | SystemExit):
            tell(swallowed)
            return

        def end(_number: int, _frame: object) -> NoReturn:
            raise error

        _End.comes_again = True
        signal.signal(signal.SIGALRM, end)
        signal.setitimer(signal.ITIMER_REAL, MOMENT)

    if hasattr(signal, "setitimer"):
        sys.unraisablehook = come_again
