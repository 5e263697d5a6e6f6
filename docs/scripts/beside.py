"""Draw five scenes on light and on dark ground, and with QGIS: `docs/scripts/beside.py` writes docs/images/beside.png.

`QGIS_PYTHON` is a Python that has the modules of QGIS, by default `/usr/bin/python3`.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).parents[2]
PICTURE = ROOT / "docs/images/beside.png"
MASKS = {
    "letters": ["skeleton-exact"],
    "vessels": ["skeleton-exact"],
    "river": ["skeleton-exact", "--what", "centerline", "--prune", "ratio=2"],
    "silhouettes": ["skeleton-exact", "--prune", "ratio=1.5"],
}
"""Scenes of the gallery, and what draws them."""
CELLS = ["delaunay", "data/dots.csv", "--what", "cells", "--frame", "0,0,512,512"]
DARK = ["--background", "#1c1c1c"]
WIDTH = 330
GAP = 8


def run(*arguments: str | Path) -> None:
    """Run vorotool; of images on a map it notes each time that they lie there."""
    subprocess.run(
        [sys.executable, "-m", "vorotool", *map(str, arguments)], check=True, cwd=ROOT, stderr=subprocess.DEVNULL
    )


def draw_mask(folder: Path, name: str, command: list[str]) -> str:
    """Draw a scene on both grounds, write what QGIS draws, and give the line that tells QGIS its size."""
    mask = folder / f"{name}.png"
    script = [sys.executable, str(ROOT / "docs/scripts/gallery_inputs.py"), name]
    mask.write_bytes(subprocess.run(script, check=True, stdout=subprocess.PIPE).stdout)
    width, height = Image.open(mask).size
    mask.with_suffix(".pgw").write_text(f"1\n0\n0\n-1\n0.5\n{height - 0.5}\n")
    run(*command, mask, "-o", folder / f"{name}-lines.geojson")
    run(*command, mask, "--width", str(WIDTH), "-o", folder / f"{name}-light.png")
    colors = ["--color", "skeleton=#ffb000", "--color", "polygons=#9a9a9a"]
    run(*command, mask, "--width", str(WIDTH), *DARK, *colors, "-o", folder / f"{name}-dark.png")
    return f"{name} {WIDTH} {WIDTH * height // width} 0 0 {width} {height}\n"


def draw_cells(folder: Path) -> str:
    """Draw the cells of points likewise."""
    run(*CELLS, "-o", folder / "cells-areas.geojson")
    run(*CELLS, "--y-up", "--width", str(WIDTH), "-o", folder / "cells-light.png")
    colors = ["--color", "cells=#1c1c1c", "--color", "points=white"]
    run(*CELLS, "--y-up", "--width", str(WIDTH), *DARK, *colors, "-o", folder / "cells-dark.png")
    return f"cells {WIDTH} {WIDTH} 0 0 512 512\n"


def main() -> None:
    """Draw all, and put them side by side."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        sizes = [draw_mask(folder, scene, command) for scene, command in MASKS.items()]
        (folder / "size.txt").write_text("".join([*sizes, draw_cells(folder)]))
        qgis = [os.environ.get("QGIS_PYTHON", "/usr/bin/python3"), str(ROOT / "docs/scripts/beside_qgis.py"), name]
        subprocess.run(qgis, check=True, env={**os.environ, "QT_QPA_PLATFORM": "offscreen"})
        rows = [
            [Image.open(folder / f"{scene}-{ground}.png").convert("RGB") for ground in ("light", "dark", "qgis")]
            for scene in (*MASKS, "cells")
        ]
    heights = [max(picture.height for picture in row) for row in rows]
    sheet = Image.new("RGB", (3 * WIDTH + 2 * GAP, sum(heights) + GAP * (len(rows) - 1)), "#808080")
    top = 0
    for row, height in zip(rows, heights, strict=True):
        for column, picture in enumerate(row):
            sheet.paste(picture, (column * (WIDTH + GAP), top))
        top += height + GAP
    sheet.quantize(128).save(PICTURE, optimize=True)


if __name__ == "__main__":
    main()
