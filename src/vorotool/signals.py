"""Signals end the process through the code that removes what was begun, wherever they come."""

from __future__ import annotations

import signal
import sys
from typing import NoReturn

MOMENT = 0.001
"""Seconds after which an end that was swallowed comes again."""


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

        signal.signal(signal.SIGALRM, end)
        signal.setitimer(signal.ITIMER_REAL, MOMENT)

    if hasattr(signal, "setitimer"):
        sys.unraisablehook = come_again
