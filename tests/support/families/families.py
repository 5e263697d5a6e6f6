"""Families of seeds that tests, fuzzing and benchmarks share: easy, tied and degenerate ones."""

import numpy as np

from vorotool.engines.tessellation.seeding import finest_scale
from vorotool.types.pixels import Frame, PixelSides


def uniform(rng, width, height, n, scale):
    return rng.integers(0, width * scale, n), rng.integers(0, height * scale, n)


def outside(rng, width, height, n, scale):
    """Some in the frame, some around it."""
    return (
        rng.integers(-width * scale, 2 * width * scale, n),
        rng.integers(-height * scale, 2 * height * scale, n),
    )


def clustered(rng, width, height, n, scale):
    centers = rng.random((3, 2)) * (width * scale, height * scale)
    xy = centers[rng.integers(0, 3, n)] + rng.normal(0, 2 * scale, (n, 2))
    return np.rint(xy[:, 0]).astype(np.int64), np.rint(xy[:, 1]).astype(np.int64)


def lattice(rng, width, height, n, scale):
    """A coarse lattice: many pixels at equal distance from two or four seeds, and duplicates."""
    step = int(rng.integers(1, 9)) * scale
    return rng.integers(0, max(1, width * scale // step), n) * step, rng.integers(
        0, max(1, height * scale // step), n
    ) * step


def cocircular(rng, width, height, n, scale):
    """Integer points on a circle about a pixel, which is then equally far from all of them."""
    radius = (5, 13, 25, 65)[rng.integers(0, 4)]
    on_circle = [(a, b) for a in range(-radius, radius + 1) for b in range(-radius, radius + 1)]
    on_circle = np.array([p for p in on_circle if p[0] ** 2 + p[1] ** 2 == radius**2])
    chosen = on_circle[rng.integers(0, len(on_circle), n)]
    return (width // 2 + chosen[:, 0]) * scale, (height // 2 + chosen[:, 1]) * scale


def collinear(rng, width, height, n, scale):
    t = rng.integers(0, max(width, height) * scale, n)
    slope = rng.integers(0, 4)
    zero = np.zeros(n, dtype=np.int64)
    return [(t, zero), (zero, t), (t, t), (t, width * scale - t)][slope]


def one_row_apart(rng, width, height, n, scale):
    """Long thin cells, where a seed is hidden late."""
    return rng.integers(0, width * scale, n), rng.integers(0, 2, n) * scale + height * scale // 2


def far_ring(rng, width, height, n, scale):
    """Nearly cocircular seeds far from the frame: products beyond 2^53, differences of a few units."""
    radius = 10 ** int(rng.integers(5, 8)) * scale
    angle = rng.random(n) * 2 * np.pi
    return (
        np.rint(np.cos(angle) * radius).astype(np.int64) + width * scale // 2,
        np.rint(np.sin(angle) * radius).astype(np.int64) + height * scale // 2,
    )


def dense(rng, width, height, n, scale):
    """A seed on every pixel but a few."""
    keep = rng.random(width * height) < 0.97
    keep[rng.integers(0, width * height)] = True
    y, x = np.divmod(np.flatnonzero(keep), width)
    return x * scale, y * scale


FAMILIES = {
    f.__name__: f for f in (uniform, outside, clustered, lattice, cocircular, collinear, one_row_apart, far_ring, dense)
}
SCALES = (1, 1, 1, 2, 16, 256)


def random_case(rng, largest_side=80):
    """One configuration: seeds with labels, a scale, and a window."""
    name = str(rng.choice(list(FAMILIES)))
    side = min(largest_side, 40) if name == "dense" else largest_side  # brute force sees as many seeds as pixels
    width, height = (int(v) for v in rng.integers(1, side + 1, 2))
    scale = int(rng.choice(SCALES))
    n = int(rng.integers(1, rng.choice([2, 6, 40, 400])))
    x, y = (np.asarray(v, dtype=np.int64) for v in FAMILIES[name](rng, width, height, n, scale))
    labels = rng.permutation(len(x)) + 1
    if rng.random() < 0.25:  # several seeds share a label, as the pixels of a component do
        labels = rng.integers(1, 1 + max(1, len(x) // 3), len(x))
    fx, fy = (int(v) for v in rng.integers(-9, 10, 2)) if rng.random() < 0.3 else (0, 0)
    return name, x, y, labels.astype(np.uint32), scale, (fx, fy, width, height)


def mirrored(rng, x, y, frame, scale):
    """Seeds and some of their images in a pixel, which is then at the same distance from both."""
    pixel = [
        int(rng.integers(first, first + side)) * scale for first, side in ((frame[0], frame[2]), (frame[1], frame[3]))
    ]
    chosen = rng.integers(0, len(x), max(1, len(x) // 3))
    way = rng.integers(0, 3, len(chosen))  # turned, or mirrored along one axis
    image_x = np.where(way == 1, x[chosen], 2 * pixel[0] - x[chosen])
    image_y = np.where(way == 2, y[chosen], 2 * pixel[1] - y[chosen])
    return np.append(x, image_x), np.append(y, image_y)


def fine_case(rng, largest_side=40):
    """A configuration on the finest lattice of its frame: any doubles, near ties a step apart, and ties."""
    name, x, y, _, scale, frame = random_case(rng, largest_side)
    sides = PixelSides([(1, 1), (1, 1), (3, 2), (13, 40)][rng.integers(4)])
    finest = finest_scale(np.stack([x, y], axis=1) / scale, Frame(*frame), sides) // 4  # images reach farther outside
    if finest > scale:
        x, y, scale = x * (finest // scale), y * (finest // scale), finest
    reach = int((scale // 4, scale, 2, 1)[rng.integers(4)])
    x, y = (k + rng.integers(-reach, reach + 1, len(k)) * (rng.random(len(k)) < 0.7) for k in (x, y))
    if rng.random() < 0.5:
        x, y = mirrored(rng, x, y, frame, scale)
    labels = (rng.permutation(len(x)) + 1).astype(np.uint32)
    return f"fine {name}", x, y, labels, scale, frame, sides


def distinct_pixels(seed, side, count):
    """Give different pixels of a square image."""
    chosen = np.random.default_rng(seed).choice(side * side, count, replace=False)
    return np.stack(np.divmod(chosen, side)[::-1], axis=1)
