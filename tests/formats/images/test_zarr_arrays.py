"""Images as Zarr arrays: any library reads them, and the bytes depend on the pixels and the chunks alone."""

import signal
import sys
import threading
import time

import numpy as np
import pytest
import zarr

from support.refusals import refused
from vorotool.errors import OutputError, UsageError
from vorotool.formats.io.descriptors import check_space
from vorotool.formats.zarr.writer import chunks_of, create_array, open_array, write_chunks, write_zarr, zarr_module

IMAGE = np.random.default_rng(1).integers(0, 9, (70, 50)).cumsum(axis=1).astype(np.uint16)


def written(folder, image, chunks, threads=1):
    array = create_array(folder, image.shape, dtype=image.dtype, chunks=chunks)
    for first in range(0, len(image), chunks[0]):
        write_chunks(array, first, image[first : first + chunks[0]], threads=threads)
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize(
    ("dtype", "chunks"),
    [
        *((np.uint8, (70, 50)), (np.uint16, (16, 16)), (np.uint32, (7, 9)), (np.uint64, (1, 50))),
        *((np.int32, (16, 16)), (np.float32, (7, 9))),
    ],
)
def test_zarr_reads_what_is_written(tmp_path, chunks, dtype):
    image = IMAGE.astype(dtype)
    files = written(tmp_path / "a", image, chunks)
    read = zarr.open_array(tmp_path / "a", mode="r")
    assert (read.dtype, read.chunks, read.metadata.dimension_names) == (dtype, chunks, ("y", "x"))
    np.testing.assert_array_equal(read[:], image)
    assert written(tmp_path / "b", image, chunks, threads=3) == files


def test_rows_of_chunks_are_written_in_any_order(tmp_path):
    create_array(tmp_path / "a", IMAGE.shape, dtype=IMAGE.dtype, chunks=(32, 32))
    for first in (64, 0, 32, 64):
        write_chunks(open_array(tmp_path / "a"), first, IMAGE[first : first + 32], threads=2)
    np.testing.assert_array_equal(zarr.open_array(tmp_path / "a", mode="r")[:], IMAGE)
    for first, rows in ((1, 32), (0, 31), (64, 32)):
        with pytest.raises(ValueError, match="are not those of chunks"):
            write_chunks(open_array(tmp_path / "a"), first, np.zeros((rows, 50), np.uint16))


def test_rows_of_chunks_stay_small():
    for width, dtype in ((2**17, np.uint64), (2**20, np.uint32), (2**30, np.uint8)):
        rows, columns = chunks_of((2**20, width), dtype)
        assert rows == 1 or rows * width * np.dtype(dtype).itemsize <= 2**28
        assert columns == 2048
    assert chunks_of((5000, 5000), np.uint8, (9999, 64)) == (5000, 64)


def test_zarr_is_named_where_it_is_missing(monkeypatch):
    monkeypatch.setitem(sys.modules, "zarr", None)
    refused(UsageError, r"pip install 'vorotool\[zarr\]'", zarr_module)


def test_room_is_asked_for_only_where_it_may_lack(tmp_path, monkeypatch):
    monkeypatch.setattr("vorotool.formats.io.descriptors._free_on_disk", lambda folder: 1000)

    def never():
        raise AssertionError("there is room for all")

    check_space(tmp_path / "new/a.npy", 1000, never)
    check_space(tmp_path / "a.npy", 1001, lambda: 1000)
    refused(OutputError, r"a\.npy", check_space, tmp_path / "a.npy", 2 * 10**12, lambda: 1200 * 10**9)
    check_space("-", 10**12, never)
    check_space("/dev/null", 10**12, never)


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("step", ["metadata", "chunk"])
def test_an_interrupt_waits_for_what_is_being_written(tmp_path, monkeypatch, threads, step):
    """Zarr's threads would make the folder again while, or after, it is removed."""
    import zarr.storage._local as local

    put, main = local._put, threading.main_thread().ident

    def slow(path, *arguments, **options):
        if (path.name == "zarr.json") == (step == "metadata"):
            if not interrupted:
                interrupted.append(signal.pthread_kill(main, signal.SIGINT))
            time.sleep(0.15)
        return put(path, *arguments, **options)

    interrupted = []
    monkeypatch.setattr(local, "_put", slow)
    refused(KeyboardInterrupt, "", write_zarr, tmp_path / "a.zarr", np.ones((4, 9000), np.uint8), threads=threads)
    assert list(tmp_path.iterdir()) == []
    time.sleep(0.25)
    assert list(tmp_path.iterdir()) == []
