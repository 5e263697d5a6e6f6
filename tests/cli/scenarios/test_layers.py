"""Layers of files of maps on the command line: FILE:LAYER wherever a file is read, several results in one file."""

import json

import geopandas
import pyogrio
import pytest
import shapely

from support.refusals import refused
from vorotool import UsageError, read
from vorotool.formats.gis import geopackage

LAYERS = {
    "lakes": [shapely.box(0, 0, 10, 4), shapely.box(20, 0, 24, 10)],
    "area": [shapely.box(-5, -5, 30, 20)],
    "odd/dots": list(shapely.points([[0, 0], [5, 8], [11, 3], [20, 9]])),
}


def frame(shapes):
    return geopandas.GeoDataFrame(geometry=shapes, crs="EPSG:2056")


@pytest.fixture
def towns(folder):
    for name, shapes in LAYERS.items():
        frame(shapes).to_file(folder / "m.gpkg", layer=name, driver="GPKG")
        frame(shapes).to_file(folder / f"{name.replace('/', '')}.geojson")
    return folder


@pytest.mark.parametrize(
    "arguments",
    [
        ["voronoi", "{lakes}", "--clip", "{area}", "--enclosures", "{area}", "-f", "wkt"],
        ["distance", "{lakes}", "{odd/dots}"],
        ["draw", "{lakes}", "-o", "{out}.svg"],
    ],
)
def test_a_layer_reads_as_a_file_of_its_own_does(run, towns, arguments):
    made = []
    for named in ("m.gpkg:{}", "{}.geojson"):
        files = {name: named.format(name if ":" in named else name.replace("/", "")) for name in LAYERS}
        typed = [word.format_map(files | {"out": "drawn"}) for word in arguments]
        done = run(*typed)
        made.append((done.out, *(path.read_bytes() for path in towns.glob("drawn.svg"))))
    assert made[0] == made[1]


def test_info_and_the_library_read_a_layer(run, towns):
    done = run("info m.gpkg:lakes m.gpkg:odd/dots --json")
    assert [json.loads(line)["kind"] for line in done.out.splitlines()] == ["polygons", "points"]
    done = run("info m.gpkg", code=3)
    assert done.err == "error: m.gpkg holds 3 layers: choose one of lakes, area, odd/dots, as m.gpkg:lakes\n"
    assert len(read(towns / "m.gpkg:lakes")) == 2
    refused(UsageError, "leave out one of them", read, towns / "m.gpkg:lakes", layer="area")


def test_a_colon_that_names_no_layer(run, towns):
    (towns / "m").write_bytes((towns / "m.gpkg").read_bytes())
    (towns / "folder").mkdir()
    for name in ("m:lakes", "folder:lakes", "none.gpkg:lakes", "m.gpkg:"):  # a drive, a folder, nothing, no layer
        run(f"skeleton-exact {name}", code=3, says=f"{name}: there is no such file")
    (towns / "m.gpkg:lakes").write_text("POLYGON ((0 0, 9 0, 0 9, 0 0))")
    assert json.loads(run("info m.gpkg:lakes --json").out)["format"] == "wkt"


def test_a_layer_whose_name_has_a_colon(run, towns):
    frame(LAYERS["lakes"]).to_file(towns / "m.gpkg", layer="roads:main:old", driver="GPKG")
    assert json.loads(run("info m.gpkg:roads:main:old --json").out)["features"] == 2
    run("info -", data=(towns / "m.gpkg").read_bytes(), code=3, says="FILE:LAYER")
    run("info m.gpkg:roads:main", code=3, says="the layer 'roads:main' of m.gpkg does not exist")


@pytest.mark.parametrize("name", ["m.gpkg:none", "none.shp"])
@pytest.mark.parametrize(("kind", "found"), [("Point", "points"), ("Polygon", "polygons"), ("LineString", "polygons")])
def test_an_empty_layer_has_its_kind_and_its_columns(run, towns, name, kind, found):
    empty = geopandas.GeoDataFrame({"height": [1.5], "name": ["a"]}, geometry=[shapely.Point(0, 0)], crs=2056)[:0]
    file, _, layer = name.partition(":")
    empty.to_file(towns / file, geometry_type=kind, **({"layer": layer} if layer else {}))
    told = json.loads(run(f"info {name} --json").out)
    assert (told["kind"], list(told["columns"])) == (found, ["height", "name"])
    header = run(f"{'delaunay' if found == 'points' else 'skeleton-exact'} {name} --what table -f csv").out
    assert header.endswith(",height,name\n")


def test_layers_of_files_that_have_none_and_of_two_options_are_refused(run, towns):
    run("skeleton-exact lakes.geojson -o s.json")
    run("sample cells.png -o c.png")
    for arguments in (
        ["skeleton-exact", "lakes.geojson:a"],
        ["draw", "s.json:a", "-o", "s.svg"],
        ["tessellate", "c.png:a", "-o", "t.png"],
        ["draw", "lakes.geojson", "--overlay", "c.png:a", "-o", "s.svg"],
        ["skeleton-exact", "m.gpkg:lakes", "--input-layer", "lakes"],
    ):
        assert "--input-layer" in run(*arguments, code=2).err, arguments


def test_a_layer_without_geometry_is_told_from_none(run, folder):
    run("sample dots.csv -o dots.csv")
    run("delaunay dots.csv --what edges,table -o x.gpkg")
    for layer, fault in (("table", "has no geometry"), ("nothing", "does not exist")):
        run(f"skeleton-exact x.gpkg:{layer} -o s.json", code=3, says=[fault, "edges"])


@pytest.mark.parametrize(
    "arguments",
    [
        ["voronoi", "m.gpkg:lakes", "-o", "m.gpkg"],
        ["voronoi", "lakes.geojson", "--clip", "m.gpkg:area", "-o", "m.gpkg"],
        ["voronoi", "m.gpkg:lakes", "-o", "v.csv", "--what", "table", "--stats", "m.gpkg"],
        ["distance", "lakes.geojson", "m.gpkg:area", "-o", "m.gpkg"],
        ["voronoi", "m.gpkg:lakes", "m.gpkg:area", "--out-dir", "out", "--stats", "m.gpkg"],
    ],
)
def test_the_file_of_a_layer_is_never_replaced(run, towns, arguments):
    before = (towns / "m.gpkg").read_bytes()
    run(*arguments, "--overwrite", code=2, says="never replaced")
    assert (towns / "m.gpkg").read_bytes() == before


def test_outputs_of_a_batch_are_named_after_layers(run, towns):
    typed = ("voronoi", "m.gpkg:lakes", "m.gpkg:odd/dots", "lakes.geojson", "--out-dir", "out", "-q", "--resume")
    run(*typed)
    names = {path.name for path in (towns / "out").iterdir()} - {"voronoi.manifest.jsonl"}
    assert names == {"m.lakes.geojson", "m.odd_dots.geojson", "lakes.geojson"}
    assert (towns / "out" / "m.lakes.geojson").read_bytes() == (towns / "out" / "lakes.geojson").read_bytes()

    def status():
        return [json.loads(line)["status"] for line in run(*typed, "--dry-run").out.splitlines()]

    assert status() == ["kept"] * 3
    frame(LAYERS["area"]).to_file(towns / "m.gpkg", layer="lakes", driver="GPKG")
    assert status() == ["planned", "planned", "kept"]
    run("voronoi m.gpkg:lakes --out-dir one -q")
    assert [path.name for path in (towns / "one").iterdir()] == ["m.lakes.geojson"]
    done = run("voronoi m.gpkg:lakes m.gpkg:lakes --out-dir out", code=2)
    assert done.err == "error: m.gpkg:lakes is named twice: leave one out\n"


def test_several_results_are_layers_of_one_geopackage(run, towns):
    typed = ("delaunay", "m.gpkg:odd/dots", "--what", "edges,cells,table")
    run(*typed, "-o", "x.gpkg")
    assert pyogrio.list_layers(towns / "x.gpkg").tolist() == [
        ["edges", "LineString"],
        ["cells", "Polygon"],
        ["table", None],
    ]
    for what in ("edges", "cells", "table"):
        run(f"delaunay m.gpkg:odd/dots --what {what} -o {what}.gpkg")
        layer, alone = (pyogrio.read_dataframe(towns / name, layer=what) for name in ("x.gpkg", f"{what}.gpkg"))
        assert layer.equals(alone)
        assert getattr(layer, "crs", None) == (None if what == "table" else "EPSG:2056")
        assert what == "table" or pyogrio.read_info(towns / "x.gpkg", layer=what)["capabilities"]["fast_spatial_filter"]
    before = (towns / "x.gpkg").read_bytes()
    run(*typed, "-o", "x.gpkg")  # of its own layers
    assert (towns / "x.gpkg").read_bytes() == before
    assert len(list(towns.glob("x*"))) == 1
    assert not list(towns.glob(".*"))
    run("voronoi x.gpkg:cells --what table -o v.csv")


@pytest.mark.parametrize("fault", ["error", "index"])
def test_all_layers_are_written_or_none(run, towns, monkeypatch, fault):
    (towns / "x.gpkg").write_text("older")
    if fault == "index":
        monkeypatch.setattr(geopackage, "has_index", lambda *_: False)
    else:
        write = geopackage.GeoPackage.gdal_write

        def failing(self, out, *args, **options):
            if self.what == "cells":
                raise OSError(28, "No space left on device")
            write(self, out, *args, **options)

        monkeypatch.setattr(geopackage.GeoPackage, "gdal_write", failing)
    words = "x.gpkg cannot be written: No space left"
    run("delaunay odddots.geojson --what edges,cells,table -o x.gpkg", code=4, says=words)
    assert (towns / "x.gpkg").read_text() == "older"
    assert not list(towns.glob(".*"))


@pytest.mark.parametrize(
    ("command", "formats", "names"),
    [
        ("tessellate dots.csv --what labels,table,neighbors", "tiff,csv", "x.labels.tif x.neighbors.csv x.table.csv"),
        ("delaunay dots.csv --what edges,triangles,table", "edge", "x.edges.edge x.table.node x.triangles.ele"),
        ("delaunay dots.csv --what edges,cells", "CSV, .geojson", "x.cells.geojson x.edges.csv"),
    ],
)
def test_each_result_has_the_format_that_is_usual_for_it(run, folder, command, formats, names):
    run("sample dots.csv -o dots.csv")
    run(command, "-f", formats, "-o", "x")
    assert sorted(path.name for path in folder.glob("x.*")) == names.split()
    run(command, "-f", formats, "--out-dir", "all")
    assert sorted(path.name for path in (folder / "all").iterdir()) == names.replace("x.", "dots.").split()
