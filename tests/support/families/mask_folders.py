"""Folders of masks, for what is done with many inputs."""

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
