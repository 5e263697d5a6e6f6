"""The docstrings of public names say what numpydoc asks for: parameters and their types, results, an example."""

import importlib

import pytest
from numpydoc.validate import validate

import vorotool

LEFT_OUT = {
    "GL01",  # the first line stands behind the quotes: newer versions ask for either
    "PR06",  # an integer array may have any integer type
    "ES01",  # the first line may say all
    "SA01",  # the reference groups names by what they are for
}

NAMES = sorted(name for name in vorotool.__all__ if not name.startswith("_"))


@pytest.mark.parametrize("name", NAMES)
def test_numpydoc(name):
    left_out = LEFT_OUT | ({"EX01"} if isinstance(getattr(vorotool, name), type(Exception)) else set())
    home = vorotool._HOME[name]
    importlib.import_module(home)
    found = [f"{code}: {text}" for code, text in validate(f"{home}.{name}")["errors"] if code not in left_out]
    assert found == []
