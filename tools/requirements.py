"""Print requirements that pyproject.toml states: `tools/requirements.py [--oldest] NAME...`.

Those of running come first, then those of each extra or dependency group. `--oldest` prints the oldest version that
each allows. pip reads dependency groups from version 25.1 on; the pip of Python 3.11 is older.
"""

from __future__ import annotations

import argparse
import re
import sys
import tomllib
from pathlib import Path
from typing import Any

REQUIREMENT = re.compile(r"(?P<name>[A-Za-z0-9_.-]+)>=(?P<version>[0-9.]+)")


def requirements(pyproject: dict[str, Any], names: list[str]) -> list[str]:
    """Return what running and some extras or dependency groups require.

    Examples
    --------
    >>> project = {"dependencies": ["numpy>=2.0"], "optional-dependencies": {"zarr": ["zarr>=3"]}}
    >>> requirements({"project": project, "dependency-groups": {"dev": ["pytest>=8"]}}, ["zarr", "dev"])
    ['numpy>=2.0', 'zarr>=3', 'pytest>=8']
    """
    project = pyproject["project"]
    known = project["optional-dependencies"] | pyproject["dependency-groups"]
    unknown = [name for name in names if name not in known]
    if unknown:
        raise SystemExit(f"pyproject.toml has no {unknown[0]!r}: use some of {', '.join(known)}")
    return list(dict.fromkeys([*project["dependencies"], *(line for name in names for line in known[name])]))


def oldest(stated: list[str]) -> list[str]:
    """Return the oldest version that each requirement allows.

    Examples
    --------
    >>> oldest(["numpy>=2.0"])
    ['numpy==2.0']
    """
    bounds: dict[str, str] = {}
    for requirement in stated:
        match = REQUIREMENT.fullmatch(requirement)
        if match is None:
            raise SystemExit(f"pyproject.toml: {requirement!r} states no lower bound such as 'numpy>=2.0'")
        if bounds.setdefault(match["name"], match["version"]) != match["version"]:
            raise SystemExit(f"pyproject.toml: {match['name']} has another lower bound than {requirement!r}")
    return [f"{name}=={version}" for name, version in bounds.items()]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--oldest", action="store_true")
    parser.add_argument("names", nargs="*", metavar="NAME", help="extra or dependency group")
    given = parser.parse_args()
    text = (Path(__file__).parents[1] / "pyproject.toml").read_text(encoding="utf-8")
    found = requirements(tomllib.loads(text), given.names)
    sys.stdout.write(" ".join(oldest(found) if given.oldest else found) + "\n")
