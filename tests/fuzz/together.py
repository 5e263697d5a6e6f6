"""All comparisons and all harnesses for a time in all: `make fuzz MINUTES=30 SEED=1`.

Each has its share of the time, two of them run side by side, and what each counted is printed as a table. One that has
compared nothing in its share fails.
"""

import argparse
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path

HERE = Path(__file__).parent

MORE = str(10**12)
"""Cases than there is time for."""


@dataclass(frozen=True)
class Share:
    """A script, its further arguments, how many parts of the time it has, and the option that tells it so."""

    script: str
    arguments: tuple[str, ...] = ()
    parts: int = 1
    option: str = "--seconds"

    def limited(self, seconds: float) -> list[str]:
        """Arguments of a run of so many seconds."""
        return [*self.arguments, self.option, f"{seconds / 60 if self.option == '--minutes' else seconds:.3f}"]


def comparisons() -> list[Share]:
    """Results compared with brute force, with other libraries, or with each other."""
    names = [path.stem for path in sorted(HERE.glob("*.py")) if "\nCOMPARISON = " in path.read_text(encoding="utf-8")]
    units = {name: import_module(f"fuzz.{name}").COMPARISON.unit for name in names}
    clusters = ("--family", "clusters", "--largest", "100", "--symmetries", "1")
    return [*(Share(name, (f"--{units[name]}s", MORE)) for name in names), Share("segment_voronoi", clusters)]


HARNESSES = (
    Share("bytes", ("--workers", "1"), 8, "--minutes"),
    Share("faults", ("--kills", MORE, "--places", "0", "--batches", "0", "--pairs", "0"), 6, "--minutes"),
    Share("faults", ("--kills", "0", "--places", MORE, "--batches", MORE, "--pairs", MORE), 4, "--minutes"),
    Share("streams", ("--runs", MORE), parts=4),
    Share("machines", parts=3),
)
"""What is around the engines: damaged files, kills and full disks, pipes and descriptors, other processors."""

SIDE_BY_SIDE = 2


@dataclass(frozen=True)
class Ended:
    """What a script printed, its exit code and seconds."""

    share: Share
    output: str
    code: int
    seconds: float

    @property
    def summary(self) -> str:
        """What it counted: its last line."""
        lines = self.output.strip().splitlines()
        return lines[-1].strip() if lines else "nothing was printed"


def run(share: Share, seconds: float, seed: int) -> Ended:
    """Run a script for its time; one that goes on for ten times as long hangs."""
    start = time.monotonic()
    command = [sys.executable, str(HERE / "run.py"), share.script, *share.limited(seconds), "--seed", str(seed)]
    given = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True, "errors": "replace"}
    try:
        done = subprocess.run(command, timeout=10 * seconds + 120, check=False, **given)
    except subprocess.TimeoutExpired as late:
        printed = late.stdout.decode(errors="replace") if isinstance(late.stdout, bytes) else late.stdout or ""
        return Ended(share, f"{printed}\nit does not end", 1, time.monotonic() - start)
    return Ended(share, done.stdout, done.returncode, time.monotonic() - start)


def main() -> int:
    """Run all; exit 1 if any has found something."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--minutes", type=float, default=30)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", nargs="+")
    arguments = parser.parse_args()
    known = [*HARNESSES, *comparisons()]
    shares = [share for share in known if arguments.only is None or share.script in arguments.only]
    part = 60 * arguments.minutes * SIDE_BY_SIDE / sum(share.parts for share in shares)
    failed = 0
    with ThreadPoolExecutor(SIDE_BY_SIDE) as pool:
        for ended in pool.map(lambda share: run(share, part * share.parts, arguments.seed), shares):
            if ended.code:
                print(ended.output, flush=True)
            word = "FAILED" if ended.code else "passed"
            print(f"{ended.share.script:20} {word} {ended.seconds:6.0f} s  {ended.summary}", flush=True)
            failed += bool(ended.code)
    print(f"{len(shares)} scripts in {arguments.minutes:g} minutes, {failed} of them failed")
    return int(failed > 0)
