"""Delimited text with a column of geometry, files of well-known binary, and the numbers in other columns."""

import json

import pytest
import shapely

import vorotool
from support.refusals import refused
from vorotool.errors import InputError
from vorotool.numeric.crs import crs_name
from vorotool.numeric.numbers import NumberText

LAKE = shapely.box(0, 0, 4, 3)


def saved(tmp_path, text, name="towns.csv"):
    (tmp_path / name).write_bytes(text if isinstance(text, bytes) else text.encode())
    return tmp_path / name


@pytest.mark.parametrize("header", ["wkt", "WKT", "geometry", "the_geom", "geom"])
@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
def test_points_and_polygons_in_text(tmp_path, header, delimiter):
    rows = [["name", header, "pop"], ["a", '"POINT (1 2)"', "3.50"], ["b", "", "7"], ["c", "MULTIPOINT (3 4)", ""]]
    path = saved(tmp_path, "".join(delimiter.join(row) + "\n" for row in rows))
    points = vorotool.read(path)
    assert points.xy.tolist() == [[1, 2], [3, 4]]
    assert points.properties == {"name": ["a", "c"], "pop": ["3.50", None]}
    assert points.y_axis == "up"
    rows = [["name", header], ["a", f'"{LAKE.wkt}"'], ["b", '"LINESTRING (5 5, 6 7)"']]
    shapes = vorotool.read(saved(tmp_path, "".join(delimiter.join(row) + "\n" for row in rows)))
    assert shapes.is_line.tolist() == [False, True]
    assert shapes.properties == {"name": ["a", "b"]}


def test_lines_are_named(tmp_path):
    path = saved(tmp_path, 'wkt,n\n"POLYGON ((0 0, 4 0, 0 3, 0 0))",1\nPOINT (1 2),2\n')
    refused(InputError, r"towns.csv, line 3", vorotool.read, path)
    path = saved(tmp_path, "wkt,n\nPOINT (1 2),1\nPOINT (1 2),2,3\n")
    refused(InputError, r"towns.csv, line 3", vorotool.read, path)
    path = saved(tmp_path, "wkt\nPOINT (1 1e999)\n")
    refused(InputError, r"towns.csv, line 2: vertex 1", vorotool.read, path)
    path = saved(tmp_path, "wkt\n" + "GEOMETRYCOLLECTION (" * 200 + ")" * 200)
    refused(InputError, "brackets are nested more than 100 deep", vorotool.read, path)


def test_systems(tmp_path):
    path = saved(tmp_path, "wkt\nSRID=2056;POINT (1 2)\nSRID=2056;POINT (3 4)\n")
    assert crs_name(vorotool.read(path).crs) == "EPSG:2056"
    path = saved(tmp_path, "wkt\nSRID=2056;POINT (1 2)\nSRID=3857;POINT (3 4)\n")
    refused(InputError, r"line 2 in EPSG:2056", vorotool.read, path)
    code = shapely.to_wkb(shapely.set_srid(shapely.Point(1, 2), 2056), hex=True, include_srid=True)
    points = vorotool.read(saved(tmp_path, f"id,wkb\n7,{code}\n"))
    assert (points.xy.tolist(), crs_name(points.crs), points.properties) == ([[1, 2]], "EPSG:2056", {"id": ["7"]})


def test_numbers_stay_numbers(tmp_path):
    text = "x,y,pop,code,part,mixed,none\n0,0,3.50,007,1e3,1,\n4,0,-2,010,,a,\n0,3,12345678901234567890123,5,0.10,,\n"
    points = vorotool.read(saved(tmp_path, text))
    kinds = {name: [type(value) for value in values] for name, values in points.properties.items()}
    assert kinds["pop"] == [NumberText] * 3
    assert kinds["code"] == kinds["mixed"] == kinds["none"] == [str] * 3
    assert points.properties["part"] == ["1e3", None, "0.10"]
    cells = vorotool.voronoi_cells(points)
    vorotool.write(cells, tmp_path / "cells.geojson")
    written = (tmp_path / "cells.geojson").read_text()
    assert '"pop":3.50,"code":"007","part":1e3,"mixed":"1","none":""' in written
    assert '"pop":12345678901234567890123,"code":"5","part":0.10,' in written
    vorotool.write(cells, tmp_path / "cells.csv")
    assert ",3.50,007,1e3,1," in (tmp_path / "cells.csv").read_text()
    vorotool.write(cells, tmp_path / "cells.json")
    first = json.loads((tmp_path / "cells.json").read_text())["polygons"][0]["properties"]
    assert (first["pop"], first["code"]) == (3.5, "007")
    vorotool.write(cells, tmp_path / "cells.gpkg")
    read = vorotool.read(tmp_path / "cells.gpkg").properties
    assert read["part"] == [1000.0, None, 0.1]
    assert read["code"] == ["007", "010", "5"]
