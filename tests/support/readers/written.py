"""The bytes of a value in a format, as the library writes them, tables read back, and values compared."""

import csv
import io

import numpy as np

from vorotool.numeric.coordinates import current_decimals, writing
from vorotool.products.formats import FORMATS
from vorotool.products.registry import chosen_part, write_product

ARCS = ("vertices", "radius", "arcs", "control", "sites", "polygon", "side", "branch", "length", "error_bound")
"""Arrays of a skeleton."""


def streamed(product):
    """Give the formats of a product that a stream can hold: those of one file."""
    return [fmt for fmt in product.written if not FORMATS[fmt].parts]


def bytes_of(write, *arguments, **options):
    """Give what a function writes into a file that it is given first."""
    out, how = io.BytesIO(), {name: options.pop(name) for name in ("precision", "threads") if name in options}
    with writing(current_decimals(), **how):
        write(out, *arguments, **options)
    return out.getvalue()


def written(value, fmt, what=None, *, decimals=None, **options):
    """Give what a file would hold."""
    with writing(decimals):
        return bytes_of(write_product, value, chosen_part(value, fmt, what), fmt, **options)


def arrays_of(value, what=None):
    """Give the arrays of what is written as NPZ, of a value or of the bytes of a file."""
    with np.load(io.BytesIO(value if isinstance(value, bytes) else written(value, "npz", what))) as arrays:
        return dict(arrays)


def rows_of(text, delimiter=","):
    """Give the rows of a table in CSV or TSV, which may be bytes, by the names of its columns."""
    text = text if isinstance(text, str) else text.decode()
    return list(csv.DictReader(io.StringIO(text, newline=""), delimiter=delimiter))


def assert_same(names, one, other):
    """Compare some arrays of two values, number by number."""
    for name in names:
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name), err_msg=name)


def differing(one, other, names=ARCS):
    """Give the names of arrays that are not the same to the bit."""
    return [name for name in names if getattr(one, name).tobytes() != getattr(other, name).tobytes()]
