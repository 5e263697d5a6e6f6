"""The command line in a process of its own that tells how much memory it has taken at most."""

import json
import subprocess
import sys
import tracemalloc
from contextlib import contextmanager

SCRIPT = """
import json, re, sys
from vorotool.cli.main import main
codes = []
for arguments in json.loads(sys.argv[1]):
    try:
        main(arguments)
    except SystemExit as end:
        codes.append(end.code)
peak = re.search(r"VmHWM:\\s*([0-9]+) kB", open("/proc/self/status").read())[1]
print(json.dumps([codes, 1024 * int(peak)]), file=sys.stderr)
"""


def peak_memory(arguments, folder):
    """Run a command; the peak of its resident memory in bytes, as Linux counts it since the program began."""
    code, errors, peak = watched(arguments, folder)
    assert code == 0, errors
    return peak


def watched(arguments, folder):
    """Run a command; its exit code, the lines of its messages, and the peak of its memory."""
    (code,), errors, peak = watched_together([arguments], folder)
    return code, errors, peak


def watched_together(commands, folder):
    """Run commands in one process; their exit codes, the lines of their messages, and the peak of its memory."""
    words = json.dumps([[str(word) for word in command] for command in commands])
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, words], cwd=folder, capture_output=True, text=True, check=False
    )
    *errors, last = done.stderr.splitlines()
    codes, peak = json.loads(last)
    return codes, errors, peak


@contextmanager
def memory_below(most):
    """Let what is done here take less than so many bytes at once, as Python counts them."""
    tracemalloc.start()
    try:
        yield
        assert tracemalloc.get_traced_memory()[1] < most
    finally:
        tracemalloc.stop()
