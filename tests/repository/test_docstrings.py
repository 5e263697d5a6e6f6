"""The docstrings of public names say what numpydoc asks for: parameters and their types, results, an example."""

import importlib

from numpydoc.validate import validate

import vorotool

LEFT_OUT = {
    "GL01",  # the first line stands behind the quotes: newer versions ask for either
    "PR06",  # an integer array may have any integer type
    "ES01",  # the first line may say all
    "SA01",  # the reference groups names by what they are for
}


def test_numpydoc():
    found = []
    for name, home in vorotool._HOME.items():
        left_out = LEFT_OUT | ({"EX01"} if isinstance(getattr(vorotool, name), type(Exception)) else set())
        importlib.import_module(home)
        errors = validate(f"{home}.{name}")["errors"]
        found += [f"{home}.{name}: {code}: {text}" for code, text in errors if code not in left_out]
    assert found == []
