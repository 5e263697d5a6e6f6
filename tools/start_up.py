"""How long the smallest job of each command takes, beside what it cannot do without: `tools/start_up.py [ROUNDS]`.

Prints a row a command: the least time of some rounds that take turns, times as long as its imports (click, numpy,
shapely, Pillow, as far as the job loads them), and the functions and files of ours that it runs.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PACKAGE = Path(__file__).parents[1] / "src/vorotool"
SAMPLES = PACKAGE / "samples"
JOBS = {
    "delaunay": ("six-seeds.csv", "-f", "csv"),
    "alphashape": ("dots.csv", "-f", "geojson"),
    "tessellate": ("six-seeds.csv", "-f", "npy"),
    "voronoi": ("shape.json", "-f", "csv"),
    "skeleton-exact": ("shape.json", "-f", "csv"),
    "skeleton-approx": ("shape.json", "-f", "csv", "--step", "20"),
}
LIBRARIES = ("click", "numpy", "shapely", "PIL")
COUNTED = """
import sys
found = set()
def look(frame, event, _):
    code = frame.f_code
    is_function = code.co_flags & 1 and code.co_name[0] != "<"  # bodies of classes and modules are not optimized
    if event == "call" and is_function and PACKAGE in code.co_filename:
        found.add((code.co_filename, code.co_qualname))
from vorotool.cli.main import main
sys.setprofile(look)
try:
    main(ARGUMENTS)
except SystemExit:
    pass
sys.setprofile(None)
print(len(found), len({name for name, _ in found}), *(name for name in LIBRARIES if name in sys.modules))
"""


def seconds(*command: str) -> float:
    """Run a command that succeeds."""
    begin = time.perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return time.perf_counter() - begin


def counted(arguments: list[str]) -> tuple[int, int, str]:
    """Count the functions of ours that a job runs, not bodies of classes and modules, their files, what it loads."""
    text = f"PACKAGE, ARGUMENTS, LIBRARIES = {str(PACKAGE)!r}, {arguments!r}, {LIBRARIES!r}\n{COUNTED}"
    done = subprocess.run([sys.executable, "-c", text], check=True, capture_output=True, text=True)
    functions, files, *loaded = done.stdout.splitlines()[-1].split()
    return int(functions), int(files), ", ".join(loaded)


def main() -> None:
    """Measure all commands in turns."""
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 7
    with tempfile.TemporaryDirectory() as folder:
        jobs = {
            command: [command, str(SAMPLES / name), *options, "-q", "-o", f"{folder}/out"]
            for command, (name, *options) in JOBS.items()
        }
        jobs["--help"] = ["delaunay", "--help"]
        facts = {name: counted(arguments) for name, arguments in jobs.items()}
        timed = {loaded: ["-c", f"import {loaded}"] for _, _, loaded in facts.values()}
        timed |= {name: ["-m", "vorotool", *arguments] for name, arguments in jobs.items()}
        times: dict[str, list[float]] = {name: [] for name in timed}
        for _ in range(rounds):
            for name, arguments in timed.items():
                times[name].append(seconds(sys.executable, *arguments))
        sys.stdout.write(f"{'job':16} {'ms':>5} {'times':>6} {'functions':>10} {'files':>6}  imports\n")
        for name, (functions, files, loaded) in facts.items():
            least = min(times[name])
            ratio = least / min(times[loaded])
            sys.stdout.write(f"{name:16} {least * 1e3:5.0f} {ratio:6.2f} {functions:10} {files:6}  {loaded}\n")


if __name__ == "__main__":
    main()
