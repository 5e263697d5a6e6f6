"""Each room of the core includes from rooms that are listed before it, and its namespace is its folder."""

import re
from pathlib import Path

import pytest

from support.readers.arrows import arrows_of

CORE = Path(__file__).parents[2] / "src" / "core"
ROOMS_BELOW = arrows_of("""
base ->
numbers ->
compression -> base
graphs -> base
kernel -> base, numbers
label_images -> base
alpha -> base, kernel, numbers
arrangement -> base, kernel, numbers
segment_voronoi/discs -> kernel, numbers
spatial -> base, kernel, numbers
text -> base, kernel
delaunay -> base, kernel, numbers, spatial
tessellation -> base, numbers, spatial
cells -> base, delaunay, kernel, numbers, spatial, text
digital -> base, delaunay, kernel, label_images, numbers, tessellation
segment_voronoi/build -> base, delaunay, kernel, numbers, segment_voronoi/discs, spatial
segment_voronoi/verify -> base, kernel, numbers, segment_voronoi/build, segment_voronoi/discs, spatial
skeleton -> base, kernel, numbers, segment_voronoi/build, segment_voronoi/discs
offsets -> base, graphs, kernel, numbers, segment_voronoi/build, skeleton
pruning -> base, graphs, kernel, numbers, skeleton
sampled_skeleton -> base, delaunay, kernel, numbers, segment_voronoi/build, skeleton, spatial
voronoi -> base, kernel, segment_voronoi/build, skeleton
volumes -> base, label_images, numbers, spatial, tessellation
proximity -> alpha, base, delaunay, kernel
distances -> base, kernel
thickness -> base, kernel, pruning, skeleton
""")
"""What each room includes, after all that it may include."""

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
