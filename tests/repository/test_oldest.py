"""The lower bounds of pyproject.toml: how they are read, and what older libraries lack."""

import tomllib

import pytest

from requirements import oldest, requirements
from support.documents import ROOT
from support.processes.ended import ended_python
from support.refusals import refused

PYPROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
PROJECT = PYPROJECT["project"]


def test_requirements_are_those_of_extras_and_of_groups():
    for name in PROJECT["optional-dependencies"] | PYPROJECT["dependency-groups"]:
        assert requirements(PYPROJECT, [name])[: len(PROJECT["dependencies"])] == PROJECT["dependencies"]
    assert set(requirements(PYPROJECT, ["bench"])) > set(PYPROJECT["dependency-groups"]["bench"])
    refused(SystemExit, "'benches'", requirements, PYPROJECT, ["build", "benches"])


def test_the_oldest_versions_are_those_that_are_stated():
    names = [name for name in (*PROJECT["optional-dependencies"], "build", "dev", "docs") if name != "all"]
    found = dict(requirement.split("==") for requirement in oldest(requirements(PYPROJECT, names)))
    for requirement in PROJECT["dependencies"]:
        name, version = requirement.split(">=")
        assert found[name] == version
    assert {"pytest", "zarr", "networkx", "dask", "nanobind"} < found.keys()


@pytest.mark.parametrize("stated", [["numpy"], ["numpy>=2.0,<3"], ["numpy>=2.0", "numpy>=2.1"]])
def test_a_requirement_has_one_lower_bound(stated):
    refused(SystemExit, "numpy", oldest, stated)


def test_types_of_options_do_not_need_the_newest_click():
    # before 8.4 click.ParamType could not say what it converts to
    program = (
        "import click\n"
        "def refuse(cls, converted): raise TypeError(\"type 'ParamType' is not subscriptable\")\n"
        "click.ParamType.__class_getitem__ = classmethod(refuse)\n"
        "from vorotool.cli.main import main\n"
        "main(['skeleton-exact', '--help'])\n"
    )
    done = ended_python("-c", program)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("Usage: vorotool skeleton-exact")
