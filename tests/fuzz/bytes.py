"""Damaged files for every reader: `--minutes 30 --cases 1000000 --seed 1 --workers 2`.

Each case takes a small valid file, changes it in ways that keep most of its structure, and reads it, or gives it to a
command. It must be read, or refused with a message, in little time and memory. A case is made of its number and the
seed alone: `--first N --cases 1` runs it again, and prints what it does.
"""

from __future__ import annotations

import argparse
import ctypes
import json
import mmap
import os
import random
import resource
import shutil
import signal
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from fuzz.byte_mutations import mutated
from fuzz.byte_oracle import LIMIT, READ, REFUSED, WRONG, batch_of_two, judge, write_bundle
from fuzz.byte_seeds import Bundle, seeds

SECONDS = 20.0
"""A case that takes longer hangs; of a busy machine, and of whole batches, more is borne with."""

MEMORY = 2**30
"""Bytes beyond those of a worker that has read one file of each kind."""

RARE = {"manifest": 0.001}
"""How often a kind is chosen that takes long, beside others: a manifest takes a batch."""

OUTCOMES = (READ, REFUSED, LIMIT, WRONG)
_IDLE = -1


class Progress(ctypes.Structure):
    """What a worker says of itself in memory that it shares with the first process."""

    _fields_ = (("case", ctypes.c_int64), ("begun", ctypes.c_double), ("counts", ctypes.c_int64 * (4 * 64)))


class Fuzzer:
    """The cases of one seed."""

    def __init__(self, arguments: argparse.Namespace) -> None:
        self.arguments = arguments
        self.bundles = [*seeds(), *_manifests()]
        kinds = sorted({bundle.kind for bundle in self.bundles})
        if arguments.kinds:
            kinds = [kind for kind in kinds if kind in arguments.kinds.split(",")]
        self.by_kind: dict[str, list[Bundle]] = {
            kind: [bundle for bundle in self.bundles if bundle.kind == kind] for kind in kinds
        }
        self.kinds = kinds

    def bundle(self, case: int) -> tuple[Bundle, random.Random]:
        """The input of a case, and what decides the rest of it."""
        chance = random.Random(f"{self.arguments.seed}-{case}")
        kind = chance.choices(self.kinds, [RARE.get(kind, 1) for kind in self.kinds])[0]
        others = self.by_kind[kind]
        return mutated(chance.choice(others), others, chance), chance

    def work(self, cases: Iterator[int], progress: Progress, folder: Path, failures: Path) -> None:
        """Run cases one after the other in this process."""
        folder.mkdir(exist_ok=True)
        for kind in self.kinds:
            judge(self.by_kind[kind][0], folder, random.Random(0), 0)
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)  # libtiff complains there
        limit = _virtual_memory() + MEMORY
        resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
        for case in cases:
            progress.begun, progress.case = time.monotonic(), case
            bundle, chance = self.bundle(case)
            outcome, wrong = judge(bundle, folder, chance, self.arguments.commands)
            progress.counts[4 * self.kinds.index(bundle.kind) + OUTCOMES.index(outcome)] += 1
            if wrong:
                with failures.open("a") as out:
                    out.write(json.dumps({"case": case, "kind": bundle.kind, "wrong": wrong}) + "\n")
        progress.case = _IDLE

    def run(self) -> int:
        """Share the cases out, watch, and say what came of them; exit 1 if anything was wrong or nothing was read."""
        given = self.arguments
        begin, end = time.monotonic(), time.monotonic() + 60 * given.minutes
        root = Path(tempfile.mkdtemp(dir="/dev/shm" if Path("/dev/shm").is_dir() else None))
        watched = [Worker(self, number, root) for number in range(given.workers)]
        try:
            while any(worker.is_running() for worker in watched) and time.monotonic() < end:
                for worker in watched:
                    worker.watch()
                time.sleep(0.02)
        finally:
            for worker in watched:
                worker.stop()
        failures = [failure for worker in watched for failure in worker.found()]
        total = self._tell(watched, failures, time.monotonic() - begin)
        shutil.rmtree(root)
        return int(bool(failures) or total == 0)

    def _tell(self, watched: list[Worker], failures: list[dict[str, object]], seconds: float) -> int:
        counts = [sum(worker.progress.counts[i] for worker in watched) for i in range(4 * len(self.kinds))]
        print(f"{'':10}" + "".join(f"{name:>10}" for name in OUTCOMES))
        for place, kind in enumerate(self.kinds):
            print(f"{kind:10}" + "".join(f"{number:10,}" for number in counts[4 * place : 4 * place + 4]))
        for failure in failures[:20]:
            print(f"wrong: seed {self.arguments.seed}, case {failure['case']}, {failure['kind']}:")
            print(failure["wrong"])
        total = sum(counts)
        print(
            f"{total:,} inputs, {len(failures)} failures, {seconds:.0f} s, {total / max(seconds, 0.01):,.0f} a second"
        )
        return total


class Worker:
    """A process that runs every n-th case; after a crash or a hang another goes on behind it."""

    def __init__(self, fuzzer: Fuzzer, number: int, root: Path) -> None:
        self.fuzzer, self.number, self.root = fuzzer, number, root
        self.progress = Progress.from_buffer(mmap.mmap(-1, ctypes.sizeof(Progress)))
        self.next, self.ends = fuzzer.arguments.first + number, []
        self.pid = 0
        self._start()

    def _start(self) -> None:
        given = self.fuzzer.arguments
        cases = iter(range(self.next, given.first + given.cases, given.workers))
        self.progress.case, self.progress.begun = self.next, time.monotonic() + 60  # to get warm
        self.pid = os.fork()
        if self.pid == 0:
            code = 1
            try:
                self.fuzzer.work(cases, self.progress, self.root / str(self.number), self._failures())
                code = 0
            finally:
                os._exit(code)

    def _failures(self) -> Path:
        return self.root / f"{self.number}.jsonl"

    def is_running(self) -> bool:
        """Whether there is a process."""
        return self.pid != 0

    def watch(self) -> None:
        """See whether the process has ended or hangs."""
        if not self.pid:
            return
        case = self.progress.case
        if case != _IDLE and time.monotonic() - self.progress.begun > SECONDS:
            is_batch = self.fuzzer.bundle(case)[0].kind == "manifest"
            if not is_batch or time.monotonic() - self.progress.begun > 6 * SECONDS:
                self._kill()
                self._went_wrong(case, "it hangs")
            return
        pid, status = os.waitpid(self.pid, os.WNOHANG)
        if not pid:
            return
        self.pid = 0
        if status:
            self._went_wrong(self.progress.case, f"the process ended: {os.waitstatus_to_exitcode(status)}")

    def _went_wrong(self, case: int, how: str) -> None:
        kind = self.fuzzer.bundle(case)[0].kind
        self.ends.append({"case": case, "kind": kind, "wrong": how})
        self.next = case + self.fuzzer.arguments.workers
        self._start()

    def _kill(self) -> None:
        os.kill(self.pid, signal.SIGKILL)
        os.waitpid(self.pid, 0)
        self.pid = 0

    def stop(self) -> None:
        """End the process."""
        if self.pid:
            self._kill()

    def found(self) -> list[dict[str, object]]:
        """All that went wrong."""
        lines = self._failures().read_text().splitlines() if self._failures().exists() else []
        return [*map(json.loads, lines), *self.ends]


def _manifests() -> list[Bundle]:
    """The manifest of a batch of two inputs."""
    with tempfile.TemporaryDirectory() as name:
        manifest = batch_of_two(Path(name))
        return [Bundle("manifest", manifest.name, {manifest.name: manifest.read_bytes()})]


def _virtual_memory() -> int:
    return int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()


def _replayed(fuzzer: Fuzzer, folder: Path) -> None:
    """Print what the first case does, and keep its files."""
    bundle, chance = fuzzer.bundle(fuzzer.arguments.first)
    for name, data in bundle.files.items():
        print(f"{name}: {len(data)} bytes: {data[:300]!r}")
    write_bundle(bundle, folder)
    with tempfile.TemporaryDirectory() as place:
        print(*judge(bundle, Path(place), chance, fuzzer.arguments.commands), sep="\n")


def main() -> int:
    """Run the cases that the command line names; the exit code."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--cases", type=int, default=10**12)
    parser.add_argument("--minutes", type=float, default=1.0)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--commands", type=float, default=0.01, help="share of the cases that are whole commands")
    parser.add_argument("--kinds", default="", help="only these, by commas")
    parser.add_argument("--keep", type=Path, help="run one case here, and write its files to this folder")
    fuzzer = Fuzzer(parser.parse_args())
    if fuzzer.arguments.keep is not None:
        _replayed(fuzzer, fuzzer.arguments.keep)
        return 0
    return fuzzer.run()
