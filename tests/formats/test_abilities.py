"""What each format carries: each is written and read, and the table of that in the documents is what was found."""

from fractions import Fraction

import geopandas
import laspy
import numpy as np
import pyproj
import pytest
import shapely
from PIL import Image

import vorotool
from support.documents import ROOT
from vorotool.errors import UsageError
from vorotool.numeric.crs import crs_name, member_of_text
from vorotool.numeric.length_units import meters
from vorotool.numeric.numbers import NumberText
from vorotool.products.formats import FORMATS
from vorotool.products.inputs import INPUTS, NAMES_WITH, VOLUME_NAMES
from vorotool.types.pixels import PixelGrid, map_grid
from vorotool.types.polygons.polygon_set import PolygonSet

VERTICES = np.array([[0.1, 0], [4, 1 / 3], [0, 3], [10, 0], [14, 0], [10, 3.5]])
ATTRIBUTES = {"name": ["a", "b"], "code": ["007", "8"], "count": [3, -4], "depth": [0.5, 2.0]}
SYSTEM = member_of_text("EPSG:2056")
GEOGRAPHIC = ("kml", "gpx")
"""Formats of longitudes and latitudes alone, which are not written."""


SIZED = PixelGrid(Fraction(1, 2), Fraction(1, 2), "µm")
PLACED = map_grid((30.0, 0.0, 2600000.0, 0.0, -30.0, 1200000.0), unit="m", crs=SYSTEM)


def shapes():
    return PolygonSet(VERTICES, [0, 3, 6], [0, 0], [0, 1], y_axis="up", crs=SYSTEM, properties=ATTRIBUTES)


def values():
    """What may be written in a format, and which part of it."""
    mesh = vorotool.delaunay(vorotool.PointSet(VERTICES[:2], None, ATTRIBUTES, "up", SYSTEM))
    triangle = vorotool.delaunay(VERTICES[:3])
    skeleton = vorotool.skeleton_exact(VERTICES[:3])
    solid = vorotool.delaunay([[0, 0, 0], [4, 0, 0], [0, 3, 0], [0, 0, 2]])
    planar = ((mesh, "table"), (mesh, "edges"), (triangle, "triangles"), (skeleton, "skeleton"))
    return ((shapes(), None), *planar, (solid, None))


def made_elsewhere(fmt, path):
    """Write what vorotool reads alone."""
    if fmt == "kml":
        places = []
        for (x, y), *row in zip(VERTICES[:2], *ATTRIBUTES.values(), strict=True):
            pairs = list(zip(ATTRIBUTES, row, strict=True))[1:]
            fields = "".join(f'<Data name="{name}"><value>{each}</value></Data>' for name, each in pairs)
            point = f"<Point><coordinates>{x},{y}</coordinates></Point>"
            places.append(f"<Placemark><name>{row[0]}</name><ExtendedData>{fields}</ExtendedData>{point}</Placemark>")
        path.write_text(f'<kml xmlns="http://www.opengis.net/kml/2.2"><Document>{"".join(places)}</Document></kml>')
    elif fmt == "gpx":
        names = geopandas.GeoDataFrame({"name": ["a", "b"]}, geometry=shapely.points(VERTICES[:2]), crs="EPSG:4326")
        names.to_file(path, driver="GPX", layer="waypoints")
    elif fmt == "csv-wkt":
        rows = zip(*ATTRIBUTES.values(), shapely.points(VERTICES[:2]), strict=True)
        lines = [",".join([*map(str, row[:-1]), f'"SRID=2056;{shapely.to_wkt(row[-1], -1)}"']) for row in rows]
        path.write_text("\n".join([",".join([*ATTRIBUTES, "wkt"]), *lines]) + "\n")
    elif fmt == "wkb":
        path.write_bytes(shapely.to_wkb(shapely.set_srid(shapely.multipoints(VERTICES[:2]), 2056), include_srid=True))
    elif fmt == "xyz":
        path.write_text("".join(f"{x!r} {y!r} 5\n" for x, y in VERTICES[:2].tolist()))
    elif fmt == "las":
        header = laspy.LasHeader(point_format=1)
        header.add_crs(pyproj.CRS.from_epsg(2056))
        data = laspy.LasData(header)
        data.x, data.y, data.z, data.intensity = *VERTICES[:2].T, [0, 0], [3, 4]
        data.write(path)
    elif fmt == "svg":
        path.write_text('<svg xmlns="http://www.w3.org/2000/svg"><path d="M0.1,0 L4,0.25 L0,3 Z"/></svg>')
    else:
        return False
    return True


def vector_row(fmt, folder):
    """What a format of points, polygons and lines carries."""
    extension = FORMATS[fmt].endings[0] if fmt in FORMATS else f".{fmt}"
    path = folder / f"a{extension.replace('.csv-wkt', '.csv')}"
    is_written = True
    for value, what in values():
        try:
            vorotool.write(value, path, fmt=fmt, what=what)
            break
        except UsageError:
            continue
    else:
        is_written = False
    if fmt in NAMES_WITH[None] and (is_written or made_elsewhere(fmt, path)):
        options = {"layer": "waypoints"} if fmt == "gpx" else {}
        read = vorotool.read(path, input_format=fmt, **options)
        whole = np.array_equal(np.sort(read.xy, axis=0), np.sort(VERTICES[: len(read.xy)], axis=0))
        system = "yes" if read.crs is not None and crs_name(read.crs) == "EPSG:2056" else "no"
        if fmt in GEOGRAPHIC:
            system = "degrees"
        returned = "yes" if whole and is_written else "–"
        return ["yes", "yes" if is_written else "no", system, carried(read), "–", returned]
    return ["no", "yes" if is_written else "no", "–", "–", "–", "–"]


def carried(read):
    """Whether attributes come back: with their types, as text, or not."""
    columns = {name.lower(): column for name, column in read.properties.items()}  # KML has a Name
    found = {name: columns.get(name) for name in ATTRIBUTES}
    if any(values is None for values in found.values()):
        return "no"
    first = {name: [type(value) for value in values] for name, values in found.items()}
    if first["count"] == [int, int] or first["count"] == [NumberText, NumberText]:
        return "with types"
    return "as text"


def image_row(fmt, folder):
    """What a format of images carries."""
    labels = np.array([[1, 1, 2], [3, 2, 2]], np.uint8)
    path = folder / f"b{'.ome' if fmt == 'zarr' else ''}{FORMATS[fmt].endings[0] if fmt in FORMATS else '.' + fmt}"
    try:
        vorotool.write(vorotool.LabelImage(labels, grid=SIZED), path, fmt=fmt, what="labels")
        is_written = True
    except UsageError:
        is_written = False
    if fmt not in INPUTS or "image" not in INPUTS[fmt].readers:
        return ["no", "yes" if is_written else "no", "–", "–", "no", "–"]
    if not is_written:
        Image.fromarray(labels * 60).save(path, **({"format": "PPM"} if fmt == "pnm" else {}))
    read = vorotool.read(path, input_format=None if fmt == "zarr" else fmt)
    is_same = is_written and np.array_equal(read.values, labels)
    has_size = read.grid is not None and read.grid.width * (meters(read.grid.unit) or 0) == Fraction(1, 2 * 10**6)
    system = "no"
    if is_written and fmt != "zarr":
        vorotool.write(vorotool.LabelImage(labels, grid=PLACED), path, fmt=fmt, what="labels")
        grid = vorotool.read(path, input_format=fmt).grid
        system = "yes" if grid is not None and grid.transform == PLACED.transform else "no"
    return [
        "yes", "yes" if is_written else "no", system, "–", "yes" if has_size else "no", "yes" if is_same else "–",
    ]  # fmt: skip


def rows(folder):
    """The rows of the table."""
    images = [name for name, each in INPUTS.items() if "image" in each.readers] + ["text"]
    vectors = [name for name in (*INPUTS, *FORMATS) if name not in images and name not in ("html", "apng")]
    found = {name: vector_row(name, folder) for name in dict.fromkeys(vectors)}
    found |= {name: image_row(name, folder) for name in images}
    for name, (read, *cells) in found.items():
        content = held(name) if read == "yes" else "no"
        yield f"| `{name}` | {' | '.join((endings(name), content, *cells))} |"


def held(name):
    """What files of a format are read as."""
    kinds = [kind for kind in ("points", "polygons", "image") if kind in INPUTS[NAMES_WITH[None][name]].readers]
    return ", ".join([*kinds, *(["volume"] if name in VOLUME_NAMES else [])])


def endings(name):
    """The extensions of files of a format."""
    read = [each for each in (INPUTS[name].names if name in INPUTS else ()) if each == name or each not in FORMATS]
    written = (FORMATS[name].extensions or (name,)) if name in FORMATS else ()
    return ", ".join(f"`.{each}`" for each in dict.fromkeys([*read, *written])).replace(".csv-wkt", ".csv")


def test_the_documents_have_the_rows_that_were_found(tmp_path):
    page = (ROOT / "docs/reference/formats.md").read_text(encoding="utf-8")
    assert [line for line in page.splitlines() if line.startswith("| `")] == list(rows(tmp_path))


@pytest.mark.parametrize("fmt", ["gpkg", "fgb", "shp", "parquet", "geojson", "jsonl"])
def test_maps_carry_everything(tmp_path, fmt):
    assert vector_row(fmt, tmp_path) == ["yes", "yes", "yes", "with types", "–", "yes"]
