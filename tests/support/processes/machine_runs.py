"""The same commands as on other machines: each setting is a process of its own that gives a digest of every output.

A machine is told to a process by its environment: which vector instructions numpy, the linear algebra, the C library
and the core may use, and the seed of hashes. The number of threads is an option of the commands.
"""

import argparse
import hashlib
import io
import json
import os
import random
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import chdir, redirect_stderr
from dataclasses import dataclass, field
from pathlib import Path

DATA = Path(__file__).parents[3] / "data"

OF_RUN = frozenset({"seconds", "simd", "threads"})
"""What statistics say of the run and not of the result."""


@dataclass(frozen=True)
class Setting:
    """What stands for a machine: variables of the environment, and a number of threads."""

    name: str
    variables: dict[str, str] = field(default_factory=dict)
    threads: int = 1


def numpy_levels() -> list[str]:
    """Give the vector instructions that numpy can leave out here, beginning with the widest: each list one longer."""
    from numpy._core import _multiarray_umath as built

    there = [name for name in built.__cpu_dispatch__ if built.__cpu_features__[name]]
    return [" ".join(there[k:]) for k in reversed(range(len(there)))]


def factors() -> dict[str, list[dict[str, str]]]:
    """Give for each part of a machine what its variables may be; nothing comes first.

    The C library of another system knows none of the names that are told to it, and the linear algebra of another
    build none of the kernels: these settings are then the usual one again.
    """
    from vorotool import _core
    from vorotool.engines.tessellation.frames import SIMD_LEVELS

    narrow = ["AVX512F", "AVX512VL", "AVX512BW", "AVX512DQ", "FMA", "FMA4", "AVX2", "AVX"]
    wide = SIMD_LEVELS[: SIMD_LEVELS.index(_core.tessellation.widest_simd()) + 1]
    return {
        "numpy": [{}, *({"NPY_DISABLE_CPU_FEATURES": level} for level in numpy_levels())],
        "linear algebra": [{}, *({"OPENBLAS_CORETYPE": name} for name in ("Haswell", "Nehalem", "Prescott"))],
        "C library": [
            {},
            *(
                {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=" + ",".join(f"-{name},-{name}_Usable" for name in names)}
                for names in (narrow[:4], narrow)
            ),
        ],
        "core": [{}, *({"VOROTOOL_SIMD": level} for level in wide)],
        "hashes": [{"PYTHONHASHSEED": seed} for seed in ("0", "1", "2")],
    }


def narrowest() -> Setting:
    """The least machine that there is in this one."""
    variables: dict[str, str] = {}
    for name, values in factors().items():
        variables |= values[1] if name == "core" else values[-1]
    return Setting("narrowest", variables, threads=2)


def settings() -> list[Setting]:
    """Give this machine as it is, each part changed alone, two threads, and all parts at their narrowest."""
    usual = {name: values[0] for name, values in factors().items()}
    made = [Setting("usual", _joined(usual)), Setting("two threads", _joined(usual), threads=2)]
    for name, values in factors().items():
        made += [Setting(f"{name}: {_named(value)}", _joined({**usual, name: value})) for value in values[1:]]
    return [*made, narrowest()]


def drawn_setting(rng: random.Random) -> Setting:
    """Draw a value for each part of a machine."""
    chosen = {name: rng.choice(values) for name, values in factors().items()}
    threads = rng.choice((1, 2, 3, 8))
    named = [f"{name}: {_named(value)}" for name, value in chosen.items() if value]
    return Setting(", ".join([*named, f"{threads} threads"]), _joined(chosen), threads)


def _joined(chosen: dict[str, dict[str, str]]) -> dict[str, str]:
    return {variable: text for value in chosen.values() for variable, text in value.items()}


def _named(value: dict[str, str]) -> str:
    return "; ".join(f"{variable}={text}" for variable, text in value.items())


def run(setting: Setting, commands: Iterable[str]) -> dict[str, str]:
    """Give the exit code and the digest of each command under a setting."""
    parts = {variable for values in factors().values() for value in values for variable in value}
    usual = {name: text for name, text in os.environ.items() if name not in parts}
    done = subprocess.run(
        [sys.executable, "-W", "ignore", __file__, f"--threads={setting.threads}"],
        env={**usual, **setting.variables},
        input="\n".join(commands),
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    results = (line.split(" ", 2) for line in done.stdout.splitlines())
    return {command: f"{code} {digest}" for code, digest, command in results}


def differences(usual: dict[str, str], other: dict[str, str]) -> list[str]:
    """Give the commands whose digests differ."""
    assert usual.keys() == other.keys()
    return [command for command, digest in usual.items() if other[command] != digest]


# ---- the commands -----------------------------------------------------------------------------------------------


def smoke() -> Iterator[str]:
    """Give a few commands, of each kind of arithmetic that there is."""
    yield "skeleton-exact great-lakes.geojson --what branches -f csv"
    yield "skeleton-exact great-lakes.geojson -f geojson"
    yield "skeleton-exact great-lakes.geojson --what table,transects --every 0.5 -f csv"
    yield "skeleton-exact great-lakes.geojson --what offset -d 0.1,-0.1 -f csv"
    yield "skeleton-exact two-shapes.json --what shape -f wkt"
    yield "skeleton-exact two-shapes.json --gap 2 -f json"
    yield "skeleton-exact blobs.png -f svg"
    yield "skeleton-approx two-shapes.json --step 4 --compare -f json"
    yield "skeleton-approx two-shapes.json --tolerance 0.5 --what branches -f csv"
    yield "delaunay points.csv --what cells -f geojson"
    yield "delaunay points.csv --what cells,table --clip area.json -f csv"
    yield "alphashape points.csv -r 30 --what hull -f geojson"
    yield "alphashape points.csv -r 30 --what hull,table,curves,family -f csv"
    yield "alphashape points.csv -r 30 --what hull,curves -f svg"
    yield "tessellate color.ppm --threshold otsu --what table -f csv"
    yield "tessellate points.csv --size 300x200 --what distance -f npy"
    yield "tessellate points.csv --size 300x200 --what table,neighbors -f csv"
    yield "draw great-lakes.geojson -f png"


def whole() -> Iterator[str]:
    """Give each product of each command in each of its formats, and the options that calculate."""
    from vorotool.products.registry import OF_SPACE, formats_of

    yield from smoke()
    for source in ("points.csv", "cells.png"):
        frame = "" if source == "cells.png" else " --size 300x200"
        yield from _products(f"tessellate {source}{frame}", formats_of("tessellate"))
        yield from _products(f"tessellate {source}{frame} --max-distance 7.3 --pixel-size 0.325um", {"table": ("csv",)})
        meshes = _without_results(formats_of("delaunay"), "compare", *_of_space_alone("delaunay"))
        yield from _products(f"delaunay {source}", meshes)
        yield from _products(f"delaunay {source} --pixel-size 0.325um", _without(meshes, "svg", "png"))
        yield from _products(f"delaunay {source} --clip area.json", {"cells": formats_of("delaunay")["cells"]})
        for radius in ("-r 12.5", "-r 30", "--auto"):
            shapes = _without_results(formats_of("alphashape"), *_of_space_alone("alphashape"))
            yield from _products(f"alphashape {source} {radius}", shapes)
    for command, more in (("delaunay", ""), ("alphashape", " -r 90"), ("alphashape", " --auto")):
        in_space = {what: product.formats for what, product in OF_SPACE[command].items()}
        yield from _products(f"{command} space.csv --space{more}", in_space)
    yield from _products("delaunay points.csv --size 300x200", {"compare": formats_of("delaunay")["compare"]})
    for source in ("great-lakes.geojson", "two-shapes.json", "segments.wkt", "blobs.png", "cells.png"):
        yield from _skeletons(source, formats_of("skeleton-exact"), formats_of("skeleton-approx"))
    for source in ("cells.png", "great-lakes.geojson", "segments.wkt"):
        yield from (f"draw {source} -f {fmt}" for fmt in ("svg", "png"))


def _skeletons(
    source: str, formats: dict[str, tuple[str, ...]], of_samples: dict[str, tuple[str, ...]]
) -> Iterator[str]:
    extent = {"great-lakes.geojson": 15.0, "two-shapes.json": 200.0, "segments.wkt": 150.0}.get(source, 300.0)
    step, inner, outer = extent / 30, extent / 200, extent / 15
    more = {
        "offset": f" -d {inner:g},-{inner:g},{outer:g}",
        "points": f" --every {step:g}",
        "transects": f" --every {step:g}",
    }
    yield from _products(f"skeleton-exact {source}", formats, more)
    yield from _products(f"skeleton-exact {source} --side both", {"skeleton": ("json", "geojson"), "table": ("csv",)})
    for criterion in ("angle=60", f"chord={step:g}", "scale=1.4", f"length={step:g}", "ratio=2"):
        pruned = {"skeleton": ("json",), "branches": ("csv",), "shape": ("wkt",)}
        yield from _products(f"skeleton-exact {source} --prune {criterion}", pruned)
    if source != "great-lakes.geojson":
        some = _without(of_samples, "png", "html")
        yield from _products(f"skeleton-approx {source} --step {step:g} --compare", some, more)
        yield from _products(f"skeleton-approx {source} --tolerance {inner:g}", {"skeleton": ("json",)})
    if source.endswith(".json"):
        yield from _products(f"skeleton-exact {source} --gap 2", {"skeleton": ("json",), "elements": ("csv", "svg")})
        yield from _products(f"skeleton-exact {source} --gap 2 --no-complete", {"skeleton": ("json",)})
    yield from _products(f"skeleton-exact {source} --simplify {inner / 4:g}", {"skeleton": ("json",)})


def _of_space_alone(command: str) -> set[str]:
    """Give the results that there are of points in space only."""
    from vorotool.products.options.rules import NEEDING

    rules = (each for each in NEEDING if command in each.commands.split() and "?is_of_space" in each.others.split())
    return {condition[5:] for rule in rules for condition in rule.these.split() if condition.startswith("what:")}


def _without_results(formats: dict[str, tuple[str, ...]], *names: str) -> dict[str, tuple[str, ...]]:
    return {what: own for what, own in formats.items() if what not in names}


def _without(formats: dict[str, tuple[str, ...]], *names: str) -> dict[str, tuple[str, ...]]:
    return {what: tuple(fmt for fmt in own if fmt not in names) for what, own in formats.items()}


def _products(begin: str, formats: dict[str, tuple[str, ...]], more: dict[str, str] | None = None) -> Iterator[str]:
    for what, own in formats.items():
        for fmt in own:
            yield f"{begin} --what {what}{(more or {}).get(what, '')} -f {fmt}"


def make_inputs(folder: Path) -> None:
    """Put what no file of the data has beside copies of these: fractions, and colors that are near to one grey."""
    for path in DATA.iterdir():
        (folder / path.name).symlink_to(path)
    draw = random.Random(15)
    rows = [f"{300 * draw.random()!r},{200 * draw.random()!r}" for _ in range(400)]
    (folder / "points.csv").write_text("\n".join(["x,y", *rows, ""]))
    rows = [f"{300 * draw.random()!r},{200 * draw.random()!r},{100 * draw.random()!r}" for _ in range(60)]
    (folder / "space.csv").write_text("\n".join(["x,y,z", *rows, ""]))
    area = [[20.25, 10.5], [280.1, 30.7], [240.3, 190.9], [90.6, 120.2], [10.4, 180.8]]
    (folder / "area.json").write_text(json.dumps(area))
    pixels = bytes(draw.randrange(256) for _ in range(3 * 120 * 80))
    (folder / "color.ppm").write_bytes(b"P6 120 80 255\n" + pixels)


def digest(command: str, folder: Path, threads: int) -> str:
    """Run a command in this process: its exit code, and a digest of what it writes, says and counts."""
    from vorotool.cli.main import main

    words = command.split()
    several = "," in command.partition("--what ")[2].partition(" ")[0]
    messages, out = io.StringIO(), folder / "out"
    out.mkdir()
    target = ["--out-dir", "out"] if several or "zarr" in words else ["-o", "out/result." + words[-1]]
    options = [] if words[0] == "draw" else ["--stats", "stats.json"]
    try:
        with redirect_stderr(messages):
            main([*words, *target, *options, "--threads", str(threads)])
    except SystemExit as end:
        code = end.code
    found = hashlib.sha256(messages.getvalue().encode())
    for path in sorted(path for path in out.rglob("*") if path.is_file()):
        found.update(path.relative_to(out).as_posix().encode() + b"\0" + path.read_bytes())
        path.unlink()
    _remove(out)
    if (stats := folder / "stats.json").exists():
        counts = json.loads(stats.read_text())
        found.update(json.dumps({key: value for key, value in counts.items() if key not in OF_RUN}).encode())
        stats.unlink()
    return f"{code} {found.hexdigest()}"


def _remove(folder: Path) -> None:
    for path in folder.iterdir():
        _remove(path)
    folder.rmdir()


def _main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--threads", type=int, default=1)
    arguments = parser.parse_args()
    commands = sys.stdin.read().splitlines()
    with tempfile.TemporaryDirectory() as name, chdir(name):
        folder = Path(name)
        make_inputs(folder)
        for command in commands:
            sys.stdout.write(f"{digest(command, folder, arguments.threads)} {command}\n")


if __name__ == "__main__":
    _main()
