"""Every command writes the same bytes where Python lacks what it lacks on Windows: modules, functions, signals."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from smoke import RUNS, Smoke
from vorotool.cli.main import COMMANDS

ROOT = Path(__file__).parents[2]
WITHOUT = {**os.environ, "PYTHONPATH": str(ROOT / "tests/support/without_posix")}
START = [sys.executable, "-m", "vorotool"]


def contents(folder):
    """Lines of all files; of a record of a batch without the first, whose run's number is drawn, in any order."""
    files = {
        str(path.relative_to(folder)): path.read_bytes().split(b"\n") for path in folder.rglob("*") if path.is_file()
    }
    return {name: sorted(lines[1:]) if name.endswith(".manifest.jsonl") else lines for name, lines in files.items()}


def test_the_smoke_runs_every_command():
    assert set(RUNS) == set(COMMANDS)


@pytest.mark.slow
def test_commands_write_the_same_bytes(tmp_path):
    written = []
    for name, environment in ("here", None), ("without", WITHOUT):
        folder = tmp_path / name
        folder.mkdir()
        Smoke(folder, start=START, environment=environment).all_commands()
        written.append(contents(folder))
    assert written[0] == written[1]
    assert len(written[0]) > 15


def test_modules_of_the_commands_can_be_imported():
    script = (
        "import sys\n"
        "from vorotool.cli.main import COMMANDS, vorotool\n"
        "from vorotool.products.commands import COMMANDS as jobs\n"
        "from vorotool.products.formats import resolved\n"
        "for command in COMMANDS:\n"
        "    vorotool.get_command(None, command)\n"
        "    command in jobs and resolved(jobs[command].job)\n"
        "    print(command, 'fcntl' in sys.modules)\n"
    )
    done = subprocess.run([sys.executable, "-c", script], env=WITHOUT, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.splitlines() == [f"{command} False" for command in COMMANDS]


def test_the_library_can_be_used():
    script = "import sys; sys.path.insert(0, 'tools'); import smoke; smoke.library(); import fcntl"
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=ROOT, env=WITHOUT, capture_output=True, text=True, check=False
    )
    assert "ModuleNotFoundError: No module named 'fcntl'" in done.stderr
    assert "smoke.py" not in done.stderr
    assert done.returncode == 1


def test_standard_streams(tmp_path):
    outputs = []
    for environment in None, WITHOUT:
        command = [*START, "tessellate", "-", "--size", "9x7", "-f", "text", "-o", "-"]
        done = subprocess.run(command, input=b"x,y\n1,1\n7,5\n", env=environment, capture_output=True, check=True)
        outputs.append(done.stdout)
    assert outputs[0] == outputs[1]
    assert len(outputs[0].split()) == 63


def test_a_batch_whose_worker_dies_goes_on(tmp_path):
    script = (
        "import os\n"
        "from pathlib import Path\n"
        "from vorotool.batch.workers import local_results\n"
        "from vorotool.batch.workers import Outcome, Task\n"
        "from support_of_test import work\n"
        "if __name__ == '__main__':\n"
        "    tasks = enumerate(Task(str(n), ()) for n in range(6))\n"
        "    print(sorted((number, outcome.code) for number, outcome in local_results(work, tasks, jobs=1)))\n"
    )
    (tmp_path / "run.py").write_text(script)
    (tmp_path / "support_of_test.py").write_text(
        "import os\nfrom vorotool.batch.workers import Outcome\n"
        "def work(task):\n"
        "    if task.file == '2':\n        os._exit(7)\n"
        "    return Outcome()\n"
    )
    done = subprocess.run(
        [sys.executable, "run.py"], cwd=tmp_path, env=WITHOUT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == str([(0, 0), (1, 0), (2, 1), (3, 0), (4, 0), (5, 0)])
