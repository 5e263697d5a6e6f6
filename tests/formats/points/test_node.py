"""Points from Triangle's .node files."""

import pytest

from support.readers.point_reading import error_of, read


@pytest.mark.parametrize("base", [0, 1])
def test_node(base):
    text = f"# box\n3 2 1 1 # header\n{base} 0 0 1.50 1\n{base + 1} 4 0.5 2 0\n\n{base + 2} -4 1e1 x 7 # last\n"
    points = read(text, "box.node")
    assert points.xy.tolist() == [[0, 0], [4, 0.5], [-4, 10]]
    assert points.labels is None
    assert points.properties == {"attribute_1": ["1.50", "2", "x"], "boundary_marker": ["1", "0", "7"]}
    assert read(text, "box.node", properties=False).properties == {}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", ".node"),
        ("1.5 2\n", "line 1: '1.5 2'"),
        ("#\n1 3 0 0\n1 0 0 0\n", "line 2"),
        ("2 2 0 0\n1 0 0\n", "line 1"),
        ("1 2 0 0\n1 0 0\n2 0 0\n", "line 1"),
        ("2 2 0 0\n1 0 0\n#\n3 0 0\n", "line 4: vertex 3"),
        ("1 2 0 0\n1 0 b\n", "line 2: 'b' in column 3"),
        (
            "1 2 1 0\n1 0 0\n",
            ", line 2: 3 fields, but each vertex after the header (line 1) has 4; give every "
            "line the same number of "
            "fields",
        ),
        (
            "1 2 0 2\n1 0 0 0 0\n",
            ", line 1: 0 attributes and 2 boundary markers per vertex; write <vertices> 2 "
            "<attributes> <0 or 1 boundary markers>",
        ),
    ],
)
def test_bad_node(text, message):
    error = error_of(text, "a.node")
    assert error.startswith("a.node")
    assert message in error
