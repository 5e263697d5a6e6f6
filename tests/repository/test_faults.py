"""A little of what `make fuzz` does with processes that are killed inside writes, and with failing disks."""

import subprocess
import sys
from pathlib import Path

FUZZ = Path(__file__).parents[1] / "fuzz"


def test_kills_and_failing_disks():
    options = ["--writers", "png,csv,zarr", "--kills", "6", "--places", "12", "--batches", "0", "--pairs", "0"]
    done = subprocess.run(
        [sys.executable, FUZZ / "faults.py", *options], capture_output=True, text=True, timeout=300, check=False
    )
    assert (done.returncode, done.stderr) == (0, ""), done.stdout + done.stderr
    assert "kills that left a temporary: 6" in done.stdout
