"""Figures that make draws, once for all tests of a run."""

import fcntl
import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from vorotool.cli.main import main

ROOT = Path(__file__).parents[3]


def drawn_figures(target, temporary):
    """Return the folder that `make target` draws into; of several processes the first to come draws for all."""
    if not (ROOT / "build" / ".installed").exists() or shutil.which("make") is None:
        pytest.skip("the figures are drawn by make, in an environment made by make")
    shared = temporary.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        shared = shared.parent
    folder, drawn = shared / target, shared / f"{target}-is-drawn"
    with (shared / f"{target}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not drawn.exists():
            _draw_here(target, folder)
            subprocess.run(["make", target, f"FIGURES={folder}"], cwd=ROOT, check=True, capture_output=True)
            drawn.touch()
    return folder


def _draw_here(target, folder):
    """Run lines of make that are one command of the data without a process; make then finds them done."""
    asked = ["make", "-n", "-o", "build/.installed", target, f"FIGURES={folder}"]
    lines = subprocess.run(asked, cwd=ROOT, check=True, capture_output=True, text=True).stdout.splitlines()
    folder.mkdir()
    with pytest.MonkeyPatch.context() as patched:
        patched.chdir(ROOT)
        patched.setattr(sys, "unraisablehook", sys.unraisablehook)  # which the command sets
        for line in lines:
            if line.startswith(".venv/bin/vorotool ") and " build/" not in line and not set(line) & set("|;>\\$"):
                with pytest.raises(SystemExit) as end:
                    main(shlex.split(line)[1:])
                assert end.value.code == 0, line
