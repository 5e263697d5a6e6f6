"""Points from delimited text: which columns are read, and what each bad line is told."""

import pytest

from support.readers.point_reading import error_of, notes_of, read, rows
from vorotool.errors import InputError, LimitError, UsageError
from vorotool.formats.io.sources import STANDARD_INPUT


@pytest.mark.parametrize(
    "text",
    [
        "1,2\n3,4.5\n",
        "1;2\r\n3;4.5\r\n",
        "1\t2\n3\t4.5",
        " 1   2 \n3 4.5\n",
        "1, 2\r3, 4.5\r",
        "\ufeff1,2\n3,4.5\n",
        "\ufeffx,y\n1,2\n3,4.5\n",
        "# made by hand\n\nX;Y\n1;2\n# more\n3;4.5\n",
        '"x","y"\n"1","2"\n"3","4.5"\n',
        "x y\n1 2\n3 4.5\n",
        "y,x\n2,1\n4.5,3\n",
    ],
)
def test_two_columns(text):
    assert rows(text) == [[1, 2], [3, 4.5]]
    assert rows(text, STANDARD_INPUT) == [[1, 2], [3, 4.5]]


@pytest.mark.parametrize(
    ("header", "used", "point"),
    [
        ("id,X,Y", "X, Y", [2, 3]),
        ("x,y,lon,lat", "x, y", [1, 2]),
        ("Lat,Lon,z", "Lon, Lat", [2, 1]),
        ("latitude,longitude,z", "longitude, latitude", [2, 1]),
        ("name,centroid-0,centroid-1", "centroid-1, centroid-0", [3, 2]),
        ("index,axis-0,axis-1", "axis-1, axis-0", [3, 2]),
    ],
)
def test_recognised_headers(header, used, point):
    text = f"{header}\n" + ",".join(str(i + 1) for i in range(header.count(",") + 1))
    assert rows(text) == [point]
    notes = notes_of(text)
    if used.lower() == "x, y":  # needs no word
        assert notes == []
        return
    assert notes[0] == f"seeds.csv: columns {used} are read as x, y"
    is_map = used.lower().startswith("lon")
    others = [note for note in notes[1:] if "the column z is ignored" not in note]
    assert ["to_crs" in note for note in others] == [True] * is_map
    assert any("the column z" in note for note in notes) == ("z" in header)
    points = read(text)
    assert (points.y_axis == "up") == is_map
    assert points.crs == ({"type": "name", "properties": {"name": "urn:ogc:def:crs:OGC:1.3:CRS84"}} if is_map else None)


def test_labels():
    points = read("label,x,y\n7,1,2\n9,3,4\n")
    assert points.labels.tolist() == [7, 9]
    assert points.properties == {}
    assert notes_of("x,y,label\n1,2,7\n") == []
    for columns in (None, "x,y,label"):
        points = read("x,y,label,name\n1,2,7,a\n", columns=columns)
        assert points.labels.tolist() == [7]
        assert points.properties == {"name": ["a"]}
    assert read("1,2,7\n", columns="1,2,3").labels.tolist() == [7]
    assert read("x,y,label\n1,2,4294967295.0\n").labels.tolist() == [4294967295]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x,y,label\n1,2,3\n\n4,5,0\n", "line 4: the label 0 "),
        ("x,y,label\n1,2,1.5\n", "line 2: the label 1.5 "),
        ("x,y,label\n1,2,b\n", "line 2: 'b' in column 3"),
    ],
)
def test_labels_that_are_none(text, message):
    assert message in error_of(text, columns="x,y,label")
    points = read(text)
    assert (points.labels, list(points.properties)) == (None, ["label"])
    [note] = notes_of(text)
    assert "label" in note


@pytest.mark.parametrize(
    ("columns", "point"),
    [("1,2", [1, 2]), ("3,1", [3, 1]), ("b,a", [2, 1]), ("A,3", [1, 3]), (" c , 2 ", [3, 2])],
)
def test_chosen_columns(columns, point):
    assert rows("a,b,c\n1,2,3\n", columns=columns) == [point]


def test_chosen_columns_without_a_header():
    assert rows("1,2,3\n4,5,6\n", columns="3,1") == [[3, 1], [6, 4]]
    assert rows("n1,2,3\nn2,5,6\n", columns="2,3") == [[2, 3], [5, 6]]
    [note] = notes_of("n,lon,lat\nn1,5,6\n", columns="lon,lat")
    assert note.startswith("seeds.csv: ")
    assert 'to_crs="EPSG:32631"' in note


def test_further_columns_stay_text():
    text = '"id",x,,y,id\n007,1,é,2,"a, ""b"""\n008,3,,4,\n'
    assert read(text).properties == {"id": ["007", "008"], "column_3": ["é", ""], "id_2": ['a, "b"', ""]}
    assert read(text, properties=False).properties == {}


@pytest.mark.parametrize("text", ["", "\n\n", "# nothing\n", "\ufeff", "x,y\n", "a,x,y"])
def test_no_points(text):
    assert len(read(text)) == 0


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x,y\n1,2\n# c\n\n3,abc\n", "line 5: 'abc' in column 2"),
        ("1,2\n3,\n", "line 2: column 2"),
        ("1,2\nNaN,3\n", "line 2: 'NaN' in column 1"),
        ("inf,2\n", "line 1: 'inf' in column 1"),
        ("x;y\r\n1;2\r\n1,5;2\r\n", "line 3: '1,5' in column 1"),
        ("1,5;2,5\n", "line 1: '1,5' in column 1"),
        ("1,2\n3,4\n5,6,7\n", "line 3"),
        ("#\nx,y\n1\n", "line 3"),
        ('1,2\n3,"4\n5,6\n', "line 2"),
    ],
)
def test_bad_lines(text, message):
    error = error_of(text)
    assert error.startswith("seeds.csv")
    assert message in error
    assert error_of(text, threads=1) == error_of(text, threads=3)


@pytest.mark.parametrize(
    ("text", "own"),
    [
        ("1,2,3\n", ["1 = 1, 2 = 2, 3 = 3", "1,2"]),
        ("id,east,north\n1,2,3\n", ["1 = id, 2 = east, 3 = north", "east,north"]),
        ("lng,lat\n1,2\n", ["1 = lng, 2 = lat", "lng,lat"]),
        ("1|2\n", ["'1|2'"]),
    ],
)
def test_unknown_columns(text, own):
    error = error_of(text)
    assert error.startswith("seeds.csv")
    assert all(each in error for each in own)


@pytest.mark.parametrize("columns", ["x", "x,y,label,more", "x,,y", "", "0,1", "x,x", "1,1"])
def test_malformed_columns(columns):
    message = error_of("x,y\n1,2\n", kind=UsageError, columns=columns)
    assert f"{columns!r}" in message


def test_columns_that_are_not_there():
    for columns, own in (("x,z", "'z'"), ("1,3", "column 3")):
        message = error_of("x,y\n1,2\n", columns=columns)
        assert message.startswith("seeds.csv: ")
        assert own in message
        assert "1 = x, 2 = y" in message
    assert "columns" in error_of("x,y\n1,2\n", columns="x,1")


def test_other_encodings():
    assert "UTF-16" in error_of("1,2\n".encode("utf-16"))
    assert "binary" in error_of(b"\x7fELF\0\0")
    message = error_of("x,y,name\n1,2,a\n3,4,é\n".encode("latin-1"))
    assert message.startswith("seeds.csv, line 3: ")
    assert "0xe9" in message
    assert "properties=False" in message
    assert len(read("x,y,name\n1,2,é\n".encode("latin-1"), properties=False)) == 1


def test_the_limit_of_text():
    text = "# c\nx,y\n\n1,2\n3,4\n5,6\n"
    assert len(read(text, max_sites=3)) == 3
    message = error_of(text, kind=LimitError, max_sites=2)
    assert message.startswith("seeds.csv ")
    assert "max_sites" in message


def test_names_of_columns_are_shown_as_a_shell_takes_them():
    with pytest.raises(InputError) as caught:
        read("x (µm),y (µm)\n1,2\n")
    assert "for example --columns 'x (µm),y (µm)'" in caught.value.typed
    assert 'for example columns="x (µm),y (µm)"' in str(caught.value)
    assert 'columns="col,row"' in error_of("row,col\n1,2\n")  # x goes along a row
    message = error_of("x,y,x\n1,2,3\n")
    assert 'columns="1,2"' in message  # by name, x would be two columns
