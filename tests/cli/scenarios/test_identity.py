"""What points and sites are called in results: labels, columns named label, and columns that join sites."""

import json

import geopandas
import numpy as np
import pandas
import pytest

import vorotool
from support.families.geojson import collection
from vorotool.products import registry

ROWS = [(101, 0.0, 0.0, "a"), (102, 5.0, 1.0, "b"), (103, 2.0, 6.0, "c")]
ORDERS = (
    ("label", "x", "y", "type"),
    ("x", "y", "type", "label"),
    ("type", "x", "label", "y"),
    ("lon", "lat", "label"),
)


def column(name):
    return [row[{"label": 0, "x": 1, "lon": 1, "y": 2, "lat": 2, "type": 3}[name]] for row in ROWS]


def text(names, labels=None):
    columns = [labels if name == "label" and labels else column(name) for name in names]
    return "\n".join([",".join(names), *(",".join(map(str, row)) for row in zip(*columns, strict=True))]) + "\n"


def squares(places):
    rings = [[[[x, 0], [x + 6, 0], [x + 6, 4], [x, 4], [x, 0]]] for x in places]
    return {"type": "MultiPolygon", "coordinates": rings}


def columns_of(path):
    """Read a table by another library."""
    if path.suffix == ".npz":
        with np.load(path) as arrays:
            return {name: arrays[name].tolist() for name in arrays}
    readers = {".csv": pandas.read_csv, ".json": pandas.read_json}
    if path.suffix == ".json" and isinstance(held := json.loads(path.read_text()), dict):
        frame = pandas.DataFrame([each["properties"] for each in held["polygons"]])
    else:
        frame = readers.get(path.suffix, geopandas.read_file)(path)
    return {name: frame[name].tolist() for name in frame}


@pytest.mark.parametrize(("names", "kind"), list(zip(ORDERS, ["csv", "npz", "features", "frame"], strict=True)))
def test_labels_are_found_wherever_they_stand(names, kind, tmp_path):
    frame = pandas.DataFrame({name: column(name) for name in names})
    if kind == "csv":
        (tmp_path / "in.csv").write_text(text(names))
        points = vorotool.read(tmp_path / "in.csv")
    elif kind == "npz":
        np.savez(tmp_path / "in.npz", **{name: np.array(column(name)) for name in names})
        points = vorotool.read(tmp_path / "in.npz")
    elif kind == "frame":
        points = vorotool.delaunay(frame)
    else:
        x, y = (column(name) for name in ("x", "y"))
        others = frame[[name for name in names if name in ("label", "type")]]
        points = vorotool.delaunay(geopandas.GeoDataFrame(others, geometry=geopandas.points_from_xy(x, y)))
    assert points.labels.tolist() == [101, 102, 103]
    assert points.properties == ({"type": ["a", "b", "c"]} if "type" in names else {})


@pytest.mark.parametrize(
    "labels", [["a", "b", "c"], [0, 1, 2], [1.5, 2, 3], [1, 2, 2**32], ["", 1, 2], [-1, 1, 2]], ids=str
)
def test_other_values_are_a_property(labels, tmp_path):
    (tmp_path / "in.csv").write_text(text(ORDERS[0], labels))
    points = vorotool.read(tmp_path / "in.csv")
    assert points.labels is None
    assert list(points.properties) == ["label", "type"]
    found = vorotool.delaunay(pandas.DataFrame({"x": column("x"), "y": column("y"), "label": labels}))
    assert found.labels is None
    assert found.properties["label"] == labels


def test_repeated_labels_share_a_region_and_are_a_property_of_triangulations(run, tmp_path):
    (tmp_path / "in.csv").write_text(text(ORDERS[1], [7, 7, 8]))
    made = run(f"tessellate {tmp_path}/in.csv --size 8x8 --what table -f csv")
    assert [row["label"] for row in made.rows] == ["7", "8"]
    assert "type" in made.err
    run(f"tessellate {tmp_path}/in.csv --size 8x8 --what table --strict", code=3, says="type")
    (tmp_path / "same.csv").write_text(text(ORDERS[1], [7, 8, 7]).replace(",a", ",c"))
    made = run(f"tessellate {tmp_path}/same.csv --size 8x8 --what table -f csv")
    assert [(row["label"], row["type"]) for row in made.rows] == [("7", "c"), ("8", "b")]
    assert not made.err
    for command in ("delaunay", "alphashape"):
        made = run(command, tmp_path / "in.csv", "--what", "edges", "-f", "csv", says="label")
        assert {row["label_a"] for row in made.rows} <= {"1", "2", "3"}
    mesh = vorotool.delaunay(vorotool.read(tmp_path / "in.csv"))
    assert mesh.labels is None
    assert mesh.properties["label"] == [7, 7, 8]


def test_the_column_that_sites_are_joined_by_stays(run, tmp_path):
    squares = geopandas.GeoSeries.from_wkt([f"POLYGON (({x} 0, {x + 1} 0, {x} 1, {x} 0))" for x in (0, 5, 9)])
    columns = {"tree": ["oak", "elm", "oak"], "kind.of": [1, 2, 1]}
    frame = geopandas.GeoDataFrame(columns, geometry=squares, crs=3857)
    frame.to_file(tmp_path / "in.geojson")
    for by, values in (("tree", ["oak", "elm"]), ("kind.of", ["1", "2"])):
        made = run(f"voronoi {tmp_path}/in.geojson --by {by} --what table -f csv -q")
        assert [(row["id"], row[by]) for row in made.rows] == [(value, value) for value in values]
        run(f"voronoi {tmp_path}/in.geojson --by {by} --what cells -o {by}.gpkg -q")
        read = geopandas.read_file(tmp_path / f"{by}.gpkg")
        assert read[by].astype(str).tolist() == values
    assert vorotool.voronoi(frame, by="tree").properties == {"tree": ["oak", "elm"]}


OF_PARTS = ["table", "skeleton", "branches", "elements", "points", "parts", "discs", "centerline"]


@pytest.mark.parametrize(
    ("what", "fmt"),
    [
        (what, fmt)
        for what in OF_PARTS
        for fmt in (("csv", "json", "geojson", "npz") if what == "parts" else ("csv",))
        if fmt in registry.PRODUCTS["skeleton-exact"][what].formats
    ],
)
def test_rows_made_of_polygons_refer_to_features_by_label(run, tmp_path, what, fmt):
    path, more = tmp_path / f"out.{fmt}", ["--every", "3"] if what == "points" else []
    for labels, column in (([12, 12, 11], [12, 11]), ([1, 1, 2], [5, 5]), ([1, 1, 2], ["a", "b"])):
        rows = [{"name": name, "label": label} for name, label in zip("AB", column, strict=True)]
        (tmp_path / "in.geojson").write_text(collection([squares((0, 10)), squares((30,))], rows))
        run(f"skeleton-exact {tmp_path}/in.geojson --what {what} -o {path}", *more, "-q")
        found = columns_of(path)
        name = "voro_label" if column != [12, 11] and "voro_label" in found else "label"
        rows = list(zip(map(int, found[name]), map(int, found["part"]), strict=True))
        expected = list(zip(labels, (1, 2, 1), strict=True))
        assert list(dict.fromkeys(rows)) == (expected[::2] if what == "discs" else expected)
        assert "polygon" not in found


@pytest.mark.parametrize(
    ("what", "fmt"),
    [
        (what, fmt)
        for what in [*OF_PARTS, "offset"]
        for fmt in ("csv", "geojson", "gpkg")
        if fmt in registry.PRODUCTS["skeleton-exact"][what].written
    ],
)
def test_a_column_id_is_the_id_of_features_that_have_no_other(run, tmp_path, what, fmt):
    path, more = tmp_path / f"out.{fmt}", {"points": ["--every", "3"], "offset": ["-d", "-1"]}.get(what, [])
    rows = [{"id": "seven", "name": "A"}, {"id": "nine", "name": "B"}]
    (tmp_path / "in.geojson").write_text(collection([squares((0,)), squares((30,))], rows))
    run(f"skeleton-exact {tmp_path}/in.geojson --what {what} -o {path}", *more, "-q")
    if fmt == "geojson":
        found = {"id": [feature["id"] for feature in json.loads(path.read_text())["features"]]}
    else:
        found = columns_of(path)
    assert list(dict.fromkeys(found["id"])) == ["seven", "nine"]
    assert "voro_id" not in found


READ_BACK = ["csv", "json", "geojson", "npz", "gpkg"]


@pytest.fixture
def kinds(tmp_path):
    """Points and polygons with columns, one of them an object, and one called as one of ours."""
    places = [(0, 0), (9, 1), (3, 8), (12, 9)]
    columns = {"type": ["a", "b", "a", None], "length": [1, 2, 3, 4], "kind": [{"name": n} for n in "pqrs"]}
    rows = [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
    for name, shapes in {
        "points": [{"type": "Point", "coordinates": place} for place in places],
        "polygons": [squares((10 * k,)) for k in range(4)],
    }.items():
        (tmp_path / f"{name}.geojson").write_text(collection(shapes, rows))
    return tmp_path


def written_formats(command, what, *, leaving=()):
    written = registry.PRODUCTS[command][what].written
    return [fmt for fmt in READ_BACK if fmt in written and fmt not in leaving]


def test_rows_that_are_features_have_all_columns_in_every_format(run, kinds):
    for command, source, what in (
        ("skeleton-exact", "polygons", "table"),
        ("skeleton-exact", "polygons", "parts"),
        ("skeleton-exact", "polygons", "discs"),
        ("delaunay", "points", "table"),
        ("delaunay", "points", "measures"),
        ("delaunay", "points", "cells"),
        ("voronoi", "polygons", "cells"),
        ("voronoi", "polygons", "table"),
        ("alphashape", "points", "points"),
    ):
        for fmt in written_formats(command, what):
            if (command, what, fmt) in {("voronoi", "cells", "json"), ("voronoi", "cells", "npz")}:
                continue  # the whole map, not its rows
            path = kinds / f"{what}.{fmt}"
            more = ["-r", "9"] if command == "alphashape" else []
            run(command, kinds / f"{source}.geojson", "--what", what, "-o", path, *more, "-q")
            found = columns_of(path)
            assert list(map(int, found["length"])) == [1, 2, 3, 4], (command, what, fmt)
            assert [str(value) for value in found["type"][:3]] == ["a", "b", "a"]
            assert not {"type_a", "polygon"} & set(found)


@pytest.mark.parametrize("what", ["skeleton", "branches", "elements", "points", "transects", "centerline", "offset"])
def test_rows_about_parts_have_the_columns_that_are_asked_for(run, kinds, what):
    more = {"points": ["--every", "2"], "transects": ["--every", "2"], "offset": ["-d", "-1"]}.get(what, [])
    whole = {"skeleton": ["json", "npz"], "offset": ["json", "npz"]}.get(what, [])
    for fmt in written_formats("skeleton-exact", what, leaving=whole):
        path = kinds / f"out.{fmt}"
        command = ("skeleton-exact", kinds / "polygons.geojson", "--what", what, "-o", path, *more, "-q")
        run(*command)
        is_feature = what in ("offset", "centerline") and fmt in ("geojson", "gpkg")
        if not is_feature:
            assert "kind.name" not in (plain := columns_of(path))
            assert not {"voro_length", "voro_kind"} & set(plain)
        run(*command, "--with", "length,kind.name")
        found = columns_of(path)
        if not is_feature:
            by_label = dict(zip(map(int, found["label"]), found["kind.name"], strict=True))
            assert by_label == {1: "p", 2: "q", 3: "r", 4: "s"}
            assert list(map(int, found["length"])) == list(map(int, found["label"]))


def test_rows_about_pairs_have_the_columns_of_both(run, kinds):
    for command, source, what, more in (
        ("delaunay", "points", "edges", []),
        ("delaunay", "points", "triangles", []),
        ("alphashape", "points", "edges", ["-r", "9"]),
        ("alphashape", "points", "complex", ["-r", "9"]),
        ("alphashape", "points", "family", []),
        ("tessellate", "points", "neighbors", []),
        ("voronoi", "polygons", "neighbors", []),
        ("voronoi", "polygons", "edges", []),
    ):
        for fmt in written_formats(command, what):
            path = kinds / f"{command}.{what}.{fmt}"
            given = (command, kinds / f"{source}.geojson", "--what", what, "-o", path, *more, "-q")
            run(*given, "--with", "kind.name")
            found = columns_of(path)
            assert [name for name in found if name.startswith("kind.name")][:2] == ["kind.name_a", "kind.name_b"]
            for end in "ab":
                assert ["pqrs"[int(label) - 1] for label in found[f"label_{end}"]] == found[f"kind.name_{end}"]


def test_columns_that_nothing_shows_are_refused(kinds):
    mesh = vorotool.delaunay(vorotool.read(kinds / "points.geojson"))
    with pytest.raises(vorotool.UsageError, match="with_columns 'nothing'"):
        vorotool.to_geojson(mesh, what="edges", with_columns=["nothing"])
    made = vorotool.to_geojson(mesh, what="edges", with_columns=["type"])["features"][0]["properties"]
    assert (made["type_a"], made["type_b"]) == tuple(mesh.properties["type"][label - 1] for label in (1, 3))


def test_a_path_with_dots_names_objects_in_pictures(run, kinds):
    for given in (
        *(f"{command} polygons.geojson" for command in ("voronoi", "skeleton-exact", "draw")),
        *(f"{command} points.geojson" for command in ("delaunay", "tessellate --what color")),
    ):
        drawn = run(f"{given} -f svg -q --label-by kind.name")
        assert all(f">{name}</text>" in drawn.out for name in "pqrs"), (given, drawn.err)
        run(f"{given} -f svg -q --label-by kind", code=3, says="column.name")
