"""The figures of the paper, drawn once for all tests."""

import pytest

from support.processes.drawn_figures import drawn_figures


@pytest.fixture(scope="session")
def figures(tmp_path_factory):
    return drawn_figures("paper", tmp_path_factory)
