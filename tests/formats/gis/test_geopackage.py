"""What a GeoPackage may hold that is read with care: curves, journals, views, values of other types."""

import sqlite3
import struct

import pandas
import pyogrio
import pytest
import shapely

import vorotool
from support.families.vector_files import frame, save
from support.refusals import refused
from vorotool.errors import InputError, LimitError, UsageError
from vorotool.formats.gis import geopackage

ARCS = struct.pack("<BIIBII", 1, 10, 1, 1, 8, 5) + struct.pack("<10d", 0, 0, 4, 0, 4, 4, 0, 4, 0, 0)


def opened(path):
    """A database without the triggers of its index, which ask for functions that SQLite alone has not."""
    database = sqlite3.connect(path)
    for (name,) in database.execute("SELECT name FROM sqlite_master WHERE type = 'trigger'").fetchall():
        database.execute(f'DROP TRIGGER "{name}"')
    return database


def changed(path, *statements):
    database = opened(path)
    for statement in statements:
        database.execute(*statement) if isinstance(statement, tuple) else database.execute(statement)
    database.commit()
    database.close()
    return path


def listing(folder):
    return {each.name: each.read_bytes() for each in folder.iterdir()}


def with_view(path, query, *columns):
    """A file whose one layer is a view."""
    names = ", ".join(columns)
    return changed(
        path,
        f"CREATE VIEW v ({names}) AS {query}",
        "UPDATE gpkg_contents SET table_name = 'v', identifier = 'v'",
        "UPDATE gpkg_geometry_columns SET table_name = 'v', column_name = 'geom'",
    )


def test_curves_are_flattened_and_counted(tmp_path):
    path = save(frame(), tmp_path / "a.gpkg")
    blob = b"GP\0\1" + struct.pack("<i", 2056) + ARCS
    changed(path, ("UPDATE a SET geom = ? WHERE fid < 3", (blob,)))
    notes = []
    shapes = vorotool.read(path, note=notes.append)
    assert [note for note in notes if "curve" in note] == [f"{path}: 2 curves flattened to short line segments"]
    assert len(shapes.ring(0)) == 64
    assert len(vorotool.read(path, flatten=0.5).ring(0)) < 20
    changed(path, ("UPDATE a SET geom = ? WHERE fid = 2", (blob[:-5],)))
    refused(InputError, r"feature 2", vorotool.read, path)


@pytest.mark.parametrize("mode", ["WAL", "DELETE"])
def test_reading_changes_nothing(tmp_path, mode):
    path = save(frame(), tmp_path / "a.gpkg")
    database = opened(path)
    database.execute(f"PRAGMA journal_mode={mode}")
    database.execute("UPDATE a SET name = 'new'")
    database.commit()
    if mode == "DELETE":  # what is not yet committed is taken back in the copy
        database.execute("PRAGMA cache_size = 1")
        database.execute("UPDATE a SET name = 'newer'")
    before = listing(tmp_path)
    assert len(before) > 1
    crashed = tmp_path / "crashed"
    crashed.mkdir()
    for name, data in before.items():
        (crashed / name).write_bytes(data)
    database.close()
    for name in list(listing(crashed)):
        if name.endswith("-shm"):  # as after a crash
            (crashed / name).unlink()
    before = listing(crashed)
    assert vorotool.read(crashed / "a.gpkg").properties["name"] == ["new"] * 4
    assert listing(crashed) == before
    crashed.chmod(0o555)
    try:
        assert vorotool.read(crashed / "a.gpkg").properties["name"] == ["new"] * 4
    finally:
        crashed.chmod(0o755)
    assert listing(crashed) == before


def test_a_file_whose_journal_is_gone(tmp_path):
    path = changed(save(frame(), tmp_path / "a.gpkg"), "PRAGMA journal_mode=WAL")
    before = listing(tmp_path)
    assert path.read_bytes()[18:20] == b"\2\2"
    assert len(vorotool.read(path)) == 4
    assert listing(tmp_path) == before


@pytest.mark.parametrize(
    "query",
    [
        "WITH RECURSIVE n(i) AS (VALUES (1) UNION ALL SELECT i + 1 FROM n) SELECT i, geom FROM n, a",
        "WITH RECURSIVE n(i) AS (VALUES (1) UNION ALL SELECT i + 1 FROM n) SELECT i, geom FROM n, a WHERE i < 0",
        "WITH RECURSIVE n(i) AS (VALUES (1) UNION ALL SELECT i + 1 FROM n) SELECT count(*), null FROM n",
        "WITH RECURSIVE n(i) AS (VALUES (1) UNION ALL SELECT i + 1 FROM n LIMIT 4000) "
        "SELECT i, geom || zeroblob(600000) FROM n, a",
    ],
)
def test_views_without_an_end(tmp_path, monkeypatch, query):
    for name, smaller in (("_STEPS", 10**6), ("_STEPS_A_BYTE", 10), ("_BATCH", 64)):
        monkeypatch.setattr(geopackage, name, smaller)
    refused(LimitError, r"a\.gpkg", vorotool.read, with_view(save(frame(), tmp_path / "a.gpkg"), query, "i", "geom"))


def test_rows_are_counted_before_they_are_read(tmp_path):
    path = save(frame([shapely.Point(k, 0) for k in range(50)], n=list(range(50))), tmp_path / "a.gpkg")
    assert len(vorotool.read(path, max_sites=50)) == 50
    refused(LimitError, r"a\.gpkg", vorotool.read, path, max_sites=49)


def test_numbers_of_features_are_ids_unless_they_count(tmp_path):
    path = save(frame(), tmp_path / "a.gpkg")
    assert vorotool.read(path).ids is None
    assert vorotool.read(changed(path, "UPDATE a SET fid = fid + 100")).ids == [101, 102, 102, 103]


def test_values_of_other_types(tmp_path):
    """SQLite holds anything in any column."""
    shapes = [shapely.Point(1, 2), shapely.Point(3, 4)]
    path = save(frame(shapes, n=[1, 2], t=["a", "b"]), tmp_path / "a.gpkg")
    changed(
        path,
        "ALTER TABLE a ADD COLUMN day DATE",
        "ALTER TABLE a ADD COLUMN flag BOOLEAN",
        "ALTER TABLE a ADD COLUMN twice INTEGER AS (n * 2)",
        "UPDATE a SET n = 'many', day = 'soon', flag = 'maybe' WHERE fid = 1",
        "UPDATE a SET t = x'00ff', flag = 1 WHERE fid = 2",
    )
    points = vorotool.read(path)
    assert points.xy.tolist() == [[shape.x, shape.y] for shape in shapes]
    assert {name: points.properties[name] for name in ("n", "t", "day", "flag")} == {
        "n": ["many", 2], "t": ["a", None], "day": ["soon", None], "flag": ["maybe", True],
    }  # fmt: skip


def test_databases_that_are_none(tmp_path):
    changed(tmp_path / "a.sqlite", "CREATE TABLE a (x INTEGER)")
    refused(InputError, r"a\.sqlite", vorotool.read, tmp_path / "a.sqlite")
    data = save(frame(), tmp_path / "a.gpkg").read_bytes()
    (tmp_path / "a.gpkg").write_bytes(data[: len(data) // 2])
    refused(InputError, r"a\.gpkg", vorotool.read, tmp_path / "a.gpkg")


TABLE = pandas.DataFrame({"x": [1.5, 4, 9], "y": [2, 7.25, 1], "east": [10, 20, 30], "name": ["a", None, "c"]})


def test_a_table_without_geometry_holds_points(tmp_path):
    path = tmp_path / "a.gpkg"
    pyogrio.write_dataframe(TABLE, path, layer="t")
    points = vorotool.read(path)
    assert points.xy.tolist() == [[1.5, 2], [4, 7.25], [9, 1]]
    assert points.properties == {"east": [10, 20, 30], "name": ["a", None, "c"]}
    assert vorotool.read(path, columns="east,y").xy.tolist() == [[10, 2], [20, 7.25], [30, 1]]
    changed(path, "UPDATE t SET fid = 7 WHERE fid = 2")
    assert vorotool.read(path).properties["id"] == [1, 3, 7]
    refused(InputError, r"a\.gpkg", vorotool.read, path, geometry="polygons")


def test_tables_beside_layers_with_geometry(tmp_path):
    path = save(frame(), tmp_path / "a.gpkg")
    for name in ("t", "u"):
        pyogrio.write_dataframe(TABLE, path, layer=name, append=True)
    assert len(vorotool.read(path)) == 4  # of the one layer with geometry
    assert len(vorotool.read(f"{path}:u")) == 3
    refused(UsageError, "columns", vorotool.read, path, geometry="points", columns="x,y")
    refused(InputError, r"'v'.* a.* t, u", vorotool.read, f"{path}:v")
    changed(path, "DELETE FROM gpkg_contents WHERE table_name = 'a'")
    refused(InputError, r"choose one of t, u, as .*a\.gpkg:t", vorotool.read, path)
