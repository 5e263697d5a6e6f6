"""Run every command of the vorotool that is installed on small inputs: `python -I tools/smoke.py`.

It needs what a user has who installed vorotool, and nothing of the repository. Inputs and outputs are in a folder that
is removed at the end.
"""

from __future__ import annotations

import json
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Mapping, Sequence
from importlib import metadata
from pathlib import Path

SPACE = "x,y,z\n3,4,1\n28,6,7\n15,20,3\n"
POINTS = "x,y\n3,4\n28,6\n15,20\n7,17\n22,13\n30,22\n"
MASK = "P2 7 4 1\n0 0 0 0 0 0 0\n0 1 1 0 0 1 0\n0 1 1 0 1 1 0\n0 0 0 0 0 0 1\n"
SHAPE = {"type": "Polygon", "coordinates": [[[0, 0], [40, 0], [40, 12], [14, 12], [14, 30], [0, 30], [0, 0]]]}

RUNS = {
    "tessellate": [
        "dots.csv --size 32x24 -o labels.png --verify",
        "mask.pgm --what table -o regions.csv",
        "mask.pgm --what distance -o distances.tif",
        "dots.csv more.csv --size 32x24 --what color --out-dir many -j 2",
        "space.csv --size 32x24x8 -o volume.tif --verify",
        "volume.tif --volume --what table -o volume.csv",
        "volume.tif --volume --what color -o slices.png",
    ],
    "delaunay": ["dots.csv -o triangles.geojson --verify", "mask.pgm -o edges.csv"],
    "alphashape": ["dots.csv -r 12 -o shape.geojson --verify", "dots.csv -r 12 -o shape.svg"],
    "skeleton-approx": ["shape.json --step 1 -o approximate.json"],
    "skeleton-exact": ["shape.json -o skeleton.json --verify", "shape.json -o skeleton.svg"],
    "voronoi": ["shape.json -o cells.geojson --verify", "mask.pgm --max-distance 2 -o cells.svg"],
    "distance": ["shape.json dots.csv --verify"],
    "draw": ["labels.png -o labels.svg", "skeleton.json -o again.png"],
    "info": ["dots.csv mask.pgm shape.json", "labels.png --json"],
    "sample": ["six-seeds.csv", "blobs.png -o blobs.png", "--all -o samples"],
    "completion": ["bash", "zsh", "fish"],
}
"""Of each command what it is given, one after the other; a command that is not here is a failure."""


class Smoke:
    """Runs commands in a folder with small inputs.

    Parameters
    ----------
    folder : Path
        There already.
    start : sequence of str, optional
        What a command line begins with; by default the script that was installed.
    environment : mapping, optional
        Of the processes.
    """

    def __init__(
        self, folder: Path, *, start: Sequence[str] = (), environment: Mapping[str, str] | None = None
    ) -> None:
        self.folder, self.environment = folder, environment
        self.start = start or [str(Path(sysconfig.get_path("scripts")) / "vorotool")]
        for name, text in {
            "dots.csv": POINTS,
            "more.csv": POINTS,
            "space.csv": SPACE,
            "mask.pgm": MASK,
            "shape.json": json.dumps(SHAPE),
        }.items():
            (folder / name).write_text(text, encoding="utf-8", newline="\n")

    def run(self, *words: str) -> str:
        """Run a command; what it prints."""
        done = subprocess.run(
            [*self.start, *words],
            cwd=self.folder,
            env=self.environment,
            capture_output=True,
            text=True,
            encoding="utf-8",
            check=False,
        )
        if done.returncode != 0 or "Traceback" in done.stderr:
            raise SystemExit(f"{' '.join(words)}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
        return done.stdout

    def all_commands(self) -> None:
        """Run each command, and ask each for help."""
        for command, runs in RUNS.items():
            check(f"vorotool {command}" in self.run(command, "--help"), f"the help of {command}")
            for words in runs:
                printed = self.run(command, *words.split())
                _, names, output = words.partition(" -o ")
                written = (self.folder / output.split()[0]).stat().st_size if names else len(printed)
                check(
                    written > 0 or "--out-dir" in words or "--all" in words, f"what vorotool {command} {words} writes"
                )
        check(len(list((self.folder / "many").glob("*.png"))) == 2, "the outputs of a batch")
        check((self.folder / "samples/dots.csv").stat().st_size > 0, "the samples")


def library() -> None:
    """Use the library: each name of it is there."""
    import numpy as np

    import vorotool

    check(vorotool.__version__ == metadata.version("vorotool"), "the version of the library")
    for name in vorotool.__all__:
        check(getattr(vorotool, name) is not None, name)
    mesh = vorotool.delaunay(np.array([[3.0, 4.0], [28.0, 6.0], [15.0, 20.0]]))
    vorotool.verify_triangulation(mesh)
    check(mesh.triangles.shape == (1, 3), "a triangle")


def documents(help_page: str) -> None:
    """Look for the README, and for a manual page of each command where `man` looks for those of this environment."""
    readme = Path(sys.prefix).resolve() / "share/doc/vorotool/README.md"
    check(readme.is_file() and str(readme) in help_page, f"{readme}, and its name in the help")
    folder = Path(sys.prefix) / "share/man/man1"
    for name in ["vorotool", *(f"vorotool-{command}" for command in RUNS)]:
        check((folder / f"{name}.1").is_file(), f"the manual page {name}.1 in {folder}")


def check(is_so: bool, what: str) -> None:
    """End where something is not so."""
    if not is_so:
        raise SystemExit(f"smoke: wrong or missing: {what}")


def main() -> None:
    """Run all of it in a folder."""
    from vorotool.cli.main import COMMANDS

    check(set(COMMANDS) == set(RUNS), f"among what is run here: {set(COMMANDS) ^ set(RUNS)}")
    with tempfile.TemporaryDirectory() as folder:
        smoke = Smoke(Path(folder))
        check(smoke.run("--version").split()[-1] == metadata.version("vorotool"), "the version")
        smoke.all_commands()
        help_page = smoke.run("--help")
    library()
    documents(help_page)


if __name__ == "__main__":
    main()
