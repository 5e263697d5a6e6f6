"""Compressions are undone as their libraries undo them, and never beyond the limit."""

import bz2
import gzip
import io
import lzma
import zlib

import numpy as np
import pytest
from PIL import Image

import vorotool
from support.families.tiff_files import grey, tiff_file
from support.processes.peak_memory import memory_below
from support.refusals import refused
from vorotool.formats.io import unpacking
from vorotool.formats.io.unpacking import most_unpacked

RANDOM = np.random.default_rng(1)
TEXTS = {
    "nothing": b"",
    "one": b"a",
    "zeros": bytes(100_000),
    "noise": RANDOM.bytes(50_000),
    "words": b"".join(RANDOM.choice([b"site", b"seed", b"cell", b"arc "], 20_000)),
    "steps": np.repeat(RANDOM.integers(0, 4, 2000), RANDOM.integers(1, 60, 2000)).astype(np.uint8).tobytes(),
}


def by_pillow(compression, text):
    """The strip that libtiff makes of a text."""
    out = io.BytesIO()
    Image.frombytes("L", (len(text), 1), text).save(out, "TIFF", compression=compression)
    with Image.open(io.BytesIO(out.getvalue())) as image:
        (offset,), (count,) = image.tag_v2[273], image.tag_v2[279]
    return out.getvalue()[offset : offset + count]


def by_numcodecs(name):
    return __import__(f"numcodecs.{name}", fromlist=["compress"]).compress


def packed(name, text):
    if name in ("lzw", "packbits"):
        return by_pillow({"lzw": "tiff_lzw"}.get(name, name), text)
    own = {"zlib": zlib.compress, "gzip": gzip.compress, "bz2": bz2.compress, "lzma": lzma.compress}
    if name == "blosc":
        return by_numcodecs("blosc")(text, b"lz4", 5, 1)
    return (own.get(name) or by_numcodecs(name))(text)


NAMES = ["zlib", "gzip", "bz2", "lzma", "lzw", "packbits", "zstd", "lz4", "blosc"]


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        (name, kind)
        for name in NAMES
        for kind in TEXTS
        if kind != "nothing" or name not in ("lzw", "packbits", "lz4", "blosc")  # which write nothing of nothing
    ],
)
def test_all_and_no_more(name, kind):
    text = TEXTS[kind]
    unpack = getattr(unpacking, f"unpack_{name}")
    data = packed(name, text)
    for limit in (len(text), len(text) + 1, 10**6):
        assert bytes(unpack(data, limit)) == text
    for limit in {0, 1, len(text) // 2, len(text) - 1} - {-1} if text else ():
        if limit < len(text):
            assert len(unpack(data, limit)) == limit + 1


@pytest.mark.parametrize("name", NAMES)
def test_what_is_cut_off_anywhere_ends(name):
    text = TEXTS["words"][:500]
    data = packed(name, text)
    unpack = getattr(unpacking, f"unpack_{name}")
    for end in range(len(data) - 1):
        try:
            made = unpack(data[:end], 1000)
        except (ValueError, RuntimeError, EOFError, OSError, zlib.error, lzma.LZMAError):
            continue
        assert name in ("lzw", "packbits", "gzip", "bz2", "zstd"), end
        assert text.startswith(bytes(made))
        assert name in ("lzw", "packbits") or end == 0  # these have no end that must be there; others may be empty


@pytest.mark.parametrize("name", ["gzip", "bz2", "zstd"])
def test_streams_that_follow_each_other(name):
    data = packed(name, b"abc" * 5) + packed(name, b"de")
    unpack = getattr(unpacking, f"unpack_{name}")
    if name != "zstd":  # numcodecs reads the first frame
        assert unpack(data, 100) == b"abc" * 5 + b"de"
    assert len(unpack(data, 16)) == 17
    assert most_unpacked(packed("zstd", b"abc") * 3) == (9, True)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["lzma", "zlib", "bz2", "gzip", "lzw", "packbits"])
def test_a_bomb_takes_no_memory(name):
    data = packed(name, bytes({"lzw": 2**22, "packbits": 2**22}.get(name, 2**28)))
    with memory_below(2**24):
        assert len(getattr(unpacking, f"unpack_{name}")(data, 1000)) == 1001


def test_dictionaries_of_lzma_are_limited():
    filters = [{"id": lzma.FILTER_LZMA2, "dict_size": 2**30}]
    refused(lzma.LZMAError, r"[Mm]emory", unpacking.unpack_lzma, lzma.compress(b"abc", filters=filters), 3)


def test_lzw_that_stands_for_nothing():
    refused(ValueError, "300", unpacking.unpack_lzw, ((256 << 9 | 300) << 6).to_bytes(3, "big"), 100)
    refused(ValueError, "from before TIFF", unpacking.unpack_lzw, b"\0\x01abc", 100)


def test_lzw_with_a_table_that_is_full(tmp_path):
    """Of pseudo-random bytes all 4096 codes are taken several times."""
    image = RANDOM.integers(0, 256, (300, 500), dtype=np.uint8)
    strip = by_pillow("tiff_lzw", image.tobytes())
    assert bytes(unpacking.unpack_lzw(strip, image.size)) == image.tobytes()
    (tmp_path / "a.tif").write_bytes(tiff_file(grey(500, 300, compression=5), [strip]))
    np.testing.assert_array_equal(vorotool.read(tmp_path / "a.tif").values, image)


def frame(blocks, *, descriptor=0, header=b"\x00"):
    """A frame that does not say how much it holds, of blocks (kind, bytes, size)."""
    body = b""
    for place, (kind, content, size) in enumerate(blocks):
        body += (int(place == len(blocks) - 1) | kind << 1 | size << 3).to_bytes(3, "little") + content
    return bytes.fromhex("28b52ffd") + bytes([descriptor]) + header + body


def test_frames_that_do_not_say_how_much_they_hold():
    raw, run = (0, b"abc", 3), (1, b"a", 2**17)
    data = frame([raw, run, raw], header=b"\x38")
    assert most_unpacked(data) == (2**17 + 6, False)
    assert unpacking.unpack_zstd(data, 2**17 + 6) == b"abc" + b"a" * 2**17 + b"abc"
    bomb = frame([run] * 3000, header=b"\x38")  # 12 kB for 393 MB
    assert most_unpacked(bomb) == (3000 * 2**17, False)
    assert len(unpacking.unpack_zstd(bomb, 1000)) == 1001
    skipped = (0x184D2A53).to_bytes(4, "little") + (5).to_bytes(4, "little") + b"hello"
    assert most_unpacked(skipped + data + skipped) == (2**17 + 6, False)
    for end in range(1, len(data)):
        refused(ValueError, "too early", most_unpacked, data[:end])
    refused(ValueError, "does not define", most_unpacked, frame([(3, b"", 0)]))
    refused(ValueError, "byte 0", most_unpacked, b"abcdefgh")
