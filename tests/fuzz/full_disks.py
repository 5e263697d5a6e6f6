"""Disks that fill up under every output: `--rounds 3 --seed 1`, or `--only shp,gpkg`.

Every format of every result of every command writes small outputs first and larger ones then, for which there is no
space: the exit code is 4 and the message one, the older outputs are what they were, byte for byte, and no temporary is
left; a batch says it of each of its inputs that it cannot write, with 6, and of its table, with 4. The disk is a
tmpfs where this process may mount one; the largest size of a file is bounded instead with `--sizes`.
"""

import argparse
import os
import random
import resource
import subprocess
import tempfile
from pathlib import Path

from fuzz.faulty import can_mount, mount
from fuzz.writers import ended, import_modules, leftovers, outputs, run, write_inputs
from support.processes.heard_signals import hear_signals
from vorotool.products.formats import FORMATS
from vorotool.products.registry import PRODUCTS, VOLUME_PRODUCTS

SMALL = 12
"""Points, or corners of the shape, of the older outputs."""

SOURCES = {
    "tessellate": "points.csv --size 150x100",
    "delaunay": "points.csv",
    "alphashape": "points.csv",
    "voronoi": "shapes.json",
    "skeleton-exact": "shape.json",
    "skeleton-approx": "shape.json --step 1",
    "distance": "shape.json points.csv",
    "draw": "image.npy",
}
OPTIONS = {
    "alphashape hull": "-r 60",
    "skeleton-exact offset": "-d 1,2",
    "skeleton-exact points": "--every 1",
    "skeleton-approx points": "--every 1",
    "skeleton-exact transects": "--every 1",
    "skeleton-approx transects": "--every 1",
}
"""What some results need."""

PIXELS = {"skeleton-exact thickness": "image.npy --threshold 50"}
"""Sources of results of images."""


def cases():
    """Names and commands of everything that is written; all outputs begin with ``out.``."""
    made = {}
    for command, products in PRODUCTS.items():
        for what, product in products.items():
            for fmt in product.formats:
                source = PIXELS.get(f"{command} {what}", SOURCES[command])
                more = OPTIONS.get(f"{command} {what}", "")
                chosen = f"--what {what}" if command != "draw" else ""
                ending = FORMATS[fmt].endings[0]
                moves = "--animate --frames 3" if fmt in ("gif", "apng", "webp") else ""
                line = f"{command} {source} {chosen} {more} {moves} -f {fmt} -o out.x{ending}"
                made[f"{command} {what} {fmt}"] = " ".join(line.split())
    for what, product in VOLUME_PRODUCTS.items():
        for fmt in product.formats:
            line = f"tessellate points.xyz --volume --size 12x40x50 --what {what} -f {fmt}"
            made[f"volume {what} {fmt}"] = f"{line} -o out.x{FORMATS[fmt].endings[0]}"
    made["several"] = "delaunay points.csv --what edges,triangles,cells,table -o out.shp --stats out.stats.json"
    made["table of all"] = "delaunay points.csv points-2.csv --what table --table out.csv -j 1"
    made["sample"] = "sample dots.csv -o out.csv"
    return made


def write_small(folder):
    """Write inputs of the older outputs."""
    write_inputs(folder, 1)
    for path in (*folder.glob("*.csv"), *folder.glob("*.xyz")):
        path.write_text("".join(path.read_text().splitlines(keepends=True)[: SMALL + 1]))


class Disk:
    """A folder whose space can be bounded: a tmpfs, or sizes of files."""

    def __init__(self, scratch, *, mounts):
        self.folder, self.mounts, self._limit = scratch / "disk", mounts, None
        self.folder.mkdir()
        if mounts:
            mount("-t", "tmpfs", "-o", "size=64m", "tmpfs", self.folder)

    def close(self):
        """Unmount it."""
        if self.mounts:
            subprocess.run(["umount", self.folder], check=True)

    def clear(self):
        """Remove all that is in it, but what is said."""
        self.limit(None)
        subprocess.run(["find", self.folder, "-mindepth", "1", "-delete"], check=True)
        (self.folder / "messages").symlink_to(self.folder.with_name("messages"))  # where there is space

    def limit(self, share, sizes=()):
        """Leave a share of the space that files of some sizes need, or all of it."""
        if not self.mounts:
            self._limit = None if share is None else int(share * max(sizes))
            return
        used, size = os.statvfs(self.folder), "64m"
        if share is not None:
            pages = sum(-(-each // used.f_frsize) for each in sizes)
            size = (used.f_blocks - used.f_bfree + int(share * pages)) * used.f_frsize
        mount("-o", f"remount,size={size}", self.folder)

    def run(self, command):
        """Run a command; its exit code."""
        limit = self._limit

        def prepare():
            if limit is not None:
                resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

        return ended(run(self.folder, command, prepare))


def trial(disk, name, command, share):
    """Write small outputs, and large ones for which there is no space: what is wrong, or that it was not tried."""
    disk.clear()
    said = disk.folder / "messages"
    write_inputs(disk.folder, 2)
    if code := disk.run(command):
        return [], f"exit code {code}: {said.read_text()[-160:]}"
    new = outputs(disk.folder)
    disk.clear()
    write_small(disk.folder)
    if code := disk.run(command):
        return [], f"small: exit code {code}: {said.read_text()[-160:]}"
    before = outputs(disk.folder)
    write_inputs(disk.folder, 2)
    sizes = [len(data) for data in new.values()]
    if not disk.mounts and int(share * max(sizes)) < 512:  # messages are a file, too
        return [], "too small"
    disk.limit(share, sizes)
    code = disk.run(command)
    text, found, left = said.read_text(), outputs(disk.folder), leftovers(disk.folder)
    disk.limit(None)
    is_batch = name == "table of all"
    wrong = [f"exit code {code}: {text[-300:]}"] * (code not in ((4, 6) if is_batch else (4,)))
    wrong += ["a traceback"] * ("Traceback" in text)
    wrong += [f"not one message: {text}"] * (not is_batch and len(text.splitlines()) != 1)
    changed = [path for path in {*before, *found} if before.get(path) != found.get(path)]
    wrong += [f"changed: {changed}"] * bool(changed) + [f"left: {left}"] * bool(left)
    return [f"{name}, {share:.3f} of the space: {each}" for each in wrong], ""


def main():
    """Run all; exit 1 if anything is wrong."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--rounds", type=int, default=1)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", help="formats or words of the names, separated by commas")
    parser.add_argument("--sizes", action="store_true", help="bound the sizes of files, and mount nothing")
    arguments = parser.parse_args()
    chance, wrong, untried, count = random.Random(arguments.seed), 0, {}, 0
    words = set(arguments.only.split(",")) if arguments.only else None
    chosen = {name: line for name, line in cases().items() if words is None or words & set(name.split())}
    hear_signals()
    with tempfile.TemporaryDirectory() as scratch:
        firsts = {name.split()[at]: line for name, line in chosen.items() for at in (0, -1)}
        import_modules(Path(scratch) / "imports", firsts.values(), refused=True)
        disk = Disk(Path(scratch), mounts=not arguments.sizes and can_mount())
        try:
            for _ in range(arguments.rounds):
                for name, command in chosen.items():
                    found, reason = trial(disk, name, command, chance.random() * 0.98)
                    count += not reason
                    wrong += len(found)
                    for each in found:
                        print(f"wrong: {each}", flush=True)
                    if reason:
                        untried[name] = reason
        finally:
            disk.close()
    for name, reason in untried.items():
        print(f"not tried: {name}: {reason}")
    print(f"{count} full disks, {len(untried)} not tried, {wrong} failures")
    return int(bool(wrong))
