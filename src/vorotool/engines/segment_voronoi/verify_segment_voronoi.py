"""An exact check of segment Voronoi diagrams, by another way than the one that makes them (paper, section 3.2)."""

from __future__ import annotations

from vorotool import _core
from vorotool.engines.segment_voronoi.segment_voronoi import core_diagram
from vorotool.errors import VerificationError
from vorotool.geometry.checks import checked_threads
from vorotool.geometry.progress import Progress
from vorotool.geometry.skeleton.segment_voronoi import SegmentVoronoiDiagram


def verify_segment_voronoi(diagram: SegmentVoronoiDiagram, *, threads: int = 0, progress: Progress = None) -> None:
    """Check a segment Voronoi diagram exactly, from its arrays alone.

    Every vertex is the centre of a disc that exactly its sites touch, in their order, and that no site enters, with
    values right to a relative 2^-48; the edges around each cell make one cycle, what meets at infinity is the convex
    hull, all is connected and Euler's relation holds, from which it follows that no vertex is missing; edges follow
    each other along each bisector. Points inside each edge are compared with all sites besides, in floating point.
    Where floating point leaves a sign open it is computed exactly.

    Parameters
    ----------
    diagram : SegmentVoronoiDiagram
        However it was made. That segments meet at common ends only is taken for granted.
    threads, progress
        As of `verify_skeleton`, as is what it raises.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 3.2.

    Examples
    --------
    >>> bisectors = [[-1, -1], [-1, -1]]
    >>> verify_segment_voronoi(
    ...     SegmentVoronoiDiagram([[0, 0], [4, 0]], [[0, 1]], [], [], [0], [], bisectors, [[0, 2], [1, 2]])
    ... )
    >>> verify_segment_voronoi(
    ...     SegmentVoronoiDiagram([[0, 0], [4, 0]], [[0, 1]], [], [], [0], [], bisectors, [[0, 2], [0, 1]])
    ... )
    Traceback (most recent call last):
        ...
    vorotool.errors.VerificationError: edge 1 between the cells of 0 and 1 does not fit the ring of its source
    """
    fault = _core.segment_voronoi.find_fault(core_diagram(diagram), checked_threads(threads), progress)
    if fault is not None:
        raise VerificationError(fault)
