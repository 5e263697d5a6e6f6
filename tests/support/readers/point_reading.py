"""Reads points from a text or bytes, and returns what a test compares: coordinates, an error, notes."""

import io

import numpy as np
import pytest

from support.readers.sources import read_as
from vorotool.errors import InputError
from vorotool.formats.io.sources import NPY as MAGIC
from vorotool.formats.io.sources import Source
from vorotool.formats.opening import read_recognized
from vorotool.formats.parsing.reader_options import ReadOptions


def read(text, name="seeds.csv", **options):
    data = text if isinstance(text, bytes) else text.encode()
    if data.startswith(MAGIC) and not options.get(
        "input_format"
    ):  # of three columns, too, which `vorotool.read` takes for an image
        return read_recognized("points", Source(name, data, "npy"), ReadOptions(**options))
    return read_as(Source(name, data), "points", **options)


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
