"""Small files that would unpack to gigabytes are refused at once, and within little memory."""

import json
import lzma
import os
import signal
import subprocess
import sys
import zlib
from functools import cache

import numcodecs.blosc
import pytest

from support.families.tiff_files import grey, tiff_file
from support.few import slow
from support.processes.peak_memory import watched

HUGE = 2**30
MEMORY = 300e6
SECONDS = 10  # of work, whatever else the machine does: ten times what it takes


PIECE = 2**24
"""Zeros that are packed; what they give is repeated: nothing in it leads back beyond its own start."""


@cache
def deflated(window):
    """A stream of a gigabyte of zeros, of zlib or gzip."""
    compressor = zlib.compressobj(1, zlib.DEFLATED, -15)
    piece = compressor.compress(bytes(PIECE)) + compressor.flush(zlib.Z_FULL_FLUSH)
    body = piece * (HUGE // PIECE) + compressor.flush()
    if window == 15:
        return bytes.fromhex("7801") + body + (1 + (HUGE % 65521 << 16)).to_bytes(4, "big")
    crc = 0
    for _ in range(HUGE // PIECE):
        crc = zlib.crc32(bytes(PIECE), crc)
    return bytes.fromhex("1f8b08000000000004ff") + body + crc.to_bytes(4, "little") + HUGE.to_bytes(4, "little")


def lzw_of_literals(count):
    """Nines of a strip, each by its own code of 9 bits, the table cleared often enough that no code gets longer."""
    bits = f"{256:09b}" + f"{9:09b}" * 231
    block = int(bits, 2).to_bytes(len(bits) // 8, "big")
    return block * (count // 231 + 1)


@cache
def lzma_bomb():
    """A gigabyte of zeros in one block of a file of xz, without a checksum of what it holds."""
    packed = lzma.compress(bytes(PIECE), lzma.FORMAT_RAW, filters=[{"id": lzma.FILTER_LZMA2, "preset": 0}])
    body = packed[:-1] * (HUGE // PIECE) + packed[-1:]  # the last byte ends the block
    start = with_sum(bytes([2, 0, 0x21, 1, 18]) + bytes(3))
    index = with_sum(padded(b"\0\1" + varint(len(start) + len(body)) + varint(HUGE)))
    end = (len(index) // 4 - 1).to_bytes(4, "little") + b"\0\0"
    footer = zlib.crc32(end).to_bytes(4, "little") + end + b"YZ"
    return b"\xfd7zXZ\0" + with_sum(b"\0\0") + start + padded(body) + index + footer


def with_sum(data):
    return data + zlib.crc32(data).to_bytes(4, "little")


def padded(data):
    return data + bytes(-len(data) % 4)


def varint(number):
    low = [number >> shift & 127 for shift in range(0, number.bit_length(), 7)]
    return bytes([*(each | 128 for each in low[:-1]), low[-1]])


def zstd_bomb(is_stated=False):
    """Runs of 128 KiB in 4 bytes each, in a frame that does not say how much it holds, unless told to."""
    start = "28b52ffd0038" if not is_stated else "28b52ffde0" + (HUGE + 1).to_bytes(8, "little").hex()
    run = (1 << 1 | 2**17 << 3).to_bytes(3, "little") + b"\0"
    last = (1 | 1 << 1 | 1 << 3).to_bytes(3, "little") + b"\0"
    return bytes.fromhex(start) + run * (HUGE // 2**17) + last


def store(folder, codec, chunk, shards=None):
    codecs = [{"name": "bytes"}, {"name": codec}]
    if shards:
        index = [{"name": "bytes"}]
        codecs = [{"name": "sharding_indexed", "configuration": shards | {"codecs": codecs, "index_codecs": index}}]
    grid = {"name": "regular", "configuration": {"chunk_shape": [8, 8]}}
    made = {"zarr_format": 3, "node_type": "array", "shape": [8, 8], "data_type": "uint8", "chunk_grid": grid}
    made |= {"chunk_key_encoding": {"name": "default"}, "fill_value": 0, "codecs": codecs}
    (folder / "c/0").mkdir(parents=True)
    (folder / "zarr.json").write_text(json.dumps(made))
    (folder / "c/0/0").write_bytes(chunk)


def png_bomb(kind, body):
    def chunk(kind, body):
        return len(body).to_bytes(4, "big") + kind + body + zlib.crc32(kind + body).to_bytes(4, "big")

    header = (8).to_bytes(4, "big") * 2 + bytes([8, 0, 0, 0, 0])
    rows = body if kind == b"IDAT" else zlib.compress(bytes(9 * 8))
    parts = [chunk(b"IHDR", header), chunk(b"IDAT", rows), chunk(b"IEND", b"")]
    if kind != b"IDAT":
        parts.insert(1, chunk(kind, body))
    return b"\x89PNG\r\n\x1a\n" + b"".join(parts)


def make(folder, kind):
    """Write a bomb; its name."""
    if kind.startswith("tiff"):
        compression, segment = {
            "tiff-deflate": (8, lambda: deflated(15)),
            "tiff-lzma": (34925, lzma_bomb),
            "tiff-zstd": (50000, zstd_bomb),
            "tiff-packbits": (32773, lambda: b"\x81\0" * 2**22),
        }[kind]
        (folder / "a.tif").write_bytes(tiff_file(grey(8, 8, compression=compression), [segment()]))
        return "a.tif"
    if kind.startswith("zarr"):
        codec, chunk = {
            "zarr-gzip": ("gzip", lambda: deflated(31)),
            "zarr-zlib": ("numcodecs.zlib", lambda: deflated(15)),
            "zarr-lzma": ("numcodecs.lzma", lzma_bomb),
            "zarr-zstd": ("zstd", lambda: zstd_bomb(is_stated=True)),
            "zarr-zstd-unstated": ("zstd", zstd_bomb),
            "zarr-blosc": ("blosc", lambda: numcodecs.blosc.compress(bytes(2**29), b"zstd", 1, 1)),
            "zarr-lz4": ("numcodecs.lz4", lambda: (2**31 - 9).to_bytes(4, "little") + bytes(60)),
            "zarr-shard": ("gzip", lambda: deflated(31)),
        }[kind]
        data, shards = chunk(), None
        if kind == "zarr-shard":
            shards = {"chunk_shape": [8, 8]}
            data += (0).to_bytes(8, "little") + len(data).to_bytes(8, "little")
        store(folder / "a.zarr", codec, data, shards)
        return "a.zarr"
    body = deflated(15)
    if kind == "png-zTXt":
        body = b"Comment\0\0" + body
    elif kind == "png-iTXt":
        body = b"Comment\0\1\0\0\0" + body
    elif kind == "png-iCCP":
        body = b"Profile\0\0" + body
    (folder / "a.png").write_bytes(png_bomb(kind.removeprefix("png-").encode(), body))
    return "a.png"


def worked():
    """Return the seconds of work of all child processes that have ended."""
    spent = os.times()
    return spent.children_user + spent.children_system


KINDS = ["tiff-deflate", "tiff-lzma", "tiff-zstd", "tiff-packbits", "png-IDAT", "png-zTXt", "png-iTXt", "png-iCCP"]
KINDS += [f"zarr-{name}" for name in ("gzip", "zlib", "lzma", "zstd", "zstd-unstated", "blosc", "lz4", "shard")]


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_a_bomb_is_refused(tmp_path, kind):
    name = make(tmp_path, kind)
    begin = worked()
    code, errors, peak = watched(["tessellate", name, "-o", "b.npy", "-q"], tmp_path)
    assert worked() - begin < SECONDS
    assert peak < MEMORY
    if kind.startswith("png-"):  # what is beyond the rows of the picture, or beside it, is not unpacked
        assert code in (0, 3), errors
    else:
        assert (code, len(errors)) == (3, 1), errors
        assert name in errors[0]
        assert not (tmp_path / "b.npy").exists()


TELLING = """
import sys
from vorotool.cli.main import main
from vorotool.formats.images import tiff_layout

unpack = tiff_layout._unpacked


def telling(*arguments):
    print("decoding", flush=True)
    unpacked = unpack(*arguments)
    print("decoded", flush=True)
    return unpacked


tiff_layout._unpacked = telling
main()
"""


@pytest.mark.parametrize("kind", ["deflate", slow("lzw")])
def test_a_signal_ends_decoding(tmp_path, kind):
    """Of an image whose strip takes a second or more to decode: it is not decoded to its end."""
    rows = 2**15
    if kind == "deflate":
        compression, strip = 8, deflated(15)
    else:
        compression, strip = 5, lzw_of_literals(2**27)
        rows = 2**12
    (tmp_path / "a.tif").write_bytes(tiff_file(grey(2**15, rows, compression=compression), [strip]))
    command = [sys.executable, "-c", TELLING, "tessellate", "a.tif", "-o", "b.npy", "--seeds", "centroids"]
    child = subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert child.stdout.readline() == b"decoding\n"
    child.send_signal(signal.SIGTERM)
    said, _ = child.communicate(timeout=600)
    assert (child.returncode, said) == (143, b"")
    assert not (tmp_path / "b.npy").exists()
