"""Run one of the comparisons and harnesses: `python tests/fuzz/run.py delaunay --cases 1000`, or `together`."""

import sys
from importlib import import_module
from pathlib import Path

TESTS = str(Path(__file__).parents[1])
if TESTS not in sys.path:
    sys.path[0] = TESTS


def main() -> int:
    """Run the one that the first argument names; the exit code."""
    name = sys.argv.pop(1)
    module = import_module(f"fuzz.{name}")
    return module.COMPARISON.run() if hasattr(module, "COMPARISON") else module.main()


if __name__ == "__main__":
    sys.exit(main())
