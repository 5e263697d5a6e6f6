"""Reads a source as `vorotool.read` does, without a file."""

from vorotool.formats.images.label_images import label_image_of
from vorotool.formats.images.reader import picture_and_grid, read_image
from vorotool.formats.io.sources import Source
from vorotool.formats.opening import image_source, opened, read_recognized
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.formats.recognition import recognized
from vorotool.products.inputs import IMAGE_NAMES, NAMES_WITH, known_input_format


def read_as(source, geometry=None, *, input_format=None, columns=None, **options):
    said = None if input_format is None else known_input_format(input_format, NAMES_WITH[geometry])
    return read_recognized(*recognized(source, geometry, said, columns), ReadOptions(columns=columns, **options))


def image_of(source, *, input_format=None, **options):
    said = None if input_format is None else known_input_format(input_format, IMAGE_NAMES)
    return read_image(image_source(source, said), ReadOptions(**options))


def picture_of(source, **options):
    return picture_and_grid(image_source(source), ReadOptions(**options))[0]


def labels_of(data, name="-"):
    return label_image_of(image_of(Source(name, data)), name).labels


def bands_of(path, *, input_format=None, page=None):
    with opened(path, geometry=None, input_format=input_format, page=page) as source:
        return source.rows()
