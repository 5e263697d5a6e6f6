"""The frame of an image is the image: what is made of it reaches its edges and no farther."""

import json

import numpy as np
import pytest
import shapely
from PIL import Image

import vorotool

WIDTH, HEIGHT = 12, 9
DOTS = [(1, 1), (9, 2), (5, 7), (11, 8)]
MASK = np.zeros((HEIGHT, WIDTH), dtype=np.uint8)
for column, row in DOTS:
    MASK[row, column] = 255
MASK[3:5, 0:3] = 255
PIXELS = shapely.box(-0.5, -0.5, WIDTH - 0.5, HEIGHT - 0.5)


@pytest.fixture
def mask(tmp_path):
    Image.fromarray(MASK).save(tmp_path / "mask.png")
    return tmp_path / "mask.png"


def shapes(text):
    made = [each["geometry"] for each in json.loads(text)["features"]]
    return [shapely.geometry.shape(each) for each in made if each is not None]


@pytest.mark.parametrize("command", ["voronoi", "delaunay"])
def test_territories_of_an_image_fill_it(run, mask, command):
    done = run(command, mask, "--what", "cells", "-f", "geojson", "--verify")
    cells = shapes(done.out)
    assert shapely.union_all(cells).equals(PIXELS)
    assert sum(cell.area for cell in cells) == pytest.approx(WIDTH * HEIGHT, rel=1e-12)


def test_exteriors_end_at_the_image(run, mask):
    line = f"skeleton-approx --step 0.25 {mask} --side exterior -f"
    assert shapely.union_all(shapes(run(f"{line} geojson").out)).bounds == PIXELS.bounds
    assert json.loads(run(f"{line} json").out)["frame"] == [-0.5, -0.5, WIDTH, HEIGHT]


@pytest.mark.parametrize("command", ["voronoi", "delaunay"])
def test_a_clip_beyond_the_image_does_not_extend_it(run, mask, tmp_path, command):
    (tmp_path / "clip.wkt").write_text("POLYGON ((3 -20, 30 -20, 30 4, 3 4, 3 -20))")
    done = run(command, mask, "--what", "cells", "-f", "geojson", "--clip", "clip.wkt")
    assert shapely.union_all(shapes(done.out)).equals(shapely.box(3, -0.5, WIDTH - 0.5, 4))


def test_the_library_frames_images_as_the_command_line_does():
    seeds = vorotool.seeds_from_raster(MASK, mode="centroids")
    assert vorotool.voronoi(MASK > 0).frame == (-0.5, -0.5, WIDTH, HEIGHT)
    assert vorotool.voronoi_cells(seeds).frame.sides == PIXELS.bounds
    assert vorotool.voronoi_cells(vorotool.delaunay(seeds)).frame.sides == PIXELS.bounds
    assert vorotool.skeleton_exact(vorotool.outlines(MASK), side="both").frame == (-0.5, -0.5, WIDTH, HEIGHT)
    places = np.array(DOTS, dtype=float)
    assert vorotool.voronoi_cells(places).frame.sides == (0, 0, 12, 9)  # of points: the bounds and a tenth


@pytest.mark.parametrize("seed", range(6))
def test_no_cell_leaves_an_image_and_nothing_is_missing(seed):
    rng = np.random.default_rng(seed)
    for _ in range(8):
        height, width = rng.integers(1, 12, 2)
        labels = rng.integers(0, 4, (height, width)).astype(np.uint8) * (rng.random((height, width)) < rng.random())
        if not labels.any():
            continue
        cells = vorotool.voronoi(vorotool.Raster(labels))
        vorotool.verify_voronoi(cells)
        assert cells.areas.sum() == pytest.approx(height * width, rel=1e-12)
        assert (cells.vertices >= -0.5).all()
        assert (cells.vertices <= [width - 0.5, height - 0.5]).all()
        outside = vorotool.skeleton_exact(vorotool.outlines(vorotool.Raster(labels)), side="exterior")
        vorotool.verify_skeleton(outside)
        assert (outside.vertices >= -0.5).all()
        assert (outside.vertices <= [width - 0.5, height - 0.5]).all()
