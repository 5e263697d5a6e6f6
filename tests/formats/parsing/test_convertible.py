"""Files that are known and not read."""

import numpy as np
import pytest

import vorotool
from vorotool.errors import InputError

FILES = {
    "logo.svg": b'<?xml version="1.0"?>\n<!-- made by hand --><svg xmlns="http://www.w3.org/2000/svg"/>',
    "drawing": b"\xef\xbb\xbf<svg>",
    "old.svg": b'<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" [ <!ENTITY a "b"> ]><svg/>',
    "plan.pdf": b"%PDF-1.7\n",
    "plan": b"%PDF-1.7\n",
}


@pytest.mark.parametrize("geometry", [None, "points", "polygons"])
@pytest.mark.parametrize("name", FILES)
def test_drawings(tmp_path, name, geometry):
    path = tmp_path / name
    path.write_bytes(FILES[name])
    tool = "pdftoppm" if b"PDF" in FILES[name] else "inkscape"
    with pytest.raises(
        InputError, match=rf"files are not read; make an image of it and give --threshold otsu.* {tool}"
    ):
        vorotool.read(path, geometry=geometry)


@pytest.mark.parametrize("geometry", [None, "points", "polygons"])
@pytest.mark.parametrize(
    "text", ["WKT,name\nPOINT (1 2),a\n", 'id;the_geom\n1;"POLYGON ((0 0, 4 0, 0 3, 0 0))"\n', "x1,geometry,y\n1,a,2\n"]
)
def test_columns_of_geometry(tmp_path, text, geometry):
    path = tmp_path / "towns.csv"
    path.write_text(text)
    column = next(name for name in ("WKT", "the_geom", "geometry") if name in text)
    with pytest.raises(InputError, match=rf"geometry in a column \({column}\).*_NAMES={column}$"):
        vorotool.read(path, geometry=geometry)


def test_a_column_of_geometry_beside_x_and_y_is_a_column(tmp_path):
    (tmp_path / "towns.csv").write_text("x,y,WKT\n1,2,POINT (1 2)\n")
    assert vorotool.read(tmp_path / "towns.csv").xy.tolist() == [[1, 2]]


@pytest.mark.parametrize("text", ['{"type": \n"Point"\n', '{"a": 1}\n[1]\n', "[[1, 2],\n[3, 4]\n"])
def test_other_json_is_told_where_it_is_wrong(tmp_path, text):
    (tmp_path / "a.json").write_text(text)
    with pytest.raises(InputError, match=r"line \d, column \d: this is not JSON"):
        vorotool.read(tmp_path / "a.json")


@pytest.mark.parametrize("shape", [(1000, 3), (2, 1000), (3, 1000)])
def test_arrays_that_are_lists(tmp_path, shape):
    np.save(tmp_path / "a.npy", np.random.default_rng(1).random(shape))
    image = vorotool.read(tmp_path / "a.npy")
    with pytest.raises(InputError, match=r"a list of points\? save x and y as one of shape \(n, 2\)"):
        vorotool.outlines(image)


@pytest.mark.parametrize("geometry", [None, "points", "polygons"])
@pytest.mark.parametrize(
    ("name", "data", "advice"),
    [
        ("a.eps", b"%!PS-Adobe-3.0 EPSF-3.0\n", r"otsu, for example: gs -o a\.png .* a\.eps$"),
        ("a.ai", b"%PDF-1.4\n", r"gs -o a\.png .* a\.ai$"),
        ("page", b"%!PS\n", r"\.ps files are not read; .*gs -o FILE\.png .* FILE\.ps$"),
        ("a.dwg", b"AC1032\0", r"save it as DXF .*ogr2ogr -f GeoJSON a\.geojson a\.dxf$"),
        ("plan", b"AC1015\0", r"\.dwg files are not read"),
        ("a.svgz", b"\x1f\x8b", r"gzip -dc a\.svgz > a\.svg; then .*inkscape a\.svg "),
        ("a.zip", b"PK\3\4", r"unpack it, and give a file that is in it: unzip a\.zip$"),
    ],
)
def test_files_that_others_open(tmp_path, monkeypatch, name, data, advice, geometry):
    monkeypatch.chdir(tmp_path)
    (tmp_path / name).write_bytes(data)
    with pytest.raises(InputError, match=advice):
        vorotool.read(name, geometry=geometry)
