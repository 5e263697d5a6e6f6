"""The command line in a process of its own that tells how much memory it has taken at most."""

import subprocess
import sys

SCRIPT = """
import re, sys
from vorotool.cli.main import main
try:
    main(sys.argv[1:])
except SystemExit as end:
    print(re.search(r"VmHWM:\\s*([0-9]+) kB", open("/proc/self/status").read())[1], file=sys.stderr)
    sys.exit(end.code)
"""


def peak_memory(arguments, folder):
    """Run a command; the peak of its resident memory in bytes, as Linux counts it since the program began."""
    code, errors, peak = watched(arguments, folder)
    assert code == 0, errors
    return peak


def watched(arguments, folder):
    """Run a command; its exit code, the lines of its messages, and the peak of its memory."""
    command = [sys.executable, "-c", SCRIPT, *map(str, arguments)]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    *errors, peak = done.stderr.splitlines()
    return done.returncode, errors, int(peak) * 1024
