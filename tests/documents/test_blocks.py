"""Every block of the README and of the documents does what it says."""

import re
import shutil
import tomllib

import pytest

from support.documents import ROOT, blocks
from support.processes.ended import ended, ended_bash, ended_python
from vorotool.cli.commands.sample import write_all_samples
from vorotool.cli.main import COMMANDS

PICTURES = [*(ROOT / "docs/images").glob("*.svg")]
"""Those that a page shows are what its commands draw."""
MANUAL = ROOT / "docs/man/man1"


def cases(language):
    """Blocks of all documents as parameters of a test; those that start a cluster are slow."""
    slow = {True: [pytest.mark.slow], False: []}
    return [pytest.param(block, id=name, marks=slow["--cluster" in block]) for name, block in blocks(language)]


@pytest.mark.parametrize("block", cases("console"))
def test_console_block(block, folder, warm_bash):
    for part in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
        first, following, expected = re.fullmatch(r"([^\n]*\n?)((?:> [^\n]*\n)*)(.*)", part, re.DOTALL).groups()
        command = first + re.sub(r"^> ", "", following, flags=re.MULTILINE)
        if "| jq " in command and shutil.which("jq") is None:
            pytest.skip("jq is not there")
        done = warm_bash(command, folder)
        assert done.returncode == 0, f"{command}\n{done.stderr}"
        assert done.stderr == ""
        assert done.stdout == expected, command
    write_all_samples(str(folder))  # which refuses where a command has replaced one
    for picture in PICTURES:
        made = folder / picture.name
        assert not made.exists() or made.read_bytes() == picture.read_bytes(), f"copy {picture.name} anew"


@pytest.mark.parametrize("block", cases("python"))
def test_python_block(block, folder, warm_python):
    done = warm_python(block, folder)
    assert done.returncode == 0, done.stderr
    write_all_samples(str(folder))


@pytest.mark.parametrize("block", cases("sh"))
def test_what_needs_the_network_or_minutes_could_be_run(block):
    """Targets of make are there, and so are the extras that pip is asked for; test_gallery.py has commands."""
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]
    for line in block.splitlines():
        words = line.partition("#")[0].split()
        if words[0] == "make":
            assert ended_bash(f"make -n {words[1]}", ROOT).returncode == 0, line
        elif words[:2] == ["pip", "install"] or words[1:3] == ["-m", "pip"]:
            named = re.search(r"\[([a-z,]+)\]", line)
            assert set(named[1].split(",") if named else ()) <= set(extras), line
        elif words[0] == ".venv/bin/python":
            shared = (ROOT / "tests/benchmarks/timing.py").read_text(encoding="utf-8")
            script = (ROOT / words[1]).read_text(encoding="utf-8") + shared
            asked = [word for word in words[2:] if word.startswith("--")]
            assert all(f'"{word}"' in script or f'"{word[2:]}"' in script for word in asked), line
        else:
            assert words[0] in ("vorotool", ".venv/bin/vorotool"), line


def test_rules_of_make_are_those_of_the_makefile():
    rules = (ROOT / "docs/pipeline/Makefile").read_text(encoding="utf-8")
    assert [block in rules for _, block in blocks("make")] == [True]


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


@pytest.mark.parametrize("arguments", [[], *([name] for name in COMMANDS)], ids=" ".join)
def test_the_example_of_the_help_runs_in_an_empty_folder(arguments, tmp_path, warm_bash):
    """All lines of it, which use samples that come with the package."""
    text = warm_bash(f"vorotool {' '.join(arguments)} --help", tmp_path).stdout
    example = re.search(r"Example:\s*\n((?:\s*vorotool .*\n)+)", text)
    assert example, "the help opens with an example"
    done = warm_bash(f"set -e\n{example[1]}", tmp_path)
    assert (done.returncode, done.stderr) == (0, ""), example[1]
    assert done.stdout or any(tmp_path.iterdir())
