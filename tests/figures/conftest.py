"""The figures, drawn once for all tests."""

import fcntl
import os
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="session")
def figures(tmp_path_factory):
    """Their folder; where tests run in several processes, the first to come draws for all."""
    if not (ROOT / "build" / ".installed").exists() or shutil.which("make") is None:
        pytest.skip("the figures are drawn by make, in an environment made by make")
    shared = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        shared = shared.parent
    folder, drawn = shared / "figures", shared / "figures-are-drawn"
    with (shared / "figures.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not drawn.exists():
            subprocess.run(["make", "figures", f"FIGURES={folder}"], cwd=ROOT, check=True, capture_output=True)
            drawn.touch()
    return folder
