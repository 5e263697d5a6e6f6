"""``vorotool`` and ``python -m vorotool``: from the first line on, signals end the process quietly."""

import gc
import os
import sys

INTERRUPTED = 130

gc.set_threshold(10_000, 3, 3)  # imports make some 30 000 objects, and no cycles; all are looked at as often as ever

try:  # before anything else is imported
    from vorotool.signals import end_at_once

    end_at_once()
except KeyboardInterrupt:
    os._exit(INTERRUPTED)


def main() -> None:
    """Run the command line and leave with its exit code."""
    try:
        from vorotool.cli.main import main as run

        try:
            run()
        except SystemExit as end:
            _leave(end.code)
    except KeyboardInterrupt:  # on the way out, when all is done or removed
        os._exit(INTERRUPTED)


def _leave(code: str | int | None) -> None:
    """End the process: what Python does in the end, object by object, takes a fifth of a small job and changes nothing.

    Where threads still run, or something is left to be told or written, Python ends as ever.
    """
    import atexit
    import threading

    if not isinstance(code, int) or threading.active_count() > 1:
        sys.exit(code)
    atexit._run_exitfuncs()
    try:
        for stream in (sys.stdout, sys.stderr):
            if stream is not None:
                stream.flush()
    except (OSError, ValueError):  # Python knows what to say of it
        sys.exit(code)
    os._exit(code)


if __name__ == "__main__":
    main()
