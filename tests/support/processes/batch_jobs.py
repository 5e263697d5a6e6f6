"""What the tests of batches do with an input, in worker processes: what its text asks for."""

import os
import signal
import time
from pathlib import Path

from vorotool.batch.workers import Outcome, Task
from vorotool.formats.io.atomic_output import open_output

LONG = 600.0
"""Seconds that a sleeper sleeps."""


class Sleeper:
    def __init__(self, sign):
        self.sign = sign

    def __del__(self):
        self.sign.touch()
        time.sleep(LONG)


def obey(task):
    """Copy a text, fail, die, or take long."""
    text = Path(task.file).read_text()
    if text == "fail":
        return Outcome(code=3, message="bad text", warnings=("one",))
    for path in task.outputs:
        with open_output(path) as out:
            out.write(text.encode())
            out.flush()
            if text == "die":
                os.kill(os.getpid(), signal.SIGKILL)
            if text == "deaf":
                Sleeper(Path(task.file).with_suffix(".asleep"))  # goes at once, and its method lets no exception out
            if text in ("sleep", "deaf"):
                time.sleep(LONG)
    return Outcome(stats={"letters": len(text)}, seconds={"copy": 0.5})


def written(folder, *texts):
    """Tasks for texts that are written to files ``0.txt``, ``1.txt``, …; outputs go to ``out``."""
    (folder / "out").mkdir(exist_ok=True)
    tasks = []
    for number, text in enumerate(texts):
        (folder / f"{number}.txt").write_text(text)
        outputs = (str(folder / f"out/{number}.txt"),)
        tasks.append(Task(str(folder / f"{number}.txt"), outputs, tag=f"{number}-"))  # of a run each task has its own
    return tasks
