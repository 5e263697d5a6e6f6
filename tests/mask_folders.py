"""Folders of masks and of their outlines, for what is done with many inputs."""

import json

import numpy as np
from PIL import Image
from skimage.filters import gaussian
from skimage.measure import find_contours


def mask(number, size=256):
    """Some blobs: three tenths of smoothed noise."""
    noise = gaussian(np.random.default_rng(number).standard_normal((size, size)), size / 20)
    return noise > np.quantile(noise, 0.7)


def write_masks(folder, count, size=256):
    """PNG files ``0000.png``, ``0001.png``, …."""
    folder.mkdir()
    for number in range(count):
        Image.fromarray(mask(number, size).astype(np.uint8) * 255).save(folder / f"{number:04}.png")


def write_outlines(folder, count, size=256):
    """Polygons around the blobs, as JSON."""
    folder.mkdir()
    for number in range(count):
        contours = find_contours(np.pad(mask(number, size), 1).astype(float), 0.5)
        shells = [contour[:-1, ::-1].tolist() for contour in contours if len(contour) > 8]
        polygons = [{"shell": shell, "holes": []} for shell in shells[:4]]
        (folder / f"{number:04}.json").write_text(json.dumps({"polygons": polygons}))
