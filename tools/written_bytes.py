"""What revisions write, byte for byte: `tools/written_bytes.py REVISION [OTHER]`.

Each revision is built in a tree of its own, and runs the same commands: the console blocks of the documents, each
product of each command in each of its formats on small data, and `make figures`, all as the first revision has them.
The sums of what they write, say and count are kept in build/bytes as JSON, one file a revision and one for each whose
commands it was given. With two revisions, what differs is printed, and the exit code is 1 if anything does.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import random
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
WORK = ROOT / "build/bytes"
OF_RUN = {"seconds", "simd", "threads"}
"""What statistics say of the run and not of the result."""
TIMED = {"table-1.md"}
"""Figures that hold seconds."""
BLOCK = re.compile(r"^```console\n(.*?)^```", re.MULTILINE | re.DOTALL)
SOURCES = {
    "tessellate": ("points.csv --size 300x200", "cells.png", "blobs.png --max-distance 7.3 --pixel-size 0.325um"),
    "delaunay": ("points.csv", "cells.png", "points.csv --clip area.json"),
    "alphashape": ("points.csv -r 12.5", "points.csv --auto", "cells.png -r 30"),
    "voronoi": ("houses.geojson", "two-shapes.json --max-distance 20", "cells.png", "segments.wkt"),
    "skeleton-exact": (
        "great-lakes.geojson",
        "two-shapes.json --side both",
        "segments.wkt --side exterior",
        "blobs.png",
    ),
    "skeleton-approx": ("two-shapes.json --step 4", "blobs.png --tolerance 0.5"),
    "distance": ("houses.geojson streets.geojson", "two-shapes.json segments.wkt"),
}
"""What each command reads; where a product is not for an input, what the command says is compared."""
MORE = {"offset": "-d 2,-1,20", "compare": "--size 300x200", "points": "--every 7", "transects": "--every 7"}
"""Options that products need."""
REGISTRY = "import json; from vorotool.products.registry import PRODUCTS, formats_of; "
REGISTRY += "print(json.dumps({command: formats_of(command) for command in PRODUCTS}))"


def main() -> None:
    """List one revision, or compare two."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("revision", help="whose commands are run")
    parser.add_argument("other", nargs="?", help="what is compared with it")
    parser.add_argument("--every", type=int, default=1, metavar="N", help="run each N-th command, and draw all figures")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="commands that run at once")
    chosen = parser.parse_args()
    first = commit_of(chosen.revision)
    commands = dict(list(commands_of(built(first)).items())[:: chosen.every])
    usual = sums(first, first, commands, chosen.jobs)
    if chosen.other is not None:
        found = sums(commit_of(chosen.other), first, commands, chosen.jobs)
        sys.exit(tell_differences(usual, found))


def commit_of(revision: str) -> str:
    """Give the name of a commit in full."""
    return output("git", "rev-parse", "--verify", f"{revision}^{{commit}}", cwd=ROOT).strip()


def built(commit: str) -> Path:
    """Give the tree of a commit, with the package built and installed in it."""
    tree = WORK / commit[:12]
    if not tree.exists():
        tell(f"building {commit[:12]}")
        subprocess.run(["git", "worktree", "add", "--quiet", "--detach", tree, commit], cwd=ROOT, check=True)
    subprocess.run(["make", "--silent", "build/.installed", "build/.tests"], cwd=tree, check=True)
    return tree


def commands_of(tree: Path) -> dict[str, str]:
    """Give lines of a shell by names: blocks of the documents, and each product in each of its formats."""
    made = {}
    for page in (tree / "README.md", *sorted((tree / "docs").rglob("*.md"))):
        for number, block in enumerate(BLOCK.finditer(page.read_text(encoding="utf-8"))):
            made[f"{page.relative_to(tree)} {number}"] = "\n".join(typed(block[1]))
    formats = json.loads(output(tree / ".venv/bin/python", "-c", REGISTRY))
    for command, sources in SOURCES.items():
        for source in sources:
            for what, own in formats[command].items():
                for fmt in own:
                    options = f"--what {what} {MORE.get(what, '')} --out-dir out --stats stats.json"
                    line = f"vorotool {command} {source} {options} -f {fmt} --threads 1"
                    made[line] = line
    return made


def typed(block: str) -> Iterator[str]:
    """Give what is typed in a block, whose other lines are answers."""
    for line in block.splitlines():
        if line.startswith(("$ ", "> ")):
            yield line[2:]


def sums(commit: str, of: str, commands: dict[str, str], jobs: int) -> dict[str, str]:
    """Give the sum of what each command writes, from the file where it is kept, or by running them."""
    kept = WORK / f"{commit[:12]}-{len(commands)}-commands-of-{of[:12]}.json"
    if kept.exists():
        found: dict[str, str] = json.loads(kept.read_text(encoding="utf-8"))
        return found
    tree = built(commit)
    tell(f"running {len(commands)} commands by {commit[:12]}")
    with ThreadPoolExecutor(jobs) as pool, tempfile.TemporaryDirectory() as name:
        samples = make_samples(tree, Path(name) / "samples")
        made = dict(zip(commands, pool.map(lambda line: digest(tree, samples, line), commands.values()), strict=True))
    made |= figures(tree)
    kept.write_text(json.dumps(made, indent=1) + "\n", encoding="utf-8")
    return made


def make_samples(tree: Path, folder: Path) -> Path:
    """Make the folder that each command gets a copy of."""
    folder.mkdir()
    subprocess.run([tree / ".venv/bin/vorotool", "sample", "--all", "-o", "."], cwd=folder, check=True)
    subprocess.run(["cp", "-r", tree / "docs/pipeline", folder / "pipeline"], check=True)
    make_inputs(folder)
    return folder


def digest(tree: Path, samples: Path, line: str) -> str:
    """Run a line in a folder of samples: its exit code, and the sum of what it writes, says and counts."""
    variables = {name: value for name, value in os.environ.items() if not name.startswith("VOROTOOL_")}
    variables["PATH"] = f"{tree / '.venv/bin'}{os.pathsep}{variables['PATH']}"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "work"
        subprocess.run(["cp", "-rp", samples, folder], check=True)
        done = subprocess.run(
            ["bash", "-c", line], cwd=folder, env=variables, stdin=subprocess.DEVNULL, capture_output=True, check=False
        )
        found = hashlib.sha256(without_paths(done.stdout, folder) + b"\0" + without_paths(done.stderr, folder))
        for path in sorted(path for path in folder.rglob("*") if path.is_file()):
            found.update(f"{path.relative_to(folder)}\0".encode() + lasting(path))
    return f"{done.returncode} {found.hexdigest()}"


def without_paths(text: bytes, folder: Path) -> bytes:
    """Give what is said without the name of the folder, which is another each time."""
    return text.replace(str(folder).encode(), b".")


def lasting(path: Path) -> bytes:
    """Give what a file holds; of statistics, what is no measurement of time."""
    data = path.read_bytes()
    if path.suffix != ".json":
        return data
    try:
        counts = json.loads(data)
    except ValueError:
        return data
    if not isinstance(counts, dict) or "seconds" not in counts:
        return data
    return json.dumps({key: value for key, value in counts.items() if key not in OF_RUN}).encode()


def make_inputs(folder: Path) -> None:
    """Add points that are fractions, and an area, to the samples."""
    draw = random.Random(15)
    rows = [f"{300 * draw.random()!r},{200 * draw.random()!r}" for _ in range(400)]
    (folder / "points.csv").write_text("\n".join(["x,y", *rows, ""]), encoding="utf-8")
    area = [[20.25, 10.5], [280.1, 30.7], [240.3, 190.9], [90.6, 120.2], [10.4, 180.8]]
    (folder / "area.json").write_text(json.dumps(area), encoding="utf-8")


def figures(tree: Path) -> dict[str, str]:
    """Draw the figures, and give their sums; not of those that hold seconds."""
    subprocess.run(["make", "--silent", "figures"], cwd=tree, check=True, stdout=subprocess.DEVNULL)
    paths = sorted(path for path in (tree / "build/figures").iterdir() if path.name not in TIMED)
    return {f"figure {path.name}": hashlib.sha256(path.read_bytes()).hexdigest() for path in paths}


def tell_differences(usual: dict[str, str], found: dict[str, str]) -> int:
    """Print what differs, and give the exit code."""
    changed = [name for name in sorted({*usual, *found}) if usual.get(name) != found.get(name)]
    for name in changed:
        one, other = (each.get(name, "nothing").split(" ")[0] for each in (usual, found))
        codes = f" (exit {one}, then {other})" if one != other and len(one) < 4 > len(other) else ""
        tell(f"{name}{codes}")
    tell(f"{len(changed)} of {len(usual)} differ")
    return 1 if changed else 0


def output(*command: Any, cwd: Path | None = None) -> str:
    """Give what a command prints."""
    return subprocess.run(command, cwd=cwd, check=True, stdout=subprocess.PIPE, text=True).stdout


def tell(text: str) -> None:
    """Print a line at once."""
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main()
