"""Batches and their worker processes are killed inside writes, and resumed; shards run beside one another."""

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

from fuzz.write_events import PATIENCE
from fuzz.writers import ENDS, leftovers, write_inputs

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
        wrong += [f"{fmt}: resumed: other outputs"] * (
            not wrong and contents(folder, "out") != contents(folder, "whole")
        )
    counts["batches"] += 1
    return wrong


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
