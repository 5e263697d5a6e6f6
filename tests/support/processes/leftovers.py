"""What commands leave behind, and waiting for it."""

import time


def leftovers(folder):
    """Names of temporary files that should not be there."""
    return [path.name for path in folder.rglob("*") if path.name.startswith(".")]


def contents(folder, pattern="*"):
    """Give the bytes of files by their paths."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob(pattern) if path.is_file()}


def wait_until(condition, child=None):
    """Wait for something, or for the end of a process that may end before."""
    deadline = time.monotonic() + 600
    while not condition() and (child is None or child.poll() is None):
        assert time.monotonic() < deadline, "it does not come"
        time.sleep(0.01)
