"""Numbers of polygons as text."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from numpy.typing import NDArray

from vorotool.formats.text.row_writer import check_precision


@dataclass(frozen=True)
class Digits:
    """Significant digits of coordinates; None stands for the shortest text that reads back the same.

    Examples
    --------
    >>> Digits(3).text(3.14159), Digits(None).text(2.0)
    ('3.14', '2')
    """

    precision: int | None = None

    def __post_init__(self) -> None:
        check_precision(self.precision)

    def rounded(self, ring: NDArray[Any]) -> list[list[float]]:
        """Positions as JSON writes them."""
        if self.precision is None:
            return ring.tolist()  # type: ignore[no-any-return]
        return [[float(f"{x:.{self.precision}g}"), float(f"{y:.{self.precision}g}")] for x, y in ring.tolist()]

    def text(self, value: float) -> str:
        """One coordinate."""
        return repr(value).removesuffix(".0") if self.precision is None else f"{value:.{self.precision}g}"
