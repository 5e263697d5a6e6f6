"""Processes that were run to their end: what they said, and their exit codes."""

import os
import subprocess
import sys
from pathlib import Path

ENVIRONMENT = {
    **{name: value for name, value in os.environ.items() if not name.startswith(("MAKE", "MFLAGS"))},
    "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
}
"""With the commands of this installation, and outside of any ``make``."""


def ended(*command, check=False, **options):
    """Run a command with captured text; other options are those of `subprocess.run`."""
    given = {"capture_output": True, "text": True, "timeout": 300, **options}
    return subprocess.run([*map(str, command)], check=check, **given)


def ended_python(*arguments, **options):
    """Run this Python."""
    return ended(sys.executable, *arguments, **options)


def ended_bash(line, folder, **options):
    """Run a line of a shell, all of whose commands must succeed."""
    return ended("bash", "-o", "pipefail", "-c", line, **{"cwd": folder, "env": ENVIRONMENT, **options})
