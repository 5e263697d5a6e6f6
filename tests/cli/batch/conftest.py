"""Batches that run inside the test, but where workers are what is tested."""

import pytest

from support.processes.batches_here import results_here


@pytest.fixture(autouse=True)
def tasks_are_done_here(request, monkeypatch):
    """Have this process do the tasks of a batch, unless the test asks for workers."""
    if "workers" not in request.fixturenames:
        monkeypatch.setattr("vorotool.batch.process_pool.local_results", results_here)


@pytest.fixture
def workers():
    """Have a batch start processes, as it does for users."""
