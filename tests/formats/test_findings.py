"""What fuzzing has found: files that crashed, hung, took memory or gave wrong pixels are refused with a message."""

from itertools import product
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
@pytest.mark.filterwarnings("ignore::vorotool.errors.VorotoolWarning")
def test_every_reader_takes_or_refuses_it(path):
    for input_format, geometry in product(sorted(INPUTS), [None, "points", "polygons"]):
        try:
            vorotool.read(path, geometry=geometry, input_format=input_format, max_pixels=2**20, max_sites=10_000)
        except vorotool.VorotoolError as error:
            assert error.exit_code in (2, 3, 5)  # noqa: PT017
