"""Disks that are full or read-only, folders that vanish, targets that become folders."""

import errno
import os
import shutil
import subprocess
from functools import cache

from fuzz.write_events import WRITES, Steps, install
from fuzz.writers import WRITERS, ended, leftovers, outputs, run
from vorotool.formats import temporaries

PAGE = 4096


@cache
def can_mount():
    """Whether this process may mount small file systems."""
    return (
        os.geteuid() == 0
        and subprocess.run(["unshare", "-m", "true"], capture_output=True, check=False).returncode == 0
    )


def trial(known, name, chance, counts):
    """Let one writer fail; what is wrong."""
    place = chance.choice(list(PLACES))
    older = chance.random() < 0.5
    folder = known.folder(name, older=older)
    counts[place] += 1
    before = outputs(folder)
    wrong = [f"{name}, {place}, older {older}: {each}" for each in PLACES[place](known, name, folder, before, chance)]
    if not wrong:
        shutil.rmtree(folder, ignore_errors=True)
    return wrong


def judge(code, known, name, folder, before):
    """What is wrong with a run that should fail, and leave what was there; some of several outputs may be whole."""
    messages = (folder / "messages").read_text() if folder.exists() else ""
    wrong = [f"exit code {code}: {messages[-300:]}"] * (code not in expected(name))
    wrong += ["a traceback"] * ("Traceback" in messages)
    wrong += [f"{leftovers(folder)} left"] * bool(leftovers(folder))
    found, new = outputs(folder), known.contents[name, 2]
    several = not any(".zarr/" in path for path in new)
    same = found == before or (several and all(found[path] in (before.get(path), new.get(path)) for path in found))
    return wrong + ["other outputs"] * (not same or not before.keys() <= found.keys())


def expected(name):
    """Exit codes; a batch fails as one where its inputs do."""
    return (4, 6) if name == "table" else (4,)


def no_space(known, name, folder, before, chance):
    """The system refuses to write, at a random step."""

    def refuse(_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    return failing(known, name, folder, before, chance, refuse, WRITES)


def failing(known, name, folder, before, chance, act, kinds):
    """Something happens at a random step; where a run has fewer, it ends well."""
    steps = Steps(chance.randrange(max(1, known.steps[name] // 2)), act, kinds)
    done = folder / "acted"
    steps.act = lambda name: (done.write_text("x") if done.parent.exists() else None, act(name))
    code = ended(run(folder, WRITERS[name], lambda: install(steps)))
    if not done.exists() and code == 0:
        return []
    return judge(code, known, name, folder, before)


def read_only(known, name, folder, before, chance):
    """Nothing can be made in the folder."""
    kind = chance.choice([errno.EROFS, errno.EACCES])

    def prepare():
        def refuse(path):
            raise OSError(kind, os.strerror(kind))

        for owner in (temporaries, import_of("outputs"), import_of("stores"), import_of("many")):
            for made in ("new_file", "new_folder"):
                if hasattr(owner, made):
                    setattr(owner, made, refuse)

    return judge(ended(run(folder, WRITERS[name], prepare)), known, name, folder, before)


def import_of(name):
    """Modules that make temporaries."""
    import vorotool.cli.many
    import vorotool.formats.outputs
    import vorotool.formats.stores

    return {"outputs": vorotool.formats.outputs, "stores": vorotool.formats.stores, "many": vorotool.cli.many}[name]


def mounted(known, name, folder, before, chance):
    """A file system that is full after some pages, or read-only."""
    if not can_mount():
        return no_space(known, name, folder, before, chance)
    full = chance.random() < 0.7
    inside, size = folder / "mounted", sum(map(len, known.contents[name, 2].values()))
    pages = chance.randrange(1 + size // PAGE) if full else 0
    inside.mkdir()
    subprocess.run(["mount", "-t", "tmpfs", "-o", "size=32m", "tmpfs", inside], check=True)
    try:
        for path in (*folder.glob("*.csv"), *folder.glob("*.json"), *folder.glob("out.*")):
            (shutil.copytree if path.is_dir() else shutil.copy)(path, inside / path.name)
        before = outputs(inside)
        (inside / "messages").write_bytes(bytes(PAGE))
        (inside / "messages").unlink()
        (inside / "messages").symlink_to(folder / "messages")
        used = os.statvfs(inside)
        size = (used.f_blocks - used.f_bfree + pages) * used.f_frsize
        options = f"remount,size={size}" if full else "remount,ro"
        subprocess.run(["mount", "-o", options, inside], check=True)
        code = ended(run(inside, WRITERS[name]))
        if full and code == 0 and outputs(inside) == known.contents[name, 2]:
            return []  # what is written takes no more than is free, as where the older file is small
        return judge(code, known, name, inside, before)
    finally:
        subprocess.run(["umount", inside], check=True)


def vanished(known, name, folder, before, chance):
    """The folder is renamed at a random step; the next run in it removes what was begun."""
    away = folder.with_name(f"{folder.name}-away")
    code = failing_away(known, name, folder, chance, lambda _: folder.rename(away))
    if not away.exists():
        return [] if code == 0 else [f"exit code {code}"]
    wrong = [f"exit code {code}"] * (code not in (0, *expected(name)))
    wrong += [f"{leftovers(folder)} left"] * (folder.exists() and bool(leftovers(folder)))
    again = ended(run(away, WRITERS[name]))
    wrong += [f"the next run: exit code {again}"] * (again != 0) + ["left"] * bool(leftovers(away))
    wrong += ["other outputs"] * (outputs(away) != known.contents[name, 2])
    shutil.rmtree(away)
    return wrong


def removed(known, name, folder, before, chance):
    """The folder is removed at a random step."""
    code = failing_away(known, name, folder, chance, lambda _: shutil.rmtree(folder))
    wrong = [f"exit code {code}"] * (code not in (0, *expected(name)))
    return wrong + [f"{leftovers(folder)} left"] * (folder.exists() and bool(leftovers(folder)))


def failing_away(known, name, folder, chance, act):
    """The exit code of a run during which the folder goes."""
    steps = Steps(chance.randrange(max(1, known.steps[name])), act)
    return ended(run(folder, WRITERS[name], lambda: install(steps)))


def becomes_folder(known, name, folder, before, chance):
    """The target is a folder, with something in it, when the output is whole."""
    targets = sorted({path.split("/")[0] for path in known.contents[name, 2]})
    target = folder / chance.choice(targets)

    def become(_):
        if target.is_dir():
            shutil.rmtree(target)
        target.unlink(missing_ok=True)
        target.mkdir()
        (target / "mine").write_text("mine")

    steps = Steps(chance.randrange(max(1, known.steps[name] // 2)), become, {*WRITES, "made", "locked"})
    code = ended(run(folder, WRITERS[name], lambda: install(steps)))
    if not (target / "mine").exists():
        return [] if code == 0 else [f"exit code {code}, and what was in the folder is gone"]
    wrong = [f"exit code {code}"] * (code not in (0, *expected(name)))
    return wrong + [f"{leftovers(folder)} left"] * bool(leftovers(folder))


PLACES = {
    "no space": no_space,
    "read-only": read_only,
    "small disk": mounted,
    "renamed folder": vanished,
    "removed folder": removed,
    "folder as target": becomes_folder,
}
