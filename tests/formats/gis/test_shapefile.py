"""The files of a Shapefile are replaced together."""

import errno
import os
from pathlib import Path

import geopandas
import pyogrio
import pytest
import shapely

import vorotool
from support.few import few
from support.processes.leftovers import contents
from support.refusals import refused
from vorotool.convert.polygons import as_polygons
from vorotool.errors import OutputError, VorotoolWarning

PARTS = (".shp", ".shx", ".dbf", ".prj", ".cpg")


def boxes(count, crs=None):
    return as_polygons(geopandas.GeoSeries([shapely.box(2 * k, 0, 2 * k + 1, 1) for k in range(count)], crs=crs))


@pytest.fixture
def older(tmp_path):
    """A Shapefile with a reference system, an index of another program, and what is the user's own."""
    vorotool.write(boxes(3, crs="EPSG:2056"), tmp_path / "a.shp")
    for ending in (".qix", ".SBN", ".shp.xml", ".qml"):
        (tmp_path / f"a{ending}").write_text(f"older {ending}")
    return tmp_path


@pytest.mark.parametrize("part", PARTS)
@pytest.mark.parametrize("crs", ["EPSG:3857", None])
def test_no_part_is_replaced_if_one_cannot_be(older, monkeypatch, part, crs):
    before, replace = contents(older), os.replace

    def fail(path, target):
        if str(path).endswith(".tmp") and Path(target).suffix == part:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        replace(path, target)

    monkeypatch.setattr(os, "replace", fail)
    if crs is None and part == ".prj":
        vorotool.write(boxes(900, crs), older / "a.shp")
        assert len(vorotool.read(older / "a.shp")) == 900
        return
    refused(OutputError, rf"a\{part}", vorotool.write, boxes(900, crs), older / "a.shp")
    assert contents(older) == before


def test_parts_that_the_new_one_lacks_go_and_the_users_own_stay(older):
    (older / "ab.prj").write_text("of another")
    vorotool.write(boxes(2), older / "a.shp")
    assert sorted(contents(older)) == ["a.cpg", "a.dbf", "a.qml", "a.shp", "a.shp.xml", "a.shx", "ab.prj"]
    assert vorotool.read(older / "a.shp").crs is None


def test_what_gdal_cannot_write_is_an_output_error(older, monkeypatch):
    before = contents(older)

    def fail(*_, **__):
        raise pyogrio.errors.FeatureError(f"at index 7: {os.strerror(errno.ENOSPC)}")

    monkeypatch.setattr(pyogrio.raw, "write", fail)
    for fmt in ("shp", "gpkg", "fgb"):
        refused(OutputError, rf"a\.{fmt}", vorotool.write, boxes(2), older / f"a.{fmt}")
    assert contents(older) == before


@pytest.mark.parametrize("count", [0, 2])
@pytest.mark.parametrize("part", PARTS)
@pytest.mark.parametrize("size", few([20, -1, 0], 1))
def test_a_part_that_is_cut_off_is_not_taken(older, monkeypatch, part, size, count):
    before, write = contents(older), pyogrio.raw.write

    def cut(path, *arguments, **options):
        write(path, *arguments, **options)
        found = path.with_suffix(part)
        data = found.read_bytes()
        found.write_bytes(data[:size] if part != ".cpg" else b"")

    monkeypatch.setattr(pyogrio.raw, "write", cut)
    if part in (".dbf", ".prj") and size == -1:  # a mark of the end, which nobody needs
        return
    refused(OutputError, r"a\.shp", vorotool.write, boxes(count, "EPSG:2056"), older / "a.shp")
    assert contents(older) == before


def test_a_link_whose_other_parts_are_elsewhere(older):
    (older / "links").mkdir()
    link = older / "links/b.shp"
    link.symlink_to(older / "a.shp")
    before = contents(older)
    refused(OutputError, r"b\.shp", vorotool.write, boxes(2), link)
    assert contents(older) == before


def test_links_of_all_parts_stay_links(older):
    (older / "links").mkdir()
    for part in PARTS:
        (older / f"links/b{part}").symlink_to(older / f"a{part}")
    vorotool.write(boxes(900, "EPSG:2056"), older / "links/b.shp")
    assert all((older / f"links/b{part}").is_symlink() for part in PARTS)
    assert len(vorotool.read(older / "a.shp")) == 900


def test_what_a_shapefile_cannot_hold_is_told(tmp_path):
    columns = {"population_total": [7], "text": ["x" * 300], "tiny": [1e-300], "huge": [2**62 + 1], "empty": [""]}
    kept = {
        "n": [None],
        "third": [1 / 3],
        "million": [1e6],
        "b": [True],
        "day": ["2020-01-31"],
        "k": [-5],
        "nan": [None],
    }
    square = [shapely.box(0, 0, 1, 1)]
    for properties in (columns, kept):
        table = vorotool.offset(geopandas.GeoDataFrame(properties, geometry=square), -0.25)
        if properties is kept:
            vorotool.write(table, tmp_path / "a.shp")
            continue
        with pytest.warns(VorotoolWarning) as told:
            vorotool.write(table, tmp_path / "a.shp")
        (line,) = told
        assert "population_total is population; values of text, tiny, huge differ; a GeoPackage" in str(line.message)
