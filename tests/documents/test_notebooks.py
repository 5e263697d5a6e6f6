"""The notebooks run without an error, and what they assert holds. The site has what they show."""

import nbformat
import pytest
from nbclient import NotebookClient

from support.documents import ROOT

NOTEBOOKS = sorted((ROOT / "docs/notebooks").glob("*.ipynb"))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path, tmp_path):
    notebook = nbformat.read(path, as_version=4)
    NotebookClient(notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": tmp_path}}).execute()


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_kept_without_outputs(path):
    cells = [cell for cell in nbformat.read(path, as_version=4).cells if cell.cell_type == "code"]
    assert any("assert " in cell.source or ".verify_" in cell.source for cell in cells)
    assert all(cell.outputs == [] and cell.execution_count is None for cell in cells), "clear all outputs"


def test_there_is_one_for_each_user():
    assert [path.stem for path in NOTEBOOKS] == ["drawing", "geometry", "maps", "microscopy"]
