"""Reads points from a text or bytes, and returns what a test compares: coordinates, an error, notes."""

import io

import numpy as np
import pytest

from vorotool.errors import InputError
from vorotool.formats.io.sources import Source
from vorotool.formats.points.reader import read_points


def read(text, name="seeds.csv", **options):
    data = text if isinstance(text, bytes) else text.encode()
    return read_points(Source(name, data), **options)


def rows(text, name="seeds.csv", **options):
    return read(text, name, **options).xy.tolist()


def error_of(text, name="seeds.csv", kind=InputError, **options):
    with pytest.raises(kind) as caught:
        read(text, name, **options)
    return str(caught.value)


def notes_of(text, name="seeds.csv", **options):
    notes = []
    read(text, name, note=notes.append, **options)
    return notes


def npy(array, **options):
    out = io.BytesIO()
    np.save(out, array, **options)
    return out.getvalue()
