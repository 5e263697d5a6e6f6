"""Rows of text: streamed in bounded memory, with separators between slices too."""

import io
import json

import numpy as np
import pytest

from support.few import few
from support.processes.peak_memory import memory_below
from support.refusals import refused
from vorotool.formats.text.row_writer import SLICE_ROWS, Column, RowShape, write_rows
from vorotool.numeric.coordinates import writing
from vorotool.types.table import Computed, Lookup


class Count(io.RawIOBase):
    """Counts bytes and forgets them."""

    size = 0

    def write(self, data):
        self.size += len(data)
        return len(data)


@pytest.mark.parametrize("rows", [0, 1, SLICE_ROWS - 1, SLICE_ROWS, SLICE_ROWS + 1, 3 * SLICE_ROWS])
@pytest.mark.parametrize("threads", few([2, 1], 1))
def test_slices_join(rows, threads):
    out = io.BytesIO()
    columns = [Column.of("", np.arange(rows)), Column.of("", Computed(lambda part: np.arange(rows)[part] / 2, rows))]
    with writing(threads=threads):
        write_rows(out, columns, RowShape(("[", ",", "]"), ","))
    assert json.loads(b"[" + out.getvalue() + b"]") == [[k, k / 2] for k in range(rows)]


@pytest.mark.parametrize("threads", [1, 2])
def test_memory_stays_bounded(threads):
    rows = 60 * SLICE_ROWS
    values, index = np.random.default_rng(0).random(1000), np.zeros(rows, np.int32)
    columns = [Column.of("", Lookup(values, index)) for _ in range(4)]
    out = Count()
    with memory_below(20e6), writing(threads=threads):
        write_rows(out, columns)
    assert out.size > 60e6


def test_a_failing_output_ends_the_work():
    class Full(io.RawIOBase):
        def write(self, _data):
            raise OSError(28, "No space left on device")

    with writing(threads=2):
        refused(OSError, "No space", write_rows, Full(), [Column.of("", np.arange(10 * SLICE_ROWS))])
