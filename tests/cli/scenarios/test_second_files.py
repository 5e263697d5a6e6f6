"""Files beside the input: converted where they state a unit, in the coordinates of the input where they do not."""

import json
from fractions import Fraction

import ezdxf
import pytest
import shapely
import tifffile

from support.families.geojson import collection
from support.families.rasters import MASK, write_sized

METERS = {"mm": Fraction(1, 1000), "um": Fraction(1, 10**6), "in": Fraction(254, 10**4), "m": Fraction(1)}
SITES = [shapely.box(0, 0, 10, 10), shapely.box(30, 5, 40, 15), shapely.box(8, 30, 20, 40)]
CLIP = shapely.box(-5, -5, 35, 45)
CODES = {"in": 1, "mm": 4, "m": 6}


def text(geometries, unit=None, **members):
    members |= {} if unit is None else {"unit": unit}
    return collection(geometries, [{"kind": k} for k in range(len(geometries))], **members)


def scaled(shape, factor):
    return shapely.transform(shape, lambda xy: xy * float(factor))


def dxf(path, shape, unit):
    drawing = ezdxf.new(units=CODES[unit])
    for ring in shapely.get_parts(shape):
        drawing.modelspace().add_lwpolyline(ring.exterior.coords[:-1], close=True)
    drawing.saveas(path)


def areas(done):
    return [float(row["area"]) for row in done.rows]


@pytest.mark.parametrize(
    ("first", "second", "option"), [("mm", "in", "--clip"), ("in", "um", "--enclosures"), ("m", "mm", "--clip")]
)
def test_a_file_in_another_unit(run, tmp_path, first, second, option):
    """The same rectangle, in the unit of the sites, and in another one."""
    (tmp_path / "in.geojson").write_text(text(SITES, first))
    (tmp_path / "same.geojson").write_text(text([CLIP], first))
    other = scaled(CLIP, METERS[first] / METERS[second])
    (tmp_path / "other.geojson").write_text(text([other], second))
    words = ["voronoi", "in.geojson", "--what", "table", "-f", "csv", "--frame=-50,-50,150,150", option]
    expected = areas(run(*words, "same.geojson"))
    done = run(*words, "other.geojson")
    assert areas(done) == pytest.approx(expected, rel=1e-12)
    assert done.err == ""
    assert sum(expected) == pytest.approx(40 * 50 if option == "--clip" else 150 * 150)


def test_drawings_state_theirs(run, tmp_path):
    (tmp_path / "in.geojson").write_text(text(SITES, "mm"))
    dxf(tmp_path / "clip.dxf", scaled(CLIP, METERS["mm"] / METERS["in"]), "in")
    assert sum(areas(run("voronoi in.geojson --clip clip.dxf --what table -f csv"))) == pytest.approx(40 * 50)
    points = [shapely.Point(xy) for xy in [(1, 2), (20, 30), (5, 40)]]
    (tmp_path / "points.geojson").write_text(text(points, "mm"))
    done = run("delaunay points.geojson --clip clip.dxf --what table -f csv")
    assert sum(areas(done)) == pytest.approx(40 * 50)


# ---- images -------------------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("command", "size"), [("voronoi", ""), ("delaunay", "--pixel-size auto"), ("voronoi", "--pixel-size 0.5um")]
)
def test_results_clip_results(run, tmp_path, command, size):
    """What vorotool writes of an image in um clips the image, whatever its results are in."""
    write_sized(tmp_path / "in.tif")
    words = [command, "in.tif", *size.split(), "--what", "table", "-f", "csv"]
    half = [shapely.box(-0.5, -0.5, 29.5, 39.5)]
    (tmp_path / "pixels.geojson").write_text(text(half, y_axis="down"))
    (tmp_path / "um.geojson").write_text(text([scaled(half[0], 0.5)], "um", y_axis="down"))
    side = Fraction(1, 2) if size else 1
    plain, stated = run(*words, "--clip", "pixels.geojson"), run(*words, "--clip", "um.geojson")
    assert areas(plain) == areas(stated)
    assert sum(areas(plain)) == pytest.approx(float(30 * 40 * side**2))
    assert "pixels.geojson states no unit: its coordinates are assumed to be pixels of in.tif" in plain.err
    assert "um.geojson" not in stated.err
    run("voronoi in.tif --pixel-size 0.5um -o cells.geojson -q")
    assert json.loads((tmp_path / "cells.geojson").read_text())["unit"] == "um"
    done = run(*words, "--clip", "cells.geojson")
    assert sum(areas(done)) == pytest.approx(float(60 * 40 * side**2))
    assert "cells.geojson" not in done.err


# ---- what states none ---------------------------------------------------------------------------
def test_what_states_none_is_as_it_is(run, tmp_path):
    (tmp_path / "in.geojson").write_text(text(SITES, "mm"))
    (tmp_path / "clip.wkt").write_text(CLIP.wkt)
    done = run("voronoi in.geojson --clip clip.wkt --what table -f csv")
    assert sum(areas(done)) == pytest.approx(40 * 50)
    assert "clip.wkt states no unit: its coordinates are assumed to be those of in.geojson" in done.err


def test_a_unit_that_cannot_be_converted(run, tmp_path):
    (tmp_path / "in.wkt").write_text("\n".join(each.wkt for each in SITES))
    (tmp_path / "clip.geojson").write_text(text([CLIP], "mm"))
    words = ["voronoi", "in.wkt", "--clip", "clip.geojson", "--what", "table", "-f", "csv"]
    done = run(*words)
    assert sum(areas(done)) == pytest.approx(40 * 50)
    assert "warning: clip.geojson is in mm, but the unit of in.wkt is unknown" in done.err
    run(*words, "--strict", code=3)
    assert sum(areas(run(*words, "--strict", "--pixel-size", "1cm"))) == pytest.approx(4 * 5)


# ---- distances -----------------------------------------------------------------------------------
def test_distances_of_two_files(run, tmp_path):
    """3 mm apart, in whatever unit the second is."""
    (tmp_path / "a.geojson").write_text(text([shapely.box(0, 0, 4, 4)], "mm"))
    b = scaled(shapely.box(7, 0, 9, 4), METERS["mm"] / METERS["in"])
    (tmp_path / "b.geojson").write_text(text([b], "in"))
    done = run("distance a.geojson b.geojson --what smallest -f csv")
    assert float(done.rows[0]["distance"]) == pytest.approx(3, rel=1e-12)
    run("distance a.geojson b.geojson -o o.geojson -q")
    assert json.loads((tmp_path / "o.geojson").read_text())["unit"] == "mm"
    assert shapely.from_geojson((tmp_path / "o.geojson").read_text()).bounds[2] == pytest.approx(9)
    (tmp_path / "c.wkt").write_text(shapely.box(7, 0, 9, 4).wkt)
    done = run("distance a.geojson c.wkt --what smallest -f csv")
    assert (float(done.rows[0]["distance"]), "c.wkt states no unit" in done.err) == (3, True)


# ---- pictures over an image ---------------------------------------------------------------------
@pytest.mark.parametrize(
    ("command", "fmt"),
    [("delaunay --layers points", "svg"), ("alphashape -r {}", "png"), ("voronoi --frame {f}", "svg"), ("draw", "png")],
)
def test_pictures_over_an_image(run, tmp_path, command, fmt):
    """Coordinates in nm over pixels of 0.5 um: as the same in pixels."""
    write_sized(tmp_path / "im.tif")
    shapes = [shapely.Point(xy) for xy in [(1, 2), (50, 30), (5, 36), (30, 9)]]
    shapes = shapes if command.startswith(("del", "alp")) else SITES
    (tmp_path / "pixels.geojson").write_text(text(shapes, y_axis="down"))
    (tmp_path / "nm.geojson").write_text(text([scaled(each, 500) for each in shapes], "nm", y_axis="down"))
    written = []
    for name, side in (("pixels", 1), ("nm", 500)):
        words = command.format(40 * side, f=",".join(str(side * each) for each in (0, 0, 40, 40))).split()
        done = run(words[0], f"{name}.geojson", *words[1:], "--overlay", "im.tif", "-o", f"{name}.{fmt}")
        assert done.err == ""
        written.append((tmp_path / f"{name}.{fmt}").read_bytes())
    assert written[0] == written[1]


def test_an_overlay_without_a_size(run, tmp_path):
    tifffile.imwrite(tmp_path / "im.tif", MASK)
    (tmp_path / "in.geojson").write_text(text(SITES, "mm"))
    run("voronoi in.geojson --overlay im.tif -o o.png", says="im.tif states no pixel size")


# ---- one table of many ---------------------------------------------------------------------------
def test_one_table_has_one_unit(run, tmp_path):
    """Lengths of files in other units are not put below each other; which unit it is the statistics say."""
    folder = tmp_path / "in"
    folder.mkdir()
    dxf(folder / "a.dxf", shapely.MultiPolygon(SITES), "mm")
    dxf(folder / "b.dxf", shapely.MultiPolygon(SITES), "in")
    run("voronoi in --table all.csv -q", code=3, says="lengths in mm (in/a.dxf) and in inch (in/b.dxf)")
    (folder / "b.dxf").unlink()
    dxf(folder / "c.dxf", shapely.MultiPolygon(SITES), "mm")
    run("voronoi in --table all.csv -q")
    resumed = ("voronoi", "in", "--out-dir", "out", "--table", "all.csv", "-q", "--resume")
    run(*resumed)
    dxf(folder / "d.dxf", shapely.MultiPolygon(SITES), "in")  # the others are kept
    run(*resumed, code=3, says="in mm (in/a.dxf) and in inch (in/d.dxf)")
    run("voronoi in/a.dxf -o a.csv --stats s.json -q")
    assert json.loads((tmp_path / "s.json").read_text())["unit"] == "mm"


@pytest.mark.parametrize("name", ["cells.gpkg", "cells.shp"])
def test_files_of_maps_state_it_in_a_column(run, tmp_path, name):
    """Where a format has no member: what vorotool writes of an image in um clips that image."""
    import geopandas

    write_sized(tmp_path / "in.tif")
    run(f"voronoi in.tif --pixel-size auto -o {name} -q")
    assert set(geopandas.read_file(tmp_path / name)["unit"]) == {"um"}
    done = run(f"voronoi in.tif --clip {name} --what table -f csv")
    assert sum(areas(done)) == pytest.approx(60 * 40)
    assert f"{name} states no unit" not in done.err
    run("voronoi in.tif -o plain.gpkg -q")
    assert "unit" not in geopandas.read_file(tmp_path / "plain.gpkg")
