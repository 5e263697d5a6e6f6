"""The options of each command are one frozen value with a field for each of them."""

import ast
import dataclasses
from pathlib import Path

import pytest

from vorotool.cli.main import COMMANDS, vorotool
from vorotool.jobs import options

PACKAGE = Path(options.__file__).parents[1]
KINDS = {
    "tessellate": options.TessellationOptions,
    "delaunay": options.TriangulationOptions,
    "alphashape": options.AlphaShapeOptions,
    "voronoi": options.VoronoiOptions,
    "skeleton-approx": options.ApproximateSkeletonOptions,
    "skeleton-exact": options.ExactSkeletonOptions,
    "distance": options.DistanceOptions,
    "draw": options.DrawingOptions,
}
WITHOUT_OPTION = {"draw": {"what"}}
"""There is one result, so that nobody chooses it."""


OTHERWISE = {"a": "inputs", "b": "other"}
"""What `distance` calls its two inputs."""


def parameters_of(name):
    asked = [each for each in vorotool.get_command(None, name).params if each.expose_value]
    return {OTHERWISE.get(each.name, each.name): each for each in asked}


def test_each_command_that_has_results_has_its_options():
    assert set(KINDS) == set(COMMANDS) - {"info", "sample", "completion"}


@pytest.mark.parametrize("name", KINDS)
def test_each_option_is_a_field_and_each_field_an_option(name):
    has_none = KINDS[name] is options.DistanceOptions  # what has a default there is of batches, of which it makes none
    unasked = {field.name for field in dataclasses.fields(KINDS[name]) if field.default is not dataclasses.MISSING}
    fields = {field.name for field in dataclasses.fields(KINDS[name])} - (unasked if has_none else set())
    assert fields == set(parameters_of(name)) | WITHOUT_OPTION.get(name, set())
    assert not set(parameters_of(name)) & WITHOUT_OPTION.get(name, set())


@pytest.mark.parametrize("name", KINDS)
def test_what_is_made_once_stays(name):
    made = KINDS[name](**dict.fromkeys(parameters_of(name)))
    with pytest.raises(dataclasses.FrozenInstanceError):
        made.threads = 2
    with pytest.raises((AttributeError, TypeError)):  # there are slots only: nothing is added on the way
        object.__setattr__(made, "found_on_the_way", 1)
    assert dataclasses.replace(made, threads=2).threads == 2


@pytest.mark.parametrize("path", sorted(PACKAGE.rglob("*.py")), ids=lambda path: str(path.relative_to(PACKAGE)))
def test_no_module_makes_values_without_a_type(path):
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        names = [node.name] if isinstance(node, ast.alias) else [getattr(node, "id", ""), getattr(node, "attr", "")]
        assert "SimpleNamespace" not in names


NO_OPTIONS = ("error", "select", "sys", "layer", "value", "features.source")
"""What may be asked: what is raised, modules, layers and values of any kind."""


@pytest.mark.parametrize("room", ["jobs", "cli", "batch"])
def test_options_are_not_asked_whether_they_have_a_field(room):
    for path in (PACKAGE / room).rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            called = node.func.id if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) else ""
            asks = called in ("hasattr", "vars", "setattr") or (called == "getattr" and len(node.args) == 3)
            assert not asks or ast.unparse(node.args[0]) in NO_OPTIONS, f"{path}, line {node.lineno}"
