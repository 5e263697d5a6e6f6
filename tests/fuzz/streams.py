"""Every command with files, pipes and descriptors on both sides: `--runs 1000 --seed 1`.

Each of the cases (a command, a result and a format) is run with each way to give the input and each way to leave the
output, in an order that the seed chooses: the bytes are those that go from a file to a file, the exit codes are those
of the contract, nothing else is said or left behind, and nothing hangs. As many runs as there are do all of them once.
"""

import itertools
import tempfile
from pathlib import Path

import numpy as np

from fuzz.runner import Cases, options
from support.families.stream_cases import CASES, INPUTS, OUTPUTS, Expected, fault
from vorotool.numeric.parallel import in_order

COMBINATIONS = list(itertools.product(CASES, INPUTS, OUTPUTS))


def main() -> int:
    """Run them; exit 1 if one is wrong."""
    arguments = options(1000, "run").parse_args()
    arguments.count = min(arguments.count, len(COMBINATIONS) - arguments.first)
    cases = Cases(arguments, "run")
    order = np.random.default_rng(arguments.seed).permutation(len(COMBINATIONS))
    with tempfile.TemporaryDirectory() as name:
        expected = Expected(Path(name))

        def judged(number: int) -> tuple[int, str | None]:
            with tempfile.TemporaryDirectory() as folder:
                return number, fault(expected, *COMBINATIONS[order[number]], Path(folder))

        for number, wrong in in_order(judged, cases, 0):
            case, given, left = COMBINATIONS[order[number]]
            cases.judge(number, case.command, wrong, f"{case.line} -f {case.fmt}, from {given} to {left}")
            cases.counts.update((f"from {given}", f"to {left}"))
    return cases.end(f"runs of {len(CASES)} cases")
