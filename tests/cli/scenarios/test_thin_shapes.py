"""The checker of discs within little memory, however thin a shape is and wherever it lies."""

import pytest
import shapely
import shapely.affinity

from support.processes.peak_memory import watched

MEMORY = 250e6
TURNED = shapely.affinity.rotate(shapely.box(0, 0, 12, 1e-5), 30)


SHAPES = {
    "thin": shapely.box(0, 0, 12, 1e-6).wkt,
    "upright": shapely.box(0, 0, 3e-8, 12).wkt,
    "turned, beside a large one": f"{TURNED.wkt}\n{shapely.box(20, 0, 30, 10).wkt}",
    "a frame of four": shapely.box(0, 0, 9, 9).difference(shapely.box(1e-6, 1e-6, 9 - 1e-6, 9 - 1e-6)).wkt,
}


@pytest.mark.parametrize(
    ("command", "name"), [*(("skeleton-exact", name) for name in SHAPES), ("voronoi", "thin"), ("voronoi", "upright")]
)
def test_thin_shapes(command, name, tmp_path):
    (tmp_path / "shape.wkt").write_text(SHAPES[name] + "\n")
    arguments = [command, "shape.wkt", "--what", "discs", "--verify", "-o", "discs.csv"]
    code, errors, peak = watched(arguments, tmp_path)
    assert code == 0, errors
    assert peak < MEMORY
    assert len((tmp_path / "discs.csv").read_text().splitlines()) > 1
