"""Tasks are started in order, until one fails; what killed runs have left is removed."""

from vorotool.batch.manifest import History, Manifest
from vorotool.batch.run import run_batch, run_tasks
from vorotool.batch.tasks import Outcome, Task

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
    outcomes = run_tasks(TASKS, two_at_a_time, keep_going=True, told=lambda task, outcome: told.append(task.source))
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
        run_tasks(TASKS, results, told=interrupt)
    except KeyboardInterrupt:
        assert closed == [True]
    else:
        raise AssertionError("the interrupt is lost")


def test_leftovers_of_earlier_runs_are_removed(tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    for name in (".vorotool-run1-3-abc.tmp", ".vorotool-run2-3-abc.tmp", "run1-3.tmp"):
        (out / name).write_text("x")
    tasks = [Task("a", (str(out / "a.csv"),))]
    manifest = Manifest(out / "m", "o", out)
    outcomes = run_batch("draw", tasks, two_at_a_time, manifest=manifest, history=History(runs=["run1"]))
    assert [outcome.code for outcome in outcomes] == [0]
    assert sorted(path.name for path in out.iterdir()) == [".vorotool-run2-3-abc.tmp", "m", "run1-3.tmp"]
