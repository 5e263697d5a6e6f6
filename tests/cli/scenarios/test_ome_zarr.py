"""OME-Zarr in all commands: labels in and out, sizes of pixels, bands, batches."""

import numpy as np
import pytest
import tifffile
import zarr

from support.families.rasters import write_sized


@pytest.fixture
def store(tmp_path):
    write_sized(tmp_path / "in.ome.tif", sides=(0.325, 0.325))
    return tmp_path


@pytest.mark.parametrize("what", ["labels", "distance"])
def test_stores_have_metadata(run, store, what):
    run(f"tessellate in.ome.tif -o out.ome.zarr --what {what} -q")
    run(f"tessellate in.ome.tif -o out.npy --what {what} -q")
    group = zarr.open_group(store / "out.ome.zarr", mode="r")
    np.testing.assert_array_equal(group["0"][...], np.load(store / "out.npy"))
    ome = group.attrs["ome"]
    assert ("image-label" in ome, ome["version"]) == (what == "labels", "0.5")
    scale = ome["multiscales"][0]
    assert scale["axes"] == [{"name": name, "type": "space", "unit": "micrometer"} for name in "yx"]
    assert scale["datasets"] == [
        {"path": "0", "coordinateTransformations": [{"type": "scale", "scale": [0.325, 0.325]}]}
    ]
    run(f"tessellate in.ome.tif -o out.ome.zarr --what {what} -q")  # replaced
    run(f"tessellate in.ome.tif -o out.ome.zarr --what {what} --no-clobber", code=4)


def test_sizes_go_all_the_way(run, store):
    table = ["--what", "table", "-q", "--pixel-size", "auto"]
    rows = run("tessellate in.ome.tif", *table).rows
    run("tessellate in.ome.tif -o a.ome.zarr --max-distance 0 -q")
    assert run("tessellate a.ome.zarr", *table).rows == rows
    run("tessellate a.ome.zarr -o b.ome.tif -q")
    with tifffile.TiffFile(store / "b.ome.tif") as file:
        assert 'PhysicalSizeX="0.325"' in file.ome_metadata
    run("skeleton-exact a.ome.zarr --what table -f csv", says="a.ome.zarr")
