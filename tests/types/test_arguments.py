"""Functions that take values of the library refuse all else, and say what makes such a value."""

import inspect

import numpy as np
import pytest

import vorotool
from vorotool import InputError

TAKING = {
    name: function
    for name in vorotool.__all__
    if inspect.isfunction(function := getattr(vorotool, name))
    and str(next(iter(inspect.signature(function).parameters.values())).annotation)
    in {
        "AnyTriangulation",
        "AnyTriangulation | ProximityGraph",
        "CellSet | SpaceCellSet",
        *(each for each in vorotool.__all__ if inspect.isclass(getattr(vorotool, each))),
    }
}
WANTED = {"delta": 1, "every": 1.0, "r": 1.0, "columns": {}, "distances": [1.0], "angle": 30.0}


def test_there_are_such_functions():
    assert {"prune", "centerline", "alpha_edges", "edge_table", "verify_cells"} <= TAKING.keys()


@pytest.mark.parametrize("name", TAKING)
def test_what_is_no_such_value_is_refused_by_name(name):
    given = np.zeros((3, 2))
    parameters = list(inspect.signature(TAKING[name]).parameters.values())
    needed = [each for each in parameters[1:] if each.default is inspect.Parameter.empty]
    named = {each.name: WANTED.get(each.name, given) for each in needed if each.kind is not each.VAR_KEYWORD}
    with pytest.raises(InputError, match=f"^invalid {parameters[0].name}: "):
        TAKING[name](given, **named)
