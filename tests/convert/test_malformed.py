"""Malformed values of the arguments that all functions share: errors of ours, whatever is inside."""

import pathlib

import numpy as np
import pytest

import vorotool
from vorotool import VorotoolError, VorotoolWarning

RING = [[0, 0], [4, 0], [0, 3]]


def closed_file():
    with pathlib.Path(__file__).open(encoding="utf-8") as file:
        return file




@pytest.mark.parametrize(
    "by", [5, [[1]] * 3, [{"name": "a"}] * 3, float("nan"), np.array(3.5), object(), closed_file()]
)
def test_by(by):
    with pytest.raises(VorotoolError, match="by"):
        vorotool.voronoi(RING, by=by)


def test_by_a_path_into_objects():
    features = [
        {
            "type": "Feature",
            "geometry": {"type": "Point", "coordinates": [x, 0]},
            "properties": {"classification": {"name": name}},
        }
        for x, name in enumerate("aba")
    ]
    document = {"type": "FeatureCollection", "features": features}
    assert vorotool.voronoi(document, by="classification.name").ids == ["a", "b"]
    with pytest.raises(VorotoolError, match=r"classification\.name|column\.name"):
        vorotool.voronoi(document, by="classification")
    with pytest.raises(VorotoolError, match=r"classification\.color"):
        vorotool.voronoi(document, by="classification.color")
