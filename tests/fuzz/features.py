"""Features among others are what they are alone, bit for bit: `--cases 20000 --seed 1`.

Each case is a list of features that touch, overlap, nest, cross, coincide or are nothing of the kind, in a frame of two
tiny triangles that keeps the lattice. What is inside each must be what one diagram of it and of the frame gives; and
the results must follow when the features are permuted or given twice, whatever the threads and the batches.
"""

import numpy as np

from fuzz.runner import Cases, Comparison, Verdict
from support.families.polygon_families import FAMILIES as RINGS
from support.families.skeleton_shapes import DATA
from vorotool import PolygonSet, VorotoolError, outlines, read, skeleton_exact
from vorotool.engines.features import batches as feature_sheets
from vorotool.engines.skeleton.exact import interior_skeleton, shape_diagram
from vorotool.types.polygons.polygon_set import SHELL
from vorotool.types.polygons.shapely_geometry import RingArrays

PLACES = ("vertices", "radius", "control", "length", "error_bound")
SITES = ("kind", "ring", "index")


# ---- features, each a list of polygons: a shell and holes ----------------------------------------
def ring(rng, around=(0, 0), size=8, n=6):
    """A simple one of integers, clockwise or not, that begins anywhere."""
    angle = np.sort(rng.uniform(0, 2 * np.pi, max(3, n)))
    xy = np.rint(np.stack([np.cos(angle), np.sin(angle)], axis=1) * rng.uniform(0.4, 1, (len(angle), 1)) * size)
    return np.roll(xy + around, int(rng.integers(n)), axis=0)[:: int(rng.choice([1, -1]))]


def box(x, y, w, h):
    """A rectangle."""
    return np.array([[x, y], [x + w, y], [x + w, y + h], [x, y + h]], dtype=float)


def tiles(rng):
    """Rectangles of a grid that share edges, stretches of edges and corners, and cover each other."""
    return [[[box(*rng.integers(0, 5, 2) * 2, *rng.integers(1, 4, 2) * 2)]] for _ in range(int(rng.integers(2, 9)))]


def nested(rng):
    """Boxes in boxes, some of them holes of the outer one as well, some the same."""
    made = []
    for depth in range(int(rng.integers(2, 6))):
        own = box(2 * depth, 2 * depth, 40 - 4 * depth, 30 - 4 * depth)
        inner = box(2 * depth + 2, 2 * depth + 2, 36 - 4 * depth, 26 - 4 * depth)
        made.append([[own, inner] if rng.random() < 0.4 else [own]])
        if rng.random() < 0.3:
            made.append(made[-1])
    return made


def crossing(rng):
    """Rings of few integers that cross each other, and themselves."""
    return [
        [[rng.integers(-9, 10, (int(rng.integers(3, 9)), 2)).astype(float)]] for _ in range(int(rng.integers(2, 6)))
    ]


def broken(rng):
    """Rings as bad as they come."""
    name = str(rng.choice(["tiny", "small", "collinear", "spikes", "mosaic"]))
    made = []
    for _ in range(int(rng.integers(1, 5))):
        xy, rings = RINGS[name](rng, int(rng.integers(3, 12)))
        made.append([[np.asarray(xy[begin:end], dtype=float)] for begin, end, kind, _ in rings if kind == SHELL])
    return [feature for feature in made if feature] or tiles(rng)


def parts(rng):
    """Features of several polygons, far apart, touching and overlapping."""
    return [
        [[ring(rng, rng.integers(-15, 16, 2), 8, int(rng.integers(3, 8)))] for _ in range(int(rng.integers(1, 4)))]
        for _ in range(int(rng.integers(1, 5)))
    ]


def fractions(rng):
    """Any numbers, slivers too."""
    flat = rng.choice([1.0, 1.0, 1e-3, 1e-6])
    return [
        [[ring(rng, rng.normal(0, 10, 2), 8, int(rng.integers(3, 40))) * [1, flat] + rng.normal(0, 0.01, 2)]]
        for _ in range(int(rng.integers(2, 8)))
    ]


def crowded(rng):
    """Many vertices in one cell of the curve that sites are ordered along: there is something far away."""
    made = [[[ring(rng, rng.integers(-300, 300, 2), 200, int(rng.integers(3, 200)))]] for _ in range(4)]
    return [*made, [[box(4_000_000, 7_000_000, 3, 3)]]]


def pierced(rng):
    """Holes that are points and segments: inside, on edges, across each other and outside."""
    made = []
    for _ in range(int(rng.integers(1, 5))):
        x, y = rng.integers(-6, 7, 2)
        shell = box(x, y, *rng.integers(4, 12, 2)) if rng.random() < 0.6 else ring(rng, (x, y), 10)
        holes = [rng.integers(-9, 15, (int(rng.choice([1, 1, 2])), 2)) * 1.0 for _ in range(int(rng.integers(1, 4)))]
        made.append([[shell, *holes]])
    return made


def scattered(rng):
    """More than a batch, in several sheets."""
    return [
        [[ring(rng, rng.integers(-90, 91, 2), int(rng.integers(4, 30)), int(rng.integers(3, 12)))]]
        for _ in range(int(rng.integers(10, 60)))
    ]


FAMILIES = (tiles, nested, crossing, broken, parts, fractions, crowded, pierced, scattered)


def as_set(features) -> PolygonSet:
    """One set of features, in a frame of two tiny triangles, which is the last feature."""
    vertices = np.concatenate([r for feature in features for polygon in feature for r in polygon])
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    margin = 4 + 2.0 ** np.ceil(np.log2(max(float((high - low).max()), 1.0)) - 4)
    a, b = low - margin, high + margin
    tiny = [[a + corner for corner in ([0, 0], [1, 0], [0, 1])], [b - corner for corner in ([0, 0], [1, 0], [0, 1])]]
    all_features = [*features, [[np.array(triangle)] for triangle in tiny]]
    rings = [r for feature in all_features for polygon in feature for r in polygon]
    polygons = [polygon for feature in all_features for polygon in feature]
    return PolygonSet(
        np.concatenate(rings),
        np.cumsum([0, *map(len, rings)]),
        np.concatenate([[0] + [1] * (len(polygon) - 1) for polygon in polygons]),
        np.repeat(np.arange(len(polygons)), [len(polygon) for polygon in polygons]),
        feature=np.repeat(np.arange(len(all_features)), [len(feature) for feature in all_features]),
    )


# ---- what is compared ----------------------------------------------------------------------------
def chosen(polygons: PolygonSet, features) -> PolygonSet:
    """Some features, in their order here."""
    numbers = [np.flatnonzero(polygons.feature == feature) for feature in features]
    arrays, _, _ = RingArrays.of(polygons).taken(np.concatenate(numbers))
    return PolygonSet(
        arrays.xy,
        np.cumsum([0, *arrays.sizes.tolist()]),
        arrays.kind,
        np.repeat(np.arange(len(arrays.rings)), arrays.rings),
        feature=np.repeat(np.arange(len(numbers)), [len(own) for own in numbers]),
        connectivity=polygons.connectivity,
    )


def inside_of(skeleton, feature, given: PolygonSet) -> list:
    """All arrays of what is inside one feature, with numbers that begin at 0, and the sites' places in the input."""
    polygons = np.flatnonzero(skeleton.polygons.feature == feature)
    arcs = np.flatnonzero(np.isin(skeleton.polygon, polygons))
    nodes = np.unique(skeleton.arcs[arcs])
    table = skeleton.site_table
    sites = np.flatnonzero(np.isin(table.polygon, polygons))
    rings = [r.tobytes() for polygon in polygons.tolist() for r in skeleton.polygons.rings_of(polygon)]
    known = sites[table.source_ring[sites] >= 0]
    source = given.xy[given.ring_starts[table.source_ring[known]] + table.source_index[known]]
    first_ring = table.source_ring[known].min(initial=2**30)
    made = [
        *(getattr(skeleton, name)[nodes if name in PLACES[:2] else arcs].tobytes() for name in PLACES),
        np.searchsorted(nodes, skeleton.arcs[arcs]).tolist(),
        np.searchsorted(sites, skeleton.sites[arcs]).tolist(),
        (skeleton.polygon[arcs] - polygons.min(initial=2**30)).tolist(),
        (skeleton.branch[arcs] - skeleton.branch[arcs].min(initial=2**30)).tolist(),
        rings,
        *(getattr(table, name)[sites].tolist() for name in SITES),
        source.tobytes(),
        (table.source_ring[known] - first_ring).tolist(),
        (table.polygon[sites] - polygons.min(initial=2**30)).tolist(),
    ]
    if len(nodes) and (nodes != np.arange(nodes[0], nodes[0] + len(nodes))).any():
        made.append("nodes of other features between")
    return made


NAMES = (
    *PLACES,
    "arcs",
    "sites",
    "polygon",
    "branch",
    "rings",
    *SITES,
    "source_index",
    "source_ring",
    "site polygon",
    "nodes",
)


def differing(one: list, other: list) -> str | None:
    """The first array that is not the same."""
    if len(one) != len(other):
        return NAMES[-1]
    return next((name for name, a, b in zip(NAMES, one, other, strict=False) if a != b), None)


def failure(polygons: PolygonSet, rng, batch: int, alone_of=None) -> str | None:
    """What is wrong with features that the last of them frames, if anything; `alone_of` gives one and the frame."""
    alone_of = alone_of or (lambda feature: chosen(polygons, [feature, count]))
    count = int(polygons.feature.max())
    feature_sheets.BATCH, before = batch, feature_sheets.BATCH
    try:
        made = skeleton_exact(polygons, threads=2)
        for feature in range(count):
            given = alone_of(feature)
            alone = interior_skeleton(shape_diagram(given, threads=1))
            if name := differing(inside_of(made, feature, polygons), inside_of(alone, 0, given)):
                return f"{name} of feature {feature} are not what they are alone"
        order = np.append(rng.permutation(np.repeat(np.arange(count), 1 + (rng.random(count) < 0.3))), count)
        reordered = chosen(polygons, order.tolist())
        permuted = skeleton_exact(reordered, threads=1)
        for place, feature in enumerate(order.tolist()):
            if name := differing(inside_of(made, feature, polygons), inside_of(permuted, place, reordered)):
                return f"{name} of feature {feature} change with the order"
    except VorotoolError as error:
        return str(error)
    finally:
        feature_sheets.BATCH = before
    return None


def failure_of_labels(rng, batch: int) -> str | None:
    """The same of a label image in which nearly all objects touch; two pixels are the frame."""
    side, connectivity = int(rng.integers(3, 14)), int(rng.choice([4, 8]))
    image = np.zeros((side + 4, side + 4), dtype=np.int32)
    image[2:-2, 2:-2] = rng.integers(0, int(rng.integers(2, 6)), (side, side))
    image[0, 0] = image[-1, -1] = 99
    present = np.unique(image)[1:]

    def alone_of(feature):
        kept = np.where((image == present[feature]) | (image == 99), image, 0)
        return outlines(kept, mode="labels", connectivity=connectivity)

    return failure(outlines(image, mode="labels", connectivity=connectivity), rng, batch, alone_of)


def of_data(rng) -> str | None:
    """Real polygons, one feature each, where most are islands or lakes in the bounds of others."""
    for path in DATA:
        shapes = read(path)
        if not shapes.is_line.any():
            numbers = np.unique(shapes.feature)
            picked = np.sort(rng.choice(numbers, min(len(numbers), 12), replace=False))
            some = chosen(shapes, picked.tolist())
            features = [
                [list(some.rings_of(polygon)) for polygon in np.flatnonzero(some.feature == k).tolist()]
                for k in range(len(picked))
            ]
            if wrong := failure(as_set(features), rng, 1 << 13):
                return f"{path.name}: {wrong}"
    return None


def check(case: int, cases: Cases) -> Verdict:
    """Judge some features together; now and then those of real polygons."""
    rng, kind = cases.random(case), case % (len(FAMILIES) + 1)
    if case % 500 == 499:
        return "data", of_data(rng), ""
    batch = int(rng.choice([8, 40, 1 << 13]))
    if kind == len(FAMILIES):
        return "labels", failure_of_labels(rng, batch), ""
    return FAMILIES[kind].__name__, failure(as_set(FAMILIES[kind](rng)), rng, batch), ""


COMPARISON = Comparison(20_000, check)
