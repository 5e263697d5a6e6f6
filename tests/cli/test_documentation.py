"""The help names the manual pages and the documents that are installed, and nothing that is not there."""

import re
from importlib import metadata
from pathlib import PurePosixPath

import pytest

from vorotool.cli import main as documentation
from vorotool.cli.main import COMMANDS

MANUAL, README = "../../../share/man/man1/vorotool.1", "../../../share/doc/vorotool/README.md"


class Installed(PurePosixPath):
    """A file of a package, as its record has it."""

    def locate(self):
        return self.root_folder / self


@pytest.fixture
def install(tmp_path, monkeypatch):
    """Install files below a folder, some of which are recorded and not there."""
    Installed.root_folder = tmp_path / "lib/python3/site-packages"

    def call(recorded, existing):
        for name in existing:
            path = (Installed.root_folder / name).resolve()
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text("")
        Installed.root_folder.mkdir(parents=True, exist_ok=True)
        monkeypatch.setattr(metadata, "files", lambda _: recorded and [Installed(name) for name in recorded])
        return documentation.places()

    return call


def test_what_is_installed_is_named(install, tmp_path):
    rows = install(["vorotool/cli.py", MANUAL, README], [MANUAL, README])
    text = " ".join(part for row in rows for part in row)
    assert f"in {tmp_path}/share/man " in text
    assert f"{tmp_path}/share/doc/vorotool/README.md" in text


@pytest.mark.parametrize("recorded", [None, [], [MANUAL, README]])
def test_what_is_not_there_is_not_named(install, recorded):
    assert install(recorded, []) == []


def test_a_package_that_is_only_on_the_path_has_no_record(monkeypatch):
    def files(name):
        raise metadata.PackageNotFoundError(name)

    monkeypatch.setattr(metadata, "files", files)
    assert documentation.places() == []


def test_a_path_is_shown_in_every_encoding(install, monkeypatch, tmp_path):
    class Ascii:
        encoding = "ascii"

    monkeypatch.setattr(documentation.sys, "stdout", Ascii())
    Installed.root_folder = tmp_path / "Zo\xeb\u2026/lib/python3/site-packages"
    rows = install([MANUAL], [MANUAL])
    assert rows[0][1].endswith("Zo\\xeb\\u2026/share/man")


@pytest.mark.parametrize("name", COMMANDS)
def test_the_help_of_each_command_names_its_manual_page(run, name):
    assert f"man vorotool-{name}" in re.sub(r"\s+", " ", run(name, "--help").out)
