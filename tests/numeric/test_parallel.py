"""Work on several threads: order, exceptions, interrupts."""

import itertools
import threading
import time

import pytest

from vorotool.numeric import parallel
from vorotool.numeric.checks import available_threads
from vorotool.numeric.parallel import in_chunks, in_order, in_threads


@pytest.mark.parametrize("threads", [0, 1, 2, 5])
def test_in_order_keeps_the_order(threads: int) -> None:
    assert list(in_order(lambda x: x * x, range(200), threads)) == [x * x for x in range(200)]


@pytest.mark.parametrize("threads", [1, 3])
def test_in_order_takes_only_a_few_items_ahead(threads: int) -> None:
    taken = itertools.count()
    results = in_order(lambda x: x, (next(taken) for _ in range(1000)), threads)
    next(results)
    assert next(taken) <= 2 * threads + 2
    results.close()


def test_in_order_passes_errors_on_and_leaves_no_thread() -> None:
    before = threading.active_count()  # other tests may have left a cluster's threads

    def fail(x: int) -> int:
        raise RuntimeError(f"item {x}")

    with pytest.raises(RuntimeError, match="item 0"):
        list(in_order(fail, range(50), 3))
    assert threading.active_count() <= before


def test_available_threads_is_positive() -> None:
    assert available_threads() >= 1


@pytest.mark.parametrize("count", [0, 1, 99, 100])
def test_chunks_are_all_rows_once(count, monkeypatch):
    monkeypatch.setattr(parallel, "CHUNK", 7)
    seen = []
    in_chunks(count, lambda rows: seen.extend(range(count)[rows]), threads=2)
    assert sorted(seen) == list(range(count))


def test_chunks_that_were_not_begun_are_left_when_one_fails(monkeypatch):
    monkeypatch.setattr(parallel, "CHUNK", 1)
    seen = []

    def fill(rows):
        seen.append(rows.start)
        time.sleep(0.01)
        raise ValueError("no")

    with pytest.raises(ValueError, match="no"):
        in_chunks(10_000, fill, threads=2)
    assert len(seen) < 5000  # 50 seconds of work, whatever else the machine does


@pytest.mark.parametrize("threads", [1, 3])
def test_results_are_in_the_order_of_the_tasks(threads):
    seen = []
    tasks = [lambda _, k=k: k * k for k in range(20)]
    assert in_threads(tasks, threads, seen.append) == [k * k for k in range(20)]
    assert set(seen) <= {(k + 1) / 20 for k in range(20)}  # tasks that tell nothing count when they are done
    assert seen == sorted(seen)
    assert len(seen) >= 20
    assert seen[-1] == 1


def test_what_a_long_task_tells_is_shown():
    shown = threading.Event()

    def long(progress):
        progress(0.5)
        assert shown.wait(60)

    def show(fraction):
        if 0.5 <= fraction < 1:  # the other task is done
            shown.set()

    assert in_threads([long, lambda _: None], 2, show) == [None, None]


def test_an_exception_stops_the_others():
    started = threading.Event()

    def endless(progress):
        started.set()
        while True:
            progress(0.5)

    def failing(_):
        started.wait()
        raise ValueError("no")

    with pytest.raises(ValueError, match="no"):
        in_threads([failing, endless], 2, None)
