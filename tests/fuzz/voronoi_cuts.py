"""Voronoi maps between clips and enclosures on small lattices, with and without a limit: `--cases 100000 --seed 1`.

On the places of a lattice of 4, 8 or 1000 steps everything ties, touches and runs along everything else. Each map is
checked by the shipped checker, and is a coverage at three flattenings; without a limit its area is that of what is
shared out, and at random places in each face the cell is that of the first of the nearest of the sites that meet it,
by shapely's overlays, faces and distances. Where doubles do not tell a cut from a border a map is refused, which is
counted: at most one in 500 may be.
"""

import warnings

import numpy as np
import shapely

from fuzz.runner import Cases, Comparison, Verdict
from support.families.cut_scenes import lattice_clip, lattice_lines, lattice_sites
from support.oracles.cut_oracle import assert_nearest_in_regions, meets_itself, regions_of_lines
from vorotool import VoronoiMap, VorotoolError, verify_voronoi, voronoi

LATTICES = (4, 8, 1000)
KINDS = ("clip", "enclosures")
PLACES = 40
AREA = 3e-8
"""Of what is shared out, or of the length of its boundary: corners of cuts are moved onto the lattice."""
REFUSED = "to within rounding"
MOST_REFUSED = 1 / 500


def check_shared(cells: VoronoiMap) -> None:
    """Cells share their borders bit for bit, and overlap nowhere."""
    for flatten in (None, 1e-3, 1.0):
        shapes = cells.to_shapely(flatten=flatten)
        assert shapely.is_valid(shapes).all(), shapely.is_valid_reason(shapes)
        total = shapely.area(shapes).sum()
        assert abs(shapely.union_all(shapes).area - total) <= 1e-9 * total
        assert shapely.coverage_is_valid(shapes) or meets_itself(shapes)


def check_scene(kind: str, side: int, limit: float | None, random: np.random.Generator, seed: list[int]) -> int:
    """Make a scene and its map, and compare them; gives how many sites there are."""
    sites = lattice_sites(random, side)
    if kind == "clip":
        clip = lattice_clip(random, side, sites)
        covered = shapely.union_all(clip)
        cells = voronoi(sites, clip=clip, max_distance=limit, threads=1)
        regions, area = [(covered, [*range(len(sites))])], covered.area
    else:
        lines = lattice_lines(random, side)
        frame = (-1.5, -1.5, side + 3, side + 3)
        cells = voronoi(sites, enclosures=lines, frame=frame, max_distance=limit, threads=1)
        x, y, w, h = frame
        regions = regions_of_lines(lines, shapely.box(x, y, x + w, y + h), sites)
        area = sum(face.area for face, own in regions if own)
    verify_voronoi(cells, places=PLACES)
    check_shared(cells)
    if limit is None:
        length = sum(face.length for face, _ in regions)
        assert abs(cells.areas.sum() - area) <= AREA * max(area, 10 * length, 1)
        assert_nearest_in_regions(cells, sites, regions, seed=seed, count=PLACES)
    return len(sites)


def check(case: int, cases: Cases) -> Verdict:
    """Judge the map of a scene."""
    random = cases.random(case)
    kind, side = KINDS[case % 2], LATTICES[case // 2 % 3]
    limit = float(side * random.choice([0.125, 0.25, 0.3, 0.5])) if case // 6 % 2 else None
    wrong = None
    try:
        with warnings.catch_warnings(action="ignore"):
            cases.counts["sites"] += check_scene(kind, side, limit, random, cases.seed(case))
    except (VorotoolError, AssertionError, ValueError) as error:
        wrong = f"{type(error).__name__}: {' '.join(str(error).split())[:300]}"
        if REFUSED in wrong:
            cases.counts["refused"] += 1
            wrong = "too many are refused" if cases.counts["refused"] > 3 + MOST_REFUSED * cases.count else None
    return kind, wrong, f"lattice of {side}, limit {limit}"


COMPARISON = Comparison(10**5, check)
