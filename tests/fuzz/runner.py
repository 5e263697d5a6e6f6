"""What the comparisons of many random cases share: their options, the loop over the cases, and what is printed."""

import argparse
import time
import warnings
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

Verdict = tuple[str, str | None, str]
"""The family of a case, what is wrong with it, if anything, and how large it is, in words."""


def options(count: int, unit: str = "case") -> argparse.ArgumentParser:
    """Say which cases are run: so many unless told otherwise, and `--first` and `--seconds` do the work in pieces."""
    parser = argparse.ArgumentParser()
    parser.add_argument(f"--{unit}s", dest="count", type=int, default=count)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seconds", type=float, default=np.inf, help=f"begin no {unit} after so many")
    parser.add_argument("--seed", type=int, default=1)
    return parser


class Cases:
    """Numbered cases; how many were run, of which families, what else was counted, and how many of them failed."""

    def __init__(self, arguments: argparse.Namespace, unit: str = "case") -> None:
        self.arguments, self.unit, self.start = arguments, unit, time.monotonic()
        self.count = self.failed = 0
        self.families: Counter[str] = Counter()
        self.counts: Counter[str] = Counter()

    def __iter__(self) -> Iterator[int]:
        first, end = self.arguments.first, time.monotonic() + self.arguments.seconds
        for case in range(first, first + self.arguments.count):
            if time.monotonic() >= end or self.counts[f"{self.unit}s"] >= self.arguments.count:
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

    def end(self, what: str) -> int:
        """Print how many of what were run and failed; the exit code, which is 1 too where none was run."""
        for name, count in self.families.items():
            print(f"{name:24} {count:10,}")
        first, seconds = self.arguments.first, time.monotonic() - self.start
        counts = [f"{name}: {count:,}" for name, count in sorted(self.counts.items())]
        numbers = f"{self.unit}s {first} to {first + self.count - 1}"
        print(", ".join([f"{numbers}: {self.count:,} {what}", f"{self.failed} failures", *counts, f"{seconds:.0f} s"]))
        return int(self.failed > 0 or self.count == 0)


@dataclass(frozen=True)
class Comparison:
    """One of results with brute force, with other libraries, or with each other.

    `check(case, cases)` judges a case that is made of its number and the seed alone. `count` cases are run unless told
    otherwise, or as many as compare so many pixels, if that is what the check counts.
    """

    count: int
    check: Callable[[int, Cases], Verdict]
    unit: str = "case"
    add_options: Callable[[argparse.ArgumentParser], object] = id

    def cases(self, arguments: Sequence[str] | None = None) -> Cases:
        """The cases that the arguments name."""
        parser = options(self.count, self.unit)
        self.add_options(parser)
        return Cases(parser.parse_args(arguments), self.unit)

    def run(self) -> int:
        """Judge all cases; the exit code."""
        cases = self.cases()
        warnings.simplefilter("ignore")
        for case in cases:
            cases.judge(case, *self.check(case, cases))
        return cases.end("cases")


def of_families(
    count: int,
    families: Sequence[Callable[[np.random.Generator], Any]],
    failure: Callable[[Any, np.random.Generator], str | None],
) -> Comparison:
    """Compare what families draw in turn."""

    def check(case: int, cases: Cases) -> Verdict:
        family, random = families[case % len(families)], cases.random(case)
        return family.__name__, failure(family(random), random), ""

    return Comparison(count, check)


def of_measured(
    unit: str, measure: Callable[[np.random.Generator, int], tuple[str, int, int]], side: Callable[[int], int]
) -> Comparison:
    """Compare configurations, each of a largest side, until enough pixels or voxels were compared."""

    def check(case: int, cases: Cases) -> Verdict:
        name, count, bad = measure(cases.random(case), side(case))
        cases.counts[f"{unit}s"] += count
        return name, f"{bad} {unit}s" if bad else None, f"{count} {unit}s"

    return Comparison(10**8, check, unit)
