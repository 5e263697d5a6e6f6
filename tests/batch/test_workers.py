"""Worker processes: failures and deaths belong to one input, and an end leaves nothing."""

import os
import subprocess
import sys
import time
from pathlib import Path
from queue import SimpleQueue

import pytest

from support.processes.batch_jobs import LONG, obey, written
from support.processes.leftovers import wait_until
from vorotool.batch import workers
from vorotool.batch.workers import Worker, local_results


def results(folder, texts, jobs):
    tasks = written(folder, *texts)
    return dict(local_results(obey, iter(enumerate(tasks)), jobs=jobs)), tasks


def test_each_input_has_its_outcome(tmp_path):
    outcomes, tasks = results(tmp_path, ["a", "fail", "die", "bb", "die", "c"], jobs=2)
    assert [outcomes[number].code for number in range(6)] == [0, 3, 1, 0, 1, 0]
    assert outcomes[3].stats == {"letters": 2}
    assert outcomes[1].warnings == ("one",)
    assert outcomes[2].message == "the process that worked on it ended by SIGKILL"
    assert {path.name for path in (tmp_path / "out").iterdir()} == {"0.txt", "3.txt", "5.txt"}
    assert set(outcomes[3].outputs) == set(tasks[3].outputs)


def test_a_failure_is_told_before_more_are_taken(tmp_path):
    taken, told = [], []
    tasks = written(tmp_path, "fail", "a", "b")

    def feed():
        for number, task in enumerate(tasks):
            taken.append((number, list(told)))
            yield number, task

    for number, _ in local_results(obey, feed(), jobs=1):
        told.append(number)
    assert taken == [(0, []), (1, [0]), (2, [0, 1])]


def test_an_end_leaves_no_process_and_no_file(tmp_path, monkeypatch):
    made = []
    monkeypatch.setattr(workers, "Worker", lambda *given: made.append(Worker(*given)) or made[-1])
    going = local_results(obey, iter(enumerate(written(tmp_path, "a", "sleep", "sleep"))), jobs=3)
    assert next(going)[0] == 0
    wait_until(lambda: len(begun(tmp_path)) == 2)
    started = time.monotonic()
    going.close()
    assert time.monotonic() - started < LONG / 2  # whoever waited for the sleepers would take longer
    assert len(made) == 3
    assert all(worker.process.returncode is not None for worker in made)
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["0.txt"]


def open_descriptors():
    return sorted(path.name for path in Path("/dev/fd").iterdir())


def test_a_worker_that_cannot_start_leaves_no_socket(tmp_path, monkeypatch):
    monkeypatch.setattr(workers.sys, "executable", str(tmp_path / "none"))
    before = open_descriptors()
    with pytest.raises(FileNotFoundError) as caught:
        next(local_results(obey, iter(enumerate(written(tmp_path, "a"))), jobs=1))
    assert open_descriptors() == before  # where nothing is closed with what the exception holds
    assert caught.tb is not None


def test_a_worker_ends_quietly_where_exceptions_are_swallowed(tmp_path, capfd):
    worker = Worker(obey, SimpleQueue())
    worker.give(*written(tmp_path, "deaf"))
    wait_until((tmp_path / "0.asleep").exists)
    worker.process.terminate()
    assert worker.process.wait(30) == 143
    worker.end(0)
    assert list((tmp_path / "out").iterdir()) == []
    assert capfd.readouterr() == ("", "")


def test_workers_end_with_a_parent_that_is_killed(tmp_path):
    written(tmp_path, "sleep")
    script = (
        "import sys\nfrom pathlib import Path\nfrom support.processes.batch_jobs import obey\n"
        "from vorotool.batch.workers import Task\n"
        "from vorotool.batch.workers import local_results\n"
        "list(local_results(obey, iter([(0, Task('0.txt', ('out/0.txt',)))]), jobs=1))"
    )
    path = os.pathsep.join(sys.path)
    parent = subprocess.Popen([sys.executable, "-c", script], cwd=tmp_path, env={**os.environ, "PYTHONPATH": path})
    wait_until(lambda: begun(tmp_path))
    parent.kill()
    parent.wait()
    wait_until(lambda: not begun(tmp_path))
    assert list((tmp_path / "out").iterdir()) == []


def begun(folder):
    return [path for path in (folder / "out").iterdir() if path.suffix == ".tmp"]
