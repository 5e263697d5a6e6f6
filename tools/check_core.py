"""Refuse sources of the core whose folders include each other in a circle, or that use what rounds differently.

Sums, products, quotients and square roots have the same bits on every machine; powers, sines, logarithms and fused
operations depend on the C library and on the compiler. A namespace is called like its folder.
"""

from __future__ import annotations

import re
import sys
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

SOURCES = Path(__file__).parents[1] / "src"
CORE = SOURCES / "core"
ROUNDED = re.compile(
    r"std::(a?sinh?|a?cosh?|a?tanh?|atan2|exp2?|expm1|log(2|10|1p|b)?|pow|cbrt|hypot|erfc?|[lt]gamma|fma|reduce|"
    r"transform_reduce)\b|long double|__float128|#pragma (GCC optimize|STDC FP_CONTRACT)|fast-math"
)


def faults() -> list[str]:
    """Return what is wrong with the sources, a line each."""
    found, included = [], {}
    for path in sorted(CORE.rglob("*.[ch]pp")):
        folder, text = path.parent.relative_to(CORE), path.read_text(encoding="utf-8")
        headers = re.findall(r'^#include "core/(.+)/', text, re.MULTILINE)
        included.setdefault(folder.as_posix(), set()).update({*headers} - {folder.as_posix()})
        namespaces = re.findall(r"^namespace (vorotool\S*)", text, re.MULTILINE)
        if namespaces != ["::".join(("vorotool", "core", *folder.parts))]:
            found.append(f"{path}: the namespace is not called like the folder")
    try:
        TopologicalSorter(included).prepare()
    except CycleError as error:
        found.append(f"folders include each other: {' -> '.join(error.args[1][::-1])}")
    for path in [*SOURCES.rglob("*.[ch]pp"), *SOURCES.rglob("*.cmake"), *SOURCES.rglob("CMakeLists.txt")]:
        text = re.sub(r"//.*", "", path.read_text(encoding="utf-8"))
        found += [f"{path}: {match.group()} rounds differently on other machines" for match in ROUNDED.finditer(text)]
    return found


if __name__ == "__main__":
    sys.exit("\n".join(faults()) or None)
