"""What packages are made of and say of themselves; `make wheel` makes them, and runs what is in them."""

import re
import tomllib
from pathlib import Path

import pytest
import yaml

import vorotool

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
WORKFLOWS = sorted((ROOT / ".github/workflows").glob("*.yml"))


def test_the_citation_is_of_this_version():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert citation["version"] == vorotool.__version__
    assert citation["cff-version"] == "1.2.0"
    assert {"message", "title", "authors", "license"} <= set(citation)
    [article] = citation["references"]
    assert article["title"] == "Voronoi Diagrams and Applications"
    assert [author["family-names"] for author in article["authors"]] == ["Melkemi", "Vandorpe"]


def test_the_changelog_has_an_entry_for_this_version():
    entries = re.findall(r"^## (\S+)", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert vorotool.__version__ in entries


def test_the_version_is_in_no_other_place():
    assert "version" in PROJECT["project"]["dynamic"]
    assert "version" not in PROJECT["project"]


def test_the_stable_abi_is_that_of_the_first_python_after_the_oldest():
    assert PROJECT["project"]["requires-python"] == ">=3.11"
    assert PROJECT["tool"]["scikit-build"]["wheel"]["py-api"] == "cp312"
    assert PROJECT["tool"]["cibuildwheel"]["build"] == ["cp311-*", "cp312-*"]


def test_no_wheel_has_what_only_tests_call():
    settings = PROJECT["tool"]["scikit-build"]
    assert settings["cmake"]["define"]["VOROTOOL_TESTING"] == "OFF"
    [editable] = settings["overrides"]
    assert editable["if"] == {"state": "editable"}
    assert editable["cmake"]["define"] == {"VOROTOOL_TESTING": "ON"}


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.name)
def test_actions_are_pinned(path):
    workflow = yaml.safe_load(path.read_text(encoding="utf-8"))
    steps = [step for job in workflow["jobs"].values() for step in job["steps"]]
    used = [step["uses"] for step in steps if "uses" in step]
    assert used
    assert all(re.fullmatch(r"[a-z]+/[a-z-]+@v[0-9.]+", action) for action in used)


def test_wheels_are_made_for_all_systems():
    [path] = [path for path in WORKFLOWS if path.name == "wheels.yml"]
    matrix = yaml.safe_load(path.read_text(encoding="utf-8"))["jobs"]["wheels"]["strategy"]["matrix"]["include"]
    linux = [("linux", "x86_64"), ("linux", "aarch64")]
    others = [("macos", "x86_64"), ("macos", "arm64"), ("windows", "AMD64")]
    assert [(each["platform"], each["arch"]) for each in matrix] == linux + others
    skipped = PROJECT["tool"]["cibuildwheel"]["skip"]
    assert not any("x86_64" in name or "aarch64" in name for name in skipped)


def test_no_code_is_for_the_processor_that_compiles():
    files = [path for path in (ROOT / "src").rglob("*") if path.name == "CMakeLists.txt" or path.suffix == ".cmake"]
    assert files
    assert not any("native" in path.read_text(encoding="utf-8") for path in files)


OF_ONE_SYSTEM = re.compile(r"#include <((?:sys/|linux/|net/)\S+|unistd\.h|pthread\.h|malloc\.h|fcntl\.h|dlfcn\.h)>")


def test_headers_of_one_system_are_asked_for_on_it_alone():
    found = 0
    for path in (ROOT / "src").rglob("*.[ch]pp"):
        lines = path.read_text(encoding="utf-8").splitlines()
        for number, line in enumerate(lines):
            if OF_ONE_SYSTEM.match(line):
                found += 1
                before = next(each for each in reversed(lines[:number]) if not OF_ONE_SYSTEM.match(each))
                assert before in ("#ifdef __linux__", "#ifdef __GLIBC__"), f"{path}:{number + 1}"
    assert found == 5


def test_the_description_is_the_readme_without_links_that_lead_nowhere():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    words = re.findall(r"\w+", re.sub(r"!\[.*?\]\(.*?\)|\]\(.*?\)", "", text))
    for each in PROJECT["tool"]["hatch"]["metadata"]["hooks"]["fancy-pypi-readme"]["substitutions"]:
        text = re.sub(each["pattern"], each["replacement"], text)
    assert "](" not in text
    assert re.findall(r"\w+", text) == words


def test_what_work_on_vorotool_needs_is_no_extra():
    extras = names(*PROJECT["project"]["optional-dependencies"].values())
    assert not {"pytest", "ruff", "sphinx", "cmake", "pyvoronoi"} & extras
    assert names(PROJECT["build-system"]["requires"]) < names(PROJECT["dependency-groups"]["build"])


def names(*lists):
    """Names of the packages in lists of requirements."""
    return {line.partition(">")[0] for lines in lists for line in lines}
