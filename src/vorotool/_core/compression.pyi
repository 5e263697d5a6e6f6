"""Compressed bytes of TIFF files."""

import numpy
import numpy.typing


def unpack_lzw(data: bytes, limit: int) -> numpy.typing.NDArray[numpy.uint8]: ...

def unpack_packbits(data: bytes, limit: int) -> numpy.typing.NDArray[numpy.uint8]: ...
