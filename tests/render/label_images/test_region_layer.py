"""Regions of a label image as polygons: each pixel lies in the polygon of its label."""

from __future__ import annotations

import numpy as np
import pytest

from vorotool import Frame, LabelImage, LimitError
from vorotool.render.canvas.layers import Page, bounds_of
from vorotool.render.canvas.palettes import cell_colour
from vorotool.render.canvas.png import layer_bands
from vorotool.render.label_images.region_layer import region_layer


@pytest.mark.parametrize("seed", range(5))
def test_every_pixel_has_the_colour_of_its_label(seed):
    rng = np.random.default_rng(seed)
    labels = rng.integers(0, 6, (9, 13)).astype(np.uint16)
    colours = {label: label for label in range(6)}
    layer = region_layer(LabelImage(labels, Frame(-4, 7, 13, 9)), colours, edge=None)
    bounds = bounds_of([layer])
    if labels[:, [0, -1]].any(axis=0).all() and labels[[0, -1]].any(axis=1).all():
        assert bounds == (-4.5, 6.5, 8.5, 15.5)
    page = Page((-4.5, 6.5, 8.5, 15.5), width=300, y_up=False)
    image = np.concatenate(list(layer_bands([layer], page))).reshape(page.height, page.width, 3)
    for (row, column), label in np.ndenumerate(labels):
        across, down = page.place(np.array([[column - 4.0, row + 7.0]]))[0].astype(int)
        assert "#" + bytes(image[down, across].tolist()).hex() == (cell_colour(label) if label else "#ffffff")


def test_ids_and_limits():
    layer = region_layer(LabelImage(np.array([[3, 9], [9, 3]])), {3: 1, 9: 2}, name="cells")
    assert layer.ids == ["cells-3", "cells-9"]
    assert len(region_layer(LabelImage(np.zeros((2, 2), np.uint8)), {}).corners) == 0
    with pytest.raises(LimitError, match="use -f png"):
        region_layer(LabelImage(np.ones((1001, 1000), np.uint8)), {1: 1})
