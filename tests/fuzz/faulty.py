"""Batches are killed inside writes, and resumed; shards run beside one another; disks are full, and folders vanish."""

import errno
import importlib
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from collections import Counter
from contextlib import suppress
from functools import cache
from pathlib import Path

from fuzz.write_events import PATIENCE, WRITES, Steps, install
from fuzz.writers import ENDS, WRITERS, ended, leftovers, outputs, run, write_inputs

TESTS = Path(__file__).parents[1]
PREPARED = "from fuzz import write_events; write_events.install_from_environment(); "
"""Comes before what a worker does."""

LAUNCH = f"""import sys
sys.path.insert(0, {str(TESTS)!r})
from vorotool.batch import workers
workers.START = workers.START.replace("from vorotool", {PREPARED!r} + "from vorotool", 1)
from vorotool.cli.main import main
main(sys.argv[1:])
"""
INPUTS = 8
FORMATS = ("csv", "json", "npz", "svg", "png", "zarr")


def start(folder, fmt, out, *options, environment=None):
    """Begin a batch."""
    if fmt in ("csv", "json", "svg", "npz"):
        command = ["delaunay", "inputs", "-f", fmt]
    else:
        command = ["tessellate", "inputs", "--size", "150x100", "-f", fmt]
    arguments = [*command, "--out-dir", out, "--table", f"{out}.csv", "-j", "2", "-q", *options]
    return subprocess.Popen(
        [sys.executable, "-c", LAUNCH, *arguments],
        cwd=folder,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        env={**os.environ, **(environment or {})},
    )


def contents(folder, out):
    """Outputs, and the table."""
    paths = [path for path in (folder / out).rglob("*") if path.is_file() and path.suffix != ".jsonl"]
    found = {str(path.relative_to(folder / out)): path.read_bytes() for path in paths}
    return found | {"table": (folder / f"{out}.csv").read_bytes()}


def many_inputs(folder):
    """Lists of points."""
    for number in range(INPUTS):
        write_inputs(folder / f"made-{number}", number)
        (folder / "inputs").mkdir(exist_ok=True)
        (folder / f"made-{number}/points.csv").rename(folder / f"inputs/p{number}.csv")


def trial(folder, chance, counts):
    """Kill a batch, a worker, or both, inside writes of a worker; what is wrong."""
    many_inputs(folder)
    fmt = chance.choice(FORMATS)
    whole = start(folder, fmt, "whole")
    _, said = whole.communicate()
    wrong = [f"{fmt}: exit code {whole.returncode}: {said.decode()[-300:]}"] * (whole.returncode != 0)
    for number in (signal.SIGKILL, chance.choice([signal.SIGTERM, signal.SIGINT]), signal.SIGKILL):
        if not wrong:
            wrong += killed(folder, fmt, number, chance, counts)
    if not wrong:
        again = start(folder, fmt, "out", "--resume")
        _, said = again.communicate()
        wrong += [f"{fmt}: resumed: exit code {again.returncode}: {said.decode()[-300:]}"] * (again.returncode != 0)
        wrong += [f"{fmt}: resumed: {leftovers(folder)} left"] * bool(leftovers(folder))
        wrong += [f"{fmt}: done {times} times: {name}" for name, times in done_in(folder / "out") if times != 1]
        wrong += [f"{fmt}: resumed: other outputs"] * (
            not wrong and contents(folder, "out") != contents(folder, "whole")
        )
    counts["batches"] += 1
    return wrong


def done_in(out):
    """Inputs that the manifest says are done, and how often; torn lines are of killed batches."""
    done = Counter()
    for line in next(out.glob("*.jsonl")).read_bytes().splitlines():
        with suppress(ValueError):
            record = json.loads(line)
            done[record.get("input")] += record.get("status") == "done"
    return [(name, times) for name, times in done.items() if name is not None and times]


def killed(folder, fmt, number, chance, counts):
    """Resume a batch, and kill at a step of a worker."""
    pipe = folder / f"pipe-{random.getrandbits(64):x}"
    os.mkfifo(pipe)
    descriptor = os.open(pipe, os.O_RDWR | os.O_NONBLOCK)
    environment = {"FAULTS_PIPE": str(pipe), "FAULTS_AT": str(chance.randrange(40)), "FAULTS_WAIT": "1"}
    victim = chance.choice(["batch", "worker", "both"]) if number == signal.SIGKILL else "batch"
    child = start(folder, fmt, "out", "--resume", "--keep-going", environment=environment)
    workers = announced(descriptor, child)
    if not workers:
        os.close(descriptor)
        child.communicate()
        return []
    if victim != "batch":
        for worker in workers:
            os.kill(worker, signal.SIGKILL)
    if victim != "worker":
        child.send_signal(number)
    wrong = finished(child, folder, number if victim != "worker" else None, descriptor)
    os.close(descriptor)
    left = leftovers(folder)
    counts[f"{number.name} to {victim}"] += 1
    counts["kills of batches that left a temporary"] += bool(left)
    wrong += [f"{left} left"] * (bool(left) and (number != signal.SIGKILL or victim == "worker"))
    return [f"{fmt}, {number.name} to {victim}: {each}" for each in wrong]


def announced(descriptor, child):
    """Workers that wait inside a write: several where they began together, none where the batch ends without."""
    while child.poll() is None:
        try:
            return [int(line.split()[0]) for line in os.read(descriptor, 4096).splitlines()]
        except BlockingIOError:
            time.sleep(0.002)
    return []


def finished(child, folder, number, descriptor):
    """Wait for a batch that got a signal, or whose worker died; other workers that wait in a step are let go."""
    deadline = time.monotonic() + 3 * PATIENCE
    while child.poll() is None and time.monotonic() < deadline:
        try:
            for line in os.read(descriptor, 4096).splitlines():
                if number is None:  # another worker, or the next one, waits: it dies, too
                    os.kill(int(line.split()[0]), signal.SIGKILL)
        except (BlockingIOError, ProcessLookupError):
            time.sleep(0.01)
    if child.poll() is None:
        child.kill()
        return ["it does not end"]
    _, said = child.communicate()
    code = ENDS[number] if number is not None else 6
    wait_for_workers(folder)
    return [f"exit code {child.returncode}: {said.decode()[-300:]}"] * (child.returncode != code)


def wait_for_workers(folder):
    """Workers of a killed batch end by themselves, each when it sees that."""
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline and any(is_worker(path, folder) for path in Path("/proc").glob("[0-9]*")):
        time.sleep(0.01)


def is_worker(path, folder):
    """Whether a process is a worker of a batch in a folder."""
    try:
        inside = (path / "cwd").readlink() == folder.resolve()
        return inside and b"write_events" in (path / "cmdline").read_bytes()
    except OSError:  # it has gone
        return False


class Pairs:
    """Two shards that are started together, and resume what the other has done."""

    def __init__(self, folder):
        folder.mkdir()
        many_inputs(folder)
        start(folder, "csv", "whole").communicate()
        self.folder, self.number = folder, 0
        self.expected = self._written("whole")

    def _written(self, out):
        return {path.name: path.read_bytes() for path in (self.folder / out).glob("*.csv")}

    def trial(self, counts):
        """Start one pair; what is wrong."""
        out = f"out-{self.number}"
        self.number += 1
        children = [
            start(self.folder, "csv", out, "--resume", "--shard", f"{part}/2", "--table", f"{out}-{part}.csv")
            for part in (1, 2)
        ]
        said = [child.communicate()[1].decode() for child in children]
        wrong = [
            f"exit code {child.returncode}: {text}"
            for child, text in zip(children, said, strict=True)
            if child.returncode
        ]
        wrong += ["other outputs"] * (self._written(out) != self.expected)
        wrong += [f"{leftovers(self.folder)} left"] * bool(leftovers(self.folder))
        counts["pairs of shards"] += 1
        return wrong


PAGE = 4096
MAKERS = ("io.temporaries", "io.atomic_output", "zarr.store")


class Place:
    """One writer in a folder of its own where something goes wrong.

    Parameters
    ----------
    known : Known
        What writers write.
    name : str
        Of the writer.
    chance : Random
        Decides when it goes wrong.
    older : bool
        There are older outputs.
    """

    def __init__(self, known, name, chance, *, older):
        self.known, self.name, self.chance = known, name, chance
        self.folder = known.folder(name, older=older)
        self.before, self.new = outputs(self.folder), known.contents[name, 2]
        self.code, self.refused = 0, False

    def run(self, folder=None, prepare=lambda: None):
        """Run the writer."""
        self.code = ended(run(folder or self.folder, WRITERS[self.name], prepare))
        self.refused = self.refused or self.has_failed()

    def run_with(self, act, kinds=None):
        """Run it, and do something at a random step; at none if there are fewer of these kinds."""
        steps = Steps(self.chance.randrange(self.known.steps[self.name]), act, kinds)
        self.run(prepare=lambda: install(steps))

    def has_failed(self):
        """Whether it says that an output cannot be written; a batch says that inputs failed."""
        return self.code in ((4, 6) if self.name == "table" else (4,))

    def judge(self, folder=None):
        """What is wrong with a run that fails and leaves what was there, or that does what it does elsewhere."""
        folder = folder or self.folder
        messages = (self.folder / "messages").read_text() if self.folder.exists() else ""
        wrong = [f"exit code {self.code}: {messages[-300:]}"] * (self.code != 0 and not self.has_failed())
        wrong += [f"{leftovers(folder)} left"] * bool(leftovers(folder))
        found = outputs(folder)
        if self.code == 0:
            return wrong + ["exit code 0, and other outputs"] * (found != self.new)
        if any(".zarr/" in path for path in self.new):
            return wrong + ["another store"] * (found != self.before)
        same = all(found[path] in (self.before.get(path), self.new.get(path)) for path in found)
        return wrong + ["other outputs"] * (not same or not self.before.keys() <= found.keys())


def place_trial(known, name, chance, counts):
    """Let one writer fail; what is wrong."""
    kind, older = chance.choice(list(PLACES)), chance.random() < 0.5
    place = Place(known, name, chance, older=older)
    wrong = PLACES[kind](place)
    counts[kind] += 1
    counts[f"{kind}, refused"] += place.refused
    if not wrong:
        shutil.rmtree(place.folder, ignore_errors=True)
    return [f"{name}, {kind}, older {older}: {each}" for each in wrong]


def no_space(place):
    """The system refuses to write, at a random step."""

    def refuse(_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    place.run_with(refuse, WRITES)
    return place.judge()


def read_only(place):
    """Nothing can be made in the folder."""
    kind = place.chance.choice([errno.EROFS, errno.EACCES])

    def refuse(path, like=""):
        raise OSError(kind, os.strerror(kind))

    def prepare():
        modules = [importlib.import_module(f"vorotool.formats.{name}") for name in MAKERS]
        for owner in (*modules, importlib.import_module("vorotool.batch.run")):
            for made in {"new_file", "new_folder"} & set(vars(owner)):
                setattr(owner, made, refuse)

    place.run(prepare=prepare)
    return place.judge() + ["it was written"] * (place.code == 0)


@cache
def can_mount():
    """Whether this process may mount file systems."""
    return subprocess.run(["unshare", "-m", "true"], capture_output=True, check=False).returncode == 0


def mount(*arguments):
    """Mount a file system."""
    subprocess.run(["mount", *arguments], check=True)


def renamed(place):
    """The folder is renamed at a random step; the next run in it removes what was begun."""
    away = place.folder.with_name(f"{place.folder.name}-away")
    place.run_with(lambda _: place.folder.rename(away))
    wrong = gone(place)
    place.run(away)
    wrong += [f"the next run: exit code {place.code}"] * (place.code != 0)
    wrong += [f"the next run leaves {leftovers(away)}"] * bool(leftovers(away))
    wrong += ["other outputs"] * (outputs(away) != place.new)
    shutil.rmtree(away)
    return wrong


def removed(place):
    """The folder is removed at a random step."""
    place.run_with(lambda _: shutil.rmtree(place.folder))
    return gone(place)


def gone(place):
    """What is wrong with a run whose folder goes; it may go when all is done."""
    wrong = [f"exit code {place.code}"] * (place.code != 0 and not place.has_failed())
    return wrong + [f"{leftovers(place.folder)} left"] * (place.folder.exists() and bool(leftovers(place.folder)))


def folder_as_target(place):
    """While an output is written its target becomes a folder, with something in it, which is not lost."""
    target = place.folder / place.chance.choice(sorted({path.split("/")[0] for path in place.new}))

    def become(_):
        shutil.rmtree(target, ignore_errors=True)
        target.unlink(missing_ok=True)
        target.mkdir()
        (target / "mine").write_text("mine")

    place.run_with(become, {*WRITES, "made", "locked"})
    wrong = [f"exit code {place.code}"] * (place.code != 0 and not place.has_failed())
    wrong += ["exit code 4, and what was in the folder is gone"] * (place.code != 0 and not (target / "mine").exists())
    return wrong + [f"{leftovers(place.folder)} left"] * bool(leftovers(place.folder))


PLACES = {
    "no space": no_space,
    "read-only": read_only,
    "renamed folder": renamed,
    "removed folder": removed,
    "folder as target": folder_as_target,
}
