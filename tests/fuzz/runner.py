"""What the comparisons of many random cases share: their options, the loop over the cases, and what is printed."""

from __future__ import annotations

import argparse
import time
import warnings
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np


def options(count: int, unit: str = "case") -> argparse.ArgumentParser:
    """Say which cases are run: so many unless told otherwise, and `--first` and `--seconds` do the work in pieces."""
    parser = argparse.ArgumentParser()
    parser.add_argument(f"--{unit}s", dest="count", type=int, default=count)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seconds", type=float, default=np.inf, help=f"begin no {unit} after so many")
    parser.add_argument("--seed", type=int, default=1)
    return parser


class Cases:
    """Numbered cases; how many were run, of which families, and how many of them failed."""

    def __init__(self, arguments: argparse.Namespace, unit: str = "case") -> None:
        self.arguments, self.unit, self.start = arguments, unit, time.monotonic()
        warnings.simplefilter("ignore")
        self.count = self.failed = 0
        self.families: Counter[str] = Counter()

    def __iter__(self) -> Iterator[int]:
        first, end = self.arguments.first, time.monotonic() + self.arguments.seconds
        for case in range(first, first + self.arguments.count):
            if time.monotonic() >= end:
                return
            yield case
            self.count += 1

    def seed(self, *numbers: int) -> list[int]:
        """What makes the random numbers of a case."""
        return [self.arguments.seed, *numbers]

    def random(self, *numbers: int) -> np.random.Generator:
        """Random numbers of a case."""
        return np.random.default_rng(self.seed(*numbers))

    def judge(self, case: int, family: str, wrong: str | None, size: str = "") -> None:
        """Count a case, and print what is wrong with it, if anything."""
        self.families[family] += 1
        if wrong is not None:
            self.failed += 1
            about = ", ".join(filter(None, (f"seed {self.arguments.seed}", f"{self.unit} {case}", family, size)))
            print(f"wrong: {about}: {wrong}", flush=True)

    def print_families(self) -> None:
        """Print how many cases of each family were run."""
        for name, count in self.families.items():
            print(f"{name:18} {count:10,} {self.unit}s")

    def end(self, what: str) -> int:
        """Print how many of what were run and failed; the exit code, which is 1 too where none was run."""
        first, seconds = self.arguments.first, time.monotonic() - self.start
        numbers = f"{self.unit}s {first} to {first + self.count - 1}"
        print(f"{numbers}: {self.count:,} {what}, {self.failed} failures, {seconds:.0f} s")
        return int(self.failed > 0 or self.count == 0)


def run_families(
    families: Sequence[Callable[[np.random.Generator], Any]],
    failure: Callable[[Any, np.random.Generator], str | None],
    count: int,
    what: str = "shapes",
) -> int:
    """Judge shapes that families draw in turn; the exit code."""
    cases = Cases(options(count).parse_args())
    for case in cases:
        family, random = families[case % len(families)], cases.random(case)
        cases.judge(case, family.__name__, failure(family(random), random))
    return cases.end(what)


def compare(
    unit: str, check: Callable[[np.random.Generator, int], tuple[str, int, int]], side: Callable[[int], int]
) -> int:
    """Check configurations, each of a largest side, until enough pixels or voxels were compared; give an exit code."""
    arguments = options(10**8, unit).parse_args()
    cases, wrong = Cases(arguments), 0
    compared: Counter[str] = Counter()
    for case in cases:
        if compared.total() >= arguments.count:
            break
        name, count, bad = check(cases.random(case), side(case))
        compared[name] += count
        wrong += bad
        cases.judge(case, name, f"{bad} {unit}s" if bad else None)
    for name, count in sorted(compared.items()):
        print(f"{name:14} {count:12,} {unit}s")
    return cases.end(f"configurations, {compared.total():,} {unit}s, {wrong} wrong")
