"""Public names have types that mypy and editors see: what is right passes, and each misuse is an error.

``python tests/repository/test_types.py > src/vorotool/__init__.pyi`` writes the public names from their table anew.
"""

import inspect
import os
import shutil
import subprocess
import sys
import typing
from pathlib import Path

import pytest

import vorotool
import vorotool.typing

ROOT = Path(__file__).parents[2]
STUB = ROOT / "src" / "vorotool" / "__init__.pyi"
USES = Path(__file__).parent / "typed_uses.py"


def stub():
    """The public names, each from its home."""
    lines = [
        '"""Exact Voronoi diagrams of images, points and polygons: the types of all public names."""',
        "",
        "# Made of the table in __init__.py by tests/repository/test_types.py, which compares both.",
        "",
    ]
    kind = {True: 0, False: 1}  # classes come before functions
    for home, name in sorted(
        ((home, name) for name, home in vorotool._HOME.items()),
        key=lambda pair: (pair[0], kind[pair[1][0].isupper()], pair[1]),
    ):
        lines += [f"from {home} import (", f"    {name} as {name},", ")"]
    return "\n".join([*lines, "", "_HOME: dict[str, str]", "__version__: str", "__all__: list[str]", ""])


def test_the_stub_has_every_public_name():
    assert STUB.read_text(encoding="utf-8") == stub()


def _mypy(path, tmp_path):
    """What mypy says of a file that uses the package."""
    settings = tmp_path / "mypy.ini"
    settings.write_text("[mypy]\nstrict = True\nwarn_unused_ignores = True\n", encoding="utf-8")
    command = [sys.executable, "-m", "mypy", "--config-file", str(settings), "--no-error-summary", str(path)]
    cache = ROOT / "build" / "mypy-of-users"
    run = subprocess.run(
        [*command, "--cache-dir", str(cache)],
        env={**os.environ, "MYPYPATH": str(ROOT / "src")},
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    return [line for line in run.stdout.splitlines() if Path(line.split(":")[0]).name == path.name] + [
        run.stderr[:500]
    ] * bool(run.stderr)


@pytest.mark.slow
def test_uses_pass_and_misuses_are_errors(tmp_path):
    assert _mypy(USES, tmp_path) == []


@pytest.mark.slow
def test_an_ignored_line_without_an_error_is_found(tmp_path):
    path = tmp_path / "right.py"
    path.write_text("import vorotool\n\nvorotool.delaunay([[0, 1]])  # type: ignore[call-arg]\n", encoding="utf-8")
    assert ["unused-ignore" in line for line in _mypy(path, tmp_path)] == [True]


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("pyright") is None, reason="pyright is not installed")
def test_pyright_sees_no_errors(tmp_path):
    (tmp_path / "pyrightconfig.json").write_text(
        f'{{"include": ["{USES}"], "extraPaths": ["{ROOT / "src"}"], "enableTypeIgnoreComments": true}}',
        encoding="utf-8",
    )
    run = subprocess.run(
        ["pyright", "-p", str(tmp_path), "--pythonpath", sys.executable], capture_output=True, text=True, check=False
    )
    assert " 0 errors" in f" {run.stdout}", run.stdout


FUNCTIONS = [name for name in vorotool._HOME if inspect.isfunction(getattr(vorotool, name))]


@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_return_what_they_say(name):
    function = getattr(vorotool, name)
    said = inspect.get_annotations(function)
    assert said["return"] != "Any"
    assert set(said) == {*inspect.signature(function).parameters, "return"}


def test_aliases_are_types_at_run_time():
    names = [name for name in vars(vorotool.typing) if name.endswith(("Like", "Kind", "Choice"))]
    assert len(names) > 8
    for each in map(vars(vorotool.typing).get, names):
        assert isinstance(each, type) or typing.get_origin(each) is not None or typing.get_args(each)


if __name__ == "__main__":
    sys.stdout.write(stub())
