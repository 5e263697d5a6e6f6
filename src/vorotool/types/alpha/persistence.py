"""When the regions of alpha shapes come and go as the radius grows."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.types import fields as f
from vorotool.types.features import Rows
from vorotool.types.fields import record
from vorotool.types.table import Table
from vorotool.types.values import Tabular, Value, counted


@record
class RegionPersistence(Value, Tabular):
    """Persistence of the regions of all alpha shapes: the radii at which each is born and dies.

    A region consists of triangles joined through edges. It is born with its first triangle, and dies when it merges
    with one born earlier (the elder rule); of several born at one radius the one with the most points survives, then
    the one whose first triangle comes first. Regions are ordered by birth, then by these triangles. Regions that would
    merge at the radius of their birth are one.

    Parameters
    ----------
    birth : (k,) float64 array
        Radii at which the regions are born.
    death : (k,) float64 array
        Radii at which the regions merge into older ones; infinite if they never do.
    into : (k,) int32 array
        The older region, or -1.
    points, triangles : (k,) int32 arrays
        Numbers of vertices and triangles just before the death, or for the largest shape.
    area : (k,) float64 array
        Area of these triangles.
    joined : float
        Smallest radius at which one region holds every point, or the largest radius if there is none; it replaces
        infinite deaths when persistences are compared.

    Examples
    --------
    >>> from vorotool import persistence
    >>> found = persistence([[0, 0], [2, 0], [0, 2], [9, 0], [12, 0], [9, 3]])
    >>> found.birth.round(3).tolist(), found.death.round(3).tolist(), found.points.tolist()
    ([1.414, 2.121], [inf, 4.876], [6, 4])
    >>> found.suggested
    2
    """

    birth: NDArray[np.float64] = f.length("regions")
    death: NDArray[np.float64] = f.length("regions")
    into: NDArray[np.int32] = f.index("regions")
    points: NDArray[np.int32] = f.index("regions")
    triangles: NDArray[np.int32] = f.index("regions")
    area: NDArray[np.float64] = f.area("regions")
    joined: float = f.length()

    def __len__(self) -> int:
        return len(self.birth)

    @property
    def persistence(self) -> NDArray[np.float64]:
        """(k,) death minus birth; for regions that never die `joined` minus birth."""
        death = np.where(np.isinf(self.death), np.maximum(self.joined, self.birth), self.death)
        there = np.isfinite(self.birth)  # of circles beyond the largest double nothing can be told
        return np.subtract(death, self.birth, out=np.zeros(len(self)), where=there)

    @property
    def suggested(self) -> int:
        """Number of regions that stand out: those above the largest gap between successive persistences.

        The last gap is between the least persistence and 0; of equal gaps the one with fewer regions counts. One
        distant point makes the first gap large: look at the table in that case.
        """
        ordered = np.append(np.sort(self.persistence)[::-1], 0.0)
        gaps = ordered[:-1] - ordered[1:]
        return int(np.argmax(gaps)) + 1 if len(gaps) else 0

    @property
    def apart_until(self) -> float:
        """Smallest radius at which one of the regions that stand out dies: below it they are separate."""
        standing = np.argsort(-self.persistence, kind="stable")[: self.suggested]
        return float(self.death[standing].min(initial=np.inf))

    def table(self) -> Table:
        """Return a table of the regions: ``region, birth, death, persistence, into, points, triangles, area``.

        Regions count from 1. Regions that never die have no ``death`` and no ``into``.
        """
        return Table(
            {
                "region": np.arange(1, len(self) + 1),
                "birth": self.birth,
                "death": np.ma.masked_invalid(self.death),
                "persistence": self.persistence,
                "into": np.ma.array(self.into.astype(np.int64) + 1, mask=self.into < 0),
                "points": self.points,
                "triangles": self.triangles,
                "area": self.area,
            }
        )

    def _rows(self, _what: str | None = None) -> Rows:
        return Rows(self.table())

    def _summary(self) -> str:
        stands = "stands" if self.suggested == 1 else "stand"
        return f"{counted(len(self), 'region')}, {self.suggested} of which {stands} out"
