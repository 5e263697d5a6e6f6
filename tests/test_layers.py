"""Imports run downwards only, and heavy modules are loaded only where they are needed."""

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "src" / "vorotool"
BELOW = {
    "errors": set(),
    "signals": set(),
    "geometry": {"errors"},
    "engines": {"errors", "geometry"},
    "formats": {"errors", "geometry"},
    "render": {"errors", "geometry"},
    "pictures": {"errors", "geometry", "engines", "formats", "render"},
    "writing": {"errors", "geometry", "engines", "formats", "render", "pictures"},
    "batch": {"errors", "geometry", "engines", "formats", "render", "pictures", "writing", "signals"},
    "cli": {"errors", "geometry", "engines", "formats", "render", "pictures", "writing", "batch", "signals"},
}
MAY_IMPORT_CORE = {"engines", "formats", "render"}


def imported_modules(path):
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import"
            yield node.module
            if node.module == "vorotool":
                yield from (f"vorotool.{alias.name}" for alias in node.names)


SOURCES = sorted(p for p in PACKAGE.rglob("*.py") if p.parent != PACKAGE or p.stem in BELOW)


@pytest.mark.parametrize("path", SOURCES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_imports_run_downwards(path):
    layer = path.relative_to(PACKAGE).parts[0].removesuffix(".py")
    for name in imported_modules(path):
        if name == "click" or name.startswith("click."):
            assert layer == "cli", f"{path}: only the command line imports click"
        if not name.startswith("vorotool."):
            continue
        target = name.split(".")[1]
        if target == "_core":
            assert layer in MAY_IMPORT_CORE, f"{path}: {layer} must not import the compiled core"
        elif target in BELOW:
            assert target == layer or target in BELOW[layer], f"{path}: {layer} must not import {target}"


@pytest.mark.parametrize(
    "arguments",
    [
        ["--help"],
        ["--version"],
        ["tessellate", "--help"],
        ["delaunay", "--help"],
        ["alphashape", "--help"],
        ["draw", "--help"],
    ],
)
def test_help_loads_no_heavy_module(arguments):
    script = (
        "import sys\n"
        "from vorotool.cli.main import main\n"
        "try:\n    main(sys.argv[1:])\n"
        "except SystemExit as end:\n"
        "    heavy = {'numpy', 'vorotool._core', 'PIL', 'skimage', 'shapely', 'orjson'} & set(sys.modules)\n"
        "    sys.exit(f'loaded {heavy}' if heavy or end.code else 0)\n"
    )
    done = subprocess.run([sys.executable, "-c", script, *arguments], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "Usage" in done.stdout or "version" in done.stdout


def test_importing_the_package_loads_no_heavy_module():
    script = "import sys, vorotool; sys.exit('numpy' in sys.modules or 'vorotool._core' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", script], check=False).returncode == 0


# Room by room, after all that it may include: what is listed below it is out of reach.
CORE = Path(__file__).parents[1] / "src" / "core"
ROOMS_BELOW = {
    "base": set(),
    "numbers": set(),
    "compression": {"base"},
    "graphs": {"base"},
    "kernel": {"numbers"},
    "label_images": {"base"},
    "alpha": {"base", "kernel", "numbers"},
    "arrangement": {"base", "kernel", "numbers"},
    "segment_voronoi/discs": {"kernel", "numbers"},
    "spatial": {"base", "kernel", "numbers"},
    "text": {"base", "kernel"},
    "delaunay": {"base", "kernel", "numbers", "spatial"},
    "tessellation": {"base", "numbers", "spatial"},
    "cells": {"base", "delaunay", "kernel", "numbers", "spatial", "text"},
    "digital": {"base", "delaunay", "kernel", "label_images", "numbers", "tessellation"},
    "segment_voronoi/build": {"base", "delaunay", "kernel", "numbers", "segment_voronoi/discs"},
    "segment_voronoi/verify": {
        "base",
        "kernel",
        "numbers",
        "segment_voronoi/build",
        "segment_voronoi/discs",
        "spatial",
    },
    "skeleton": {"base", "kernel", "segment_voronoi/build"},
    "offsets": {"base", "graphs", "kernel", "numbers", "segment_voronoi/build", "skeleton"},
    "pruning": {"base", "graphs", "numbers", "skeleton"},
    "sampled_skeleton": {
        "arrangement",
        "base",
        "delaunay",
        "kernel",
        "numbers",
        "segment_voronoi/build",
        "skeleton",
        "spatial",
    },
}
CORE_FILES = sorted(CORE.rglob("*.[ch]pp"))


def room_of(path):
    return str(path.relative_to(CORE).parent)


def included_rooms(path):
    text = path.read_text(encoding="utf-8")
    included = re.findall(r'^#include "([^"]+)"', text, re.MULTILINE)
    return {str(Path(name).relative_to("core").parent) for name in included}


def test_rooms_are_listed_after_what_they_include():
    rooms = list(ROOMS_BELOW)
    for room, below in ROOMS_BELOW.items():
        assert below <= set(rooms[: rooms.index(room)]), f"{room} includes what is listed after it"


def test_the_rooms_of_the_core_include_what_is_listed():
    found = {}
    for path in CORE_FILES:
        found.setdefault(room_of(path), set()).update(included_rooms(path) - {room_of(path)})
    assert found == ROOMS_BELOW


@pytest.mark.parametrize("path", CORE_FILES, ids=lambda p: str(p.relative_to(CORE)))
def test_the_namespace_of_a_core_file_is_its_folder(path):
    opened = re.findall(r"^namespace (vorotool\S*)", path.read_text(encoding="utf-8"), re.MULTILINE)
    assert opened == ["::".join(["vorotool", "core", *Path(room_of(path)).parts])]
