"""Reads polygons from a text or bytes, and returns what a test compares."""

import io

import numpy as np
import pytest

from support.readers.sources import read_as
from vorotool.errors import InputError
from vorotool.formats.io.sources import Source
from vorotool.formats.results.features import write_polygons
from vorotool.numeric.coordinates import writing


def read(text, name="shapes.json", **options):
    data = text if isinstance(text, bytes) else text.encode()
    return read_as(Source(name, data), "polygons", **options)


def rings(shapes):
    """Kind, polygon and vertices of each ring."""
    rows = zip(shapes.ring_kind.tolist(), shapes.ring_polygon.tolist(), strict=True)
    return [(kind, polygon, shapes.ring(k).tolist()) for k, (kind, polygon) in enumerate(rows)]


def written(shapes, fmt, *, decimals=None):
    out = io.BytesIO()
    with writing(decimals):
        write_polygons(out, shapes, fmt)
    return out.getvalue().decode()


def assert_same(a, b):
    assert rings(a) == rings(b)
    np.testing.assert_array_equal(a.part, b.part)
    assert (a.ids, a.properties, a.y_axis, a.crs) == (b.ids, b.properties, b.y_axis, b.crs)


def error_of(text, name="shapes.json", kind=InputError, **options):
    with pytest.raises(kind) as caught:
        read(text, name, **options)
    return str(caught.value)


def notes_of(text, name="shapes.json", **options):
    notes = []
    read(text, name, note=notes.append, **options)
    return notes
