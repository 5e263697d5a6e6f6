"""An exact check of segment Voronoi diagrams, by another way than the one that makes them (paper, section 3.2)."""

from __future__ import annotations

from vorotool import _core
from vorotool.engines.segment_voronoi.segment_voronoi import core_diagram
from vorotool.errors import VerificationError
from vorotool.numeric.checks import checked_threads
from vorotool.numeric.parallel import Progress
from vorotool.types.skeleton.segment_voronoi import SegmentVoronoiDiagram


def verify_segment_voronoi(diagram: SegmentVoronoiDiagram, *, threads: int = 0, progress: Progress = None) -> None:
    """Check a segment Voronoi diagram exactly, from its arrays alone."""
    fault = _core.segment_voronoi.find_fault(core_diagram(diagram), checked_threads(threads), progress)
    if fault is not None:
        raise VerificationError(fault)
