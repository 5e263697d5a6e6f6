"""Maps on the command line: layers, attributes and reference systems on their way through, streams, folders, extras."""

import json
import os
import threading

import geopandas
import pytest
import shapely

from support.families.vector_files import DRIVERS, frame, load, save
from support.processes.ended import ended_python

FORMATS = list(DRIVERS)
LAKES = [shapely.box(8.0, 47.0, 8.3, 47.1), shapely.box(8.5, 47.2, 8.55, 47.5)]


@pytest.fixture
def lakes(folder):
    for fmt in FORMATS:
        save(frame(LAKES, crs="EPSG:4326", name=["Zugersee", "Aegerisee"], depth=[197, 82]), folder / f"lakes.{fmt}")
    return folder


@pytest.mark.parametrize(("read", "written"), list(zip(FORMATS, [*FORMATS[1:], FORMATS[0]], strict=True)))
def test_lakes_become_centerlines_with_attributes_and_system(run, lakes, read, written):
    assert run(f"skeleton-exact lakes.{read} --crs EPSG:2056 --what centerline -o axes.{written}").err == ""
    axes = load(lakes / f"axes.{written}")
    assert axes.crs.to_epsg() == 2056
    assert axes["name"].tolist() == ["Zugersee", "Aegerisee"]
    assert axes["depth"].tolist() == [197, 82]
    expected = geopandas.GeoSeries(LAKES, crs="EPSG:4326").to_crs("EPSG:2056")
    assert all(axis.within(lake.buffer(1e-3)) for axis, lake in zip(axes.geometry, expected, strict=True))
    assert 20_000 < axes.geometry[0].length < 25_000  # meters: the lake is 0.3 degrees long


@pytest.mark.parametrize("clip", ["area.gpkg", "area.geojson"])
def test_points_and_what_they_are_clipped_to_are_brought_into_one_system(run, folder, clip):
    points = shapely.points([[8.1, 47.1], [8.2, 47.3], [8.4, 47.2], [8.3, 47.0]])
    save(frame(points, crs="EPSG:4326", n=[1, 2, 3, 4]), folder / "towns.gpkg")
    area = frame([shapely.box(2_680_000, 1_200_000, 2_700_000, 1_240_000)], n=[1])
    area.to_file(folder / clip, driver="GPKG" if clip.endswith("gpkg") else "GeoJSON")
    options = ("--what", "cells", "--clip", clip, "-o", "cells.gpkg")
    run("delaunay towns.gpkg", *options, code=3, says="--crs")
    done = run("delaunay towns.gpkg", *options, "--crs", "EPSG:2056")
    assert done.err == "note: 2 of 4 cells are empty: those of sites 1, 2\n"
    cells = load(folder / "cells.gpkg")
    assert shapely.union_all(cells.geometry).area == pytest.approx(20_000 * 40_000)
    assert cells["n"].tolist() == [1, 2, 3, 4]


def test_streams_on_both_sides(run, process, lakes):
    data = (lakes / "lakes.gpkg").read_bytes()
    os.mkfifo(lakes / "pipe.gpkg")
    feeder = threading.Thread(target=(lakes / "pipe.gpkg").write_bytes, args=(data,))
    feeder.start()
    started = process("skeleton-exact", "pipe.gpkg", "-q", "--with", "name", "-f", "gpkg", "-o", "/dev/stdout")
    out, err = started.communicate(timeout=120)
    feeder.join()
    assert (started.returncode, err) == (0, b"")
    (lakes / "made.gpkg").write_bytes(out)
    assert set(load(lakes / "made.gpkg")["name"]) == {"Zugersee", "Aegerisee"}
    run("skeleton-exact - -q --with name -o again.gpkg", data=data)
    assert (lakes / "again.gpkg").read_bytes() == out


WITHOUT = """
import sys
from vorotool.cli.main import main
for line, name in %r:
    sys.modules.update({f"{name}{part}": None for part in ("", ".raw", ".parquet", f".{name}")})
    try:
        main(line.split())
    except SystemExit as end:
        print(end.code)
"""


def test_what_lacks_is_named_with_the_way_to_get_it(lakes):
    cases = [
        ("delaunay dots.csv --crs EPSG:3857 --input-crs CRS:84", "pyproj", "other coordinate reference systems", "gis"),
        ("skeleton-exact lakes.shp", "pyogrio", "Shapefile files", "gis"),
        ("voronoi dots.csv -o a.dxf", "ezdxf", "DXF drawings", "cad"),
    ]
    done = ended_python("-c", WITHOUT % [case[:2] for case in cases], cwd=lakes)
    assert done.stdout.split() == ["2"] * len(cases)
    assert [line for line in done.stderr.splitlines() if line.startswith("error")] == [
        f"error: {what} need the package {name}: pip install 'vorotool[{extra}]'" for _, name, what, extra in cases
    ]
    assert not list(lakes.glob("a.*"))


def test_numbers_of_a_table_are_numbers_in_a_map(run, folder):
    (folder / "towns.csv").write_text("x,y,people,code\n2,1,500,007\n7,5,,010\n1,6,1250.50,3\n")
    done = run("delaunay towns.csv --what cells")
    properties = [feature["properties"] for feature in json.loads(done.out)["features"]]
    assert [each["people"] for each in properties] == [500, None, 1250.5]
    assert [each["code"] for each in properties] == ["007", "010", "3"]
    run("delaunay towns.csv --what cells -o cells.gpkg")
    assert load(folder / "cells.gpkg")["people"].dtype == float
