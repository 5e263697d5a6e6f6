"""Writing places along skeletons, and the segments between their feet."""

from __future__ import annotations

from typing import Any, BinaryIO

import numpy as np

from vorotool.formats.io.npy_arrays import write_array
from vorotool.formats.text.feature_collection import write_collection
from vorotool.formats.text.row_writer import Column, RowShape, write_rows
from vorotool.formats.text.tables import json_text, write_table
from vorotool.geometry.polygons.polygon_set import PolygonSet
from vorotool.geometry.skeleton.points_along import SkeletonPoints
from vorotool.geometry.skeleton.skeleton import SIDES
from vorotool.geometry.table import Lookup
from vorotool.products.formats import TABLES


def write_skeleton_points(
    out: BinaryIO,
    points: SkeletonPoints,
    fmt: str,
    *,
    what: str = "points",
    precision: int | None = None,
    threads: int = 0,
) -> None:
    """Write a row or a feature a point, or a transect: the segment between its two feet, none in a corner."""
    points = (points.transects() if what == "transects" else points).as_given
    if fmt == "npy":
        write_array(out, points.xy)
        return
    if fmt in TABLES:
        write_table(out, points.table(), fmt, precision=precision, threads=threads)
        return
    places = points.xy if what == "points" else points.feet.reshape(-1, 4)
    coordinates = [Column.of_places(values) for values in places.T]
    if fmt == "wkt":
        around = ("POINT (", " ", ")\n") if what == "points" else ("LINESTRING (", " ", ", ", " ", ")\n")
        write_rows(out, coordinates, RowShape(around), precision=precision, threads=threads)
    else:
        _write_geojson(out, points, coordinates, precision, threads)


def _write_geojson(
    out: BinaryIO, points: SkeletonPoints, coordinates: list[Column], precision: int | None, threads: int
) -> None:
    skeleton = points.skeleton
    polygons, side = skeleton.polygons, skeleton.side[points.arc]
    rings = {} if points.rings is None else dict(zip(("ring_a", "ring_b"), points.rings.T, strict=True))
    most = 1 + max((int(ring.max(initial=-1)) for ring in rings.values()), default=-1)
    own = {name: f"voro_{name}" if name in polygons.properties else name for name in (*_OWN, *rings)}
    columns: list[Any] = [
        Lookup(_openings(polygons, own["polygon"]), points.polygon % (len(polygons) + 1)),
        skeleton.branch[points.arc].astype(np.int64),
        points.along,
        points.radius,
        points.width,
        Lookup([f'"{name}"' for name in SIDES] + ["null"], np.where(side < 0, len(SIDES), side).astype(np.int32)),
        *(Lookup([*map(str, range(most)), "null"], ring % (most + 1)) for ring in rings.values()),
    ]
    between: tuple[str, ...] = (",",)
    kind, after = "Point", "]}}"
    if len(coordinates) > 2:
        kind, between, after = "LineString", (",", "],[", ","), "]]}}"
    names = [f',"{own[name]}":' for name in [*_OWN, *rings][1:]]
    opening = f'}},"geometry":{{"type":"{kind}","coordinates":{"[" * (len(coordinates) // 2)}'
    shape = RowShape(("", *names, opening, *between, after), ",\n", "null")
    rows = [*(Column("", values) for values in columns), *coordinates]
    write_collection(out, rows, shape, crs=polygons.crs, precision=precision, threads=threads)


_OWN = ("polygon", "branch", "along", "r", "width", "side")


def _openings(polygons: PolygonSet, name: str) -> list[str]:
    """The beginning of a feature in each polygon, and of one in none."""
    texts = []
    for index in (*range(len(polygons)), None):
        identity = None if index is None or polygons.ids is None else polygons.ids[index]
        named = "" if identity is None else f'"id":{json_text(identity)},'
        given = {} if index is None else {key: values[index] for key, values in polygons.properties.items()}
        texts.append(f'{{"type":"Feature",{named}"properties":{json_text({**given, name: index}).removesuffix("}")}')
    return texts
