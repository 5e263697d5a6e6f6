"""Processes are killed inside their writes, and disks fail: `--kills 1000 --places 300 --batches 20 --seed 1`.

Every writer is ended by SIGKILL, SIGTERM and SIGINT at random steps of its writes (and a random moment after one). Then
an older output is untouched or the new one is whole; after SIGTERM and SIGINT no temporary is left; what a SIGKILL has
left is removed by the next run. Disks that are full or read-only, folders that vanish, and targets that become folders
give exit code 4, and leave the older output and nothing else. Batches lose nothing, whichever process dies. In a time
that is too short for all (`--minutes 1`) each of the four has an equal part of it; one that was reached by none fails.
"""

import argparse
import os
import random
import select
import shutil
import signal
import tempfile
import time
from collections import Counter
from pathlib import Path

from fuzz import faulty
from fuzz.write_events import Steps, announce, install
from fuzz.writers import ENDS, WRITERS, ended, import_modules, leftovers, outputs, run, write_inputs
from support.processes.heard_signals import hear_signals

LONGEST = 0.003
"""Seconds after a step in which a signal comes that is not sent at the step itself."""


class Known:
    """What each writer writes of two inputs, and in how many steps."""

    def __init__(self, scratch, names):
        scratch.mkdir()
        import_modules(scratch / "imports", map(WRITERS.get, names))
        self.contents, self.steps, self.scratch = {}, {}, scratch
        for name in names:
            for number in (1, 2):
                folder = scratch / f"known-{name}-{number}"
                write_inputs(folder, number)
                steps, count = Steps(), folder / "count"

                def finish(steps=steps, count=count):
                    count.write_text(str(steps.count))

                code = ended(run(folder, WRITERS[name], lambda steps=steps: install(steps), finish))
                if code or leftovers(folder):
                    raise RuntimeError(f"{name}: exit code {code}: {(folder / 'messages').read_text()}")
                self.contents[name, number] = outputs(folder)
                self.steps[name] = int(count.read_text())

    def folder(self, name, *, older):
        """A fresh folder with the second inputs, and perhaps the outputs of the first."""
        folder = Path(tempfile.mkdtemp(dir=self.scratch))
        write_inputs(folder, 2)
        if older:
            for path, data in self.contents[name, 1].items():
                (folder / path).parent.mkdir(parents=True, exist_ok=True)
                (folder / path).write_bytes(data)
        return folder

    def judge(self, name, folder, *, older):
        """What is wrong with the outputs: each is the old one or the new one, and stores are not mixed."""
        new, old = self.contents[name, 2], self.contents[name, 1] if older else {}
        found = outputs(folder)
        if any(".zarr/" in path for path in new):
            return [] if found in (old, new) else ["neither the old store nor the new one"]
        wrong = [
            f"{path} is neither old nor new" for path in found if found[path] not in (old.get(path), new.get(path))
        ]
        return wrong + [f"{path} is gone" for path in old if path not in found]


def kill(known, name, chance, counts):
    """End one writer inside a write; what is wrong."""
    older, number = chance.random() < 0.5, chance.choice(list(ENDS))
    folder, wait = known.folder(name, older=older), chance.random() < 0.7
    pipe = folder / "pipe"
    os.mkfifo(pipe)
    steps = Steps(chance.randrange(known.steps[name]), announce(pipe, wait=wait))
    with Pipe(pipe) as announced:
        child = run(folder, WRITERS[name], lambda: install(steps))
        step = announced.read(60)
        if not wait:
            time.sleep(chance.uniform(0, LONGEST))
        os.kill(child, number)
        code = ended(child)
    left = leftovers(folder)
    wrong = known.judge(name, folder, older=older) + ["no step was reached"] * (not step)
    if code == 0 and not wait:
        counts["ended first"] += 1
        wrong += ["exit code 0, but not the new outputs"] * (outputs(folder) != known.contents[name, 2])
    elif code != ENDS[number]:
        wrong.append(f"exit code {code}: {said(folder)[-300:]}")
    counts[number.name] += 1
    counts["kills that left a temporary"] += bool(left) and number == signal.SIGKILL
    wrong += [f"{left} left after {number.name}"] * (bool(left) and number != signal.SIGKILL)
    wrong += [f"{line} said" for line in said(folder).splitlines()]
    wrong += next_run(known, name, folder)
    return [f"{name}, {number.name} at {step}, older {older}: {each}" for each in wrong]


def next_run(known, name, folder):
    """What is wrong after the same command has run once more, undisturbed."""
    code = ended(run(folder, WRITERS[name]))
    wrong = [f"the next run: exit code {code}"] * (code != 0)
    wrong += ["the next run: other outputs"] * (outputs(folder) != known.contents[name, 2])
    wrong += [f"the next run leaves {leftovers(folder)}"] * bool(leftovers(folder))
    if not wrong:
        shutil.rmtree(folder)
    return wrong


def said(folder):
    """What a run has said."""
    path = folder / "messages"
    return path.read_text() if path.exists() else "it has not even begun"


class Pipe:
    """A named pipe in which processes say where they are."""

    def __init__(self, path):
        self._path = path

    def __enter__(self):
        self._descriptor = os.open(self._path, os.O_RDWR | os.O_NONBLOCK)
        return self

    def __exit__(self, *_):
        os.close(self._descriptor)

    def read(self, seconds):
        """A line, or nothing after some seconds."""
        ready, _, _ = select.select([self._descriptor], [], [], seconds)
        return os.read(self._descriptor, 4096).decode().splitlines()[0] if ready else ""


class Stage:
    """One kind of cases, each made of the seed and its number; how many there were, and the seconds they took.

    Parameters
    ----------
    name : str
        Of the kind.
    goal : int
        How many there should be.
    trial : callable
        ``trial(chance)`` runs a case and says what is wrong.
    counted : callable, optional
        How many of the goal there are, if not every case counts.
    """

    def __init__(self, name, goal, trial, counted=None):
        self.name, self.goal, self.trial = name, goal, trial
        self.cases, self.seconds = 0, 0.0
        self.counted = counted or (lambda: self.cases)

    def is_done(self):
        """Whether there are as many as there should be."""
        return self.counted() >= self.goal

    def run(self, seed, first):
        """Run the next case; what is wrong, with what makes the case again."""
        begin, number = time.monotonic(), first + self.cases
        found = self.trial(random.Random(f"{seed} {self.name} {number}"))
        self.cases, self.seconds = self.cases + 1, self.seconds + time.monotonic() - begin
        return [f"seed {seed}, {self.name} {number}: {each}" for each in found]


def stages(arguments, scratch, counts):
    """The four kinds."""
    names = arguments.writers.split(",") if arguments.writers else list(WRITERS)
    known = Known(scratch / "known", names) if arguments.kills or arguments.places else None
    pairs = faulty.Pairs(scratch / "pairs") if arguments.pairs else None

    def killed(chance):
        return kill(known, chance.choice(names), chance, counts)

    def placed(chance):
        return faulty.place_trial(known, chance.choice(names), chance, counts)

    def batched(chance):
        return faulty.trial(Path(tempfile.mkdtemp(dir=scratch)), chance, counts)

    return [
        Stage("kills", arguments.kills, killed, lambda: counts["kills that left a temporary"]),
        Stage("places", arguments.places, placed),
        Stage("batches", arguments.batches, batched),
        Stage("pairs", arguments.pairs, lambda _: pairs.trial(counts)),
    ]


def main():
    """Run all; exit 1 if anything is wrong, or not begun."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--kills", type=int, default=1000, help="that left a temporary")
    parser.add_argument("--places", type=int, default=300)
    parser.add_argument("--batches", type=int, default=20)
    parser.add_argument("--pairs", type=int, default=50, help="of shards that are started together")
    parser.add_argument("--minutes", type=float, default=1e9)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first case of each kind")
    parser.add_argument("--writers", help="separated by commas")
    arguments = parser.parse_args()
    end, counts, wrong = time.monotonic() + 60 * arguments.minutes, Counter(), []

    def tell(found):
        wrong.extend(found)
        for each in found:
            print(f"wrong: {each}", flush=True)

    hear_signals()
    with tempfile.TemporaryDirectory() as scratch:
        wanted = [stage for stage in stages(arguments, Path(scratch), counts) if stage.goal]
        while (left := [stage for stage in wanted if not stage.is_done()]) and time.monotonic() < end:
            tell(min(left, key=lambda stage: stage.seconds).run(arguments.seed, arguments.first))
    tell([f"{stage.name}: none was run" for stage in wanted if not stage.cases])
    counted = [f"{name}: {count}" for name, count in counts.items()]
    print(", ".join([*counted, f"{len(wrong)} failures"]))
    return int(bool(wrong))
