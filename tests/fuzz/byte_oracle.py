"""What must hold of every input, however damaged: it is read, or refused with a message."""

import contextlib
import io
import math
import os
import random
import shutil
import sys
import traceback
import warnings
from pathlib import Path

import numpy as np

import vorotool
from fuzz.byte_seeds import Bundle
from support.readers.sources import bands_of
from vorotool.cli.main import main
from vorotool.types.images import Raster

LIMITS = {"max_pixels": 2**16, "max_sites": 2**14, "threads": 1}
LONGEST = 2**22
"""Pixels of an image that a command is given: one that passes by in bands may have any number, and takes its time."""

READ, REFUSED, LIMIT, WRONG = "read", "refused", "limit", "wrong"
VOLUMES = {"ome-tiff", "ome-zarr"}
IMAGES = {"png", "tiff", "npy", "pnm", "zarr", "jpeg", "bmp", "gif", "webp", "avif", *VOLUMES}
SHAPES = {"json", "geojson", "wkt", "poly", "skeleton", "voronoi", "svg", "dxf"}
COMMANDS = {
    "images": (
        ["tessellate", "{}", "-o", "out.npy"],
        ["draw", "{}", "-o", "out.svg"],
        ["skeleton-exact", "{}", "-o", "out.json"],
    ),
    "volumes": (
        ["tessellate", "--volume", "{}", "-o", "out.npy"],
        ["info", "{}"],
        ["tessellate", "{}", "-o", "out.tif"],
    ),
    "points": (["tessellate", "{}", "-o", "out.tif", "--size", "40x30"], ["delaunay", "{}", "-o", "out.geojson"]),
    "shapes": (
        ["skeleton-exact", "{}", "-o", "out.geojson"],
        ["voronoi", "{}", "-o", "out.json"],
        ["draw", "{}", "-o", "out.svg"],
    ),
}
BATCH = ["tessellate", "in", "--out-dir", "out", "-f", "npy", "--size", "6x5", "-q", "-j", "1"]


def write_bundle(bundle: Bundle, folder: Path) -> Path:
    """Put the files of an input in an empty folder; the path to read."""
    for name, data in bundle.files.items():
        path = folder / name
        with contextlib.suppress(OSError, ValueError):  # a chunk named like a folder of chunks
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
    return folder / bundle.name


def judge_reading(path: Path, kind: str, chance: random.Random) -> tuple[str, str]:
    """Read a file in one of the ways in which it can be read; the outcome, and what is wrong."""
    options: dict[str, object] = dict(LIMITS)
    if chance.random() < 0.3:
        options["geometry"] = chance.choice(("points", "polygons"))
    if kind == "tiff" and chance.random() < 0.5:
        options["page"] = 0
    if kind in VOLUMES:
        volume = {"max_pixels": LIMITS["max_pixels"], "geometry": "volume"}
        options = volume if chance.random() < 0.7 else LIMITS | {"page": 0}
    if kind in ("csv", "npy") and chance.random() < 0.2:
        options["columns"] = chance.choice(("1,2", "x,y", "2,1,3"))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            value = vorotool.read(path, **options)
            if kind in ("tiff", "zarr") or (kind in VOLUMES and isinstance(value, Raster)):
                _check_rows(path, value.values, options.get("page"))
    except vorotool.VorotoolError as error:
        return (
            (LIMIT, "") if error.exit_code == 5 else (WRONG, _place(error)) if error.exit_code == 1 else (REFUSED, "")
        )
    except BaseException as error:  # all others are what is looked for
        return WRONG, _place(error)
    return READ, ""


def _check_rows(path: Path, values: np.ndarray, page: object) -> None:
    rows = bands_of(path, page=page)
    if rows is None or values.ndim != 2:
        return
    height = rows.shape[0]
    bands = [rows.rows(first, min(5, height - first)) for first in range(0, height, 5)]
    if not np.array_equal(np.concatenate(bands), values, equal_nan=values.dtype.kind == "f"):
        raise AssertionError("bands of rows differ from the image that is read whole")


def judge_command(path: Path, kind: str, chance: random.Random) -> tuple[str, str]:
    """Give a file to a command in a folder of its own; the outcome, and what is wrong."""
    key = "images" if kind in IMAGES else "shapes" if kind in SHAPES and chance.random() < 0.7 else "points"
    key = "volumes" if kind in VOLUMES else key
    command = [word.format(path.name) for word in chance.choice(COMMANDS[key])]
    limits = ["--max-pixels", "65536"] * ("draw" not in command)
    limits += ["--max-sites", "2000"] * (command[0] not in ("draw", "info"))
    before = set(os.listdir(path.parent))  # noqa: PTH208
    code, said = run_command([*command, *limits, *["-q"] * ("info" not in command)], path.parent)
    if code not in (0, 2, 3, 5) or "Traceback" in said:
        return WRONG, f"{' '.join(command)}: exit {code}: {said[-1500:]}"
    made = set(os.listdir(path.parent)) - before  # noqa: PTH208
    if any(name.startswith(".") for name in made) or (code and made):
        return WRONG, f"{' '.join(command)}: exit {code} leaves {sorted(made)}"
    if code and "error:" not in said:
        return WRONG, f"{' '.join(command)}: exit {code} without a message"
    return (LIMIT if code == 5 else REFUSED if code else READ), ""


def batch_of_two(folder: Path) -> Path:
    """Run a batch; its manifest."""
    (folder / "in").mkdir()
    for name in ("a.csv", "b.csv"):
        (folder / "in" / name).write_text("1,2\n3,4\n5,1\n")
    run_command(BATCH, folder)
    return next((folder / "out").glob("*.jsonl"))


def judge_manifest(data: bytes, folder: Path, chance: random.Random) -> tuple[str, str]:
    """Resume a batch of two inputs by a manifest that is damaged."""
    batch_of_two(folder).write_bytes(data)
    (folder / "keep-1.tmp").write_text("mine")
    code, said = run_command([*BATCH, "--resume"], folder)
    left = list(folder.rglob(".vorotool-*.tmp"))
    if code not in (0, 2, 3, 4) or "Traceback" in said or left or not (folder / "keep-1.tmp").exists():
        return WRONG, f"--resume: exit {code}, left {left}: {said[-1500:]}"
    return (REFUSED if code else READ), ""


def run_command(arguments: list[str], folder: Path) -> tuple[object, str]:
    """Run a command in this process; its exit code, and what it says."""
    said, hook, before = io.TextIOWrapper(io.BytesIO(), "utf-8", write_through=True), sys.unraisablehook, Path.cwd()
    os.chdir(folder)
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said), warnings.catch_warnings():
            main([*arguments, "--threads", "1"])
    except SystemExit as end:
        return end.code, _text(said)
    except BaseException:  # which nothing should let through
        return None, _text(said) + traceback.format_exc()
    finally:
        sys.unraisablehook = hook
        os.chdir(before)


def _text(written: io.TextIOWrapper) -> str:
    return written.buffer.getvalue().decode("utf-8", "replace")


def judge(bundle: Bundle, folder: Path, chance: random.Random, commands: float) -> tuple[str, str]:
    """Judge one input in a folder, which is emptied then."""
    try:
        if bundle.kind == "manifest":
            return judge_manifest(bundle.files[bundle.name], folder, chance)
        path = write_bundle(bundle, folder)
        if chance.random() < commands and _pixels_that_pass_by(path) <= LONGEST:
            return judge_command(path, bundle.kind, chance)
        return judge_reading(path, bundle.kind, chance)
    finally:
        for entry in os.scandir(folder):
            shutil.rmtree(entry.path) if entry.is_dir() else os.unlink(entry.path)  # noqa: PTH108


def _pixels_that_pass_by(path: Path) -> int:
    """Pixels of an image that is read in bands, of which there may be more than memory holds; 0 of all else."""
    with contextlib.suppress(vorotool.VorotoolError):
        if (rows := bands_of(path)) is not None:
            return math.prod(rows.shape)
    return 0


def _place(error: BaseException) -> str:
    return "".join(traceback.format_exception(error))[-2500:]
