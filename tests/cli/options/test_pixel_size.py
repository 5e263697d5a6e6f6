"""``--pixel-size``: what is written is what a larger input gives, byte by byte where the factor is a power of two."""

import numpy as np
import pytest


@pytest.mark.parametrize("what", ["labels", "distance"])
def test_the_resolution_of_an_image_is_kept(run, tmp_path, what):
    import tifffile

    image = np.zeros((6, 8), np.uint8)
    image[1, 2] = image[4, 5] = 255
    tifffile.imwrite(tmp_path / "in.tif", image, resolution=(300, 150), resolutionunit=2)
    run(f"tessellate in.tif -o out.tif --what {what} -q")
    with tifffile.TiffFile(tmp_path / "out.tif") as file:
        tags = {name: file.pages[0].tags.valueof(name) for name in ("XResolution", "YResolution", "ResolutionUnit")}
    assert tags == {"XResolution": (300, 1), "YResolution": (150, 1), "ResolutionUnit": 2}


# ---- the column --------------------------------------------------------------------------------


def test_a_column_of_the_input_keeps_its_name(run, tmp_path):
    (tmp_path / "a.csv").write_text("x,y,unit\n1,2,px\n4,3,px\n2,6,px\n")
    row = run("delaunay a.csv --what table --pixel-size 2nm -q").rows[0]
    assert (row["unit"], row["voro_unit"], list(row)[-1]) == ("px", "nm", "voro_unit")
