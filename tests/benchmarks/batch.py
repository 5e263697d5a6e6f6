"""Inputs a second through one process an input, one worker and two: ``batch.py [INPUTS]``, by default 1000.

On a machine with other work to do the seconds of processors tell more: they are printed as well.
"""

import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))
from support.families.mask_folders import write_masks

TOOL = Path(sys.executable).parent / "vorotool"
RUNS = 3
ALONE = 20
"""Inputs that are given to a process of their own."""


def seconds(*arguments, **options):
    """Of one process."""
    begin = time.perf_counter()
    subprocess.run([TOOL, *map(str, arguments), "-q"], check=True, **options)
    return time.perf_counter() - begin


def processor_seconds():
    """Of all processes that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def rates(folder, command, inputs):
    """Inputs a second: a loop, one worker, two workers; the best of some rounds, in which they take turns.

    Then milliseconds of processors an input, in the same order: their means.
    """
    best, used = [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]
    files = sorted(inputs.iterdir())
    for number in range(RUNS):
        for way in range(3):
            begin = processor_seconds()
            if way == 0:
                count = ALONE
                taken = sum(seconds(command, path, "--out-dir", folder / "alone") for path in files[:ALONE])
            else:
                count = len(files)
                taken = seconds(command, inputs, "--out-dir", folder / f"{number}-{way}", "-j", way, "--threads", 1)
            best[way] = max(best[way], count / taken)
            used[way] += 1000 * (processor_seconds() - begin) / count / RUNS
    return best, used


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    print(f"{count} masks of 256 x 256: inputs a second")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_masks(folder / "inputs", count)
        for command in ("tessellate", "skeleton-exact"):
            (loop, one, two), used = rates(folder / command, command, folder / "inputs")
            print(
                f"  {command}: a process each {loop:.1f}, -j 1 {one:.0f}, -j 2 {two:.0f}: "
                f"{two / one:.2f} x one worker (at least 1.8), {two / loop:.0f} x the loop (at least 20); "
                f"ms of processors: {used[0]:.0f}, {used[1]:.1f}, {used[2]:.1f}"
            )


if __name__ == "__main__":
    main()
