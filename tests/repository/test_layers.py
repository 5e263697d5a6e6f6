"""Imports run downwards only, and heavy modules are loaded only where they are needed."""

import ast
from pathlib import Path

import pytest

from support.readers.arrows import arrows_of

PACKAGE = Path(__file__).parents[2] / "src" / "vorotool"
ARROWS = """
formats/compression ->
products ->
geometry -> products
formats/io -> formats/compression, geometry
geometry/points -> geometry
geometry/polygons -> geometry
geometry/curves -> geometry
formats/parsing -> formats/io, geometry, geometry/curves, geometry/points, geometry/polygons
formats/points -> formats/io, formats/parsing, geometry, geometry/curves, geometry/points
render/canvas -> geometry, geometry/curves, products
render/label_images -> geometry, geometry/points, products, render/canvas
render ->
geometry/volumes -> geometry, geometry/points
geometry/arguments -> geometry, geometry/curves, geometry/points, geometry/polygons, geometry/volumes, products
formats/zarr -> formats/compression, formats/io, geometry, geometry/volumes
formats/images -> formats/compression, formats/io, formats/parsing, formats/zarr, geometry, geometry/points
geometry/mesh -> geometry, geometry/arguments, geometry/curves, products
geometry/voronoi -> geometry, geometry/curves, geometry/mesh, geometry/polygons, products
formats/written -> geometry, geometry/mesh, geometry/polygons
geometry/skeleton -> geometry, geometry/arguments, geometry/curves, geometry/polygons
typing -> geometry, geometry/mesh, geometry/points, geometry/polygons, geometry/skeleton, geometry/volumes
engines/arrangement -> geometry, geometry/arguments, geometry/curves, geometry/polygons, geometry/skeleton, typing
engines/delaunay -> geometry, geometry/arguments, geometry/curves, geometry/mesh, geometry/points, products, typing
engines/segment_voronoi -> geometry, geometry/polygons, geometry/skeleton
formats/text -> geometry, geometry/skeleton
formats/features -> formats/io, formats/parsing, formats/points, formats/text, geometry, geometry/arguments,
    geometry/curves, geometry/points, geometry/polygons, products
geometry/alpha -> geometry, geometry/curves, geometry/mesh, geometry/polygons
formats/drawing -> formats/compression, formats/io, formats/parsing, geometry, geometry/alpha, geometry/curves,
    geometry/polygons, geometry/skeleton, products
engines/alpha -> engines/delaunay, geometry, geometry/alpha, geometry/arguments, geometry/curves, geometry/mesh,
    geometry/points, geometry/polygons, typing
engines/features -> engines/arrangement, geometry, geometry/polygons, geometry/skeleton
formats/polygons -> formats/io, formats/parsing, formats/points, formats/text, formats/written, geometry,
    geometry/arguments, geometry/curves, geometry/polygons, products
render/pages -> geometry, geometry/alpha, geometry/curves, geometry/mesh, geometry/skeleton, geometry/voronoi, products,
    render/canvas, render/label_images
formats -> formats/drawing, formats/features, formats/images, formats/io, formats/parsing, formats/points,
    formats/polygons, geometry, geometry/arguments, geometry/points, geometry/polygons, geometry/skeleton,
    geometry/volumes, geometry/voronoi, products
formats/volumes -> formats, formats/images, formats/io, formats/parsing, formats/points, formats/zarr, geometry,
    geometry/volumes, products
engines/smoothing -> geometry, geometry/arguments, geometry/curves, geometry/skeleton
geometry/distances -> geometry, geometry/polygons
formats/results -> formats/images, formats/io, formats/parsing, formats/polygons, formats/text, formats/written,
    geometry, geometry/alpha, geometry/arguments, geometry/curves, geometry/distances, geometry/mesh, geometry/polygons,
    geometry/skeleton, geometry/voronoi, products
geometry/any -> geometry, geometry/alpha, geometry/distances, geometry/mesh, geometry/points,
    geometry/polygons, geometry/skeleton, geometry/volumes, geometry/voronoi, products
engines/common -> geometry, geometry/any
engines/tessellation -> engines/common, geometry, geometry/arguments, geometry/curves, geometry/points,
    geometry/polygons, geometry/volumes, products, typing
engines/skeleton -> engines/arrangement, engines/common, engines/features, engines/segment_voronoi, geometry,
    geometry/arguments, geometry/curves, geometry/polygons, geometry/skeleton
engines/offsets -> engines/arrangement, engines/common, engines/features, engines/segment_voronoi, engines/skeleton,
    geometry, geometry/arguments, geometry/curves, geometry/polygons, geometry/skeleton, typing
engines/pruning -> engines/common, engines/skeleton, geometry, geometry/arguments, geometry/curves, geometry/skeleton,
    typing
engines/sampled_skeleton -> engines/arrangement, engines/common, engines/features, engines/segment_voronoi,
    engines/skeleton, geometry, geometry/curves, geometry/polygons, geometry/skeleton
batch -> engines/tessellation, formats, formats/io, formats/text, formats/zarr
engines -> engines/sampled_skeleton, engines/skeleton, geometry, geometry/arguments, geometry/skeleton, typing
engines/from_skeleton -> engines, engines/arrangement, engines/common, engines/skeleton, geometry, geometry/arguments,
    geometry/curves, geometry/polygons, geometry/skeleton, typing
engines/centerlines -> engines/common, engines/from_skeleton, engines/pruning, engines/skeleton, geometry,
    geometry/arguments, geometry/polygons, geometry/skeleton, typing
engines/voronoi -> engines/arrangement, engines/common, engines/segment_voronoi, engines/skeleton, geometry,
    geometry/arguments, geometry/curves, geometry/polygons, geometry/skeleton, geometry/voronoi, typing
engines/label_images -> engines/common, engines/tessellation, geometry, geometry/arguments, geometry/points,
    geometry/polygons, products, typing
engines/digital -> engines/common, engines/delaunay, engines/label_images, engines/tessellation, geometry, geometry/any,
    geometry/arguments, geometry/curves, geometry/mesh, geometry/points, typing
engines/junctions -> engines/common, engines/pruning, engines/skeleton, geometry, geometry/arguments, geometry/skeleton
engines/distances -> engines/arrangement, engines/common, engines/segment_voronoi, geometry, geometry/arguments,
    geometry/curves, geometry/distances, geometry/polygons, geometry/skeleton
engines/necks -> engines, engines/arrangement, engines/common, engines/features, engines/from_skeleton,
    engines/skeleton, geometry, geometry/arguments, geometry/polygons, geometry/skeleton, typing
engines/volumes -> engines/common, engines/tessellation, geometry, geometry/arguments, geometry/volumes, typing
engines/peers -> engines, engines/delaunay, engines/from_skeleton, engines/label_images, engines/pruning,
    engines/tessellation, engines/volumes, geometry, geometry/arguments, geometry/mesh, geometry/points,
    geometry/volumes, typing
render/layers -> geometry, geometry/alpha, geometry/distances, geometry/mesh, geometry/polygons, geometry/skeleton,
    geometry/voronoi, render/canvas, render/label_images
jobs -> batch, engines/alpha, engines/arrangement, engines/centerlines, engines/delaunay, engines/digital,
    engines/distances, engines/from_skeleton, engines/label_images, engines/pruning, engines/tessellation,
    engines/voronoi, formats, formats/features, formats/images, formats/io, formats/parsing, formats/points,
    formats/text, formats/volumes, formats/zarr, geometry, geometry/alpha, geometry/any,
    geometry/arguments, geometry/curves, geometry/distances, geometry/mesh, geometry/points, geometry/polygons,
    geometry/skeleton, geometry/volumes, geometry/voronoi, products, render/canvas, render/label_images, render/layers,
    render/pages, typing
cli/options -> engines/offsets, engines/pruning, geometry, jobs, products
cli/batch -> batch, cli/options, formats/io, geometry, jobs, products
jobs/volumes -> engines/label_images, engines/tessellation, engines/volumes, formats/io, formats/volumes, formats/zarr,
    geometry, geometry/points, geometry/volumes, jobs, products, render/canvas, render/pages
jobs/skeletons -> engines, engines/centerlines, engines/features, engines/from_skeleton, engines/junctions,
    engines/necks, engines/offsets, engines/pruning, engines/sampled_skeleton, engines/segment_voronoi,
    engines/skeleton, engines/smoothing, formats/images, formats/io, geometry, geometry/polygons, geometry/skeleton,
    jobs, products, render/canvas, render/label_images, render/layers, render/pages
cli/commands -> cli/batch, cli/options, jobs, jobs/skeletons, jobs/volumes, products
cli -> cli/commands, jobs
"""
"""Rooms of the package from below, and what each may import; `errors` and `signals` are for all."""

FOR_ALL = {"errors", "signals"}
MAY_IMPORT_CORE = {"engines", "formats", "render"}


ALLOWED = arrows_of(ARROWS)
SOURCES = sorted(
    path for path in PACKAGE.rglob("*.py") if path.name not in ("__init__.py", "__main__.py") or path.parent != PACKAGE
)


def room_of(path):
    """A folder below the package, or a module that is beside the folders."""
    inner = path.relative_to(PACKAGE)
    return inner.stem if inner.parent == Path() else inner.parent.as_posix()


def is_compiled(name):
    return name.startswith("vorotool._core")


def room_named(name):
    """The room of what is imported by this name, module or package; None of what is not ours, or compiled."""
    parts = name.split(".")
    if parts[0] != "vorotool" or len(parts) == 1 or is_compiled(name):
        return None
    path = PACKAGE.joinpath(*parts[1:])
    if path.is_dir():
        return "/".join(parts[1:])
    return "/".join(parts[1:-1]) or parts[1] if path.with_suffix(".py").exists() else None


def imported_modules(path):
    """Names of modules and packages, those that are imported within functions too."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import"
            inner = [f"{node.module}.{alias.name}" for alias in node.names]
            modules = [name for name in inner if room_named(name) or is_compiled(name)]
            yield from modules
            if len(modules) < len(inner):
                yield node.module


def test_no_room_is_above_another_that_is_above_it():
    """Each imports from rooms that stand before it."""
    seen = set()
    for room, below in ALLOWED.items():
        assert below <= seen, f"{room} must not import {below - seen}"
        seen.add(room)


@pytest.mark.parametrize("path", SOURCES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_imports_follow_the_arrows(path):
    room = room_of(path)
    for name in imported_modules(path):
        if name == "click" or name.startswith("click."):
            assert room.partition("/")[0] == "cli", f"{path}: only the command line imports click"
        if is_compiled(name):
            assert name == "vorotool._core", f"{path}: import vorotool._core, and call its rooms by their names"
            assert room.partition("/")[0] in MAY_IMPORT_CORE, f"{path}: {room} must not import the compiled core"
            continue
        target = room_named(name)
        if target not in {None, room, *FOR_ALL}:
            assert target in ALLOWED[room], f"{path}: {room} must not import {name}"


def test_each_arrow_is_used():
    used = {room: set() for room in ALLOWED}
    for path in SOURCES:
        if (room := room_of(path)) in used:
            used[room] |= {room_named(name) for name in imported_modules(path)} - {None, room, *FOR_ALL}
    assert used == ALLOWED


def test_checkers_share_nothing_with_makers():
    """From a module that checks others take its checks alone: what both need is in a module of its own."""
    for path in SOURCES:
        if path.stem.startswith("verify_"):
            continue
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.module.rpartition(".")[2].startswith("verify_"):
                taken = [alias.name for alias in node.names if not alias.name.startswith("verify_")]
                assert not taken, f"{path} takes {taken} from {node.module}"
