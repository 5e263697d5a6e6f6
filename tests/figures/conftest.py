"""The figures, drawn once for all tests."""

import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="session")
def figures(tmp_path_factory):
    if not (ROOT / "build" / ".installed").exists() or shutil.which("make") is None:
        pytest.skip("the figures are drawn by make, in an environment made by make")
    folder = tmp_path_factory.mktemp("figures")
    subprocess.run(["make", "figures", f"FIGURES={folder}"], cwd=ROOT, check=True, capture_output=True)
    return folder
