"""Tasks are started in order, until one fails; what killed runs have left is removed."""

import fcntl
from pathlib import Path

from vorotool.batch.records import Manifest
from vorotool.batch.run import run_tasks
from vorotool.batch.workers import Outcome, Task
from vorotool.formats.io.temporaries import _host

TASKS = [Task(name, (f"out/{name}",)) for name in "abcde"]


def two_at_a_time(tasks):
    """The later one of two is done first, and c fails."""
    pending = []
    for number, task in tasks:
        pending.append((number, Outcome(code=3 * (task.source == "c"))))
        if len(pending) == 2:
            yield from (pending.pop(), pending.pop())
    yield from pending


def test_outcomes_come_in_the_order_of_tasks():
    told = []
    outcomes = run_tasks(TASKS, two_at_a_time, keep_going=True, finish=lambda task, outcome: told.append(task.source))
    assert told == ["b", "a", "d", "c", "e"]
    assert [outcome.code for outcome in outcomes] == [0, 0, 3, 0, 0]


def test_no_more_are_started_after_a_failure():
    outcomes = run_tasks(TASKS, two_at_a_time)
    assert [outcome and outcome.code for outcome in outcomes] == [0, 0, 3, 0, None]


def test_results_are_closed_when_it_ends():
    closed = []

    def results(tasks):
        try:
            yield from two_at_a_time(tasks)
        finally:
            closed.append(True)

    def interrupt(task, outcome):
        raise KeyboardInterrupt

    try:
        run_tasks(TASKS, results, finish=interrupt)
    except KeyboardInterrupt:
        assert closed == [True]
    else:
        raise AssertionError("the interrupt is lost")


def test_what_the_dead_have_left_is_removed_and_what_others_write_is_not(tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    (out / dead_name("0a1b2c3d-3-")).write_text("of a killed run")
    live = ".vorotool-0123456789abcdef.tmp"
    (out / live).write_text("of version 0.1.0")
    tasks = [Task("a", (str(out / "a.csv"),))]
    with (out / dead_name("0a1b2c3d-4-")).open("w") as writer:
        fcntl.flock(writer, fcntl.LOCK_EX)
        outcomes = run_tasks(tasks, two_at_a_time, manifest=Manifest(out, "draw", "o"))
        assert {path.name for path in out.iterdir()} == {Path(writer.name).name, live, "draw.manifest.jsonl"}
    assert [outcome.code for outcome in outcomes] == [0]


def test_what_lost_workers_have_left_is_removed_at_the_end(tmp_path):
    """Also of another machine: the batch is over."""
    left = []

    def results(tasks):
        for number, task in tasks:
            left.append(tmp_path / f".vorotool-{24 * 'f'}-{task.tag}{16 * '0'}.tmp")
            left[-1].write_text("x")
            yield number, Outcome(code=3 * (task.source == "b"))

    tasks = [Task(name, (str(tmp_path / name),)) for name in "abc"]
    run_tasks(tasks, results, manifest=Manifest(tmp_path, "draw", "o"))
    assert len(left) == 2
    assert [path.name for path in tmp_path.iterdir()] == ["draw.manifest.jsonl"]


def dead_name(tag):
    return f".vorotool-{''.join(_host())}-{tag}{16 * '0'}.tmp"
