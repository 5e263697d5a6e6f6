"""The documents: the README and every page of docs, and the blocks of code in them."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
DATA = ROOT / "data"
DOCUMENTS = ["README.md", *sorted(str(path.relative_to(ROOT)) for path in (ROOT / "docs").rglob("*.md"))]
"""Their paths from the root."""
FENCE = re.compile(r"^```(\w+)\n(.*?)^```", re.MULTILINE | re.DOTALL)


def read(name):
    return (ROOT / name).read_text(encoding="utf-8")


def blocks(language):
    """Blocks of one language, with a name for each."""
    for name in DOCUMENTS:
        for number, match in enumerate(FENCE.finditer(read(name))):
            if match[1] == language:
                yield f"{name}-{number}", match[2]
