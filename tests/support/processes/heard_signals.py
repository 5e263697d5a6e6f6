"""Signals that a program which was started in the background ignores, and that what it starts would ignore as well."""

import signal


def hear_signals() -> None:
    """Let interrupts and hang-ups do what they usually do, here and in processes that are started from now on."""
    for number, usual in ((signal.SIGINT, signal.default_int_handler), (signal.SIGHUP, signal.SIG_DFL)):
        if signal.getsignal(number) == signal.SIG_IGN:
            signal.signal(number, usual)


def stop(*_):
    """Interrupt what calls this as its progress."""
    raise KeyboardInterrupt
