"""The scripts of `make fuzz`: in the shortest time each compares something, or says that it has not."""

import re
import runpy
import sys
import warnings
from pathlib import Path

import pytest

from fuzz.runner import Cases, options
from support.few import slow
from support.processes.ended import ended_python

FUZZ = Path(__file__).parents[1] / "fuzz"


@pytest.fixture
def script_here(monkeypatch, capsys):
    """Run a script inside this process: its exit code, and what it printed and complained of."""

    def run(script, *arguments):
        monkeypatch.setattr(sys, "argv", [script, *arguments])
        monkeypatch.delenv("VOROTOOL_SIMD", raising=False)  # which scripts set
        with warnings.catch_warnings(), pytest.raises(SystemExit) as end:
            runpy.run_path(str(FUZZ / script), run_name="__main__")
        return (end.value.code, *capsys.readouterr())

    return run


def test_the_documents_list_every_script():
    scripts = {path.name for path in FUZZ.glob("*.py") if "__main__" in path.read_text(encoding="utf-8")}
    page = (FUZZ.parents[1] / "docs/tested.md").read_text(encoding="utf-8")
    assert set(re.findall(r"`(\w+\.py)`", page)) == scripts - {"together.py"}


def test_cases_that_were_not_run_have_not_passed(capsys):
    cases = Cases(options(10).parse_args(["--seconds", "0"]))
    assert list(cases) == []
    assert cases.end("cases") == 1
    assert capsys.readouterr().out.startswith("cases 0 to -1: 0 cases, 0 failures")


@pytest.mark.parametrize("script", ["predicates.py", "tessellate.py", "spacing.py", "volumes.py"])
def test_a_script_that_compares_nothing_fails(script, script_here):
    code, out, complaints = script_here(script, "--seconds", "0")
    assert (code, complaints) == (1, "")
    assert " 0 wrong" in out


@pytest.mark.parametrize(
    ("script", "arguments", "said"),
    [
        ("tessellate.py", "--pixels 400000 --seed 7", ", 0 wrong, "),
        ("voronoi.py", "--cases 10 --seed 2", "0 failures"),
        slow("voronoi.py", "--cases 72 --seed 2", "0 failures"),
        slow("spacing.py", "--pixels 100000 --first 1 --seed 7", ", 0 wrong, "),
        slow("volumes.py", "--voxels 200000 --first 1 --seed 7", ", 0 wrong, "),
        slow("digital.py", "--sets 12 --seed 3", "0 failures"),
        slow("written.py", "--sets 40 --seed 2", "0 failures"),
        slow("voronoi_cuts.py", "--cases 36 --seed 2", "0 failures"),
        slow("bytes.py", "--cases 2000 --minutes 5 --seed 7 --commands 0.02", "2,000 inputs, 0 failures"),
        slow(
            "faults.py",
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
        FUZZ / "faults.py", "--kills", "0", "--places", "0", "--pairs", "0", "--batches", "1", "--minutes", "0"
    )
    assert (done.returncode, done.stderr) == (1, "")
    assert done.stdout == "wrong: batches: none was run\n1 failures\n"


@pytest.mark.slow
def test_other_machines_are_compared_at_once(script_here):
    code, out, complaints = script_here("machines.py", "--seconds", "0", "--few", "3")
    assert (code, complaints) == (0, "")
    assert out.startswith("3 commands, 1 settings, 3 outputs compared, 0 different, 0 failed")


def test_all_that_failed_is_told():
    passed = ended_python(FUZZ / "together.py", "--minutes", "0.005", "--only", "planar_graph.py")
    assert (passed.returncode, passed.stderr) == (0, "")
    assert passed.stdout.splitlines()[-1] == "1 scripts in 0.005 minutes, 0 of them failed"
    failed = ended_python(FUZZ / "together.py", "--minutes", "0", "--only", "planar_graph.py")
    assert (failed.returncode, failed.stderr) == (1, "")
    assert "planar_graph.py      FAILED" in failed.stdout
