"""Print requirements that pyproject.toml states: `tools/requirements.py [--oldest] EXTRA...`.

Those of running come first, then those of each extra. `--oldest` gives the oldest version that each allows.
"""

from __future__ import annotations

import argparse
import re
import sys
import tomllib
from pathlib import Path
from typing import Any

REQUIREMENT = re.compile(r"(?P<name>[A-Za-z0-9_.-]+)>=(?P<version>[0-9.]+)")


def requirements(project: dict[str, Any], extras: list[str]) -> list[str]:
    """Give what running and some extras require.

    Examples
    --------
    >>> requirements({"dependencies": ["numpy>=2.0"], "optional-dependencies": {"zarr": ["zarr>=3"]}}, ["zarr"])
    ['numpy>=2.0', 'zarr>=3']
    """
    further = (project["optional-dependencies"][extra] for extra in extras)
    return list(dict.fromkeys([*project["dependencies"], *(line for lines in further for line in lines)]))


def oldest(stated: list[str]) -> list[str]:
    """Give the oldest version that each requirement allows.

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
    parser.add_argument("extras", nargs="*", metavar="EXTRA")
    given = parser.parse_args()
    text = (Path(__file__).parents[1] / "pyproject.toml").read_text(encoding="utf-8")
    found = requirements(tomllib.loads(text)["project"], given.extras)
    sys.stdout.write(" ".join(oldest(found) if given.oldest else found) + "\n")
