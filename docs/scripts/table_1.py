"""Print the paper's Table 1 beside our seconds: `table_1.py FOLDER SIZE...` reads the --stats of each run."""

import json
import sys
from pathlib import Path

PAPER_SECONDS = {64: 0.13, 128: 0.49, 256: 2.40, 512: 18.5}


def seconds(folder: Path, method: str, size: int) -> float:
    """Seconds of the tessellation alone, without reading and writing."""
    return float(json.loads((folder / f"{method}-{size}.json").read_text())["seconds"]["tessellate"])


def main() -> None:
    """Write the table as Markdown."""
    folder, sizes = Path(sys.argv[1]), [int(size) for size in sys.argv[2:]]
    rows = [(size, seconds(folder, "propagation", size), seconds(folder, "exact", size)) for size in sizes]
    lines = [
        "| image size | paper, s | its two passes here, s | exact, s | paper / exact |",
        "|---|---|---|---|---|",
        *(
            f"| {m}² | {PAPER_SECONDS[m]:g} | {passes:.6f} | {exact:.6f} | {PAPER_SECONDS[m] / exact:,.0f} |"
            for m, passes, exact in rows
        ),
    ]
    sys.stdout.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
