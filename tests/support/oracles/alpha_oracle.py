"""Alpha shapes from the definition, in rational numbers. It shares no code with the package.

Two points are joined for the radius r if, for all small ε > 0, an open disc of a radius in (r, r + ε) with both on its
circle holds no point. Its center is the middle plus s times the vector N across the pair: the points that the open disc
does not hold bound s from one side each by a rational number, and the radius gives s².
"""

from fractions import Fraction
from functools import lru_cache
from itertools import combinations
from math import isqrt


def rounded_root(square):
    """The double nearest to the square root of a fraction, ties to even."""
    if square == 0:
        return 0.0
    shift = 140 - (square.numerator.bit_length() - square.denominator.bit_length()) // 2
    scaled = square * Fraction(4) ** shift
    whole = isqrt(scaled.numerator // scaled.denominator)
    root = (
        Fraction(whole) if whole * whole == scaled else Fraction(2 * whole + 1, 2)
    )  # anything in between rounds alike
    try:
        return float(root / Fraction(2) ** shift)
    except OverflowError:
        return float("inf")


def exceeds_root(value, square, *, or_equal):
    """Whether a rational number is greater than the root of another one."""
    if value < 0:
        return False
    return value * value > square or (or_equal and value * value == square)


def bounds(a, b, places):
    """The least and greatest s of empty open discs through a and b (None: no bound), or nothing if there is none."""
    middle = (a[0] + b[0]) / 2, (a[1] + b[1]) / 2
    across = a[1] - b[1], b[0] - a[0]
    quarter = (across[0] ** 2 + across[1] ** 2) / 4
    low = high = None
    for p in places:
        x, y = p[0] - middle[0], p[1] - middle[1]
        left, slope = x * x + y * y - quarter, 2 * (x * across[0] + y * across[1])  # outside: left >= s slope
        if slope == 0:
            if left < 0:
                return None
        elif slope > 0:
            high = left / slope if high is None else min(high, left / slope)
        else:
            low = left / slope if low is None else max(low, left / slope)
    return low, high


@lru_cache(maxsize=4)
def pairs_with_bounds(places):
    """Pairs of places, the squares of their lengths, and their bounds: the same for all radii."""
    pairs = ((a, b, bounds(a, b, places)) for a, b in combinations(places, 2))
    return [(a, b, (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2, *limits) for a, b, limits in pairs if limits is not None]


def alpha_edges(points, square):
    """Pairs of places that are joined for the radius whose square is given: "singular" or "boundary"."""
    places = tuple(sorted({(Fraction(x), Fraction(y)) for x, y in points}))
    found = {}
    for a, b, length2, low, high in pairs_with_bounds(places):
        if 4 * square < length2:
            continue
        s2 = (square - length2 / 4) / length2
        # s in (σ, σ + ε) with σ² = s2, and -s in it
        above = (high is None or exceeds_root(high, s2, or_equal=False)) and (
            low is None or not exceeds_root(low, s2, or_equal=False)
        )
        below = (low is None or exceeds_root(-low, s2, or_equal=False)) and (
            high is None or not exceeds_root(-high, s2, or_equal=False)
        )
        if above or below:
            found[frozenset((a, b))] = "singular" if above and below else "boundary"
    return found
