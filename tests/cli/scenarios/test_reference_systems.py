"""Coordinate reference systems on the command line: carried on, never mixed, never guessed from numbers."""

import json

import pytest
import shapely

from support.families.geojson import collection

STATIONS = [[-20.5, 64.1], [-18.2, 65.3], [-22.1, 64.9], [-16, 64.6]]
DEGREES = "longitude and latitude are treated as planar, lengths are in degrees; --crs EPSG:32627 works in meters (UTM)"


def stations(crs=None):
    return collection([{"type": "Point", "coordinates": place} for place in STATIONS], crs=crs)


def box(*bounds, crs=None):
    return collection([shapely.box(*bounds)], crs=crs)


@pytest.fixture
def maps(folder):
    (folder / "stations.geojson").write_text(stations("urn:ogc:def:crs:OGC:1.3:CRS84"))
    (folder / "bare.geojson").write_text(stations())
    (folder / "stations.csv").write_text("lon,lat\n" + "".join(f"{x},{y}\n" for x, y in STATIONS))
    (folder / "plain.csv").write_text("x,y\n" + "".join(f"{x},{y}\n" for x, y in STATIONS))
    (folder / "stations.wkt").write_text("".join(f"SRID=4326;POINT ({x} {y})\n" for x, y in STATIONS))
    (folder / "meters.geojson").write_text(box(240e3, 300e3, 760e3, 680e3, crs="urn:ogc:def:crs:EPSG::3057"))
    (folder / "degrees.geojson").write_text(box(-25, 63, -13, 67.5, crs="EPSG:4326"))
    (folder / "unnamed.geojson").write_text(box(-25, 63, -13, 67.5))
    return folder


def crs_of(text):
    return json.loads(text).get("crs", {}).get("properties", {}).get("name")


@pytest.mark.parametrize("name", ["stations.geojson", "stations.csv", "stations.wkt"])
def test_polygons_to_clip_to_in_another_system_are_refused(run, maps, name):
    done = run(f"delaunay {name} --what cells --clip meters.geojson -o cells.geojson", code=3)
    message = done.err.splitlines()[-1]
    assert all(word in message for word in ("meters.geojson", "EPSG:3057", name))
    assert "--crs OGC:CRS84" in message or "--crs EPSG:4326" in message
    assert not (maps / "cells.geojson").exists()


def test_polygons_to_clip_to_in_the_same_system_by_another_name(run, maps):
    done = run("delaunay stations.geojson --what cells --clip degrees.geojson")
    assert done.err == f"warning: stations.geojson: {DEGREES}\n"
    assert crs_of(done.out) == "urn:ogc:def:crs:OGC:1.3:CRS84"
    assert all(feature["geometry"] for feature in json.loads(done.out)["features"])


def test_polygons_to_clip_to_that_name_no_system_take_that_of_the_points(run, maps):
    done = run("delaunay stations.geojson --what cells --clip unnamed.geojson")
    [note] = done.err.splitlines()[1:]
    assert all(word in note for word in ("unnamed.geojson", "OGC:CRS84", "stations.geojson"))


def test_points_that_name_no_system_take_that_of_the_polygons(run, maps):
    done = run("delaunay plain.csv --what cells --clip degrees.geojson")
    assert crs_of(done.out) == "EPSG:4326"
    note, warning = done.err.splitlines()
    assert all(word in note for word in ("plain.csv", "EPSG:4326", "degrees.geojson"))
    assert warning.startswith("warning: plain.csv: ")


@pytest.mark.parametrize("name", ["bare.geojson", "plain.csv"])
def test_points_that_name_no_system_and_lie_elsewhere_are_refused(run, maps, name):
    run(f"delaunay {name} --what cells --clip meters.geojson", code=3, says="meters.geojson")


@pytest.mark.parametrize(
    ("name", "command", "options"),
    [
        ("stations.csv", "delaunay", ("-f", "geojson")),
        ("stations.wkt", "alphashape", ("-r", "3", "-f", "geojson")),
        ("stations.geojson", "delaunay", ("--what", "cells")),
    ],
)
def test_the_system_is_carried_on_and_degrees_are_a_warning(run, maps, name, command, options):
    done = run(command, name, *options)
    assert f"warning: {name}: {DEGREES}" in done.err.splitlines()
    assert crs_of(done.out) in ("urn:ogc:def:crs:OGC:1.3:CRS84", "urn:ogc:def:crs:EPSG::4326")


def test_a_drawing_is_no_map(run, folder):
    (folder / "drawing.geojson").write_text(box(0.5, 0.5, 100.5, 50.5))
    done = run("skeleton-exact drawing.geojson -f geojson")
    assert crs_of(done.out) is None
    assert "warning" not in done.err
    assert "drawing.geojson" in done.err
    assert run("draw drawing.geojson -f svg").err == ""


def test_a_system_is_declared_for_inputs_that_name_none(run, maps):
    for command, name in (("skeleton-exact", "unnamed.geojson"), ("skeleton-approx", "unnamed.geojson")):
        options = ("--step", "0.5") if command == "skeleton-approx" else ()
        done = run(command, name, *options, "-f", "geojson", "--input-crs", "epsg:3857")
        assert (done.err, crs_of(done.out)) == ("", "urn:ogc:def:crs:EPSG::3857")
    done = run("skeleton-exact unnamed.geojson -f geojson --input-crs OGC:CRS84")
    assert done.err == f"warning: unnamed.geojson: {DEGREES}\n"
    run("skeleton-exact degrees.geojson --input-crs CRS:84")
    run("skeleton-exact degrees.geojson --input-crs EPSG:3857", code=3, says="degrees.geojson")


@pytest.mark.parametrize(
    ("arguments", "files"),
    [
        (("--what", "edges", "-o", "a.csv"), "a.csv"),
        (("--what", "cells", "-o", "a.wkt"), "a.wkt"),
        (("--what", "cells,table", "-f", "csv", "--out-dir", "o"), "o/meters.cells.csv, o/meters.table.csv"),
        (("--what", "statistics", "-o", "a.csv"), None),  # without coordinates
        (("--what", "cells", "-o", "a.geojson"), None),
        (("--what", "edges", "--pixel-size", "2", "-o", "a.csv"), None),  # no longer in it
        (("--what", "edges", "-q", "-o", "a.csv"), None),
    ],
)
def test_files_that_cannot_state_the_system_are_named_once(run, folder, arguments, files):
    points = [{"type": "Point", "coordinates": place} for place in ([3, 1], [9, 2], [4, 8])]
    (folder / "meters.geojson").write_text(collection(points, crs="EPSG:3057"))
    done = run("delaunay meters.geojson", *arguments)
    named = [line for line in done.err.splitlines() if "--input-crs" in line]
    assert len(named) == int(files is not None)
    assert files is None or (files in named[0] and "EPSG:3057" in named[0])
