"""Print the oldest versions that pyproject.toml allows, of all that running, building and testing need.

`make test-oldest` installs them in an environment of their own: the lower bounds are read from where they are stated.
"""

from __future__ import annotations

import re
import sys
import tomllib
from pathlib import Path
from typing import Any

EXTRAS = ("dev", "zarr", "graphs", "distributed")

REQUIREMENT = re.compile(r"(?P<name>[A-Za-z0-9_.-]+)>=(?P<version>[0-9.]+)")


def oldest(project: dict[str, Any]) -> list[str]:
    """Give a requirement of one version for each package of pyproject.toml.

    Examples
    --------
    >>> oldest({"project": {"dependencies": ["numpy>=2.0"], "optional-dependencies": {}}})
    ['numpy==2.0']
    """
    own = project["project"]
    extras = [own["optional-dependencies"].get(extra, []) for extra in EXTRAS]
    building = project.get("build-system", {}).get("requires", [])
    stated = [*own["dependencies"], *building, *(line for lines in extras for line in lines)]
    bounds: dict[str, str] = {}
    for requirement in stated:
        match = REQUIREMENT.fullmatch(requirement)
        if match is None:
            raise SystemExit(f"pyproject.toml: {requirement!r} states no lower bound such as 'numpy>=2.0'")
        if bounds.setdefault(match["name"], match["version"]) != match["version"]:
            raise SystemExit(f"pyproject.toml: {match['name']} has another lower bound than {requirement!r}")
    return [f"{name}=={version}" for name, version in bounds.items()]


if __name__ == "__main__":
    text = (Path(__file__).parents[1] / "pyproject.toml").read_text(encoding="utf-8")
    sys.stdout.write(" ".join(oldest(tomllib.loads(text))) + "\n")
