"""Processes are killed inside their writes, and disks fail: `--kills 1000 --places 300 --pairs 50 --seed 1`.

Every writer is ended by SIGKILL, SIGTERM and SIGINT at random steps of its writes (and a random moment after one). Then
an older output is untouched or the new one is whole; after SIGTERM and SIGINT no temporary is left; what a SIGKILL has
left is removed by the next run. Disks that are full or read-only, folders that vanish, and targets that become folders
give exit code 4, and leave the older output and nothing else. Batches lose nothing, whichever process dies.
"""

import argparse
import os
import random
import select
import shutil
import signal
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))
from fuzz import faulty_batches, faulty_places
from fuzz.write_events import Steps, announce, install
from fuzz.writers import ENDS, WRITERS, ended, import_modules, leftovers, outputs, run, write_inputs

LONGEST = 0.003
"""Seconds after a step in which a signal comes that is not sent at the step itself."""


class Known:
    """What each writer writes of two inputs, and in how many steps."""

    def __init__(self, scratch, names):
        import_modules(scratch / "imports", names)
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


def main():
    """Run all; exit 1 if anything is wrong."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--kills", type=int, default=1000, help="that left a temporary")
    parser.add_argument("--places", type=int, default=300)
    parser.add_argument("--batches", type=int, default=20)
    parser.add_argument("--pairs", type=int, default=50, help="of shards that are started together")
    parser.add_argument("--minutes", type=float, default=1e9)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--writers", help="separated by commas")
    arguments = parser.parse_args()
    chance, end = random.Random(arguments.seed), time.monotonic() + 60 * arguments.minutes
    names = arguments.writers.split(",") if arguments.writers else list(WRITERS)
    counts, wrong = Counter(), []

    def tell(found):
        wrong.extend(found)
        for each in found:
            print(f"wrong: seed {arguments.seed}: {each}", flush=True)

    with tempfile.TemporaryDirectory() as scratch:
        known = Known(Path(scratch), names)
        while counts["kills that left a temporary"] < arguments.kills and time.monotonic() < end:
            tell(kill(known, chance.choice(names), chance, counts))
        for case in range(arguments.places):
            if time.monotonic() < end:
                tell(faulty_places.trial(known, names[case % len(names)], chance, counts))
        for _ in range(arguments.batches):
            if time.monotonic() < end:
                tell(faulty_batches.trial(Path(tempfile.mkdtemp(dir=scratch)), chance, counts))
        tell(faulty_batches.pairs(Path(scratch) / "pairs", arguments.pairs, end, counts))
    print(", ".join([*(f"{name}: {count}" for name, count in counts.items()), f"{len(wrong)} failures"]))
    return int(bool(wrong))


if __name__ == "__main__":
    sys.exit(main())
