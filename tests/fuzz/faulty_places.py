"""Disks that are full or read-only, folders that vanish, targets that become folders."""

import errno
import importlib
import os
import shutil
import subprocess
from functools import cache

from fuzz.write_events import WRITES, Steps, install
from fuzz.writers import WRITERS, ended, leftovers, outputs, run

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


def trial(known, name, chance, counts):
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

    def refuse(path):
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


def mounted(place):
    """A file system that is full after some pages, or read-only."""
    if not can_mount():
        return no_space(place)
    is_full = place.chance.random() < 0.7
    inside, size = place.folder / "mounted", sum(map(len, place.new.values()))
    inside.mkdir()
    mount("-t", "tmpfs", "-o", "size=32m", "tmpfs", inside)
    try:
        for path in (*place.folder.glob("*.csv"), *place.folder.glob("*.json"), *place.folder.glob("out.*")):
            (shutil.copytree if path.is_dir() else shutil.copy)(path, inside / path.name)
        (inside / "messages").symlink_to(place.folder / "messages")
        used = os.statvfs(inside)
        pages = used.f_blocks - used.f_bfree + place.chance.randrange(1 + size // PAGE)
        mount("-o", f"remount,size={pages * used.f_frsize}" if is_full else "remount,ro", inside)
        place.run(inside)
        return place.judge(inside) + ["it was written"] * (place.code == 0 and not is_full)
    finally:
        subprocess.run(["umount", inside], check=True)


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
    "small disk": mounted,
    "renamed folder": renamed,
    "removed folder": removed,
    "folder as target": folder_as_target,
}
