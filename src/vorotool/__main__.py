"""``vorotool`` and ``python -m vorotool``: from the first line on, signals end the process quietly."""

import os

INTERRUPTED = 130

try:  # before anything else is imported
    from vorotool.signals import end_at_once

    end_at_once()
except KeyboardInterrupt:
    os._exit(INTERRUPTED)


def main() -> None:
    """Run the command line and leave with its exit code."""
    try:
        from vorotool.cli.main import main as run

        run()
    except KeyboardInterrupt:  # on the way out, when all is done or removed
        os._exit(INTERRUPTED)


if __name__ == "__main__":
    main()
