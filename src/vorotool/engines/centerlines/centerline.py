"""Centerlines: the longest of the shortest paths along the skeleton of each polygon, to the middles of its ends."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import sqrt
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.points import as_place
from vorotool.engines.centerlines.ends import Unforked, forked, unforked
from vorotool.engines.centerlines.extended_ends import led_on, rounded
from vorotool.engines.centerlines.path_network import Network, Paths, Pieces, at_strip_ends, geometry_of
from vorotool.engines.centerlines.twigs import around_edges
from vorotool.engines.from_skeleton.points_along import first_hits
from vorotool.engines.skeleton.parts import with_arcs
from vorotool.errors import InputError, UsageError, warn
from vorotool.numeric.arrays import Booleans, Floats, Numbers, crosses, mask_of, starts_of
from vorotool.numeric.checks import is_choice
from vorotool.numeric.numbers import shown_number
from vorotool.numeric.parallel import Progress
from vorotool.types.arguments import check_value
from vorotool.types.box import check_lengths
from vorotool.types.skeleton.lines import Centerlines, without_centerline
from vorotool.types.skeleton.segment_voronoi import EDGE
from vorotool.types.skeleton.skeleton import Skeleton

if TYPE_CHECKING:
    from vorotool.typing import PointsLike

Indices = NDArray[np.int32]
Place = tuple[float, float]
Ends = Literal["middle", "corner", "none"]

MOST_NAMED = 10
"""Polygons without a centerline that a warning names."""


def centerline(
    skeleton: Skeleton,
    *,
    start: PointsLike | None = None,
    end: PointsLike | None = None,
    ends: Ends = "middle",
    progress: Progress = None,
) -> Centerlines:
    """Compute the centerline of each polygon: the longest shortest path between ends of its skeleton.

    An *end* is a leaf, or a fork of two arcs to both corners of one edge, as far as its longer arc reaches. The
    longest path is decided first; of those as long but for a millionth that at the first edges of the polygon (where
    it has cycles, of exactly as long ones). Then a fork is replaced by the straight line to the middle of its edge.
    At the end of a strip, whose sides are about parallel for its width (`vorotool.engines.centerlines.path_network`),
    the path stops at the last disc that touches both; from there, and from leaves inside, a straight line leads to
    the middle of the end: the piece of outline between both sides, however many vertices it has
    (`vorotool.engines.centerlines.extended_ends`). Other round ends, where the skeleton forks to more corners that
    follow each other within half a radius, are led straight on to the boundary, from the place of the path one radius
    before. A path leads into a tip: a corner of less than 45 degrees, or sharper than the next one by more than 90;
    and into all other corners, but in outlines of pixels: see `vorotool.engines.centerlines.centerline`. Where a
    connected skeleton has no end, paths between its nodes are compared; where it has one, paths from it.

    A triangle without tips has its end at the shortest edge, and a centerline from there to the corner opposite; a
    quadrilateral around a circle, such as a square, has two at opposite edges without tips; of equal ones the first.
    Other polygons that are all one round end have none: the centerline goes from the corner farthest from the middle of
    the largest disc straight through that middle. Neither have plates with holes in corners that are beside a cycle and
    much like both corners beside them.

    Trees take linear time. Let a skeleton have F branches on cycles, and trees at K places of these (all nodes, if
    there is no tree): that takes at most K searches in F branches, most of which bounds on distances save.

    Parameters
    ----------
    skeleton : Skeleton
        A skeleton; only its arcs inside polygons are used.
    start, end : (x, y) or a point of shapely, GeoJSON or WKT, optional
        Give the one path between the places nearest to these on the skeleton whose forks are led to the middles of
        their edges, and whose round ends are left out: it goes up no corner of these. With one of the two, the path
        leads to the end that is farthest from there.
    ends : {"middle", "corner", "none"}
        As described above; or paths run along the whole skeleton, and straight on from leaves inside; or they stop at
        forks, where ends of strips begin, at round ends, and at leaves inside.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    Centerlines
        The centerlines, in the order of the polygons.

    Raises
    ------
    InputError
        If there is no path between `start` and `end`.
    UsageError
        If `start` or `end` is not finite, or `ends` is unknown.

    Warns
    -----
    VorotoolWarning
        If polygons have no centerline (no skeleton inside, or a single point): their number and names.

    Examples
    --------
    >>> from vorotool import skeleton_exact
    >>> skeleton = skeleton_exact([[0, 0], [6, 0], [6, 2], [0, 2]])
    >>> centerline(skeleton).flattened(0.1)[0].tolist()
    [[0.0, 1.0], [6.0, 1.0]]
    >>> centerline(skeleton, ends="corner").flattened(0.1)[0].tolist()
    [[0.0, 0.0], [1.0, 1.0], [5.0, 1.0], [6.0, 0.0]]
    >>> centerline(skeleton, start=(2, 2), end=(3, 0)).flattened(0.1)[0].tolist()
    [[2.0, 1.0], [3.0, 1.0]]
    """
    check_value(skeleton, "skeleton", "Skeleton")
    if not is_choice(ends, get_args(Ends)):
        raise UsageError(f"ends is {shown_number(ends)}: use {', '.join(get_args(Ends))}")
    is_whole = ends == "corner"
    network = Network(forked(skeleton) if is_whole else unforked(skeleton), by_edge=not is_whole)
    if start is None and end is None:
        lines = _made(network, network.longest_paths(progress), skeleton, ends, wanted=(True, True))
        _warn_missing(lines)
        return lines
    return _path_between(network, skeleton, start, end, ends, progress)


def _path_between(
    network: Network, skeleton: Skeleton, start: Any, end: Any, ends: Ends, progress: Progress
) -> Centerlines:
    """The one path with a place that is given at one end or both."""
    start, end = (None if place is None else as_place(place, name) for name, place in (("start", start), ("end", end)))
    for place in (start, end):
        if place is not None and not np.isfinite(place).all():
            raise UsageError(f"the point ({place[0]}, {place[1]}) is not finite: give finite coordinates")
        check_lengths(place or (), "coordinate")
    if not len(network.arc):
        raise InputError("the skeleton has no arcs inside polygons for a path to follow")
    first, last = (-1 if place is None else network.node_near(place) for place in (start, end))
    is_reversed = start is None
    path = network.path(last if is_reversed else first, -1 if is_reversed else last, progress)
    if path is None or not len(path.arcs):
        raise InputError(_no_path(skeleton, start, end, is_apart=path is None))
    path = path.turned(np.array([is_reversed]))
    line = _made(network, path, skeleton, ends, wanted=(start is None, end is None))
    if not len(line):
        raise InputError(_no_path(skeleton, start, end, is_apart=False))
    return line


# ---- paths as skeletons ---------------------------------------------------------------------------
def _made(network: Network, paths: Paths, skeleton: Skeleton, ends: Ends, *, wanted: tuple[bool, bool]) -> Centerlines:
    """Put the arcs of paths together as skeletons, and lead them on."""
    pieces, is_strip = network.pieces(paths), np.zeros((len(paths.start) - 1, 2), dtype=bool)
    if ends != "corner":
        pieces, is_strip = at_strip_ends(network.axis, pieces, len(skeleton), wanted)
    start = starts_of(np.bincount(pieces.line))
    is_lead, is_round = _marked(network.axis, pieces, start, is_strip)
    outer = start[:-1], start[1:] - 1
    leads = np.stack([is_lead[places] for places in outer], axis=1)
    rounds = np.stack([is_round[places] for places in outer], axis=1)
    middles = _outer_places(network.skeleton, pieces, outer)
    middles[~leads] = np.nan
    left = _without(pieces, is_lead, is_lead | is_round)
    if ends == "none":
        path = _joined(network.skeleton, _with_length(left))
        path = _without_places(_rounded(_without_ends(path)).path)
        return _without_ends(path)
    lines = Centerlines(_joined(network.skeleton, left), middles)
    asked = np.array(wanted) & ~_at_open_border(network.skeleton, lines)
    is_open = ((paths.end_nodes < network.leaves) | rounds | is_strip) & ~leads & asked
    to_middles = (~rounds | is_strip) & (ends == "middle")
    if ends == "middle":
        lines = led_to_oblique_ends(lines, (is_open | leads) & ~rounds & asked)
    is_open &= np.isnan(lines.ends[:, :, 0])
    return _rounded(replace(lines, ends=led_on(lines, is_open, to_middles=to_middles)))


def _without_ends(path: Skeleton) -> Centerlines:
    """Lines that are led on nowhere."""
    return Centerlines(path, np.full((int(path.branch.max(initial=-1)) + 1, 2, 2), np.nan))


def _without_places(path: Skeleton) -> Skeleton:
    """Leave out lines that go nowhere: pruning leaves single places of round shapes as arcs."""
    source, target = path.vertices[path.arcs].swapaxes(0, 1)
    goes_on = mask_of(path.branch[(source != target).any(axis=1)], int(path.branch.max(initial=-1)) + 1)
    return with_arcs(path, goes_on[path.branch])


def _rounded(lines: Centerlines) -> Centerlines:
    vertices, ends = rounded(lines)
    return Centerlines(replace(lines.path, vertices=vertices), ends)


def _at_open_border(skeleton: Skeleton, lines: Centerlines) -> Booleans:
    """(k, 2) which ends are where the polygon goes on beyond the frame: there is nothing to lead them on to."""
    if skeleton.border != "open":
        return np.zeros((len(lines), 2), dtype=bool)
    return replace(lines.path, frame=skeleton.frame).touches_frame[lines.end_nodes]


def _marked(axis: Unforked, pieces: Pieces, start: NDArray[np.int64], is_strip: Booleans) -> tuple[Booleans, Booleans]:
    """Which pieces are taken off the ends of lines: whole leads, and round ends where there is more."""
    is_lead, is_round = axis.is_lead[pieces.arc], axis.is_round[pieces.arc]
    plain = np.concatenate([[0], np.cumsum(~is_round)])
    is_round &= ~is_strip[pieces.line, 0] | (plain[1:] > plain[start[:-1]][pieces.line])
    is_round &= ~is_strip[pieces.line, 1] | (plain[:-1] < plain[start[1:]][pieces.line])
    is_lead &= (pieces.first == 0) & (pieces.last == 1)
    count = len(start) - 1

    def has_more(taken: Booleans) -> Booleans:
        return np.bincount(pieces.line[~taken], minlength=count) > 0

    is_round &= has_more(is_lead | is_round)[pieces.line]
    is_lead &= (np.diff(start) > 1)[pieces.line]
    return is_lead, is_round


def _outer_places(skeleton: Skeleton, pieces: Pieces, outer: Sequence[NDArray[np.int64]]) -> Floats:
    """(k, 2, 2) where lines begin and end."""
    places = np.empty((len(outer[0]), 2, 2))
    for end, chosen in enumerate(outer):
        made = pieces[chosen]
        parts = geometry_of(skeleton, made.arc, made.first, made.last)
        is_target = made.is_turned == (end == 0)
        places[:, end] = np.where(is_target[:, None], parts["last"], parts["first"])
    return places


def _without(pieces: Pieces, is_lead: Booleans, taken: Booleans) -> Pieces:
    """The rest of lines; of two leads a single place, the fork."""
    left = np.bincount(pieces.line[~taken], minlength=int(pieces.line.max(initial=-1)) + 1) > 0
    single = ~left[pieces.line] & is_lead & (np.diff(pieces.line, prepend=-1) > 0)
    made = pieces[np.flatnonzero(~taken | single)]
    single = single[~taken | single]
    return replace(made, last=np.where(single, made.first, made.last))


def _with_length(pieces: Pieces) -> Pieces:
    """Lines that are more than a single place, numbered again."""
    long = np.flatnonzero(pieces.first != pieces.last)
    _, line = np.unique(pieces.line[long], return_inverse=True)
    return replace(pieces[long], line=line.reshape(-1).astype(np.int32))


def _joined(skeleton: Skeleton, pieces: Pieces) -> Skeleton:
    """The pieces as a skeleton: one branch a line."""
    arc, line, is_turned = pieces.arc, pieces.line, pieces.is_turned
    parts = geometry_of(skeleton, arc, pieces.first, pieces.last)
    turned = is_turned[:, None]
    is_first = np.diff(line, prepend=-1) > 0
    node = np.arange(len(arc)) + line  # at the source of each arc: one more than arcs on each line
    count = len(arc) + int(is_first.sum())
    vertices, radius = np.empty((count, 2)), np.empty(count)
    vertices[node[is_first]] = np.where(turned, parts["last"], parts["first"])[is_first]
    radius[node[is_first]] = np.where(is_turned, parts["last_radius"], parts["first_radius"])[is_first]
    vertices[node + 1] = np.where(turned, parts["first"], parts["last"])
    radius[node + 1] = np.where(is_turned, parts["first_radius"], parts["last_radius"])
    sites = skeleton.sites[arc]
    return replace(
        skeleton,
        vertices=vertices,
        radius=radius,
        arcs=np.stack([node, node + 1], axis=1),
        control=parts["control"],
        sites=np.where(turned, sites[:, ::-1], sites),
        polygon=skeleton.polygon[arc],
        side=skeleton.side[arc],
        branch=line,
        length=parts["length"],
        error_bound=skeleton.error_bound[arc],
        frame=None,
    )


# ---- what is said ---------------------------------------------------------------------------------
def _warn_missing(lines: Centerlines) -> None:
    missing = without_centerline(lines)
    if not len(missing):
        return
    polygons = lines.path.polygons
    total = int(np.count_nonzero(~polygons.is_line))
    ids = polygons.feature_ids
    has_ids = ids is not None and all(ids[k] is not None for k in missing.tolist())
    named = [str(ids[k] if ids is not None and has_ids else k + 1) for k in missing[:MOST_NAMED].tolist()]
    more = f" and {len(missing) - MOST_NAMED} more" if len(missing) > MOST_NAMED else ""
    has, noun = ("has", "") if len(missing) == 1 else ("have", "s")
    what = f"id{noun}" if has_ids else f"number{noun}"
    warn(f"{len(missing)} of {total} polygons {has} no centerline: {what} {', '.join(named)}{more}")


def _no_path(skeleton: Skeleton, start: Place | None, end: Place | None, *, is_apart: bool) -> str:
    def told(place: Place | None) -> str:
        return "a leaf" if place is None else f"({place[0]:g}, {place[1]:g})"

    if is_apart:
        return (
            f"no path along the skeleton leads from {told(start)} to {told(end)}: these parts of the skeleton are not "
            "connected"
        )
    return f"the path from {told(start)} to {told(end)} is a single point of the skeleton: give points farther apart"


WIDTH = 4.0
"""In radii of the place where the path comes to an edge: an end is no longer. A stroke cut at 30 degrees has 4."""

STEEP = (1 - sqrt(0.5)) / 2
"""Square of the sine of half of 45 degrees: by so much radii fall along the way into such a corner, which is no tip."""


def led_to_oblique_ends(lines: Centerlines, wanted: Booleans) -> Centerlines:
    """Cut off what leads along one edge into its corner, and lead on to the middle of that edge."""
    path, start = lines.path, lines.arc_starts
    if path.polygons.connectivity is None:  # no outlines of pixels
        return lines
    kept, ends = np.ones(len(path), dtype=bool), lines.ends.copy()
    outer = np.stack([start[:-1], start[1:] - 1], axis=1)
    begins = _edges_between_corners(lines, outer)
    xy, following = path.polygons.xy, path.polygons.following
    size = np.where(begins < 0, 0.0, np.abs(xy[following[begins]] - xy[begins]).max(axis=-1))
    for line, end in np.argwhere(wanted & (size[..., 0] != size[..., 1])).tolist():
        side = int(size[line, end].argmax())
        arcs = np.arange(start[line], start[line + 1])[:: -1 if end else 1]
        cut = _along(lines, arcs, int(path.sites[outer[line, end], side]))
        middle = _middle(lines, arcs, cut, end, int(begins[line, end, side]))
        if middle is not None and kept[arcs].sum() > cut:
            kept[arcs[:cut]] = False
            ends[line, end] = middle
    return lines if kept.all() else Centerlines(with_arcs(path, kept), ends)


def _edges_between_corners(lines: Centerlines, arcs: Numbers) -> NDArray[np.int64]:
    """(…, 2) where sites of arcs begin that are edges between two corners into which the inside goes; else -1."""
    polygons, table = lines.path.polygons, lines.path.site_table
    sites = lines.path.sites[arcs]
    vertex = table.vertices(polygons, sites)
    p, a, b, q = np.moveaxis(around_edges(polygons, vertex), -2, 0)
    turns = [np.sign(crosses(a - p, b - a)), np.sign(crosses(b - a, q - b))]
    is_edge = (table.kind[sites] == EDGE) & (turns[0] == turns[1]) & (turns[0] != 0)
    return np.where(is_edge, vertex, -1)


def _along(lines: Centerlines, arcs: Numbers, site: int) -> int:
    """How many arcs from the end of a line on are beside a site."""
    for count, arc in enumerate(arcs.tolist()):
        if site not in lines.path.sites[arc]:
            return count
    return len(arcs)


def _middle(lines: Centerlines, arcs: Numbers, cut: int, end: int, vertex: int) -> Floats | None:
    """The middle of an edge that a line can be led to when some arcs are cut off."""
    if not 0 < cut < len(arcs):
        return None
    path, polygons = lines.path, lines.path.polygons
    node, last = path.arcs[arcs[cut - 1], 1 - end], path.arcs[arcs[0], end]
    a, b = polygons.xy[vertex], polygons.xy[polygons.following[vertex]]
    (x, y), most = b - a, WIDTH * path.radius[node]
    is_short = x * x + y * y <= most * most
    (u, v), fall = path.vertices[last] - path.vertices[node], path.radius[node] - path.radius[last]
    is_steep = fall > 0 and fall * fall >= STEEP * (u * u + v * v)
    if not is_short or not (is_steep or path.radius[last] <= path.radius[node] / 2):
        return None
    middle: Floats = a / 2 + b / 2
    origin = path.vertices[node]
    _, met = first_hits(polygons, path.polygon[arcs[:1]], origin[None], (middle - origin)[None])
    return middle if met[0] == vertex else None
