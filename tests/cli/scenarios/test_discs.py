"""`--what discs` of skeletons and Voronoi diagrams: tables, GeoJSON, pictures, units, refusals."""

import json

import numpy as np
from PIL import Image


def test_a_row_a_feature(run, tmp_path):
    shapes = {"pool": [[0, 0], [10, 0], [10, 2], [0, 2]], "pond": [[0, 5], [4, 5], [4, 9], [0, 9]]}
    (tmp_path / "a.json").write_text(json.dumps([{"id": name, "shell": ring} for name, ring in shapes.items()]))
    rows = run("skeleton-exact a.json --what discs --verify").rows
    found = [[row[name] for name in ("id", "x", "y", "r", "feet")] for row in rows]
    assert found == [["pool", "5", "1", "1", "2"], ["pond", "2", "7", "2", "4"]]
    assert (rows[0]["x_1"], {rows[0]["y_1"], rows[0]["y_2"]}, rows[0]["x_3"]) == ("5", {"0", "2"}, "")


def test_masks_in_units(run, tmp_path):
    mask = np.zeros((12, 20), dtype=np.uint8)
    mask[2:10, 3:17] = 255
    Image.fromarray(mask).save(tmp_path / "mask.png")
    (row,) = run("skeleton-exact mask.png --what discs --verify --pixel-size 0.5um").rows
    assert (row["r"], row["unit"]) == ("2", "um")
    stats = json.loads(run("skeleton-exact mask.png --what discs --local --stats - -o d.csv").out)
    assert (stats["discs"], stats["largest_radius"]) == (1, 4)


def test_empty_discs_in_a_frame_and_a_clip(run, tmp_path):
    (tmp_path / "points.csv").write_text("x,y\n0,0\n4,0\n4,4\n0,4\n")
    (tmp_path / "clip.wkt").write_text("POLYGON ((1 0, 3 0, 2 3, 1 0))\n")
    line = "voronoi points.csv --what discs"
    (row,) = run(f"{line} --frame 0,0,4,4 --verify").rows
    assert (row["x"], row["y"], row["feet"], row["label_3"]) == ("2", "2", "4", "4")
    assert "label" not in row
    for more, place in (("", ("2", "2")), (" --frame 0,0,4,1 --count 2", ("2", "1"))):
        row = run(f"{line} --clip clip.wkt --verify{more}").rows[0]
        assert (row["x"], row["y"]) == place
    assert "<circle" in run(f"{line} -f svg").out
