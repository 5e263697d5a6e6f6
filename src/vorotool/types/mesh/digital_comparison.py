"""How far a digital triangulation is from the exact one."""

from __future__ import annotations

from vorotool.plain import plain
from vorotool.types.features import Rows
from vorotool.types.table import Table
from vorotool.types.values import Tabular, Value


@plain(eq=False, repr=False)
class DigitalComparison(Value, Tabular):
    """Precision and recall of a digital triangulation, and every difference with its cause.

    Ties are allowed: an edge or triangle is right if some Delaunay triangulation of the sites has it, and must be
    there if all of them have it.

    Parameters
    ----------
    edge_precision, edge_recall, triangle_precision, triangle_recall : float
        Fraction of the results that are right, and of the required ones that are found; 1 if there are none.
    differences : Table
        One row per difference: ``kind`` (edge or triangle), ``difference`` (missing, false or tie), ``label_a``,
        ``label_b``, ``label_c`` (of triangles), ``cause``, and ``voronoi_length``: pixels of the Voronoi edge that
        explains it, inside the frame, where there is one.
    counts : dict of str to int
        Differences by ``kind difference cause``.
    suggestion : str
        A frame or scale at which most of the missing ones would be found.

    Examples
    --------
    >>> DigitalComparison(1.0, 0.5, 1.0, 1.0, Table({}), {"edge missing off_frame": 1}, "").summary()
    'edges: precision 1.000, recall 0.500; triangles: precision 1.000, recall 1.000; 1 edge missing (off_frame 1)'
    """

    edge_precision: float
    edge_recall: float
    triangle_precision: float
    triangle_recall: float
    differences: Table
    counts: dict[str, int]
    suggestion: str

    def summary(self) -> str:
        """Return a summary in one line."""
        parts = [
            f"edges: precision {self.edge_precision:.3f}, recall {self.edge_recall:.3f}",
            f"triangles: precision {self.triangle_precision:.3f}, recall {self.triangle_recall:.3f}",
        ]
        causes: dict[tuple[str, str], dict[str, int]] = {}
        for name, count in self.counts.items():
            kind, difference, cause = name.split()
            causes.setdefault((kind, difference), {})[cause] = count
        for (kind, difference), by_cause in causes.items():
            total = sum(by_cause.values())
            listed = ", ".join(f"{cause} {count}" for cause, count in by_cause.items())
            parts.append(f"{total} {kind}{'s' if total > 1 else ''} {difference} ({listed})")
        return "; ".join(parts)

    def _rows(self, _what: str | None = None) -> Rows:
        return Rows(self.differences)

    def _summary(self) -> str:
        return self.summary()
