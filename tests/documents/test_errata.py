"""The counterexamples of docs/errata.md to section 2.1 are the smallest; the search that finds them is exhaustive."""

from __future__ import annotations

import numpy as np
import pytest

import errata_search as errata
import vorotool

SMALLEST = {
    "lacks_an_edge": (3, 2, ((0, 0), (1, 0), (2, 1))),
    "has_a_false_edge": (3, 3, ((0, 0), (2, 1), (1, 0), (0, 2))),
    "has_a_false_triangle": (3, 2, ((0, 0), (2, 1), (1, 0), (0, 1))),
    "is_in_pieces": (3, 1, ((0, 0), (2, 0), (1, 0))),
    "is_in_pieces_of_seeds_not_collinear": (4, 2, ((0, 0), (3, 1), (1, 0))),
    "has_a_block": (3, 2, ((0, 0), (1, 0), (2, 0))),
    "has_a_superfluous_pixel": (2, 2, ((1, 0), (0, 0), (0, 1))),
}
"""Among all seeds in all images of up to 9 pixels: width, height, seeds."""

SQUARE = SMALLEST | {
    "lacks_an_edge": (3, 3, ((1, 1), (0, 0), (2, 0))),
    "has_a_false_triangle": (3, 3, ((0, 0), (2, 2), (1, 1))),
    "is_in_pieces": (3, 3, ((0, 0), (2, 0), (1, 0))),
    "is_in_pieces_of_seeds_not_collinear": (4, 4, ((0, 0), (3, 2), (1, 1))),
    "has_a_block": (3, 3, ((0, 0), (1, 0), (2, 0))),
}


def test_the_smallest_counterexamples():
    assert errata.search(errata.CLAIMS, 9, 9) == SMALLEST


def test_the_smallest_in_squares():
    """With a few seeds; the command that docs/errata.md names takes any number."""
    assert errata.search(errata.CLAIMS, 16, 3, square=True) == {
        name: case for name, case in SQUARE.items() if len(case[2]) == 3
    }
    assert errata.search([errata.has_a_false_edge], 9, 4, square=True) == {
        "has_a_false_edge": SQUARE["has_a_false_edge"]
    }


@pytest.mark.parametrize("cases", [SMALLEST, SQUARE])
def test_the_engines_agree(cases):
    """The search tessellates by itself: its counterexamples must be ours."""
    for name, (width, height, seeds) in cases.items():
        image = vorotool.tessellate(seeds, shape=(height, width))
        comparison = vorotool.compare_digital(seeds, shape=(height, width))
        counts = {tuple(key.split()[:2]) for key in comparison.counts}
        diagram = vorotool.voronoi_diagram(image)
        if name == "lacks_an_edge":
            assert ("edge", "missing") in counts
        elif name.startswith("has_a_false"):
            assert (name.split("_")[-1], "false") in counts
        elif name.startswith("is_in_pieces"):
            from scipy.ndimage import label

            assert label(diagram, np.ones((3, 3)))[1] > 1
        else:
            block = diagram[:-1, :-1] + diagram[:-1, 1:] + diagram[1:, :-1] + diagram[1:, 1:]
            assert block.max() == (4 if name == "has_a_block" else 3)


def test_links_at_corners_connect_the_diagram():
    """What is right instead: where boundaries meet at a corner of the lattice, the diagram is 8-connected.

    So it has at most as many pieces as the boundary, which is a graph over the corners.
    """
    from scipy.ndimage import label

    for seed in range(60):
        rng = np.random.default_rng(seed)
        width, height, n = (int(v) for v in rng.integers(2, 14, 3))
        seeds = rng.integers(0, (width, height), (n, 2))
        image = vorotool.tessellate(np.unique(seeds, axis=0), shape=(height, width)).labels.astype(int)
        grid = np.zeros((2 * height + 1, 2 * width + 1), dtype=bool)  # corners at even places, sides between them
        down, across = np.nonzero(image[:-1] != image[1:])
        for side in (-1, 0, 1):
            grid[2 * down + 2, 2 * across + 1 + side] = True
        down, across = np.nonzero(image[:, :-1] != image[:, 1:])
        for side in (-1, 0, 1):
            grid[2 * down + 1 + side, 2 * across + 2] = True
        assert label(vorotool.voronoi_diagram(image), np.ones((3, 3)))[1] <= label(grid)[1]
