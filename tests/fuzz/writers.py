"""Every writer of the command line, run in forked processes of one that has imported everything: milliseconds a run."""

import gc
import json
import os
import signal
import sys
import traceback
from importlib import import_module
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # a process that forks must have no threads

import numpy as np

WRITERS = {
    "png": "tessellate points.csv --size 150x100 -o out.png",
    "tiff": "tessellate points.csv --size 150x100 -o out.tif",
    "npy": "tessellate points.csv --size 150x100 -o out.npy",
    "text": "tessellate points.csv --size 150x100 -o out.txt",
    "zarr": "tessellate points.csv --size 150x100 --chunk 64x64 -o out.zarr",
    "color png": "tessellate points.csv --size 150x100 --what color -o out.png",
    "picture png": "delaunay points.csv -f png -o out.png",
    "svg": "delaunay points.csv -o out.svg",
    "csv": "delaunay points.csv --what table -o out.csv",
    "json": "delaunay points.csv --what cells -o out.json",
    "geojson": "delaunay points.csv --what cells -o out.geojson",
    "npz": "delaunay points.csv --what triangles -o out.npz",
    "wkt": "delaunay points.csv --what cells -o out.wkt",
    "obj": "delaunay points.csv --what triangles -o out.obj",
    "node": "delaunay points.csv --what table -o out.node",
    "edge": "delaunay points.csv --what edges -o out.edge",
    "ele": "delaunay points.csv --what triangles -o out.ele",
    "html": "alphashape points.csv -o out.html",
    "graphml": "skeleton-exact shape.json -o out.graphml",
    "skeleton json": "skeleton-exact shape.json -o out.json",
    "poly": "skeleton-exact shape.json --what shape -o out.poly",
    "several": "delaunay points.csv --what edges,table,cells -o out.csv",
    "shp": "delaunay points.csv --what cells -o out.shp",
    "gpkg": "delaunay points.csv --what cells -o out.gpkg",
    "several shp": "delaunay points.csv --what cells,triangles -o out.shp --stats out.stats.json",
    "stats": "delaunay points.csv --what edges -o out.csv --stats out.stats.json",
    "table": "delaunay points.csv points-2.csv --table out.csv -j 1",
}
"""Commands by what they write; all outputs begin with ``out.``."""

ENDS = {signal.SIGKILL: -signal.SIGKILL, signal.SIGTERM: 143, signal.SIGINT: 130}
"""Exit codes of processes that got a signal."""

SENT = {signal.SIGTERM, signal.SIGINT}
"""Signals that a process can wait with."""

_IMPORTED = ("vorotool", "numpy", "zarr", "shapely", "orjson", "PIL", "skimage", "numcodecs", "pyogrio", "ezdxf")

VARYING = b'"seconds"'
"""Statistics tell seconds, which differ."""


def write_inputs(folder, number):
    """Inputs of all commands: some points, a shape, and a row of it."""
    chance = np.random.default_rng(number)
    folder.mkdir(parents=True, exist_ok=True)
    for name in ("points.csv", "points-2.csv"):
        rows = "\n".join(f"{x},{y}" for x, y in chance.integers(0, 100, (150, 2)))
        (folder / name).write_text(f"x,y\n{rows}\n")
    angles = np.sort(chance.uniform(0, 2 * np.pi, 40))
    radii = chance.integers(20, 50, 40)
    ring = np.column_stack([np.round(radii * np.cos(angles)), np.round(radii * np.sin(angles))])
    places = "\n".join(f"{x} {y} {z}" for x, y, z in chance.integers(0, 12, (60, 3)))
    (folder / "points.xyz").write_text(f"x y z\n{places}\n")
    np.save(folder / "image.npy", np.repeat(np.arange(60 * number, dtype=np.uint16)[:, None] % 97, 80, axis=1))
    (folder / "shape.json").write_text(json.dumps([ring.tolist()]))
    row = [{"shell": np.add(ring, [120 * k, 0]).tolist()} for k in range(4)]
    (folder / "shapes.json").write_text(json.dumps({"polygons": row}))


def run(folder, command, prepare=lambda: None, finish=lambda: None):
    """Start a command in a forked process, which begins with something else; its number."""
    sys.stdout.flush()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, SENT)  # an exception of the child would unwind what is ours
    number = os.fork()
    if number:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
        return number
    code = 70
    try:
        code = _in_child(folder, command, before, prepare, finish)
    finally:  # nothing that is the parent's is unwound, whatever comes
        os._exit(code)


def _in_child(folder, command, signals, prepare, finish):
    """Run a command in a folder with the signals of before; its exit code."""
    code = 70
    try:
        os.chdir(folder)
        with Path(os.devnull).open("rb") as nothing, (folder / "messages").open("wb") as messages:
            for descriptor, file in ((0, nothing), (1, messages), (2, messages)):
                os.dup2(file.fileno(), descriptor)
        signal.signal(signal.SIGINT, signal.default_int_handler)
        signal.pthread_sigmask(signal.SIG_SETMASK, signals)
        prepare()
        code = result(command)
        for each in (signal.SIGINT, signal.SIGTERM, signal.SIGALRM):  # what comes now comes too late
            signal.signal(each, signal.SIG_IGN)
        finish()
    except KeyboardInterrupt:
        code = 130
    except SystemExit as end:
        code = end.code
    except BaseException:
        traceback.print_exc()
    gc.collect()
    sys.stderr.flush()
    return code


def result(command):
    """Run a command in this process; its exit code."""
    from vorotool.cli.main import main

    try:
        main([*command.split(), *["-q"] * (not command.startswith("sample"))])
    except SystemExit as end:
        return end.code


def ended(number):
    """Wait for a process; its exit code, or the signal below 0."""
    return os.waitstatus_to_exitcode(os.waitpid(number, 0)[1])


def import_modules(scratch, commands, *, refused=False):
    """Import what commands import, without running one here: threads do not survive a fork."""
    write_inputs(scratch, 0)
    modules = scratch / "modules"
    for command in commands:
        code = ended(run(scratch, command, finish=lambda: modules.write_text("\n".join(sys.modules))))
        if code and not refused:
            raise RuntimeError(f"{command}: exit code {code}: {(scratch / 'messages').read_text()}")
        for name in modules.read_text().split("\n"):
            if name.startswith(_IMPORTED):
                import_module(name)


def outputs(folder):
    """Contents of the outputs by their names."""
    paths = [path for path in folder.rglob("*") if path.is_file() and path.relative_to(folder).parts[0][:4] == "out."]
    contents = {str(path.relative_to(folder)): path.read_bytes() for path in paths}
    return {name: data.partition(VARYING)[0] if ".stats" in name else data for name, data in contents.items()}


def leftovers(folder):
    """Temporaries."""
    return sorted(path.name for path in folder.rglob(".vorotool-*"))
