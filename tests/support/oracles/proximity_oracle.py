"""Proximity graphs by their definitions, in exact numbers: no triangulation, no code of the package."""

from itertools import combinations

from support.oracles.whole_numbers import in_units


def squares_of(points):
    """Squared distances of all pairs, in the square of a common unit of these points."""
    places, _ = in_units(points)
    return {
        frozenset((a, b)): (places[a][0] - places[b][0]) ** 2 + (places[a][1] - places[b][1]) ** 2
        for a, b in combinations(range(len(places)), 2)
    }


def gabriel_edges(points):
    """Pairs without another point in the closed disc over them."""
    return _joined(points, lambda square, to_ends: sum(to_ends) > square)


def relative_edges(points):
    """Pairs without another point that is nearer to both ends."""
    return _joined(points, lambda square, to_ends: max(to_ends) >= square)


def _joined(points, is_outside):
    square, numbers = squares_of(points), range(len(points))
    found = set()
    for pair in square:
        others = ([square[frozenset((p, end))] for end in pair] for p in numbers if p not in pair)
        if all(is_outside(square[pair], to_ends) for to_ends in others):
            found.add(pair)
    return found


def tree_lengths(points):
    """Squared lengths of a minimum spanning tree of the complete graph (Prim), sorted: all of them have the same."""
    square = squares_of(points)
    reached, found = {0} if points else set(), []
    while len(reached) < len(points):
        least, new = min(
            (square[frozenset((a, b))], b) for a in reached for b in range(len(points)) if b not in reached
        )
        found.append(least)
        reached.add(new)
    return sorted(found)
