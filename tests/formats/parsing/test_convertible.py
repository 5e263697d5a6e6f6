"""Files that are known and not read."""

import numpy as np
import pytest

import vorotool
from support.refusals import refused
from vorotool.errors import InputError

FONTS = {".ttf": b"\0\1\0\0\0\x0f", ".otf": b"OTTO\0\x0f", ".woff2": b"wOF2\0\1", ".ttc": b"ttcf\0\1"}


@pytest.mark.parametrize("geometry", [None, "points", "polygons"])
@pytest.mark.parametrize("suffix", FONTS)
def test_fonts(tmp_path, suffix, geometry):
    for name in (f"a{suffix}", "font"):
        (tmp_path / name).write_bytes(FONTS[suffix])
        with pytest.raises(InputError, match=rf"\{suffix} files are not supported; it is a font: write the text"):
            vorotool.read(tmp_path / name, geometry=geometry)


@pytest.mark.parametrize("geometry", [None, "points", "polygons"])
@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x1,geometry,y\n1,a,2\n", "line 2: 'a'"),
        ('wkt\n"POLYGON ((0 0))"\n', "line 2"),
        ("id,wkb\n1,0101\n", "line 2: '0101'"),
    ],
)
def test_columns_of_geometry_that_is_none(tmp_path, text, message, geometry):
    path = tmp_path / "towns.csv"
    path.write_text(text)
    refused(InputError, f"towns.csv, {message}", vorotool.read, path, geometry=geometry)


@pytest.mark.parametrize("text", ['{"type": \n"Point"\n', '{"a": 1}\n[1]\n', "[[1, 2],\n[3, 4]\n"])
def test_other_json_is_told_where_it_is_wrong(tmp_path, text):
    (tmp_path / "a.json").write_text(text)
    refused(InputError, r"line \d, column \d: .* not valid JSON", vorotool.read, tmp_path / "a.json")


@pytest.mark.parametrize("shape", [(1000, 3), (2, 1000), (3, 1000)])
def test_arrays_that_are_lists(tmp_path, shape):
    np.save(tmp_path / "a.npy", np.random.default_rng(1).random(shape))
    image = vorotool.read(tmp_path / "a.npy")
    refused(InputError, r"a list of points\? save x and y with shape \(n, 2\)", vorotool.outlines, image)


@pytest.mark.parametrize("geometry", [None, "points", "polygons"])
@pytest.mark.parametrize(
    ("name", "data", "advice"),
    [
        ("a.eps", b"%!PS-Adobe-3.0 EPSF-3.0\n", r"otsu., .*: gs -o a\.png .* a\.eps; or.*inkscape a\.eps .*a\.svg$"),
        ("a.ai", b"%PDF-1.4\n", r"gs -o a\.png .* a\.ai; or"),
        ("page", b"%!PS\n", r"\.ps files are not supported; .*gs -o FILE\.png .* FILE\.ps; or"),
        ("a.dwg", b"AC1032\0", r"save it as DXF .*dwg2dxf -o a\.dxf a\.dwg$"),
        ("plan", b"AC1015\0", r"\.dwg files are not supported"),
        ("a.zip", b"PK\3\4", r"unpack it, .*: unzip a\.zip$"),
    ],
)
def test_files_that_others_open(tmp_path, monkeypatch, name, data, advice, geometry):
    monkeypatch.chdir(tmp_path)
    (tmp_path / name).write_bytes(data)
    refused(InputError, advice, vorotool.read, name, geometry=geometry)
