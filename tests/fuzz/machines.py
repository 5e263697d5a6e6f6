"""Compare what every product, format and option writes on many machines in one: `make fuzz MACHINES=40 SEED=1`.

First this machine is narrowed part by part (vector instructions of numpy, the linear algebra, the C library and the
core; threads; the seed of hashes), then all parts at random. A setting runs a slice of the commands, or all of them.
"""

from __future__ import annotations

import argparse
import itertools
import random
import sys
import time
from math import inf
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))
from machine_runs import differences, drawn_setting, run, settings, whole

SLICE = 100
"""Commands that a random setting runs."""


def main() -> int:
    """Run all settings; exit 1 if any byte differed."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--settings", dest="count", type=int, default=40, help="random ones, after the systematic ones")
    parser.add_argument("--seconds", type=float, default=inf, help="begin no setting after so many")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="of the random ones")
    arguments = parser.parse_args()
    start = time.monotonic()
    first, *others = settings()
    usual = run(first, "whole")
    bad = {command for command, result in usual.items() if not result.startswith("0 ")}
    for command in sorted(bad):
        print(f"failed: {command}")
    compared, different = 0, 0
    for setting in itertools.takewhile(lambda _: time.monotonic() - start < arguments.seconds, others):
        found = differences(usual, run(setting, "whole"))
        compared, different = compared + len(usual), different + len(found)
        _report(setting.name, found)
    commands = list(whole())
    numbers = range(arguments.first, arguments.first + arguments.count)
    for number in itertools.takewhile(lambda _: time.monotonic() - start < arguments.seconds, numbers):
        rng = random.Random(f"{arguments.seed} {number}")
        setting, begin = drawn_setting(rng), rng.randrange(len(commands) - SLICE)
        part = {command: usual[command] for command in commands[begin : begin + SLICE]}
        found = differences(part, run(setting, "whole", begin, SLICE))
        compared, different = compared + len(part), different + len(found)
        _report(setting.name, found)
    seconds = time.monotonic() - start
    counts = f"{compared:,} outputs compared, {different} different"
    print(f"{len(usual)} commands, {counts}, {len(bad)} failed, {seconds:.0f} s")
    return int(different > 0 or len(bad) > 0)


def _report(name: str, commands: list[str]) -> None:
    for command in commands:
        print(f"different: {name}: {command}", flush=True)


if __name__ == "__main__":
    sys.exit(main())
