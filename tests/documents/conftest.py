"""What readers have when they follow the documents."""

import os
import shutil

import pytest

from support.documents import ROOT
from support.processes.ended import ENVIRONMENT, ended, ended_bash
from support.processes.warm_commands import warm_commands
from vorotool.cli.commands.sample import write_all_samples


@pytest.fixture(scope="session")
def warm(tmp_path_factory):
    """The environment of a shell whose `vorotool` is a process that needs not import anything."""
    with warm_commands(tmp_path_factory.mktemp("programs")) as programs:
        yield {**ENVIRONMENT, "PATH": f"{programs}{os.pathsep}{ENVIRONMENT['PATH']}"}


@pytest.fixture
def warm_bash(warm):
    """Run a line of a shell in a folder."""
    return lambda line, folder: ended_bash(line, folder, env=warm)


@pytest.fixture
def warm_python(warm):
    """Run a script of Python in a folder."""
    return lambda script, folder: ended(shutil.which("warm-python", path=warm["PATH"]), script, cwd=folder, env=warm)


@pytest.fixture(scope="session")
def samples(tmp_path_factory):
    """A folder with what a reader has there: the samples, and the pipeline that a page explains."""
    folder = tmp_path_factory.mktemp("samples")
    write_all_samples(str(folder))
    shutil.copytree(ROOT / "docs/pipeline", folder / "docs/pipeline")
    return folder


@pytest.fixture
def folder(samples, tmp_path):
    """A copy of the samples."""
    return shutil.copytree(samples, tmp_path, dirs_exist_ok=True)
