"""Compare what every product, format and option writes on many machines in one: `make fuzz MACHINES=40 SEED=1`.

First this machine is narrowed part by part (vector instructions of numpy, the linear algebra, the C library and the
core; threads; the seed of hashes), and runs all commands; then all parts at random, each with a slice of the commands.
In a time that is too short for that (`--seconds 60`), a few commands at a time, drawn from all, run under a few of the
settings, both kinds.
"""

import argparse
import random
import time
from collections.abc import Iterable
from itertools import count, islice

from support.processes.machine_runs import Setting, differences, drawn_setting, run, settings, whole

SLICE = 100
"""Commands that a random setting runs."""

FEW = 8
"""Commands that are drawn together, and take a second or two."""

SYSTEMATIC, RANDOM = 2, 1
"""Settings of each kind, under which the few run."""


class Comparison:
    """The bytes of this machine as they are needed, and what differs from them on others."""

    def __init__(self) -> None:
        self.usual: dict[str, str] = {}
        self.settings: set[str] = set()
        self.compared = self.different = self.failed = 0

    def compare(self, setting: Setting, commands: list[str]) -> None:
        """Run commands under a setting, and those that are new on this machine as it is."""
        self._run_as_usual([command for command in commands if command not in self.usual])
        found = differences({command: self.usual[command] for command in commands}, run(setting, commands))
        for command in found:
            print(f"different: {setting.name}: {command}", flush=True)
        self.settings.add(setting.name)
        self.compared, self.different = self.compared + len(commands), self.different + len(found)

    def _run_as_usual(self, commands: list[str]) -> None:
        results = run(settings()[0], commands) if commands else {}
        bad = sorted(command for command, result in results.items() if not result.startswith("0 "))
        for command in bad:
            print(f"failed: {command}", flush=True)
        self.usual |= results
        self.failed += len(bad)

    def end(self, seconds: float) -> int:
        """Print what was compared; the exit code."""
        print(
            f"{len(self.usual)} commands, {len(self.settings)} settings, {self.compared:,} outputs compared, "
            f"{self.different} different, {self.failed} failed, {seconds:.0f} s"
        )
        return int(self.different > 0 or self.failed > 0 or self.compared == 0)


def all_in_turn(seed: int, numbers: Iterable[int]) -> Iterable[tuple[Setting, list[str]]]:
    """Give each part of a machine alone with all commands, then random settings with a slice of them."""
    commands = list(whole())
    for setting in settings()[1:]:
        yield setting, commands
    for number in numbers:
        rng = random.Random(f"{seed} {number}")
        setting, begin = drawn_setting(rng), rng.randrange(len(commands) - SLICE)
        yield setting, commands[begin : begin + SLICE]


def few_at_a_time(seed: int, few: int = FEW) -> Iterable[tuple[Setting, list[str]]]:
    """Give a few commands with a few settings, without end; a command comes again when all have come."""
    systematic = settings()[1:]
    for turn in count():
        commands = list(whole())
        random.Random(f"{seed} {turn}").shuffle(commands)
        for first in range(0, len(commands), few):
            rng = random.Random(f"{seed} {turn} {first}")
            drawn = [drawn_setting(rng) for _ in range(RANDOM)]
            for setting in [*drawn, *rng.sample(systematic, SYSTEMATIC)]:
                yield setting, commands[first : first + few]


def main() -> int:
    """Run all settings, or as many as a time allows; exit 1 if any byte differed or nothing was compared."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--settings", dest="count", type=int, default=40, help="random ones, after the systematic ones")
    parser.add_argument("--seconds", type=float, help="a few commands at a time, and none begun after so many")
    parser.add_argument("--few", type=int, default=FEW, help="commands that are drawn together with --seconds")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="of the random ones")
    arguments = parser.parse_args()
    start, comparison = time.monotonic(), Comparison()
    if arguments.seconds is None:
        numbers = range(arguments.first, arguments.first + arguments.count)
        for setting, commands in all_in_turn(arguments.seed, numbers):
            comparison.compare(setting, commands)
    else:
        for setting, commands in islice(few_at_a_time(arguments.seed, arguments.few), arguments.first, None):
            comparison.compare(setting, commands)
            if time.monotonic() - start >= arguments.seconds:
                break
    return comparison.end(time.monotonic() - start)
