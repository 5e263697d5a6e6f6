"""A GeoPackage with layers that a run does not write is not replaced."""

import sqlite3

import shapely

import vorotool
from support.families.vector_files import frame, load
from support.refusals import refused
from vorotool.errors import OutputError

DOTS = "x,y\n0,0\n9,0\n0,9\n9,9\n4,5\n"


def test_other_layers_are_named_and_kept(run, tmp_path):
    (tmp_path / "dots.csv").write_text(DOTS)
    path = tmp_path / "map.gpkg"
    for layer in ("lakes", "rivers"):
        frame([shapely.box(0, 0, 1, 1)], name=["a"]).to_file(path, layer=layer, driver="GPKG")
    before = path.read_bytes()
    run("delaunay dots.csv --what cells -o map.gpkg", code=4, says=["lakes, rivers", "--overwrite"])
    assert path.read_bytes() == before
    cells = vorotool.voronoi_cells([[0, 0], [9, 0], [0, 9]])
    refused(OutputError, r"lakes, rivers.*overwrite=True", vorotool.write, cells, path)
    assert path.read_bytes() == before
    vorotool.write(cells, path, overwrite=True)
    assert len(load(path)) == 3
    run("delaunay dots.csv --what cells -o map.gpkg")
    assert len(load(path)) == 5
    edges = ["delaunay", "dots.csv", "--what", "edges", "-o", "map.gpkg"]
    run(*edges, code=4, says="cells")
    run(*edges, "--no-clobber", "--overwrite", code=4)
    assert len(load(path)) == 5
    run(*edges, "--overwrite")


def test_a_file_that_another_program_writes(tmp_path):
    """Its journal would be taken for one of the new file."""
    path = tmp_path / "a.gpkg"
    mesh = vorotool.delaunay([[0, 0], [9, 0], [0, 9]])
    vorotool.write(mesh, path, what="triangles")
    database = sqlite3.connect(path)
    database.execute("PRAGMA journal_mode=WAL")
    database.execute("CREATE TABLE mine (x)")
    database.commit()
    before = path.read_bytes()
    for overwrite in (False, True):
        refused(OutputError, r"a\.gpkg-wal", vorotool.write, mesh, path, what="triangles", overwrite=overwrite)
    assert path.read_bytes() == before
    database.close()


def test_what_is_no_geopackage_is_replaced(tmp_path):
    path = tmp_path / "a.gpkg"
    path.write_text("not one")
    vorotool.write(vorotool.voronoi_cells([[0, 0], [9, 0], [0, 9]]), path)
    assert len(load(path)) == 3
