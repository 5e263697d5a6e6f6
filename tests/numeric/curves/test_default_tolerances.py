"""Each curve has its own tolerance, whatever else is in the file."""

import numpy as np
import pytest
import shapely

import vorotool
from vorotool.numeric.coordinates import writing

HOUSES = [shapely.box(x, 0, x + 8, 6) for x in (0, 11, 24)]
FAR = shapely.box(4e5, 3e5, 4e5 + 8, 3e5 + 6)


@pytest.mark.parametrize("make", [lambda shapes: vorotool.offset(shapes, 1), vorotool.largest_discs])
def test_a_far_feature_changes_no_shape(make):
    alone, together = make(HOUSES).to_shapely(), make([*HOUSES, FAR]).to_shapely()
    counts = shapely.get_num_coordinates(together)[: len(alone)]
    assert counts.tolist() == shapely.get_num_coordinates(alone).tolist()
    assert shapely.hausdorff_distance(alone, together[: len(alone)]).max() < 1e-3


def test_borders_and_skeletons_keep_their_distance():
    """Lines are within the larger of 1/2000 of the extent of a curve and 1/100 of its clearance."""
    cells = vorotool.voronoi(["LINESTRING (0 0, 100 0)", "POINT (50 1)"], frame=(0, -10, 100, 60))
    with writing() as curves:
        cells.to_shapely()
    assert 0 < curves.deviation <= 110 / 2000
    skeleton = vorotool.skeleton_exact([[0, 0], [10, 0], [10, 10], [5, 4], [0, 10]])
    with writing() as curves:
        skeleton.to_shapely()
    assert 0 < curves.deviation <= 0.05


def test_circles_of_drawings_keep_their_form(tmp_path):
    """A hole of 10 mm in a sheet of 2.4 m."""
    pytest.importorskip("svgelements")
    (tmp_path / "sheet.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="2400mm" height="1200mm" viewBox="0 0 2400 1200">'
        '<path d="M0 0H2400V1200H0Z"/><circle cx="60" cy="60" r="5"/></svg>'
    )
    shapes = vorotool.read(tmp_path / "sheet.svg", geometry="polygons")
    area = min(shape.area for shape in shapes.to_shapely())
    assert area == pytest.approx(np.pi * 25, rel=2e-3)


def test_the_default_has_a_name(tmp_path):
    (tmp_path / "arc.wkt").write_text("CURVEPOLYGON (CIRCULARSTRING (0 0, 4 4, 8 0, 4 -4, 0 0))")
    curved = vorotool.read(tmp_path / "arc.wkt", geometry="polygons", flatten="auto")
    np.testing.assert_array_equal(curved.xy, vorotool.read(tmp_path / "arc.wkt", geometry="polygons").xy)
    for value in (vorotool.skeleton_exact(HOUSES), vorotool.offset(HOUSES, 1), vorotool.voronoi(HOUSES), curved):
        if value is not curved:
            np.testing.assert_array_equal(value.to_shapely(flatten="auto"), value.to_shapely())
        assert vorotool.to_geojson(value, flatten="auto") == vorotool.to_geojson(value)
        vorotool.write(value, tmp_path / "a.wkt", flatten="auto")
        vorotool.write(value, tmp_path / "b.wkt")
        assert (tmp_path / "a.wkt").read_bytes() == (tmp_path / "b.wkt").read_bytes()
    np.testing.assert_array_equal(
        vorotool.rebuild(vorotool.skeleton_exact(HOUSES), flatten="auto").xy,
        vorotool.rebuild(vorotool.skeleton_exact(HOUSES)).xy,
    )
    with pytest.raises(vorotool.UsageError, match="give a number"):
        vorotool.to_geojson(curved, flatten="fine")
