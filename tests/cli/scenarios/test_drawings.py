"""Drawings on the command line: streams, batches, options, from a logo to the way of a bit, what is said."""

import gzip
import os
import threading

import ezdxf
import numpy as np
import pytest

import vorotool
from support.documents import DATA

LOGO = DATA / "logo.svg"
NOISY = (
    '<svg xmlns="http://www.w3.org/2000/svg"><circle r="4" fill="none" stroke="red"/><g display="none"><path/></g>'
    '<path d="M0 0L9 9" fill="none"/></svg>'
)


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "logo.svg").write_bytes(LOGO.read_bytes())
    drawing = ezdxf.new()
    drawing.units = 4
    for ends in (((0, 0), (40, 0)), ((40, 0), (40, 30)), ((40, 30), (0, 30.0001)), ((0, 30), (0, 0))):
        drawing.modelspace().add_line(*ends, dxfattribs={"layer": "plate"})
    drawing.modelspace().add_circle((20, 15), 5, dxfattribs={"layer": "plate"})
    drawing.saveas(tmp_path / "plate.dxf")
    return tmp_path


def test_streams_give_the_same_bytes(run, folder):
    from_file = run("skeleton-exact logo.svg -f dxf")
    for data in (LOGO.read_bytes(), gzip.compress(LOGO.read_bytes())):
        assert run("skeleton-exact - -f dxf", data=data).out == from_file.out
    os.mkfifo(folder / "pipe")
    feeder = threading.Thread(target=lambda: (folder / "pipe").write_bytes(LOGO.read_bytes()))
    feeder.start()
    assert run("skeleton-exact pipe -f dxf").out == from_file.out
    feeder.join()
    assert "<path" in run("draw - -f svg", data=from_file.out.encode()).out


def test_from_a_logo_to_the_way_of_a_bit(run, folder):
    assert run("skeleton-exact logo.svg --prune angle=40 --what points --every 0.5 -o a.dxf").err == ""
    drawing = ezdxf.readfile("a.dxf")
    places = np.array([point.dxf.location for point in drawing.modelspace().query("POINT")])
    shapes = vorotool.read("logo.svg")
    axis = vorotool.prune(vorotool.skeleton_exact(shapes), angle=40)
    points = vorotool.points_along(axis, every=0.5).as_given
    assert np.array_equal(places, np.column_stack([points.xy * [1, -1], -points.radius]))
    assert drawing.units == 4
    assert np.ptp(shapes.xy[:, 0]) < 90


def test_notes(run, folder):
    (folder / "a.svg").write_text(NOISY)
    notes = ("1 closed line without a fill", "1 hidden element", "1 shape without fill and stroke")
    run("draw a.svg -f svg", says=[f"note: a.svg: {words}" for words in notes])
    assert run("draw a.svg -f svg -q").err == ""
