"""The checker of discs within little memory, however thin a shape is and wherever it lies."""

import pytest
import shapely
import shapely.affinity

from support.processes.peak_memory import watched_together

MEMORY = 250e6
TURNED = shapely.affinity.rotate(shapely.box(0, 0, 12, 1e-5), 30)


SHAPES = {
    "thin": shapely.box(0, 0, 12, 1e-6).wkt,
    "upright": shapely.box(0, 0, 3e-8, 12).wkt,
    "turned, beside a large one": f"{TURNED.wkt}\n{shapely.box(20, 0, 30, 10).wkt}",
    "a frame of four": shapely.box(0, 0, 9, 9).difference(shapely.box(1e-6, 1e-6, 9 - 1e-6, 9 - 1e-6)).wkt,
}


COMMANDS = [("skeleton-exact", name) for name in SHAPES] + [("voronoi", "thin"), ("voronoi", "upright")]


@pytest.mark.slow
def test_thin_shapes(tmp_path):
    commands = []
    for command, name in COMMANDS:
        (tmp_path / f"{name}.wkt").write_text(SHAPES[name] + "\n")
        commands.append([command, f"{name}.wkt", "--what", "discs", "--verify", "-o", f"{command} {name}.csv"])
    codes, errors, peak = watched_together(commands, tmp_path)
    assert codes == [0] * len(commands), errors
    assert peak < MEMORY
    for command, name in COMMANDS:
        assert len((tmp_path / f"{command} {name}.csv").read_text().splitlines()) > 1, (command, name)
