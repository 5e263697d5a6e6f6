"""Independent parts in threads: order, exceptions, interrupts."""

import threading

import pytest

from vorotool.engines.common.parallel_parts import in_threads


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
