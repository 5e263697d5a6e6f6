"""Folders of masks, killed at random moments and resumed: `--masks 1000 --kills 20 --seed 1`."""

from __future__ import annotations

import argparse
import json
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))
from support.families.mask_folders import write_masks

COMMANDS = ("tessellate", "skeleton-exact")
BROKEN = 7
"""Number of the input that is broken."""


def start(command: str, folder: Path, out: str, *options: str) -> subprocess.Popen[bytes]:
    """Begin a batch."""
    arguments = [command, "inputs", "--out-dir", out, "--table", f"{out}.csv", "-j", "2", "--keep-going", "-q"]
    return subprocess.Popen(
        [sys.executable, "-m", "vorotool", *arguments, *options], cwd=folder, stderr=subprocess.DEVNULL
    )


def contents(folder: Path, out: str) -> dict[str, bytes]:
    """Outputs, and the table."""
    found = {
        path.name: path.read_bytes() for path in (folder / out).iterdir() if path.suffix != ".jsonl" and path.is_file()
    }
    return found | {"table": (folder / f"{out}.csv").read_bytes()}


def trial(command: str, folder: Path, kills: int, chance: random.Random, count: int) -> list[str]:
    """What is wrong after kills: each batch is killed and resumed until it ends by itself, then another begins."""
    begin = time.monotonic()
    code = start(command, folder, "whole").wait()
    whole, length = contents(folder, "whole"), time.monotonic() - begin
    wrong = [f"exit code {code}"] * (code != 6) + [f"{len(whole)} files"] * (len(whole) != count)  # and the table
    deaths: Counter[str] = Counter()
    batches = lines = 0
    while deaths.total() < kills:
        out = f"out-{batches}"
        while (code := interrupted(command, folder, out, chance.uniform(0, length), chance, deaths)) is None:
            pass
        found, written = faults(command, folder, out, whole)
        wrong += [f"exit code {code} at the end"] * (code != 6) + found
        batches, lines = batches + 1, lines + written
    print(f"{command}: {dict(deaths)} in {batches} batches of {count} inputs, {lines} lines, {len(wrong)} faults")
    return wrong


def interrupted(
    command: str, folder: Path, out: str, seconds: float, chance: random.Random, deaths: Counter[str]
) -> int | None:
    """Resume, and kill after some seconds; the exit code of a batch that has ended by then."""
    child = start(command, folder, out, "--resume")
    try:
        return child.wait(seconds)
    except subprocess.TimeoutExpired:
        sent = chance.choice([signal.SIGKILL, signal.SIGINT, signal.SIGTERM])
        child.send_signal(sent)
        code = child.wait()
    if code in (0, 6):  # it ended before the signal came
        return code
    deaths[sent.name] += 1
    return None


def faults(command: str, folder: Path, out: str, whole: dict[str, bytes]) -> tuple[list[str], int]:
    """What is wrong with a batch that has ended, and how many lines its manifest has."""
    lines = (folder / f"{out}/{command}.manifest.jsonl").read_bytes().splitlines()
    done = Counter(record["input"] for record in map(read, lines) if record.get("status") == "done")
    again = sum(number - 1 for number in done.values())
    wrong = [f"{out}: other bytes"] * (contents(folder, out) != whole)
    wrong += [f"{out}: {again} inputs were done twice"] * (again > 0)
    wrong += [f"{out}: {len(done)} inputs were done"] * (len(done) != len(whole) - 1)  # the table is no input's
    wrong += [f"{out}: {path.name} was left" for path in (folder / out).rglob(".vorotool-*")]
    return wrong, len(lines)


def read(line: bytes) -> dict[str, object]:
    """A line of the manifest; a torn one is empty."""
    try:
        record: dict[str, object] = json.loads(line)
    except ValueError:
        return {}
    return record


def main() -> int:
    """Run both commands; exit 1 if anything is wrong."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--masks", type=int, default=1000)
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    chance, failed = random.Random(arguments.seed), 0
    for command in COMMANDS:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            write_masks(folder / "inputs", arguments.masks)
            sorted((folder / "inputs").iterdir())[BROKEN].write_text("broken")
            wrong = trial(command, folder, arguments.kills, chance, arguments.masks)
        for each in wrong:
            print(f"wrong: {command}: {each}")
        failed += len(wrong)
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
