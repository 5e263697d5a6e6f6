"""The notebooks show what they show when they are run again."""

import nbformat
import pytest

from notebooks import NOTEBOOKS, executed, joined, shown


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_shows_what_is_kept_in_it(path):
    kept = nbformat.read(path, as_version=4)
    assert list(shown(executed(path))) == list(shown(kept)), "run `make notebooks`, and look at what it shows"


def test_there_is_one_for_each_user():
    assert [path.stem for path in NOTEBOOKS] == ["drawing", "geometry", "maps", "microscopy"]


def test_text_that_comes_in_pieces_is_one():
    pieces = [
        nbformat.v4.new_output("stream", name=name, text=text) for name, text in (("stdout", "4"), ("stdout", "\n"))
    ]
    value = nbformat.v4.new_output("execute_result", data={"text/plain": "True"})
    made = joined([*pieces, value, nbformat.v4.new_output("stream", name="stderr", text="a")])
    assert [output.get("text") for output in made] == ["4\n", None, "a"]
