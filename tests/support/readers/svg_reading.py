"""Reading drawings in SVG that are written in tests."""

import shapely

from vorotool.formats.drawing.svg_reader import read_svg
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.types.polygons.shapely_geometry import to_shapely


def svg(body, attributes="", **options):
    """Read a drawing with these elements; gives it, and what was noted."""
    return read(f'<svg xmlns="http://www.w3.org/2000/svg" {attributes}>{body}</svg>', **options)


def read(text, **options):
    notes = []
    data = text if isinstance(text, bytes) else text.encode()
    return read_svg(Source("a.svg", data), ReadOptions(note=notes.append, **options)), notes


def shape_of(body, attributes="", **options):
    return shapely.union_all(shapely.make_valid(to_shapely(svg(body, attributes, **options)[0])))
