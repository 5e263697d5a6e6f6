"""Print the picture of the README, of four SVG pictures that the tool has drawn: `front_picture.py CELLS REGIONS ...`.

One white card, so that it can be read on a light and on a dark page.
"""

import re
import sys
from pathlib import Path

TITLES = ("points → cells", "objects of a mask → regions", "polygons → skeletons", "polygons → offset curves")
PANEL = (430, 262)
GAP, TITLE = 20, 34
SIZE = (2 * PANEL[0] + 3 * GAP, 2 * (PANEL[1] + TITLE) + 2 * GAP)
FIRST_TAG = re.compile(r'<svg [^>]*viewBox="([^"]+)"[^>]*>')


def card(pictures: list[str]) -> str:
    """Four pictures with their titles, two in a row."""
    width, height = SIZE
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}">',
        f'<rect width="{width}" height="{height}" rx="12" fill="#ffffff"/>',
        '<g font-family="sans-serif" font-size="17" fill="#222222">',
    ]
    for number, (title, picture) in enumerate(zip(TITLES, pictures, strict=True)):
        left = GAP + number % 2 * (PANEL[0] + GAP)
        top = GAP + number // 2 * (PANEL[1] + TITLE + GAP // 2)
        parts.append(f'<text x="{left}" y="{top + 12}">{title}</text>')
        parts.append(panel(picture, left, top + TITLE - 10))
    return "\n".join([*parts, "</g>", "</svg>", ""])


def panel(picture: str, left: int, top: int) -> str:
    """One picture as a part of another: it fills its panel, or, where it is wider, lies in the middle of it."""
    first = FIRST_TAG.search(picture)
    assert first is not None
    width, height = map(float, first[1].split()[2:])
    fit = "slice" if width == height else "meet"
    place = f'x="{left}" y="{top}" width="{PANEL[0]}" height="{PANEL[1]}" preserveAspectRatio="xMidYMid {fit}"'
    return f'<svg {place} viewBox="{first[1]}">{picture[first.end() :].strip()}'


if __name__ == "__main__":
    sys.stdout.write(card([Path(name).read_text(encoding="utf-8") for name in sys.argv[1:]]))
