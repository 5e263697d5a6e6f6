"""The page of legends and scale bars."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.render.canvas.layers import Page


class PixelPage(Page):
    """The page of what is placed in px of another page, such as a legend."""

    def __init__(self, page: Page) -> None:
        super().__init__((0.0, 0.0, float(page.width), float(page.height)), width=page.width, y_up=False)
        self.width, self.height, self.style, self.decimals = page.width, page.height, page.style, page.decimals

    def place(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n, 2) px from the left and from the top: the points themselves."""
        return points

    def length(self, distance: float) -> float:
        """Px of a distance."""
        return distance
