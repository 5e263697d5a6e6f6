"""Triangulations read off the digital tessellation (section 2.1): to the letter, and repaired."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.convert.spacings import asked_sides
from vorotool.engines.common import label_array
from vorotool.engines.delaunay.delaunay import MOST_POINTS, delaunay, triangulation_fault
from vorotool.engines.label_images.measured_regions import Regions
from vorotool.engines.label_images.regions import measure_regions
from vorotool.engines.tessellation.frames import (
    as_seeds,
    asked_frame,
    band_limits,
    default_frame,
    require_memory,
)
from vorotool.engines.tessellation.tessellate import verify_labels
from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.errors import InputError, LimitError, UsageError, VerificationError, option, warn
from vorotool.frozen import frozen
from vorotool.numeric.checks import MAX_PIXELS, checked_threads
from vorotool.numeric.parallel import Progress, running
from vorotool.types.arguments import check_value
from vorotool.types.images import LabelImage
from vorotool.types.mesh.triangulation import DigitalTriangulation, Triangulation
from vorotool.types.pixels import Frame, PixelSides
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.scaling import scaled

if TYPE_CHECKING:
    from vorotool.typing import SeedsLike, Spacing

Mesh = TypeVar("Mesh", DigitalTriangulation, Triangulation)

_ONE_A_LABEL = option(
    "--seeds pixels or centroids, or --method digital",
    'mode="pixels" or "centroids" of seeds_from_raster, or digital_triangulation',
)
"""Advice where a label has several seeds."""


def digital_triangulation(
    source: SeedsLike,
    *,
    shape: tuple[int, int] | None = None,
    window: tuple[int, int, int, int] | None = None,
    image: bool | None = None,
    spacing: Spacing | None = None,
    strict: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> DigitalTriangulation:
    """Extract edges and triangles from the digital tessellation, exactly by the rule of the paper.

    Edges link neighboring regions, those with 4-neighboring pixels ("by linking the neighboring seeds we obtain
    the correct Delaunay triangulation"). Triangles come from a pixel and two of its 4-neighbors that are
    8-neighbors of each other, where the three labels differ. Neither is always right: see `compare_digital`, and
    `digital_delaunay` for the repair.

    Parameters
    ----------
    source : LabelImage, or what `tessellate` accepts
        Seeds are tessellated exactly, band by band: memory does not grow with the height of the frame. The sites of a
        label image without seeds are the centroids of its regions.
    shape, window : tuple of int, optional
        As in `tessellate`; not for a label image.
    image : bool, optional
        As in `tessellate`.
    spacing : float, (height, width) or "auto", optional
        As in `tessellate`: coordinates of the result are in its unit. That of a label image holds for it.
    strict : bool
        Refuse several seeds at one place.
    threads : int
        Number of threads; 0 uses all. The result does not depend on it.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    DigitalTriangulation
        The triangulation, empty if there are no seeds.

    Raises
    ------
    InputError
        If a seed is unusable, or the points have negative coordinates and no window.
    UsageError
        If options contradict each other.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 2.1.

    Examples
    --------
    >>> found = digital_triangulation([[1, 1], [6, 1], [2, 6]], shape=(8, 8))
    >>> found.edges.tolist(), found.triangles.tolist()
    ([[0, 1], [0, 2], [1, 2]], [[0, 1, 2]])
    """
    threads = checked_threads(threads)
    sides = asked_sides(source, spacing)
    if isinstance(source, LabelImage):
        if spacing is not None and sides != source.sides:
            raise UsageError(f"spacing is set by the label image, {source.sides.text()}: leave it out")
        sites = _sites_of_image(source, threads)
        return _in_unit(_read(source, sites, [label_array(source.labels)], threads, progress), source.sides)
    frame = asked_frame(shape, window)
    seeds = as_seeds(source, "source", image=image, frame=frame, sides=sides)
    sites = _sites_of_seeds(seeds, sides)
    if not len(seeds):
        return _read(seeds, sites, [], threads, None)
    sweep = Tessellator(seeds, frame, sides=sides, threads=threads, strict=strict, progress=progress)
    return _in_unit(_read(seeds, sites, _bands(sweep), threads, None), sides)


def _bands(sweep: Tessellator) -> Iterator[NDArray[Any]]:
    """Rows of labels from the top; each band begins with the last row of the one before."""
    for first, count in band_limits(sweep.frame):
        lap = min(first, 1)
        yield sweep.labels(first - lap, count + lap)


def _in_unit(mesh: Mesh, sides: PixelSides) -> Mesh:
    """What was found in steps of the sides of a pixel in their unit; what was decided stays."""
    if sides.step == 1:
        return mesh
    return scaled(mesh, sides.step)


def _sites_of_seeds(seeds: SeedSet, sides: PixelSides) -> tuple[NDArray[np.float64], NDArray[np.uint32]]:
    """Places in steps of the sides of a pixel, and labels."""
    return seeds.sites * (sides.x, sides.y), seeds.site_labels


def _sites_of_image(image: LabelImage, threads: int) -> tuple[NDArray[np.float64], NDArray[np.uint32]]:
    if image.seeds is not None:
        return _sites_of_seeds(image.seeds, image.sides)
    regions = Regions(measure_regions(image, threads=threads), image.frame, image.sides)
    return regions.sites, regions.labels


def _read(
    source: SeedSet | LabelImage,
    sites: tuple[NDArray[np.float64], NDArray[np.uint32]],
    bands: Any,
    threads: int,
    progress: Progress,
) -> DigitalTriangulation:
    scan = _core.digital.DigitalTriangulationScan()
    for rows in bands:
        scan.add_rows(rows, threads, progress)
    found = scan.finish()
    points, labels = sites
    edges = _indices(labels, found["edge_a"], found["edge_b"])
    triangles = _indices(labels, found["triangle_a"], found["triangle_b"], found["triangle_c"])
    seeds = source.seeds if isinstance(source, LabelImage) else source
    return DigitalTriangulation(
        points,
        edges,
        _counter_clockwise(points, triangles),
        (found["corners"] & 2) != 0,
        labels.astype(np.int64),
        three_label_corners=found["three_label_corners"],
        four_label_corners=found["four_label_corners"],
        properties={} if seeds is None else seeds.properties,
        index=None if seeds is None else seeds.index,
    )


def _indices(known: NDArray[np.uint32], *columns: NDArray[np.uint32]) -> NDArray[np.int32]:
    """Rows of indices for columns of labels, whose order is that of the indices."""
    labels = np.stack(columns, axis=1)
    index = np.searchsorted(known, labels)
    wrong = labels[np.append(known, 0)[np.minimum(index, len(known))] != labels]
    if wrong.size:
        raise InputError(
            f"a pixel has label {wrong[0]}, which is not one of the {len(known)} sites: pass the seeds that the image "
            "was computed from"
        )
    return index.astype(np.int32)


def _counter_clockwise(points: NDArray[np.float64], triangles: NDArray[np.int32]) -> NDArray[np.int32]:
    clockwise = _core.kernel.orient2d(np.ascontiguousarray(points[triangles])) < 0
    triangles[clockwise] = triangles[clockwise][:, [0, 2, 1]]
    return triangles


# ---- the repair -----------------------------------------------------------------------------------------


@frozen
class DigitalRepair:
    """Counts of the steps of `repair_digital`."""

    # "rebuilt" if all sites had to be inserted one by one; "chain" for fewer than three or collinear sites
    route: str
    split_regions: int = 0  # regions that were not 4-connected; pixels that went to a neighboring region
    moved_pixels: int = 0  # regions that were not 4-connected; pixels that went to a neighboring region
    three_label_corners: int = 0  # corners that gave one triangle, and two
    four_label_corners: int = 0  # corners that gave one triangle, and two
    twins: int = 0  # sites taken out because only two neighbors were left to them
    straightened: int = 0  # triangles of collinear sites
    filled: int = 0  # triangles that closed the hull beyond the frame
    flipped: int = 0  # sides that were not locally Delaunay
    inserted: int = 0  # sites inserted where they lie, those taken out among them
    fault: str | None = None  # what the certificate found wrong, if anything ever: then all sites were inserted


def digital_delaunay(source: SeedsLike, **options: Any) -> Triangulation:
    """Compute the Delaunay triangulation of seeds by repairing and certifying their digital triangulation.

    The result equals ``delaunay(seeds)``, array by array.

    Parameters
    ----------
    source : what `tessellate` accepts
        As in `repair_digital`.
    **options
        As in `repair_digital`.

    Returns
    -------
    Triangulation
        That of ``delaunay(seeds)``.

    Examples
    --------
    >>> digital_delaunay([[1, 1], [6, 1], [2, 6]], shape=(8, 8)).triangles.tolist()
    [[0, 1, 2]]
    """
    return repair_digital(source, **options)[0]


def repair_digital(
    source: SeedsLike,
    *,
    shape: tuple[int, int] | None = None,
    window: tuple[int, int, int, int] | None = None,
    image: bool | None = None,
    spacing: Spacing | None = None,
    strict: bool = False,
    threads: int = 0,
    max_pixels: int = MAX_PIXELS,
    progress: Progress = None,
) -> tuple[Triangulation, DigitalRepair]:
    """Repair and certify the triangulation of a digital tessellation, and count the repairs.

    Flooding makes regions 4-connected; each corner of three labels becomes a triangle, of four labels two; sites with
    only two neighbors are removed; Graham's scan closes the hull along the frame; sides are flipped until all are
    Delaunay; sites without a triangle are inserted. Then `verify_triangulation` checks the result. If a step fails, all
    sites are inserted one by one, with a warning.

    Parameters
    ----------
    source : what `tessellate` accepts
        Each label must have one seed. Seeds between pixels, or outside the frame, may have no region: they are
        inserted.
    shape, window : tuple of int, optional
        As in `tessellate`.
    image : bool, optional
        As in `tessellate`.
    spacing : float, (height, width) or "auto", optional
        As in `tessellate`: the mesh is that of the seeds in its unit.
    strict : bool
        Refuse several seeds at one place.
    threads : int
        Number of threads; 0 uses all. The result does not depend on it.
    max_pixels : int
        Larger frames are refused before memory is allocated: the labels of all pixels are held, 4 bytes each.
    progress : callable, optional
        Called with the fraction done of each step.

    Returns
    -------
    mesh : Triangulation
        That of ``delaunay(seeds)``, array by array.
    repair : DigitalRepair
        How many regions, sites and sides had to be changed.

    Raises
    ------
    InputError
        If several seeds share a label: regions of objects have no triangulation of points.
    LimitError
        If the frame has more than `max_pixels` pixels, or there are more than 2^28 seeds.

    Warns
    -----
    VorotoolWarning
        If all sites had to be inserted.

    References
    ----------
    Cao, Edelsbrunner and Tan, "Proof of correctness of the digital Delaunay triangulation algorithm", 2015.

    Examples
    --------
    >>> mesh, repair = repair_digital([[0, 0], [4, 0], [0, 3], [1, 1]])
    >>> len(mesh), repair.route, repair.filled
    (3, 'repaired', 1)
    """
    sides = asked_sides(source, spacing)
    frame = asked_frame(shape, window)
    seeds = as_seeds(source, "source", image=image, max_pixels=max_pixels, frame=frame, sides=sides)
    order = one_seed_a_label(seeds)
    if not len(seeds):
        return delaunay(seeds), DigitalRepair("chain")
    frame = frame or default_frame(seeds)
    require_memory(frame, max_pixels)
    run = running(threads, progress)
    ranked = SeedSet(seeds.x[order], seeds.y[order], np.arange(1, len(order) + 1, dtype=np.uint32), scale=seeds.scale)
    points, labels = _sites_of_seeds(seeds, sides)
    points = np.ascontiguousarray(points)
    sweep = Tessellator(ranked, frame, sides=sides, strict=strict, **run)
    core, counts = _core.digital.digital_mesh(
        points, ranked.x, ranked.y, seeds.scale, sweep.labels(dtype=np.uint32), frame.x, frame.y, **run
    )

    def mesh_of(core: _core.delaunay.DelaunayTriangulation) -> Triangulation:
        arrays = core.arrays(**run)
        known: Any = {"labels": labels.astype(np.int64), "properties": seeds.properties, "index": seeds.index}
        box = None if seeds.frame is None else seeds.frame.box.stretched(sides.x, sides.y)
        return Triangulation(points, **arrays, **known, y_axis=seeds.y_axis, frame=box)

    mesh = mesh_of(core)
    fault = triangulation_fault(mesh, run)
    if fault is not None:
        counts |= {"route": "rebuilt", "inserted": len(points)}
        mesh = mesh_of(_core.digital.inserted_mesh(points, **run))
    repair = DigitalRepair(**counts, fault=fault)
    _report_rebuilt(repair)
    return _in_unit(mesh, sides), repair


def one_seed_a_label(seeds: SeedSet) -> NDArray[np.intp]:
    """Order of the seeds by label; labels with several seeds are refused."""
    if len(seeds) > MOST_POINTS:
        raise LimitError(f"there are {len(seeds)} seeds, more than {MOST_POINTS}: triangulate them in parts")
    order = np.argsort(seeds.labels, kind="stable")
    ordered = seeds.labels[order]
    same = np.flatnonzero(ordered[1:] == ordered[:-1])
    if same.size:
        label = ordered[same[0]]
        raise InputError(
            f"label {label} has {np.count_nonzero(ordered == label)} seeds: a triangulation of points needs one seed "
            f"per label; use {_ONE_A_LABEL}, which triangulates regions"
        )
    return order


def _report_rebuilt(repair: DigitalRepair) -> None:
    if repair.route != "rebuilt":
        return
    why = f"the certificate failed ({repair.fault})" if repair.fault else "the regions have no planar dual"
    warn(
        f"the digital triangulation could not be repaired because {why}: all {repair.inserted} sites were inserted "
        "exactly instead"
    )


def verify_digital_triangulation(
    found: DigitalTriangulation,
    source: SeedsLike,
    *,
    shape: tuple[int, int] | None = None,
    window: tuple[int, int, int, int] | None = None,
    image: bool | None = None,
    spacing: Spacing | None = None,
    threads: int = 0,
) -> None:
    """Check a digital triangulation against the definitions of section 2.1, band by band.

    The labels of every band are checked by an independent search for the nearest seed; then each pixel is compared
    with its neighbors.

    Parameters
    ----------
    found : DigitalTriangulation
        From any source.
    source : what `tessellate` accepts
        The source of the triangulation, but not a label image.
    shape, window : tuple of int, optional
        As in `digital_triangulation`.
    image : bool, optional
        As in `digital_triangulation`.
    spacing : float, (height, width) or "auto", optional
        As in `digital_triangulation`.
    threads : int
        Number of threads; 0 uses all.

    Raises
    ------
    VerificationError
        If an edge or triangle is missing or false; the message names the first.

    Examples
    --------
    >>> from vorotool.engines.digital.triangulation import digital_triangulation
    >>> seeds = [[1, 1], [6, 1], [2, 6]]
    >>> verify_digital_triangulation(digital_triangulation(seeds), seeds)
    """
    check_value(found, "found", "DigitalTriangulation")
    frame = asked_frame(shape, window)
    sides = asked_sides(source, spacing)
    seeds = as_seeds(source, "source", image=image, frame=frame, sides=sides)
    edges, triangles = np.empty((0, 2), np.int64), np.empty((0, 3), np.int64)
    if len(seeds):
        frame = frame or default_frame(seeds)
        sweep = Tessellator(seeds, frame, sides=sides, threads=threads)
        for first, count in band_limits(frame):
            lap = min(first, 1)
            labels = sweep.labels(first - lap, count + lap)
            band = Frame(frame.x, frame.y + first - lap, frame.width, count + lap)
            verify_labels(labels, sweep.seeds, band, sides=sides, threads=threads)
            edges = np.concatenate([edges, _edges(labels)])
            triangles = np.concatenate([triangles, _triangles(labels)])
    for name, rows, right in (("edge", found.edges, edges), ("triangle", found.triangles, triangles)):
        _compare(name, found.labels[rows], np.unique(right, axis=0))


def _edges(labels: NDArray[Any]) -> NDArray[np.int64]:
    """Pairs of different labels side by side, or one above the other."""
    pairs = [(labels[:, :-1], labels[:, 1:]), (labels[:-1], labels[1:])]
    return _distinct(np.concatenate([_columns(pair) for pair in pairs]))


def _triangles(labels: NDArray[Any]) -> NDArray[np.int64]:
    """Triples of different labels: of a pixel and a neighbor in its row and one in its column."""
    a, b, c, d = labels[:-1, :-1], labels[:-1, 1:], labels[1:, :-1], labels[1:, 1:]
    return _distinct(np.concatenate([_columns(three) for three in ((a, b, c), (b, a, d), (c, a, d), (d, b, c))]))


def _columns(arrays: tuple[NDArray[Any], ...]) -> NDArray[np.int64]:
    """Rows of labels that are not all alike."""
    changing = np.logical_or.reduce([array != arrays[0] for array in arrays[1:]])
    return np.stack([array[changing].astype(np.int64) for array in arrays], axis=1)


def _distinct(rows: NDArray[np.int64]) -> NDArray[np.int64]:
    """Sorted rows of labels that all differ and are not 0, each once."""
    rows = np.sort(rows, axis=1)
    return np.unique(rows[(np.diff(rows, axis=1) != 0).all(axis=1) & (rows[:, 0] != 0)], axis=0)


def _compare(name: str, given: NDArray[np.int64], right: NDArray[np.int64]) -> None:
    rows = [tuple(row) for row in np.sort(given, axis=1).tolist()]
    wanted = {tuple(row) for row in right.tolist()}
    if len(set(rows)) < len(rows):
        raise VerificationError(f"an {name} occurs twice" if name == "edge" else f"a {name} occurs twice")
    for what, members in (("is missing", wanted - set(rows)), ("should not be there", set(rows) - wanted)):
        if members:
            labels = "-".join(str(label) for label in min(members))
            raise VerificationError(f"{name} {labels} {what} ({len(members)} such {name}s)")
