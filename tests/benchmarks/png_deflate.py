"""Purpose: choose the deflate of the PNG writer, on the images it is for: 8192 x 8192 labels of 16 bits.

Filter (Up, as `formats/images/png_writer.py` does it), checksum and deflate of fixed blocks of rows are timed together;
then the writer itself, into a file. Run: python tests/benchmarks/png_deflate.py [--size 8192] [--threads 2].
isal and zlib-ng are measured where they are installed (pip install isal zlib-ng). Every result is
decompressed and compared. The `deflate` wheel (libdeflate) has no sync flush, so that blocks cannot be
joined to one stream: it is no candidate. Chosen: zlib's run-length strategy, which uses no hash table,
where builds of zlib differ.
"""

from __future__ import annotations

import argparse
import importlib
import tempfile
import time
import zlib
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import NDArray

import vorotool
from vorotool.formats.images.png_writer import write_png
from vorotool.numeric.coordinates import writing

BLOCK_BYTES = 1 << 20


def label_image(size: int, count: int) -> NDArray[np.uint16]:
    """Voronoi labels of ``count`` seeds in random order."""
    seeds = np.random.default_rng(7).integers(0, size, (count, 2))
    return vorotool.tessellate(seeds, shape=(size, size)).labels.astype(np.uint16)


def filtered(image: NDArray[np.uint16], start: int, stop: int) -> NDArray[np.uint8]:
    """Rows with the Up filter, each after its filter byte."""
    rows = image[max(start - 1, 0) : stop].astype(">u2").view(np.uint8)
    out = np.empty((stop - start, 1 + rows.shape[1]), np.uint8)
    out[:, 0] = 2
    if start == 0:
        out[0, 1:] = rows[0]
    np.subtract(rows[1:], rows[:-1], out=out[stop - start + 1 - len(rows) :, 1:])
    return out


Compress = Callable[[NDArray[np.uint8]], bytes]


def candidates() -> Iterator[tuple[str, Compress]]:
    """Names and raw-deflate functions that end in a sync flush."""
    strategies = {"filtered": zlib.Z_FILTERED, "huffman": zlib.Z_HUFFMAN_ONLY, "rle": zlib.Z_RLE}
    for module_name in ("zlib", "zlib_ng.zlib_ng"):
        try:
            module = importlib.import_module(module_name)
        except ImportError:
            continue
        for level in (1, 2, 3, 4, 6):
            yield f"{module_name} level {level}", _deflate(module, level, 0)
        yield f"{module_name} level 6 filtered", _deflate(module, 6, strategies["filtered"])
        for name in ("huffman", "rle"):
            yield f"{module_name} {name}", _deflate(module, 1, strategies[name])
    try:
        module = importlib.import_module("isal.isal_zlib")
    except ImportError:
        return
    for level in (0, 1, 2, 3):
        yield f"isal level {level}", _deflate(module, level, 0)


def _deflate(module: object, level: int, strategy: int) -> Compress:
    def compress(block: NDArray[np.uint8]) -> bytes:
        stream = module.compressobj(level, 8, -15, 8, strategy)  # type: ignore[attr-defined]
        return bytes(stream.compress(block) + stream.flush(zlib.Z_FULL_FLUSH))

    return compress


def measure(image: NDArray[np.uint16], compress: Compress, threads: int) -> tuple[list[bytes], float]:
    """Compressed blocks and seconds: filter, checksum and deflate."""
    rows = max(1, BLOCK_BYTES // (image.shape[1] * 2))

    def block(start: int) -> tuple[bytes, int]:
        data = filtered(image, start, min(start + rows, len(image)))
        return compress(data), zlib.adler32(data)

    begin = time.perf_counter()
    with ThreadPoolExecutor(threads) as pool:
        parts = list(pool.map(block, range(0, len(image), rows)))
    return [part for part, _ in parts], time.perf_counter() - begin


def written(image: NDArray[np.uint16], threads: int) -> tuple[int, float]:
    """Bytes and seconds of the writer itself, given bands of 64 rows."""
    begin = time.perf_counter()
    with tempfile.TemporaryFile() as out:
        bands = (image[start : start + 64] for start in range(0, len(image), 64))
        with writing(threads=threads):
            write_png(out, bands, image.shape)
        out.flush()
        return out.tell(), time.perf_counter() - begin


def main() -> None:
    """Print one row a candidate: size and seconds for each image."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", type=int, default=8192)
    parser.add_argument("--threads", type=int, default=2)
    options = parser.parse_args()
    images = {count: label_image(options.size, count) for count in (10_000, 60_000)}
    print(f"{options.size} x {options.size} uint16, {options.threads} threads; filter + checksum + deflate")
    print(f"{'candidate':34}" + "".join(f"{f'n = {count}':>24}" for count in images))
    for name, compress in candidates():
        cells = []
        for image in images.values():
            parts, seconds = measure(image, compress, options.threads)
            whole = zlib.decompressobj(-15).decompress(b"".join(parts))
            correct = zlib.adler32(whole) == zlib.adler32(filtered(image, 0, len(image)))
            cells.append(f"{sum(map(len, parts)) / 1e6:9.2f} MB {seconds:6.3f} s {'' if correct else 'WRONG'}")
        print(f"{name:34}" + "".join(f"{cell:>24}" for cell in cells))
    sizes = [written(image, options.threads) for image in images.values()]
    print(f"{'write_png, into a file':34}" + "".join(f"{b / 1e6:12.2f} MB {s:6.3f} s " for b, s in sizes))


if __name__ == "__main__":
    main()
