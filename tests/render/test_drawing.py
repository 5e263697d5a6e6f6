"""Pictures of values: what has none, and layers that are computed when they are drawn."""

import pytest

import vorotool

MESH = vorotool.delaunay([[0, 0], [4, 0], [0, 3], [5, 5]])
WITHOUT = (vorotool.PointSet([[0, 0], [4, 1]]), MESH.table(), vorotool.cell_statistics(MESH))


@pytest.mark.parametrize("value", WITHOUT, ids=lambda value: type(value).__name__)
@pytest.mark.parametrize("options", [{}, {"label_by": "name"}, {"scale_bar": True}], ids=str)
def test_what_has_no_picture_is_refused(tmp_path, value, options):
    with pytest.raises(vorotool.UsageError, match=f"a {type(value).__name__} has no picture"):
        vorotool.write(value, tmp_path / "a.svg", **options)
    assert not (tmp_path / "a.svg").exists()
