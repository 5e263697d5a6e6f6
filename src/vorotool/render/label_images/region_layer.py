"""The regions of a label image as a layer, to lie beneath others."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.geometry.points.label_image import LabelImage
from vorotool.render.canvas.layers import Polygons
from vorotool.render.canvas.palettes import EDGE, cell_colour
from vorotool.render.label_images.crack_outline import crack_loops
from vorotool.render.label_images.svg import check_size


def region_layer(
    image: LabelImage,
    colour_of_label: NDArray[Any] | Mapping[int, int],
    *,
    name: str = "regions",
    edge: str | None = EDGE,
    width: float = 1.5,
) -> Polygons:
    """Make a layer of the crack outlines of regions; pixel (x, y) covers half a unit on each side of its centre.

    Parameters
    ----------
    image : LabelImage
        With its frame.
    colour_of_label : integer array or mapping
        Colour class by label.
    name : str
        Of the layer; the polygon of label 7 has the id ``<name>-7``.
    edge : str, optional
        Colour of the outlines.
    width : float
        Of the outlines, in px.

    Raises
    ------
    LimitError
        If the image has more than 10^6 pixels.

    Examples
    --------
    >>> layer = region_layer(LabelImage(np.array([[7, 7]])), {7: 1})
    >>> layer.points[layer.corners].tolist(), layer.ids
    ([[-0.5, -0.5], [1.5, -0.5], [1.5, 0.5], [-0.5, 0.5]], ['regions-7'])
    """
    check_size(image.shape)
    labels: list[int] = []
    places: list[tuple[int, int]] = []
    rings, first_rings = [0], [0]
    for label, loops in crack_loops(image.labels):
        labels.append(label)
        for loop in loops:
            places += loop
            rings.append(len(places))
        first_rings.append(len(rings) - 1)
    classes = [int(colour_of_label[label]) for label in labels]
    used = sorted(set(classes))
    frame = image.frame
    assert frame is not None  # LabelImage has filled it in
    corner = np.array([frame.x - 0.5, frame.y - 0.5])
    return Polygons(
        name,
        np.array(places, dtype=np.float64).reshape(-1, 2) + corner,
        np.arange(len(places), dtype=np.int32),
        np.array(rings),
        np.array(first_rings),
        colours=[cell_colour(k) for k in used],
        colour_of=np.searchsorted(used, classes),
        ids=[f"{name}-{label}" for label in labels],
        edge=edge,
        width=width,
    )
