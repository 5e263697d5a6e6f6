"""Search all small seed sets for counterexamples to section 2.1 of the paper: `python docs/scripts/errata_search.py`.

Images come in order of their pixels, then of their longer side (width ≥ height: the others are mirror images); within
an image, first the sets of fewest seeds. Every set is tried with every order of its labels, since ties go to the
smallest one. Tessellations are made here by brute force, triangulations from the definition, in rationals.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import combinations, permutations

import numpy as np

from support.oracles.delaunay_oracle import circle, cross
from support.oracles.digital_oracle import edge_is_delaunay


@dataclass(frozen=True)
class Batch:
    """The tessellations of an image by one set of pixels.

    ``orders[t]`` are pixels of the set in the order of their labels, ``labels[t]`` the image, (height, width), from 0.
    """

    sites: tuple[tuple[Fraction, Fraction], ...]
    orders: np.ndarray
    labels: np.ndarray

    @cached_property
    def diagram(self):
        """Pixels with a 4-neighbor of larger label."""
        v = np.pad(self.labels, ((0, 0), (1, 1), (1, 1)), constant_values=-1)
        around = [v[:, :-2, 1:-1], v[:, 2:, 1:-1], v[:, 1:-1, :-2], v[:, 1:-1, 2:]]
        return self.labels < np.max(around, axis=0)

    @cached_property
    def members(self):
        """The same as `labels`, in numbers of the set: what belongs to which pixel, whatever the order."""
        return np.take_along_axis(self.orders, self.labels.reshape(len(self.labels), -1), axis=1).reshape(
            self.labels.shape
        )

    @cached_property
    def neighbors(self):
        """(orders, k, k) whether two regions have 4-neighboring pixels."""
        m, k = self.members, len(self.sites)
        found = np.zeros((len(m), k, k), dtype=bool)
        for a, b in ((m[:, :, 1:], m[:, :, :-1]), (m[:, 1:], m[:, :-1])):
            number = np.arange(len(m))[:, None, None]
            found[number, a, b] = found[number, b, a] = True
        return found & ~np.eye(k, dtype=bool)

    @cached_property
    def triangles(self):
        """(orders, k, k, k) whether a pixel and two of its 4-neighbors have three labels, as the paper says."""
        m, k = self.members, len(self.sites)
        found = np.zeros((len(m), k, k, k), dtype=bool)
        a, b, c, d = m[:, :-1, :-1], m[:, :-1, 1:], m[:, 1:, :-1], m[:, 1:, 1:]
        for three in ((a, b, c), (b, a, d), (c, a, d), (d, b, c)):
            found[np.arange(len(m))[:, None, None], *np.sort(three, axis=0)] = True
        p, q, r = np.indices((k, k, k))
        return found & (p < q) & (q < r)

    @cached_property
    def circles(self):
        """Triples that are not collinear, with the center and whether no site is inside, and none but they on it."""
        found = {}
        for three in combinations(range(len(self.sites)), 3):
            corners = [self.sites[i] for i in three]
            if cross(*corners) == 0:
                continue
            (x, y), square = circle(*corners)
            others = [(p - x) ** 2 + (q - y) ** 2 - square for i, (p, q) in enumerate(self.sites) if i not in three]
            found[three] = ((x, y), all(d >= 0 for d in others), 0 not in others)
        return found

    @cached_property
    def has_no_four_cocircular(self):
        """Whether each circle through three sites goes through no fourth."""
        return all(alone for _, _, alone in self.circles.values())

    @cached_property
    def delaunay_edges(self):
        """Which pairs of sites an edge joins, as a symmetric matrix."""
        linked = np.zeros((len(self.sites),) * 2, dtype=bool)
        for a, b in combinations(range(len(self.sites)), 2):
            linked[a, b] = linked[b, a] = edge_is_delaunay(self.sites, a, b)[0]
        return linked

    @cached_property
    def delaunay_triangles(self):
        """Which triples of sites have an empty circle."""
        found = np.zeros((len(self.sites),) * 3, dtype=bool)
        for three, (_, empty, _) in self.circles.items():
            found[three] = empty
        return found

    @cached_property
    def are_collinear(self):
        """Whether all sites are on one line."""
        return not self.circles


# ---- what the paper says, and which orders of a batch contradict it ---------------------------------------------


def lacks_an_edge(batch):
    """Section 2.1: linking neighbors gives the Delaunay triangulation, if no four seeds are cocircular."""
    if not (batch.delaunay_edges & ~batch.neighbors).any() or not batch.has_no_four_cocircular:
        return np.zeros(len(batch.orders), dtype=bool)
    return (batch.delaunay_edges & ~batch.neighbors).any(axis=(1, 2))


def has_a_false_edge(batch):
    """The same: two neighbors that no Delaunay triangulation links."""
    if not (batch.neighbors & ~batch.delaunay_edges).any() or not batch.has_no_four_cocircular:
        return np.zeros(len(batch.orders), dtype=bool)
    return (batch.neighbors & ~batch.delaunay_edges).any(axis=(1, 2))


def has_a_false_triangle(batch):
    """Section 2.1: a pixel and two of its 4-neighbors show a Delaunay triangle."""
    if not (batch.triangles & ~batch.delaunay_triangles).any() or not batch.has_no_four_cocircular:
        return np.zeros(len(batch.orders), dtype=bool)
    return (batch.triangles & ~batch.delaunay_triangles).any(axis=(1, 2, 3))


def is_in_pieces(batch):
    """Section 2.1: the digital diagram is 8-connected."""
    diagram = batch.diagram
    flat = diagram.reshape(len(diagram), -1)
    reached = np.zeros_like(flat)
    reached[np.arange(len(flat)), flat.argmax(axis=1)] = True
    reached = (reached & flat).reshape(diagram.shape)
    while True:
        padded = np.pad(reached, ((0, 0), (1, 1), (1, 1)))
        height, width = diagram.shape[1:]
        shifts = [padded[:, y : y + height, x : x + width] for y in range(3) for x in range(3)]
        grown = np.logical_or.reduce(shifts) & diagram
        if (grown == reached).all():
            return (diagram & ~reached).any(axis=(1, 2))
        reached = grown


def is_in_pieces_of_seeds_not_collinear(batch):
    """The same, where the continuous diagram is connected: only those of collinear seeds are parallel lines."""
    return is_in_pieces(batch) if not batch.are_collinear else np.zeros(len(batch.orders), dtype=bool)


def has_a_block(batch):
    """Section 2.1: it has unit thickness. Here two by two pixels are all in it."""
    d = batch.diagram
    return (d[:, :-1, :-1] & d[:, :-1, 1:] & d[:, 1:, :-1] & d[:, 1:, 1:]).any(axis=(1, 2))


def has_a_superfluous_pixel(batch):
    """The same: a pixel between two of its 4-neighbors that are 8-neighbors of each other."""
    d = batch.diagram
    block = d[:, :-1, :-1].astype(int) + d[:, :-1, 1:] + d[:, 1:, :-1] + d[:, 1:, 1:]
    return (block >= 3).any(axis=(1, 2))


CLAIMS = (
    lacks_an_edge,
    has_a_false_edge,
    has_a_false_triangle,
    is_in_pieces,
    is_in_pieces_of_seeds_not_collinear,
    has_a_block,
    has_a_superfluous_pixel,
)


# ---- the search -------------------------------------------------------------------------------------------------


def images(pixels: int, *, square: bool = False) -> Iterator[tuple[int, int]]:
    """Width and height of images of up to so many pixels, the smallest first."""
    sizes = [(w, h) for w in range(1, pixels + 1) for h in range(1, w + 1) if w * h <= pixels]
    return iter(sorted((s for s in sizes if not square or s[0] == s[1]), key=lambda s: (s[0] * s[1], s[0])))


def batches(width: int, height: int, seeds: int) -> Iterator[Batch]:
    """All sets of so many pixels of an image."""
    pixels = [(x, y) for y in range(height) for x in range(width)]
    at = np.array(pixels)
    square = ((at[:, None] - at[None]) ** 2).sum(axis=2)
    orders = np.array(list(permutations(range(seeds))))
    for chosen in combinations(range(len(pixels)), seeds):
        distances = square[:, np.array(chosen)][:, orders]  # pixel, order, label
        labels = distances.argmin(axis=2).T.reshape(len(orders), height, width)  # of equal ones the smallest label
        yield Batch(tuple((Fraction(pixels[k][0]), Fraction(pixels[k][1])) for k in chosen), orders, labels)


def search(claims, pixels: int, most_seeds: int, *, square: bool = False):
    """Find the smallest counterexample to each claim: (width, height, seeds in the order of their labels)."""
    found = {}
    for width, height in images(pixels, square=square):
        for seeds in range(2, min(most_seeds, width * height) + 1):
            open_claims = [claim for claim in claims if claim.__name__ not in found]
            if not open_claims:
                return found
            for batch in batches(width, height, seeds):
                for claim in open_claims:
                    if claim.__name__ in found:
                        continue
                    wrong = claim(batch)
                    if wrong.any():
                        order = batch.orders[wrong.argmax()]
                        sites = tuple(tuple(map(int, batch.sites[k])) for k in order)
                        found[claim.__name__] = (width, height, sites)
    return found


def main() -> int:
    """Say the smallest counterexample to each claim."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--pixels", type=int, default=12, help="largest image")
    parser.add_argument("--seeds", type=int, default=4, help="most seeds")
    parser.add_argument("--square", action="store_true", help="square images only")
    arguments = parser.parse_args()
    start = time.monotonic()
    found = search(CLAIMS, arguments.pixels, arguments.seeds, square=arguments.square)
    lines = []
    for claim in CLAIMS:
        lines.append(f"{claim.__name__}: none")
        if claim.__name__ in found:
            width, height, sites = found[claim.__name__]
            lines[-1] = f"{claim.__name__}: {width} x {height}, seeds {' '.join(map(str, sites))}"
    what = "square images" if arguments.square else "images"
    seconds = time.monotonic() - start
    lines.append(f"{what} of up to {arguments.pixels} pixels, up to {arguments.seeds} seeds, {seconds:.0f} s")
    sys.stdout.write("\n".join(lines) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
