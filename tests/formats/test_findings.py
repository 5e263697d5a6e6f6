"""What fuzzing has found: files that crashed, hung, took memory or gave wrong pixels are refused with a message."""

import subprocess
import sys
from pathlib import Path

import pytest

import vorotool
from vorotool.products.inputs import INPUTS

FUZZ = Path(__file__).parents[1] / "fuzz"
FINDINGS = sorted((FUZZ / "findings").iterdir())


@pytest.mark.parametrize("path", FINDINGS, ids=lambda path: path.name)
def test_a_finding_is_refused(path):
    with pytest.raises(vorotool.VorotoolError) as caught:
        vorotool.read(path, max_pixels=2**20)
    assert caught.value.exit_code in (3, 5)
    assert path.name in str(caught.value)


@pytest.mark.parametrize("path", FINDINGS, ids=lambda path: path.name)
@pytest.mark.parametrize("input_format", sorted(INPUTS))
@pytest.mark.parametrize("geometry", [None, "points", "polygons"])
@pytest.mark.filterwarnings("ignore::vorotool.errors.VorotoolWarning")
def test_every_reader_takes_or_refuses_it(path, input_format, geometry):
    try:
        vorotool.read(path, geometry=geometry, input_format=input_format, max_pixels=2**20, max_sites=10_000)
    except vorotool.VorotoolError as error:
        assert error.exit_code in (2, 3, 5)  # noqa: PT017


def test_a_smoke_of_the_fuzzer():
    """Some hundred inputs of each kind; `make fuzz` runs for longer."""
    command = [sys.executable, FUZZ / "bytes.py", "--cases", "2000", "--minutes", "5", "--seed", "7"]
    done = subprocess.run([*command, "--commands", "0.02"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "2,000 inputs, 0 failures" in done.stdout
