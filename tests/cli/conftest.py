"""Running the command line inside the test, and as a process of its own."""

import subprocess
import sys
from contextlib import nullcontext
from dataclasses import dataclass

import pytest

from support.processes.batches_here import results_here
from support.processes.fed_input import fed_input
from support.readers.written import rows_of
from vorotool.cli.main import main


@dataclass
class Outcome:
    code: int
    out: str
    err: str

    @property
    def rows(self):
        """Those of a table in CSV that went to standard output."""
        return rows_of(self.out)


@pytest.fixture(autouse=True)
def tasks_are_done_here(request, monkeypatch):
    """Have this process do the tasks of a batch, unless the test asks for workers."""
    if "workers" not in request.fixturenames:
        monkeypatch.setattr("vorotool.batch.workers.local_results", results_here)


@pytest.fixture
def workers():
    """Have a batch start processes, as it does for users."""


@pytest.fixture
def run(tmp_path, monkeypatch, capfd):
    """Run a command, given as words or as a line of words and more, with data on standard input if there are any.

    It runs in an empty folder. It has to end with a code, None for any, and to say some texts on standard error; a
    traceback fails the test.
    """
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "unraisablehook", sys.unraisablehook)  # which the command sets

    def call(line, *arguments, data=None, code=0, says=()):
        with nullcontext() if data is None else fed_input(data), pytest.raises(SystemExit) as end:
            main([*str(line).split(), *map(str, arguments)])
        out, err = capfd.readouterr()
        assert "Traceback" not in err
        assert code in (None, end.value.code), err
        assert all(text in err for text in ([says] if isinstance(says, str) else says)), err
        return Outcome(end.value.code, out, err)

    return call


@pytest.fixture
def process(tmp_path):
    """Start a command as a process in the empty folder."""

    def start(*arguments, **options):
        return subprocess.Popen(
            [sys.executable, "-m", "vorotool", *map(str, arguments)],
            cwd=tmp_path,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            **options,
        )

    return start


@pytest.fixture
def folder(tmp_path):
    """The folder that commands run in, with a list of points and a mask."""
    (tmp_path / "dots.csv").write_text("x,y,name\n2,1,a\n7,5,b\n1,6,c\n")
    (tmp_path / "mask.pbm").write_text("P1\n8 4\n1 1 0 0 0 0 0 0\n0 0 0 0 0 0 1 0\n0 0 0 0 0 1 0 0\n0 0 0 0 0 0 0 0\n")
    return tmp_path
