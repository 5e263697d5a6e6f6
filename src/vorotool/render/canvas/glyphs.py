"""Texts as pixels, the same everywhere: capitals are seven cells high, all glyphs five wide, one cell apart."""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence
from functools import cache

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import owners, within

HEIGHT, WIDTH, ADVANCE = 7, 5, 6
"""Of a glyph, and from one to the next, in cells."""

_FIRST, _UNKNOWN = " ", "?"
_MICRO = bytes.fromhex("7c2020203c")
"""Columns of µ and of the Greek letter."""
_COLUMNS = bytes.fromhex(
    "0000000000 00005f0000 0007000700 147f147f14 242a7f2a12 2313086462 3649552250 0005030000 001c224100 0041221c00"
    "14083e0814 08083e0808 0050300000 0808080808 0060600000 2010080402 3e5149453e 00427f4000 4261514946 2141454b31"
    "1814127f10 2745454539 3c4a494930 0171090503 3649494936 064949291e 0036360000 0056360000 0814224100 1414141414"
    "0041221408 0201510906 324979413e 7e1111117e 7f49494936 3e41414122 7f4141221c 7f49494941 7f09090901 3e4149497a"
    "7f0808087f 00417f4100 2040413f01 7f08142241 7f40404040 7f020c027f 7f0408107f 3e4141413e 7f09090906 3e4151215e"
    "7f09192946 4649494931 01017f0101 3f4040403f 1f2040201f 3f4038403f 6314081463 0708700807 6151494543 007f414100"
    "0204081020 0041417f00 0402010204 4040404040 0001020400 2054545478 7f48444438 3844444420 384444487f 3854545418"
    "087e090102 0c5252523e 7f08040478 00447d4000 2040443d00 7f10284400 00417f4000 7c04180478 7c08040478 3844444438"
    "7c14141408 081414187c 7c08040408 4854545420 043f444020 3c4040207c 1c2040201c 3c4030403c 4428102844 0c5050503c"
    "4464544c44 0008364100 00007f0000 0041360800 1008081008"
)
"""Columns of the glyphs from blank to tilde; the least bit is the topmost cell."""


@cache
def _glyph(letter: str) -> NDArray[np.bool_]:
    """(7, 5) the cells of a letter; of one with an accent those of the letter without it."""
    plain = unicodedata.normalize("NFKD", letter)[:1]
    index = ord(plain if " " <= plain <= "~" else _UNKNOWN) - ord(_FIRST)
    is_micro = plain == "\N{GREEK SMALL LETTER MU}"
    columns = np.frombuffer(_MICRO, np.uint8) if is_micro else np.frombuffer(_COLUMNS, np.uint8, WIDTH, WIDTH * index)
    return (columns >> np.arange(HEIGHT, dtype=np.uint8)[:, None] & 1).astype(bool)


def grown(pixels: NDArray[np.bool_], *, back: bool = True, on: bool = True) -> NDArray[np.bool_]:
    """Add the pixels before and after each, above and below, corner to corner, too."""
    made = pixels.copy()
    for along in (made, made.T):
        before = along.copy(order="K")
        if back:
            along[:-1] |= before[1:]
        if on:
            along[1:] |= before[:-1]
    return made


@cache
def _cells(text: str) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Cells of a text and of its halo, as (n, 2) columns and rows from the middle of its box."""
    ink = np.zeros((HEIGHT + 2, ADVANCE * len(text) + 1), bool)
    for k, letter in enumerate(text):
        ink[1:-1, ADVANCE * k + 1 : ADVANCE * k + 1 + WIDTH] = _glyph(letter)
    middle = np.array([ink.shape[1] // 2, ink.shape[0] // 2])
    return np.argwhere(ink)[:, ::-1] - middle, np.argwhere(grown(ink) & ~ink)[:, ::-1] - middle


def text_cells(texts: Sequence[str]) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.bool_]]:
    """Give the cells of texts."""
    parts = [np.concatenate(_cells(text)) for text in texts]
    inks = [len(_cells(text)[0]) for text in texts]
    sizes = np.array([len(part) for part in parts], dtype=np.int64)
    owner, number = owners(sizes), within(sizes)
    cells = np.concatenate([np.empty((0, 2), np.int64), *parts])
    return owner, cells, number < np.array(inks, dtype=np.int64)[owner]
