"""Zarr arrays are read as the zarr package reads them, but no codec runs that is not known."""

import json
import os
import pickle
import re
from pathlib import Path

import google_crc32c
import numpy as np
import pytest

import vorotool
from vorotool.errors import InputError, OutputError
from vorotool.formats.zarr.reader import StoredArray
from vorotool.formats.zarr.store import check_store

zarr = pytest.importorskip("zarr")
from zarr import codecs  # noqa: E402

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


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("separator", [".", "/"])
@pytest.mark.parametrize("compressor", [None, "Zlib", "GZip", "BZ2", "LZMA", "LZ4", "Zstd", "Blosc"])
def test_format_2(tmp_path, order, separator, compressor):
    import numcodecs

    chosen = None if compressor is None else getattr(numcodecs, compressor)()
    filters = [numcodecs.Delta(dtype="<u2"), numcodecs.Shuffle(2)] if order == "F" else None
    array = zarr.create_array(
        tmp_path / "a",
        shape=(70, 50),
        dtype="u2",
        chunks=(32, 20),
        zarr_format=2,
        compressors=chosen,
        filters=filters,
        order=order,
        chunk_key_encoding={"name": "v2", "separator": separator},
    )
    array[:60] = IMAGE[:60]
    check(tmp_path / "a", array[:])


@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize("dtype", ["bool", "int8", "uint64", "float16", "float32", "float64"])
@pytest.mark.parametrize("fill", [1, "NaN", "-Infinity"])
def test_types_and_what_fills(tmp_path, version, dtype, fill):
    value = float(fill) if isinstance(fill, str) and dtype[0] == "f" else 1
    array = zarr.create_array(
        tmp_path / "a", shape=(5, 6), chunks=(2, 3), dtype=dtype, fill_value=value, zarr_format=version
    )
    array[:2] = np.ones((2, 6))
    expected = array[:]
    np.testing.assert_array_equal(StoredArray("a", tmp_path / "a").read((slice(0, 5), slice(0, 6))), expected)


def store(path, metadata, chunks=(), *, version=3):
    path.mkdir()
    (path / ("zarr.json" if version == 3 else ".zarray")).write_text(
        metadata if isinstance(metadata, str) else json.dumps(metadata)
    )
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
    path = store(
        tmp_path / "evil.zarr", version_2(**{where: [codec] if where == "filters" else codec}), data, version=2
    )
    with pytest.raises(InputError, match="its codec 'pickle' is not accepted: these are: zstd, gzip"):
        vorotool.read(path)
    assert not (tmp_path / "ran").exists()


@pytest.mark.parametrize("name", ["pickle", "numcodecs.pickle", "numcodecs.json2", "vlen-utf8", "os.system"])
def test_a_codec_of_format_3_that_is_not_known(tmp_path, name):
    inner = [{"name": "bytes"}, {"name": name}]
    index = [{"name": "bytes"}, {"name": "crc32c"}]
    options = {"chunk_shape": [2, 2], "codecs": inner, "index_codecs": index}
    for number, codec in enumerate(
        (
            inner,
            [{"name": "sharding_indexed", "configuration": options}],
            [{"name": "sharding_indexed", "configuration": options | {"codecs": index, "index_codecs": inner}}],
        )
    ):
        path = store(tmp_path / f"{number}.zarr", version_3(codecs=codec))
        with pytest.raises(InputError, match=f"zarr: its codec '{name}' is not accepted: these are"):
            vorotool.read(path)


@pytest.mark.parametrize(
    ("metadata", "version", "words"),
    [
        (version_2(dtype="|O"), 2, r"it holds '\|O': an image of numbers"),
        (version_2(dtype=[["a", "<u1"]]), 2, "an image of numbers was expected"),
        (version_3(data_type="string"), 3, "it holds 'string'"),
        (version_3(data_type={"name": "struct"}), 3, "an image of numbers was expected"),
        (version_3(shape=[2, -4]), 3, r"\[2, -4\] is no shape: whole numbers from 0"),
        (version_3(shape=[2, 4.0]), 3, "is no shape"),
        (version_3(shape=[2, True]), 3, "is no shape"),
        (version_3(shape=[2, 4, 4]), 3, "but that of its chunks"),
        (version_2(chunks=[0, 4]), 2, "is no shape: whole numbers from 1"),
        (version_2(chunks=[2**20, 2**20]), 2, r"chunks of shape \(1048576, 1048576\) for an array of shape"),
        (version_2(fill_value=300), 2, "its fill value 300 does not fit in uint8"),
        (version_2(fill_value="x"), 2, "cannot be read as Zarr"),
        (version_3(chunk_grid={"name": "rectilinear"}), 3, "grid of chunks is 'rectilinear'"),
        (version_3(chunk_key_encoding="odd"), 3, "chunks are named by 'odd'"),
        (version_2(dimension_separator="../"), 2, r"dimension_separator is '../': \. or / was"),
        (version_3(storage_transformers=["x"]), 3, "storage transformers"),
        (version_3(extension=1), 3, "have 'extension', an extension that is not known"),
        (version_3(codecs=[]), 3, "make no bytes"),
        (version_3(codecs=5), 3, "its codecs are 5"),
        (version_3(codecs=[{"name": "transpose", "configuration": {"order": [0, 0]}}]), 3, "none of 2 axes"),
        (version_3({"name": "crc32c"}, {"name": "transpose"}), 3, "codec 'transpose' is not accepted"),
        (version_3(zarr_format=4), 3, "format is 4"),
        ("[" * 100_000, 3, "brackets are nested more than 100 deep"),
        ('{"a":' * 100_000, 2, "brackets are nested more than 100 deep"),
        (" " * 2**20 + "{}", 3, "more than 1048576 bytes"),
        ("[1]", 3, "holds no JSON object"),
        ('{"node_type": "array"', 3, "is no JSON"),
        ('{"zarr_format": 3, "node_type": "array", "shape": [' + "9" * 5000 + "]}", 3, "is no JSON"),
    ],
)
def test_metadata_that_are_refused(tmp_path, metadata, version, words):
    path = store(tmp_path / "a.zarr", metadata, version=version)
    with pytest.raises(InputError, match=words) as caught:
        vorotool.read(path)
    assert "a.zarr" in str(caught.value)


def test_nested_brackets_as_an_output(tmp_path):
    path = store(tmp_path / "a.zarr", "[" * 100_000)
    with pytest.raises(OutputError, match="is there and is no Zarr array, which alone is replaced"):
        check_store(path)


@pytest.mark.parametrize(
    ("further", "chunk", "words"),
    [
        ((), bytes(7), "a chunk of shape (2, 4) needs 8 bytes, but has 7"),
        ((), bytes(9), "needs 8 bytes, but has 9"),
        (("crc32c",), bytes(12), "wrong checksum"),
        (("zstd",), b"", "needs 8 bytes, but has 0"),
        (("blosc",), bytes(5), "header of 16 bytes"),
        (("lz4",), bytes(3), "header of 4 bytes"),
        (("gzip",), b"\x1f\x8b", "too early"),
    ],
)
def test_chunks_that_are_damaged(tmp_path, further, chunk, words):
    path = store(tmp_path / "a.zarr", version_3(*({"name": name} for name in further)), {"c/0/0": chunk})
    words = re.escape(words)
    with pytest.raises(InputError, match=rf"a\.zarr cannot be read as Zarr: .*({words})"):
        vorotool.read(path)


def test_a_chunk_that_is_no_file(tmp_path):
    path = store(tmp_path / "a.zarr", version_3())
    (path / "c/0").mkdir(parents=True)
    os.mkfifo(path / "c/0/0")
    with pytest.raises(InputError, match="chunk c/0/0 is no file"):
        vorotool.read(path)


def test_indices_of_shards_that_lie(tmp_path):
    array = zarr.create_array(tmp_path / "a", shape=(4, 4), dtype="u2", chunks=(2, 2), shards=(4, 4), compressors=None)
    array[...] = IMAGE[:4, :4] + 1
    file = tmp_path / "a/c/0/0"
    data = file.read_bytes()
    for offset, size in ((2**40, 8), (0, 2**62), (2**64 - 1, 8), (0, 7)):
        index = offset.to_bytes(8, "little") + size.to_bytes(8, "little") + data[-52:-4]
        file.write_bytes(data[:-68] + index + google_crc32c.value(index).to_bytes(4, "little"))
        with pytest.raises(InputError, match=r"cannot be read as Zarr: .*(of a shard has|needs 8 bytes)"):
            vorotool.read(tmp_path / "a")
    file.write_bytes(data[:-1])
    with pytest.raises(InputError, match="wrong checksum"):
        vorotool.read(tmp_path / "a")
    file.write_bytes(data[:50])
    with pytest.raises(InputError, match="a shard has 50 bytes, but its index 68"):
        vorotool.read(tmp_path / "a")


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
