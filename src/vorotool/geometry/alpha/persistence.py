"""When the regions of alpha shapes come and go as the radius grows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vorotool.geometry.table import Table
from vorotool.geometry.values import Tabular, Value, counted


@dataclass(frozen=True, eq=False, repr=False)
class RegionPersistence(Value, Tabular):
    """Regions of the alpha shapes of all radii: the radii at which each is born and dies.

    A region is triangles joined through edges. It is born with its first triangle, and dies where it merges with one
    that was born earlier (the elder rule); of several born at one radius that with the most points lives on, then the
    one whose first triangle comes first. Regions are in the order of their births, then of these triangles. Regions
    that would merge at the radius of their birth are one.

    Parameters
    ----------
    birth : (k,) float64 array
        Radii from which on they are there.
    death : (k,) float64 array
        Radii at which they become part of another; infinite if they never do.
    into : (k,) int32 array
        That other region, or -1.
    points, triangles : (k,) int32 arrays
        Vertices and triangles of the region just before it dies, or at last.
    area : (k,) float64 array
        Of these triangles.
    joined : float
        The least radius at which one region holds every point, or the largest radius of all if there is none: what
        stands for a death that never comes where persistences are compared.

    Examples
    --------
    >>> from vorotool import persistence
    >>> found = persistence([[0, 0], [2, 0], [0, 2], [9, 0], [12, 0], [9, 3]])
    >>> found.birth.round(3).tolist(), found.death.round(3).tolist(), found.points.tolist()
    ([1.414, 2.121], [inf, 4.876], [6, 4])
    >>> found.suggested
    2
    """

    birth: NDArray[np.float64]
    death: NDArray[np.float64]
    into: NDArray[np.int32]
    points: NDArray[np.int32]
    triangles: NDArray[np.int32]
    area: NDArray[np.float64]
    joined: float

    def __len__(self) -> int:
        return len(self.birth)

    @property
    def persistence(self) -> NDArray[np.float64]:
        """(k,) death less birth; of regions that never die the radius at which all points are joined less birth."""
        death = np.where(np.isinf(self.death), np.maximum(self.joined, self.birth), self.death)
        there = np.isfinite(self.birth)  # of circles beyond the largest double nothing can be told
        return np.subtract(death, self.birth, out=np.zeros(len(self)), where=there)

    @property
    def suggested(self) -> int:
        """How many regions stand out: those above the largest gap between persistences that follow one another.

        The last gap is that between the least persistence and 0; of equal gaps the one with fewer regions counts. One
        point far away makes the first gap large: then look at the table.
        """
        ordered = np.append(np.sort(self.persistence)[::-1], 0.0)
        gaps = ordered[:-1] - ordered[1:]
        return int(np.argmax(gaps)) + 1 if len(gaps) else 0

    @property
    def apart_until(self) -> float:
        """The least radius at which one of the regions that stand out dies: below it they are apart."""
        standing = np.argsort(-self.persistence, kind="stable")[: self.suggested]
        return float(self.death[standing].min(initial=np.inf))

    def table(self) -> Table:
        """Give one row a region: ``region, birth, death, persistence, into, points, triangles, area``.

        Regions count from 1. Of one that never dies ``death`` and ``into`` do not exist.
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

    def _summary(self) -> str:
        stands = "stands" if self.suggested == 1 else "stand"
        return f"{counted(len(self), 'region')}, {self.suggested} of which {stands} out"
