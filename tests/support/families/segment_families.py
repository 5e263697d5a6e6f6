"""Families of planar straight-line graphs that tests, fuzzing and benchmarks of segment diagrams share.

A family gives a graph of n segments, or about as many, on the lattice: points (k, 2) and segments (m, 2), both int32.
Segments meet at shared ends only, and no point lies inside one.
"""

import warnings

import numpy as np

HALF = 2**29 - 1
"""Most families span twice this: 30 bits."""
LIMIT = 2**30 - 1

BOOST_FAILURE = [
    (0, 1),
    (100000, 1),
    (12501, 37499),
    (37500, 62500),
    (100001, 100001),
    (25000, 87499),
    (-1, 100001),
    (0, 50001),
]
"""A valid polygon on which Boost 1.90 is wrong."""


def lattice(points):
    points = np.rint(np.asarray(points, dtype=np.float64)).reshape(-1, 2)
    assert np.abs(points).max(initial=0) <= LIMIT
    return points.astype(np.int32)


def polygon(points):
    """A closed ring; repeated neighbors are dropped."""
    points = lattice(points)
    points = points[(points != np.roll(points, 1, axis=0)).any(axis=1)]
    ends = np.arange(len(points), dtype=np.int32)
    return points, np.stack([ends, np.roll(ends, -1)], axis=1)


def polyline(points):
    points = lattice(points)
    ends = np.arange(len(points) - 1, dtype=np.int32)
    return points, np.stack([ends, ends + 1], axis=1)


def together(graphs):
    """Several graphs that do not touch."""
    points, segments, count = [], [], 0
    for p, s in graphs:
        points.append(p)
        segments.append(s + count)
        count += len(p)
    return np.concatenate(points).astype(np.int32), np.concatenate(segments).astype(np.int32)


def around(radius, scale=HALF):
    """The points of a star: radii from 0 to 1 at equal angles."""
    angle = 2 * np.pi * np.arange(len(radius)) / len(radius)
    return scale * radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def star_smooth(rng, n):
    n = max(n, 3)
    angle = 2 * np.pi * np.arange(n) / n
    waves = sum(rng.random() / k * np.cos(k * angle + rng.uniform(0, 6.28)) for k in range(2, 22))
    return polygon(around(0.6 + 0.4 * np.tanh(0.3 * waves)))


def star_rough(rng, n):
    """Deep spikes."""
    return polygon(around(rng.uniform(0.1, 1, max(n, 3))))


def star_small(rng, n):
    """On a coarse lattice: ties, and corners of any kind."""
    return polygon(around(rng.uniform(0.5, 1, max(n, 3)), scale=max(n, 3) * 4))


def histogram(rng, n, step, height):
    """The corners of a row of columns whose heights differ from column to column."""
    columns = max(1, (n - 2) // 2)
    heights = np.cumsum(rng.integers(1, max(2, height // 2), columns)) % height + 1
    x = np.repeat(np.arange(columns + 1), 2) * step
    y = np.concatenate([[0], np.repeat(heights, 2), [0]]) * step
    keep = np.concatenate([[True], np.ones(2 * columns, bool), [True]])
    return np.stack([x, y], axis=1)[keep]


def rectilinear(rng, n):
    """Columns above a base line; corners of two columns alike are dropped."""
    step = int(rng.choice([1, 2, 1000, HALF // max(n, 4)]))
    points = histogram(rng, n, step, max(4, int(rng.integers(4, 20))))
    same = (points == np.roll(points, 1, axis=0)).all(axis=1)
    points = points[~same]
    straight = (points == np.roll(points, 1, axis=0)) & (points == np.roll(points, -1, axis=0))
    return polygon(points[~straight.any(axis=1)] if rng.random() < 0.5 else points)


def jittered_grid(rng, n):
    """A rectilinear polygon with coordinates to 10^9, every corner moved by at most 1: near ties everywhere."""
    step = int(rng.choice([10, 12500, 10**9 // max(n, 30)]))
    points = histogram(rng, n, step, 20)
    points = points[~(points == np.roll(points, 1, axis=0)).all(axis=1)]
    return polygon(points + rng.integers(-1, 2, points.shape))


def toothed(rng, n, offsets):
    """A bar with deep teeth, whose corners are at these places of a tooth's width."""
    teeth = max(1, n // 4)
    width = max(2, LIMIT // (8 * teeth + 8)) * 2
    height = int(rng.choice([3 * width + 1, HALF]))
    x = (4 * np.arange(teeth)[:, None] + np.array(offsets)).ravel() * width // 2
    points = np.stack([x, np.tile([0, height, height, 0], teeth)], axis=1)
    right = 2 * teeth * width
    return polygon(np.concatenate([points, [[right, -width], [-width, -width]]]) - [right // 2, 0])


def comb(rng, n):
    """Rectangular teeth."""
    return toothed(rng, n, [0, 0, 2, 2])


def comb_tapered(rng, n):
    """Teeth that are narrower at their tips: congruent, so that discs tie without being dyadic."""
    return toothed(rng, n, [0, 1, 2, 3])


def spiral(rng, n):
    """A band that winds around the origin."""
    half = max(4, n // 2)
    turns = max(1.0, half / 40)
    angle = np.linspace(1, 2 * np.pi * turns + 1, half)
    radius = angle / angle[-1]
    inner = radius - 0.4 * 2 * np.pi / angle[-1] * np.minimum(1, radius * 2)
    way = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return polygon(HALF * np.concatenate([radius[:, None] * way, (inner[:, None] * way)[::-1]]))


def hilbert(rng, n):
    """An open curve through every point of a square grid."""
    order = max(1, round(np.log2(max(n, 4)) / 2))
    d = np.arange(4**order)
    x, y = np.zeros_like(d), np.zeros_like(d)
    for k in range(order):
        s = 2**k
        rx = (d >> (2 * k + 1)) & 1
        ry = ((d >> (2 * k)) & 1) ^ rx
        flip = (ry == 0) & (rx == 1)
        x, y = np.where(flip, s - 1 - x, x), np.where(flip, s - 1 - y, y)
        x, y = np.where(ry == 0, y, x), np.where(ry == 0, x, y)
        x, y = x + s * rx, y + s * ry
    unit = int(rng.choice([1, 3, HALF >> order]))
    return polyline(np.stack([x, y], axis=1) * unit)


def koch(rng, n):
    """A snowflake, turned."""
    start = rng.uniform(0, 6.28)
    corners = np.exp(1j * (start - 2 * np.pi * np.arange(3) / 3)) * HALF
    for _ in range(max(0, round(np.log(max(n, 3) / 3) / np.log(4)))):
        side = np.roll(corners, -1) - corners
        bump = corners + side * (0.5 + 1j * np.sqrt(3) / 6)
        corners = np.stack([corners, corners + side / 3, bump, corners + 2 * side / 3], axis=1).ravel()
    return polygon(np.stack([corners.real, corners.imag], axis=1))


def regular(rng, n):
    """Corners on one circle but for rounding."""
    return polygon(around(np.ones(max(n, 3)), scale=int(rng.choice([4 * max(n, 3), 10**6, HALF]))))


def squares(rng, n):
    """Squares in a grid: cocircular sites in plenty; some share a side."""
    side = max(1, round(np.sqrt(n / 4)))
    size, gap = int(rng.integers(1, 5)), int(rng.integers(1, 4))
    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * size
    return together([polygon(corners + np.array([i, j]) * (size + gap)) for i in range(side) for j in range(side)])


def symmetric(rng, n):
    """A grid of copies of a shape that is its own mirror image, turned: ties of segments of irrational lengths."""
    a, b = np.sort(rng.choice(np.arange(1, int(rng.choice([8, 100, 10**4]))), 2, replace=False))
    rhombus = [(b, 0), (0, a), (-b, 0), (0, -a)]
    octagon = [(b, a), (a, b), (-a, b), (-b, a), (-b, -a), (-a, -b), (a, -b), (b, -a)]
    corners = np.array(rhombus if n < 8 or rng.random() < 0.5 else octagon)
    side, step = max(1, round(np.sqrt(n / len(corners)))), int(rng.integers(2, 5)) * b + int(rng.integers(1, 4))
    shapes = [polygon(corners + np.array([i, j]) * step) for i in range(side) for j in range(side)]
    points, segments = together(shapes)
    p, q = [(1, 0), (2, 1), (4, 3)][rng.integers(0, 3)]
    return lattice(points @ np.array([[p, q], [-q, p]])), segments


def tiled(rng, n):
    """A grid of unit squares that share their sides, some left out: nodes of any degree to 4, collinear chains."""
    side = max(1, round(np.sqrt(n / 2)))
    size = int(rng.choice([1, 2, 7, HALF // (side + 1)]))
    x, y = np.meshgrid(np.arange(side + 1), np.arange(side + 1), indexing="ij")
    points = np.stack([x, y], axis=-1).reshape(-1, 2)
    number = np.arange(len(points)).reshape(side + 1, side + 1)
    across = np.stack([number[:-1].ravel(), number[1:].ravel()], axis=1)
    up = np.stack([number[:, :-1].ravel(), number[:, 1:].ravel()], axis=1)
    segments = np.concatenate([across, up])
    return lattice(points * size), segments[rng.random(len(segments)) < rng.choice([0.5, 0.8, 1.0])].astype(np.int32)


def needles(rng, n):
    """Triangles a unit wide and up to 2^30 long."""
    graphs = []
    for i in range(max(1, n // 3)):
        left, right = np.sort(rng.integers(-LIMIT, LIMIT, 2))
        right += 1
        y = 4 * i
        corners = [(left, y), (left, y + 1), (right, y + int(rng.integers(0, 2)))]
        graphs.append(polygon(corners if rng.random() < 0.5 else [(right, y), (right, y + 1), (left, y)]))
    return together(graphs)


def strips(rng, n):
    """Segments across the whole lattice that are nearly parallel."""
    y = 3 * np.arange(max(n, 1)) + rng.integers(0, 2, (2, max(n, 1)))
    x = LIMIT - rng.integers(0, 3, (2, max(n, 1)))
    points = np.stack([np.stack([-x[0], y[0]], axis=1), np.stack([x[1], y[1]], axis=1)], axis=1).reshape(-1, 2)
    return lattice(points), np.arange(len(points), dtype=np.int32).reshape(-1, 2)


def wheel(rng, n):
    """A hub with many spokes, some joined at the rim."""
    spokes = max(3, n // 2)
    points = np.concatenate([[[0, 0]], lattice(around(np.ones(spokes), scale=int(rng.choice([40 * spokes, HALF]))))])
    rim = np.arange(1, spokes + 1)
    sides = np.stack([rim, np.roll(rim, -1)], axis=1)[rng.random(spokes) < rng.choice([0.5, 1.0])]
    segments = np.concatenate([np.stack([np.zeros_like(rim), rim], axis=1), sides])
    return points.astype(np.int32), segments.astype(np.int32)


def chains(rng, n):
    """A triangle whose sides are cut into collinear pieces."""
    pieces = max(1, n // 3)
    a, b = rng.integers(1, 1000, 2), rng.integers(-1000, 1000, 2)
    if a[0] * b[1] == a[1] * b[0]:
        b = np.array([-a[1], a[0]])
    corners = np.array([[0, 0], a, b])
    steps = np.arange(pieces)[:, None]
    sides = zip(corners, np.roll(corners, -1, axis=0), strict=True)
    return polygon(np.concatenate([p * pieces + (q - p) * steps for p, q in sides]))


def contour(rng, n):
    """Contours of smooth noise: shells and holes."""
    from scipy.ndimage import gaussian_filter
    from skimage.measure import find_contours

    side = max(12, round(np.sqrt(3.6 * n)))
    noise = gaussian_filter(rng.normal(size=(side, side)), 2.5, mode="constant")
    noise[[0, -1]] = noise[:, [0, -1]] = -1
    scale = 2 * HALF // side
    rings = [ring[:-1] for ring in find_contours(noise / np.abs(noise[1:-1, 1:-1]).max(), 0.1)]
    graphs = [polygon(ring * scale - HALF) for ring in rings if len(ring) > 3]
    return together(graphs or [regular(rng, n)])


def joined(points, pairs):
    """Segments of those pairs, one after the other, that cross none before and hold no point."""
    x, y = points[:, 0].astype(np.int64), points[:, 1].astype(np.int64)

    def side(i, j, k):
        return np.sign((x[j] - x[i]) * (y[k] - y[i]) - (y[j] - y[i]) * (x[k] - x[i]))

    everyone = np.arange(len(points))
    kept = np.empty((0, 2), np.int64)
    for i, j in pairs:
        between = (
            (side(i, j, everyone) == 0)
            & (np.minimum(x[i], x[j]) <= x)
            & (x <= np.maximum(x[i], x[j]))
            & (np.minimum(y[i], y[j]) <= y)
            & (y <= np.maximum(y[i], y[j]))
        )
        if i == j or between.sum() > 2:
            continue
        a, b = kept[:, 0], kept[:, 1]
        crossing = (side(i, j, a) * side(i, j, b) < 0) & (side(a, b, i) * side(a, b, j) < 0)
        same = ((a == i) & (b == j)) | ((a == j) & (b == i))
        if not (crossing | same).any():
            kept = np.concatenate([kept, [[i, j]]])
    return kept.astype(np.int32)


def graph_on(rng, points, tries):
    points = np.unique(points, axis=0)
    points = points[rng.permutation(len(points))].astype(np.int32)
    return points, joined(points, rng.integers(0, len(points), (tries, 2)))


def random_graph(rng, points, tries, size):
    """A graph on random points of a square; small ones give many ties."""
    return graph_on(rng, rng.integers(-size, size + 1, (points, 2)), tries)


def clusters(rng, n):
    """Nodes of any degree among points 1-2 units apart, in an extent of 10^7 to 10^9."""
    extent = int(10 ** rng.uniform(7, 9))
    centers = rng.integers(-extent, extent, (int(rng.integers(2, 7)), 2))
    count = max(4, n // 2)
    points = centers[rng.integers(0, len(centers), count)] + rng.integers(-2, 3, (count, 2))
    return graph_on(rng, points, 3 * n)


def crowded(rng, n):
    """A graph on a lattice of a few units: ties, collinear points, nodes of high degree."""
    side = int(rng.integers(2, 6))
    return graph_on(rng, rng.integers(-side, side + 1, (max(2, n // 2), 2)), 3 * n)


def two_boxes(rng, n):
    """A graph on two small boxes of points far apart: long segments that are nearly parallel, and nearly touch."""
    distance = int(rng.choice([100, 10**6, LIMIT - 40]))
    box = np.array([int(rng.choice([1, 2, 3, 8])), int(rng.choice([2, 5, 12, 30]))])
    near, far = (rng.integers(0, box + 1, (max(2, n // k), 2)) for k in (4, 2))
    return graph_on(rng, np.concatenate([near, far + np.array([distance, 0])]), 3 * n)


def fan(rng, n):
    """Needles from one point to points of a narrow strip at the edge of the lattice."""
    reach = int(rng.choice([10, 1000, LIMIT]))
    rows = np.arange(max(2, n)) * int(rng.choice([1, 2, 7]))
    tips = np.stack([reach - rng.choice([0, 0, 1, reach // 2], len(rows)), -rows], axis=1)
    points = np.concatenate([[[0, 0]], tips]).astype(np.int32)
    return points, joined(points, [(0, i) for i in range(1, len(points))])


def scattered(rng, n):
    """A graph on random points."""
    extent = int(rng.choice([30, 10**4, LIMIT]))
    return graph_on(rng, rng.integers(-extent, extent + 1, (max(2, n // 2), 2)), 3 * n)


def cells_of_a_map(rng, n):
    """Quadrangles that share their corners and sides, some left out; or digitised one by one, off by 1."""
    side, extent = max(2, round(np.sqrt(n / 3))), float(rng.choice([20, 10**6, 10**9]))
    corners = np.stack(np.meshgrid(np.arange(side + 1), np.arange(side + 1), indexing="ij"), axis=-1)
    corners = np.rint((corners + rng.uniform(-0.3, 0.3, corners.shape)) * extent / side)
    off = int(rng.integers(0, 2))
    kept = np.argwhere(rng.random((side, side)) < 0.9)
    cells = [corners[[i, i + 1, i + 1, i], [j, j, j + 1, j + 1]] for i, j in kept]
    return [cell + rng.integers(-off, off + 1, (4, 2)) for cell in cells]


def partition(rng, n):
    """A map, cut where its cells overlap: nodes of degree 3 and more, and slivers a unit wide."""
    from vorotool.engines.arrangement.planar_graph import planar_graph

    with warnings.catch_warnings(action="ignore"):
        graph = planar_graph(cells_of_a_map(rng, n), threads=1)
    return graph.points, graph.segments


NAMES = """
    star_smooth star_rough star_small rectilinear jittered_grid comb comb_tapered spiral hilbert koch regular
    squares symmetric tiled needles strips wheel chains contour clusters crowded two_boxes fan scattered partition
"""
FAMILIES = {name: globals()[name] for name in NAMES.split()}


JOINED = ("clusters", "crowded", "two_boxes", "fan", "scattered")
"""Families that take time in the square of n to draw."""


def draw(name, n, seed):
    """The graph of a family, the same for the same arguments."""
    points, segments = FAMILIES[name](np.random.default_rng(seed), n)
    assert points.dtype == segments.dtype == np.int32
    assert np.abs(points.astype(np.int64)).max(initial=0) <= LIMIT
    assert len(np.unique(points, axis=0)) == len(points)
    return np.ascontiguousarray(points), np.ascontiguousarray(segments)


def coarse(points, segments, limit):
    """The graph on a lattice so small, without what crosses there; points that no segment ends at may be left."""
    small = lattice(points * min(1, limit / np.abs(points.astype(np.float64)).max(initial=1)))
    places, number = np.unique(small, axis=0, return_inverse=True)
    return places, joined(places, number.reshape(-1)[segments])


def symmetries(points):
    """The points under the 8 symmetries of the square."""
    for turned in (points, points[:, ::-1]):
        for signs in ((1, 1), (-1, 1), (1, -1), (-1, -1)):
            yield np.ascontiguousarray(turned * np.array(signs, np.int32))


def renumbered(points, segments, rng):
    """The same graph with other numbers and turned segments; and the new number of each site."""
    order, segment_order = rng.permutation(len(points)), rng.permutation(len(segments))
    number = np.concatenate([np.argsort(order), len(points) + np.argsort(segment_order)])
    new = number[: len(points)][segments[segment_order]]
    new = np.where(rng.random((len(new), 1)) < 0.5, new, new[:, ::-1])
    return np.ascontiguousarray(points[order]), np.ascontiguousarray(new, dtype=np.int32), number
