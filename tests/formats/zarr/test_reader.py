"""Zarr arrays are read as the zarr package reads them, but no codec runs that is not known."""

import json
import os
import pickle
import re
from pathlib import Path

import google_crc32c
import numcodecs
import numpy as np
import pytest
import zarr
from zarr import codecs

import vorotool
from support.few import few
from support.refusals import refused
from vorotool.errors import InputError, OutputError
from vorotool.formats.zarr.reader import StoredArray
from vorotool.formats.zarr.store import check_store

IMAGE = np.random.default_rng(3).integers(0, 200, (70, 50)).astype(np.uint16)


def check(path, expected):
    stored = StoredArray("a.zarr", path)
    assert stored.dtype == expected.dtype.newbyteorder("=")
    for rows in (slice(0, 70), slice(0, 1), slice(31, 33), slice(69, 70)):
        for columns in (slice(0, 50), slice(19, 41)):
            np.testing.assert_array_equal(stored.read((rows, columns)), expected[rows, columns])


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"compressors": None},
        {"compressors": [codecs.GzipCodec(level=5)]},
        {"compressors": [codecs.GzipCodec(), codecs.ZstdCodec(), codecs.Crc32cCodec()]},
        {"compressors": [codecs.BloscCodec(cname="lz4", shuffle="bitshuffle")]},
        {"compressors": [codecs.BloscCodec(cname="zstd")]},
        {"filters": [codecs.TransposeCodec(order=(1, 0))]},
        {"serializer": codecs.BytesCodec(endian="big")},
        {"shards": (64, 60)},
        {"shards": (96, 40), "compressors": [codecs.GzipCodec()]},
        {"chunk_key_encoding": {"name": "v2", "separator": "."}},
        {"chunk_key_encoding": {"name": "default", "separator": "."}},
        {"fill_value": 7},
    ],
)
def test_format_3(tmp_path, options):
    array = zarr.create_array(tmp_path / "a", shape=(70, 50), dtype="u2", chunks=(32, 20), **options)
    array[:60] = IMAGE[:60]  # the last chunks are partly, or wholly, what fills
    check(tmp_path / "a", array[:])


@pytest.mark.parametrize("order", few(["F", "C"], 1))
@pytest.mark.parametrize("separator", [".", "/"])
@pytest.mark.parametrize("compressor", [None, "Zlib", "GZip", "BZ2", "LZMA", "LZ4", "Zstd", "Blosc"])
def test_format_2(tmp_path, order, separator, compressor):
    chosen = None if compressor is None else getattr(numcodecs, compressor)()
    filters = [numcodecs.Delta(dtype="<u2"), numcodecs.Shuffle(2)] if order == "F" else None
    keys = {"name": "v2", "separator": separator}
    options = {"compressors": chosen, "filters": filters, "order": order, "chunk_key_encoding": keys, "zarr_format": 2}
    array = zarr.create_array(tmp_path / "a", shape=(70, 50), dtype="u2", chunks=(32, 20), **options)
    array[:60] = IMAGE[:60]
    check(tmp_path / "a", array[:])


@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize("dtype", few(["bool", "uint64", "float32", "int8", "float16", "float64"], 3))
@pytest.mark.parametrize("fill", [1, "NaN", "-Infinity"])
def test_types_and_what_fills(tmp_path, version, dtype, fill):
    value = float(fill) if isinstance(fill, str) and dtype[0] == "f" else 1
    options = {"dtype": dtype, "fill_value": value, "zarr_format": version}
    array = zarr.create_array(tmp_path / "a", shape=(5, 6), chunks=(2, 3), **options)
    array[:2] = np.ones((2, 6))
    expected = array[:]
    np.testing.assert_array_equal(StoredArray("a", tmp_path / "a").read((slice(0, 5), slice(0, 6))), expected)


def store(path, metadata, chunks=(), *, version=3):
    path.mkdir()
    text = metadata if isinstance(metadata, str) else json.dumps(metadata)
    (path / ("zarr.json" if version == 3 else ".zarray")).write_text(text)
    for name, data in dict(chunks).items():
        (path / name).parent.mkdir(parents=True, exist_ok=True)
        (path / name).write_bytes(data)
    return path


def version_2(**changes):
    made = {"zarr_format": 2, "shape": [2, 4], "chunks": [2, 4], "dtype": "|u1", "compressor": None}
    return made | {"fill_value": 0, "order": "C", "filters": None} | changes


def version_3(*further, **changes):
    encoding = {"name": "default", "configuration": {"separator": "/"}}
    grid = {"name": "regular", "configuration": {"chunk_shape": [2, 4]}}
    made = {"zarr_format": 3, "node_type": "array", "shape": [2, 4], "data_type": "uint8", "chunk_grid": grid}
    codec = [{"name": "bytes"}, *further]
    return made | {"chunk_key_encoding": encoding, "fill_value": 0, "codecs": codec, "attributes": {}} | changes


class Payload:
    """Makes a file when it is unpickled."""

    def __init__(self, path):
        self.path = str(path)

    def __reduce__(self):
        return os.mkdir, (self.path,)


@pytest.mark.parametrize("where", ["compressor", "filters"])
def test_a_pickled_chunk_of_format_2_does_not_run(tmp_path, where):
    codec = {"id": "pickle", "protocol": 5}
    data = {"0.0": pickle.dumps(Payload(tmp_path / "ran"))}
    metadata = version_2(**{where: [codec] if where == "filters" else codec})
    path = store(tmp_path / "evil.zarr", metadata, data, version=2)
    refused(InputError, "'pickle'", vorotool.read, path)
    assert not (tmp_path / "ran").exists()


@pytest.mark.parametrize("name", ["pickle", "numcodecs.pickle", "numcodecs.json2", "vlen-utf8", "os.system"])
def test_a_codec_of_format_3_that_is_not_known(tmp_path, name):
    inner = [{"name": "bytes"}, {"name": name}]
    index = [{"name": "bytes"}, {"name": "crc32c"}]
    options = {"chunk_shape": [2, 2], "codecs": inner, "index_codecs": index}
    turned = options | {"codecs": index, "index_codecs": inner}
    shards = ([{"name": "sharding_indexed", "configuration": each}] for each in (options, turned))
    for number, codec in enumerate((inner, *shards)):
        path = store(tmp_path / f"{number}.zarr", version_3(codecs=codec))
        refused(InputError, f"'{name}'", vorotool.read, path)


@pytest.mark.parametrize(
    ("metadata", "version", "words"),
    [
        (version_2(dtype="|O"), 2, r"'\|O'"),
        (version_2(dtype=[["a", "<u1"]]), 2, "an image of numbers is expected"),
        (version_3(data_type="string"), 3, "it holds 'string'"),
        (version_3(data_type={"name": "struct"}), 3, "an image of numbers is expected"),
        (version_3(shape=[2, -4]), 3, r"\[2, -4\] is not a shape"),
        (version_3(shape=[2, 4.0]), 3, "is not a shape"),
        (version_3(shape=[2, True]), 3, "is not a shape"),
        (version_3(shape=[2, 4, 4]), 3, "but that of its chunks"),
        (version_2(chunks=[0, 4]), 2, "is not a shape: .* 1"),
        (version_2(chunks=[2**20, 2**20]), 2, r"chunks of shape \(1048576, 1048576\) for an array of shape"),
        (version_2(fill_value=300), 2, "value 300"),
        (version_2(fill_value="x"), 2, "cannot be read as Zarr"),
        (version_3(chunk_grid={"name": "rectilinear"}), 3, "'rectilinear'"),
        (version_3(chunk_key_encoding="odd"), 3, "'odd'"),
        (version_2(dimension_separator="../"), 2, r"dimension_separator"),
        (version_3(storage_transformers=["x"]), 3, "storage transformers"),
        (version_3(extension=1), 3, "'extension'"),
        (version_3(codecs=[]), 3, "produce no bytes"),
        (version_3(codecs=5), 3, "its codecs are 5"),
        (version_3(codecs=[{"name": "transpose", "configuration": {"order": [0, 0]}}]), 3, "not an order of 2 axes"),
        (version_3({"name": "crc32c"}, {"name": "transpose"}), 3, "'transpose'"),
        (version_3(zarr_format=4), 3, "format is 4"),
        (version_3(shape=[1] * 50_000), 3, "50000 axes"),
        (version_3(*[{"name": "shuffle"}] * 9_999), 3, "10000 codecs"),
        (version_2(filters=[{"id": "shuffle"}] * 9_999), 2, "9999 codecs"),
        (version_3(codecs=[{"name": "transpose", "configuration": {"order": "C"}}] * 9_999), 3, "9999 codecs"),
        ("[" * 100_000, 3, "100"),
        ('{"a":' * 100_000, 2, "100"),
        (" " * 2**20 + "{}", 3, "more than 1048576 bytes"),
        ("[1]", 3, "holds no JSON object"),
        ('{"node_type": "array"', 3, "is not JSON"),
        ('{"zarr_format": 3, "node_type": "array", "shape": [' + "9" * 5000 + "]}", 3, "is not JSON"),
    ],
)
def test_metadata_that_are_refused(tmp_path, metadata, version, words):
    path = store(tmp_path / "a.zarr", metadata, version=version)
    refused(InputError, [words, "a.zarr"], vorotool.read, path)


def test_nested_brackets_as_an_output(tmp_path):
    path = store(tmp_path / "a.zarr", "[" * 100_000)
    refused(OutputError, "is not a Zarr array", check_store, path)


@pytest.mark.parametrize(
    ("further", "chunk", "words"),
    [
        ((), bytes(7), "a chunk of shape (2, 4) needs 8 bytes, but has 7"),
        ((), bytes(9), "needs 8 bytes, but has 9"),
        (("crc32c",), bytes(12), "wrong checksum"),
        (("zstd",), b"", "needs 8 bytes, but has 0"),
        (("blosc",), bytes(5), "Blosc has 16 bytes"),
        (("lz4",), bytes(3), "LZ4 has 4 bytes"),
        (("gzip",), b"\x1f\x8b", "too early"),
    ],
)
def test_chunks_that_are_damaged(tmp_path, further, chunk, words):
    path = store(tmp_path / "a.zarr", version_3(*({"name": name} for name in further)), {"c/0/0": chunk})
    words = re.escape(words)
    refused(InputError, rf"a\.zarr cannot be read as Zarr: .*({words})", vorotool.read, path)


def test_indices_of_shards_that_lie(tmp_path):
    array = zarr.create_array(tmp_path / "a", shape=(4, 4), dtype="u2", chunks=(2, 2), shards=(4, 4), compressors=None)
    array[...] = IMAGE[:4, :4] + 1
    file = tmp_path / "a/c/0/0"
    data = file.read_bytes()
    for offset, size in ((2**40, 8), (0, 2**62), (2**64 - 1, 8), (0, 7)):
        index = offset.to_bytes(8, "little") + size.to_bytes(8, "little") + data[-52:-4]
        file.write_bytes(data[:-68] + index + google_crc32c.value(index).to_bytes(4, "little"))
        refused(InputError, r"cannot be read as Zarr: .*(of a shard|needs 8 bytes)", vorotool.read, tmp_path / "a")
    file.write_bytes(data[:-1])
    refused(InputError, "wrong checksum", vorotool.read, tmp_path / "a")
    file.write_bytes(data[:50])
    refused(InputError, "a shard has 50 bytes, but its index 68", vorotool.read, tmp_path / "a")


@pytest.mark.parametrize(
    "names",
    [{"name": "default", "separator": "/"}, {"name": "default", "separator": "."}, {"name": "v2", "separator": "."}],
)
def test_chunks_that_are_left_out_are_not_looked_for_one_by_one(tmp_path, names, monkeypatch):
    array = zarr.create_array(
        tmp_path / "a", shape=(2**40, 6), dtype="u2", chunks=(4, 3), fill_value=9, chunk_key_encoding=names
    )
    array[400_000:400_003, 3:] = 5
    looked_for = []
    found = Path.stat
    monkeypatch.setattr(Path, "stat", lambda path, **options: looked_for.append(path) or found(path, **options))
    stored = StoredArray("a.zarr", tmp_path / "a")
    looked_for.clear()
    values = stored.read((slice(0, 2**19), slice(0, 6)), threads=1)
    assert len(looked_for) <= 3
    expected = np.full((2**19, 6), 9, np.uint16)
    expected[400_000:400_003, 3:] = 5
    np.testing.assert_array_equal(values, expected)


@pytest.mark.parametrize("separator", ["/", "."])
def test_only_chunks_that_are_stored_are_gone_through(tmp_path, separator):
    """An array of a few bytes may have room for 2^60 chunks; those that it has are found whatever their number."""
    side, grid = 2**30, {"name": "regular", "configuration": {"chunk_shape": [1, 1]}}
    encoding = {"name": "default", "configuration": {"separator": separator}}
    about = version_3(shape=[side, side], chunk_grid=grid, fill_value=7, chunk_key_encoding=encoding)
    path = store(tmp_path / "a", about)
    for value, place in enumerate(((0, 0), (3, 2**29), (2**29, 5), (side - 1, side - 1))):
        file = path / separator.join(map(str, ("c", *place)))
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(bytes([value]))
    stored = StoredArray("a.zarr", path)
    region = (slice(2**29 - 2**11, 2**29 + 2**11), slice(0, 2**11))
    expected = np.full((2**12, 2**11), 7, np.uint8)
    expected[2**11, 5] = 2
    np.testing.assert_array_equal(stored.read(region), expected)
    assert stored.read((slice(0, 4), slice(2**29, 2**29 + 2))).tolist() == [[7, 7]] * 3 + [[1, 7]]
    assert stored.read((slice(side - 1, side), slice(side - 2, side))).tolist() == [[7, 3]]


def test_chunks_of_a_shard_share_no_bytes(tmp_path):
    """Each would be decoded anew: the time is that of their number and what one of them unpacks to."""
    array = zarr.create_array(
        tmp_path / "a", shape=(32, 32), dtype="u1", chunks=(1, 1), shards=(32, 32), compressors=[codecs.GzipCodec()]
    )
    array[...] = 1
    file = tmp_path / "a/c/0/0"
    data = file.read_bytes()
    index = np.frombuffer(data[-(32 * 32 * 16 + 4) : -4], "<u8").reshape(-1, 2).copy()
    index[:] = index[0] * [1, 2]
    file.write_bytes(data[: -len(index.tobytes()) - 4] + index.tobytes() + crc32c(index))
    refused(InputError, f"{len(data)}", vorotool.read, tmp_path / "a")


def crc32c(values):
    return google_crc32c.value(values.tobytes()).to_bytes(4, "little")
