"""One row of the table of options."""

from __future__ import annotations

from typing import Any, NamedTuple

SITES = "tessellate delaunay alphashape"
"""Commands whose sites are points, or the seeds of an image."""
SKELETONS = "skeleton-approx skeleton-exact"
SHAPES = f"voronoi {SKELETONS}"
"""Commands that take shapes, or the outlines of an image."""
BATCHES = f"{SITES} {SHAPES}"
"""Commands that compute something of each of many inputs."""
COMPUTING = f"{BATCHES} distance"
ALL = f"{COMPUTING} draw"
"""Commands that write results."""


class Option(NamedTuple):
    """An option of some commands; another row may describe it for others."""

    flags: str  # all spellings, then what stands for the value, if there is one: `-d --distance D`
    commands: str
    help: str  # with `{names}` of results, formats or layers, where it has those of the command
    # of the value: text, `int:1:10`, `float:0:1`, `choice:a b`, `results`, `layers`, or a function of `cli.values`
    type: str = ""
    default: Any = None
    name: str = ""  # of the value, where it is not that of the last long flag
    repeats: str = ""  # `joined`: lists that are put together; `each`: values that are collected
    env: str = ""  # what follows VOROTOOL_ in the variable that gives the default
    complete: str = ""  # `files:csv json`, `inputs:points`, `folders`, `any` or `words:a b`: what shells offer
    # what shows it, any of: `WHAT`, `WHAT.FORMAT`, `.KIND`, `option=value` or `layer:NAME`; see `jobs.refusals`
    acts_on: str = ""

    @property
    def spellings(self) -> list[str]:
        """Flags; those of a pair of opposites, ``--a/--no-a``, are one."""
        return [word for word in self.flags.split() if word.startswith("-")]

    @property
    def metavar(self) -> str:
        """What stands for the value; empty for flags."""
        return " ".join(word for word in self.flags.split() if not word.startswith("-"))

    @property
    def is_pair(self) -> bool:
        """Whether it is a flag with an opposite."""
        return any("/" in flag for flag in self.spellings)

    @property
    def is_flag(self) -> bool:
        """Whether it has neither a value nor an opposite."""
        return not self.metavar and not self.type and not self.is_pair

    @property
    def parameter(self) -> str:
        """Name of the value."""
        long = max(self.spellings, key=lambda flag: (flag.startswith("--"), -self.spellings.index(flag)))
        return self.name or long.partition("/")[0].lstrip("-").replace("-", "_")

    @property
    def unset(self) -> Any:
        """Value where it is not given."""
        return False if self.default is None and self.is_flag else self.default
