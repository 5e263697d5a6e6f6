"""Run the notebooks of `docs/notebooks`, and write what they show into them: `docs/scripts/notebooks.py [--check]`.

Each runs in a folder of its own. `--check` writes nothing, and ends with 1 if one shows something else than it has.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import nbformat
from nbclient import NotebookClient

FOLDER = Path(__file__).parents[1] / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
COMPARED = ("text/plain", "image/svg+xml", "text/html")
"""What is the same with every version of the libraries that draw and print; small pictures are in HTML."""


def executed(path: Path) -> Any:
    """Give a notebook with what its cells show, without times and numbers of runs.

    Parameters
    ----------
    path : Path
        The notebook.

    Returns
    -------
    nbformat.NotebookNode
        As it is written.
    """
    notebook = nbformat.read(path, as_version=4)
    with tempfile.TemporaryDirectory() as folder:
        NotebookClient(notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": folder}}).execute()
    for order, cell in enumerate((cell for cell in notebook.cells if cell.cell_type == "code"), 1):
        cell.metadata = {}
        cell.execution_count = order
        cell.outputs = joined(cell.outputs)
        for output in cell.outputs:
            if "execution_count" in output:
                output.execution_count = order
    notebook.metadata = {
        "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
        "language_info": {"name": "python"},
    }
    return notebook


def joined(outputs: list[Any]) -> list[Any]:
    """Join texts that follow each other in one stream: a kernel sends them in as many pieces as it has time for."""
    made: list[Any] = []
    for output in outputs:
        if output.output_type == "stream" and made and made[-1].get("name") == output.name:
            made[-1].text += output.text
        else:
            made.append(output)
    return made


def shown(notebook: Any) -> Iterator[tuple[int, str, str]]:
    """Give what the cells show: the number of the cell, the kind, and the text."""
    for number, cell in enumerate(notebook.cells):
        for output in cell.get("outputs", ()):
            if output.output_type == "stream":
                yield number, output.name, output.text
            for kind, content in sorted(output.get("data", {}).items()):
                if kind in COMPARED:
                    yield number, kind, content


def main() -> None:
    """Run what the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--check", action="store_true", help="write nothing")
    check = parser.parse_args().check
    for path in NOTEBOOKS:
        made = executed(path)
        if not check:
            nbformat.write(made, path)
        elif list(shown(made)) != list(shown(nbformat.read(path, as_version=4))):
            sys.exit(f"{path.name} shows something else: run docs/scripts/notebooks.py")


if __name__ == "__main__":
    main()
