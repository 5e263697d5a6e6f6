"""``--min-area`` and ``--fill-holes``, whose value may be missing: which argument is taken for one."""

import pytest

from vorotool.cli.values.lengths import with_hole_areas

FILL = "--fill-holes"


@pytest.mark.parametrize(
    ("typed", "expected"),
    [
        ([FILL], ["--fill-holes=all"]),
        ([FILL, "a.png"], ["--fill-holes=all", "a.png"]),
        ([FILL, "12.tif", "-o", "b.png"], ["--fill-holes=all", "12.tif", "-o", "b.png"]),
        ([FILL, "3.m"], ["--fill-holes=all", "3.m"]),
        (["a.png", FILL, "-"], ["a.png", "--fill-holes=all", "-"]),
        ([FILL, "-5", "a.png"], ["--fill-holes=-5", "a.png"]),
        ([FILL, "12", "a.png"], ["--fill-holes=12", "a.png"]),
        ([FILL, "2.5", FILL, ".5e1", "a.png"], ["--fill-holes=2.5", "--fill-holes=.5e1", "a.png"]),
        ([FILL, FILL, "5µm²"], ["--fill-holes=all", "--fill-holes=5µm²"]),
        ([FILL, "1e-3", "a.png"], ["--fill-holes=1e-3", "a.png"]),
        ([FILL, "3.h5"], ["--fill-holes=all", "3.h5"]),
        ([FILL, "5parsec2"], ["--fill-holes=5parsec2"]),
        ([FILL, "5 pixels"], ["--fill-holes=5 pixels"]),
        ([FILL, "5 um^2"], ["--fill-holes=5 um^2"]),
        (["--fill-holes=7", "8"], ["--fill-holes=7", "8"]),
        ([FILL, "--", FILL, "3"], ["--fill-holes=all", "--", FILL, "3"]),
        (["--", FILL, "3"], ["--", FILL, "3"]),
        ([], []),
    ],
)
def test_which_argument_is_the_area(typed, expected):
    assert with_hole_areas(typed) == expected
