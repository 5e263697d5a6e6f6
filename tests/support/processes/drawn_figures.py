"""Figures that make draws, once for all tests of a run."""

import fcntl
import os
import shutil
import subprocess
from pathlib import Path

import pytest

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
            subprocess.run(["make", target, f"FIGURES={folder}"], cwd=ROOT, check=True, capture_output=True)
            drawn.touch()
    return folder
