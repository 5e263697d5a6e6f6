"""The rule of section 2.1 pixel by pixel, and the regions of a label image. It shares no code with the package."""

from itertools import combinations

from support.oracles.delaunay_oracle import circle, cross


def neighbor_pixels(x, y, width, height):
    """4-neighbors in the image."""
    around = ((x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1))
    return [(i, j) for i, j in around if 0 <= i < width and 0 <= j < height]


def paper_rule(labels):
    """Edges and triangles as sorted tuples of labels, from the definitions of section 2.1."""
    height, width = labels.shape
    edges, triangles = set(), set()
    for y in range(height):
        for x in range(width):
            i = int(labels[y, x])
            around = neighbor_pixels(x, y, width, height)
            edges |= {tuple(sorted((i, int(labels[q, p])))) for p, q in around if labels[q, p] != i}
            for one, other in combinations(around, 2):
                if max(abs(one[0] - other[0]), abs(one[1] - other[1])) > 1:
                    continue  # no 8-neighbors of each other
                three = {i, int(labels[one[1], one[0]]), int(labels[other[1], other[0]])}
                if len(three) == 3:
                    triangles.add(tuple(sorted(three)))
    return {e for e in edges if 0 not in e}, {t for t in triangles if 0 not in t}


def parts(labels, label):
    """Number of 4-connected parts of a region."""
    height, width = labels.shape
    left = {(x, y) for y in range(height) for x in range(width) if labels[y, x] == label}
    count = 0
    while left:
        count += 1
        stack = [left.pop()]
        while stack:
            for pixel in neighbor_pixels(*stack.pop(), width, height):
                if pixel in left:
                    left.remove(pixel)
                    stack.append(pixel)
    return count


def edge_is_delaunay(sites, a, b):
    """Whether some, and whether every Delaunay triangulation has the edge, by circles through its ends.

    The circles through both ends are one family: the others keep the center in an interval of the bisector. It is not
    empty for the first, and has an inside for the second.
    """
    (ax, ay), (bx, by) = sites[a], sites[b]
    low, high = None, None  # of the parameter t of the center (a + b) / 2 + t (ay - by, bx - ax)
    for k, (x, y) in enumerate(sites):
        if k in (a, b):
            continue
        side = cross(sites[a], sites[b], (x, y))
        if side == 0:
            dot = (x - ax) * (bx - ax) + (y - ay) * (by - ay)
            if 0 < dot < (bx - ax) ** 2 + (by - ay) ** 2:
                return False, False
            continue
        (cx, cy), _ = circle(sites[a], sites[b], (x, y))
        nx, ny = ay - by, bx - ax
        t = ((cx - (ax + bx) / 2) * nx + (cy - (ay + by) / 2) * ny) / (nx * nx + ny * ny)
        if side > 0:  # the circle grows towards this site with t
            high = t if high is None else min(high, t)
        else:
            low = t if low is None else max(low, t)
    open_ended = low is None or high is None
    return open_ended or low <= high, open_ended or low < high
