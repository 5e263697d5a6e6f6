"""The scripts of `make fuzz`: in the shortest time each compares something, or says that it has not."""

import re
import sys
import warnings
from pathlib import Path

import pytest

from fuzz import run
from fuzz.runner import Cases, options
from support.few import slow
from support.processes.ended import ended_python

FUZZ = Path(__file__).parents[1] / "fuzz"


@pytest.fixture
def script_here(monkeypatch, capsys):
    """Run a script inside this process: its exit code, and what it printed and complained of."""

    def here(script, *arguments):
        monkeypatch.setattr(sys, "argv", ["run.py", script, *arguments])
        monkeypatch.delenv("VOROTOOL_SIMD", raising=False)  # which scripts set
        with warnings.catch_warnings():
            return (run.main(), *capsys.readouterr())

    return here


def test_the_documents_list_every_script():
    texts = {path.name: path.read_text(encoding="utf-8") for path in FUZZ.glob("*.py")}
    scripts = {name for name, text in texts.items() if "\nCOMPARISON = " in text or "\ndef main(" in text}
    page = (FUZZ.parents[1] / "docs/tested.md").read_text(encoding="utf-8")
    assert set(re.findall(r"`(\w+\.py)`", page)) == scripts - {"together.py", "run.py"}


def test_cases_that_were_not_run_have_not_passed(capsys):
    cases = Cases(options(10).parse_args(["--seconds", "0"]))
    assert list(cases) == []
    assert cases.end("cases") == 1
    assert capsys.readouterr().out.startswith("cases 0 to -1: 0 cases, 0 failures")


@pytest.mark.parametrize(
    ("script", "arguments", "said"),
    [
        ("tessellate", "--pixels 400000 --seed 7", "0 failures, pixels: "),
        ("voronoi", "--cases 10 --seed 2", "10 cases, 0 failures"),
        slow("digital", "--sets 12 --seed 3", "0 failures"),
        slow("written", "--sets 40 --seed 2", "0 failures"),
        slow("bytes", "--cases 2000 --minutes 5 --seed 7 --commands 0.02", "2,000 inputs, 0 failures"),
        slow(
            "faults",
            "--writers png,csv,zarr --kills 3 --places 6 --batches 0 --pairs 0",
            "kills that left a temporary: 3",
        ),
    ],
)
def test_a_little_of_what_is_done_for_longer(script, arguments, said, script_here):
    code, out, complaints = script_here(script, *arguments.split())
    assert code == 0, out + complaints
    assert said in out


def test_no_kind_of_faults_is_left_out():
    done = ended_python(
        FUZZ / "run.py", "faults", "--kills", "0", "--places", "0", "--pairs", "0", "--batches", "1", "--minutes", "0"
    )
    assert (done.returncode, done.stderr) == (1, "")
    assert done.stdout == "wrong: batches: none was run\n1 failures\n"


@pytest.mark.slow
def test_other_machines_are_compared_at_once(script_here):
    code, out, complaints = script_here("machines", "--seconds", "0", "--few", "3")
    assert (code, complaints) == (0, "")
    assert out.startswith("3 commands, 1 settings, 3 outputs compared, 0 different, 0 failed")


def test_all_that_failed_is_told():
    passed = ended_python(FUZZ / "run.py", "together", "--minutes", "0.005", "--only", "planar_graph")
    assert (passed.returncode, passed.stderr) == (0, "")
    assert passed.stdout.splitlines()[-1] == "1 scripts in 0.005 minutes, 0 of them failed"
    failed = ended_python(FUZZ / "run.py", "together", "--minutes", "0", "--only", "planar_graph")
    assert (failed.returncode, failed.stderr) == (1, "")
    assert "planar_graph         FAILED" in failed.stdout
