"""Every block of the README and of the documents does what it says."""

import re
import shutil
from pathlib import Path

import pytest

from support.processes.ended import ended, ended_bash, ended_python

ROOT = Path(__file__).parents[2]
DOCUMENTS = ["README.md", "docs/errata.md", "docs/pipeline/README.md"]
MANUAL = ROOT / "docs/man/man1"
FENCE = re.compile(r"^```(\w+)\n(.*?)^```", re.MULTILINE | re.DOTALL)


def blocks(language):
    for name in DOCUMENTS:
        for number, match in enumerate(FENCE.finditer((ROOT / name).read_text(encoding="utf-8"))):
            if match[1] == language:
                yield pytest.param(match[2], id=f"{name}-{number}")


@pytest.fixture
def folder(tmp_path):
    """A folder like the root of the repository, to write into."""
    shutil.copytree(ROOT / "data", tmp_path / "data")
    shutil.copytree(ROOT / "docs/pipeline", tmp_path / "docs/pipeline")
    return tmp_path


@pytest.mark.parametrize("block", list(blocks("console")))
def test_console_block(block, folder):
    for part in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
        first, following, expected = re.fullmatch(r"([^\n]*\n?)((?:> [^\n]*\n)*)(.*)", part, re.DOTALL).groups()
        command = first + re.sub(r"^> ", "", following, flags=re.MULTILINE)
        if "| jq " in command and shutil.which("jq") is None:
            pytest.skip("jq is not there")
        done = ended_bash(command, folder)
        assert done.returncode == 0, f"{command}\n{done.stderr}"
        assert done.stderr == ""
        assert done.stdout == expected, command


@pytest.mark.parametrize("block", list(blocks("python")))
def test_python_block(block, folder):
    done = ended_python("-c", block, cwd=folder)
    assert done.returncode == 0, done.stderr


def test_rules_of_make_are_those_of_the_makefile():
    rules = (ROOT / "docs/pipeline/Makefile").read_text(encoding="utf-8")
    assert [block.values[0] in rules for block in blocks("make")] == [True]


def test_the_reference_is_true():
    done = ended_python(ROOT / "docs/scripts/cli_reference.py", check=True)
    assert done.stdout == (ROOT / "docs/cli.md").read_text(encoding="utf-8"), (
        "run docs/scripts/cli_reference.py > docs/cli.md"
    )


def test_the_manual_pages_are_true(tmp_path):
    ended_python(ROOT / "docs/scripts/manual_pages.py", tmp_path, check=True)
    made, kept = ({path.name: path.read_bytes() for path in folder.iterdir()} for folder in (tmp_path, MANUAL))
    assert made == kept, "run docs/scripts/manual_pages.py"


@pytest.mark.parametrize(
    "command", [["groff", "-ww", "-man", "-Tutf8", "-z"], ["mandoc", "-T", "lint", "-W", "warning"]], ids=lambda c: c[0]
)
def test_the_manual_pages_are_read_without_warnings(command):
    if shutil.which(command[0]) is None:
        pytest.skip(f"{command[0]} is not there")
    done = ended(*command, *sorted(MANUAL.iterdir()))
    said = (done.stdout + done.stderr).splitlines()
    assert [line for line in said if "missing date" not in line] == []  # they are as old as the commands


@pytest.mark.parametrize(
    "arguments",
    [[], ["tessellate"], ["delaunay"], ["alphashape"], ["skeleton-exact"], ["draw"], ["completion"]],
    ids=" ".join,
)
def test_the_example_of_the_help_runs(arguments, folder):
    text = ended_bash(f"vorotool {' '.join(arguments)} --help", folder).stdout
    example = re.search(r"Example:\s*\n\s*(vorotool .*)", text)
    assert example, "the help opens with an example"
    done = ended_bash(example[1], folder)
    assert (done.returncode, done.stderr) == (0, ""), example[1]
