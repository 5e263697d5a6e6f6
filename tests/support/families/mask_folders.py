"""Folders of inputs, made alike wherever they are needed."""

import numpy as np
from PIL import Image
from skimage.filters import gaussian


def mask(number, size=256):
    """Some blobs: three tenths of smoothed noise."""
    noise = gaussian(np.random.default_rng(number).standard_normal((size, size)), size / 20)
    return noise > np.quantile(noise, 0.7)


def write_masks(folder, count, size=256):
    """PNG files ``0000.png``, ``0001.png``, …."""
    folder.mkdir()
    for number in range(count):
        Image.fromarray(mask(number, size).astype(np.uint8) * 255).save(folder / f"{number:04}.png")


def write_many_points(folder, count, seeds=3):
    """Write lists of points into the folder ``many``; with few seeds they take some milliseconds each."""
    (folder / "many").mkdir()
    for number in range(count):
        xy = np.random.default_rng(number).integers(0, 300, (seeds, 2))
        np.savetxt(folder / f"many/p{number:03}.csv", xy, fmt="%d", delimiter=",", header="x,y", comments="")
