"""One row of the table of options."""

from __future__ import annotations

from typing import Any

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


class Option:
    """An option of some commands; another row may describe it for others."""

    def __init__(
        self,
        flags: str,  # all spellings, then what stands for the value, if there is one: `-d --distance D`
        commands: str,
        help: str,  # with `{names}` of results, formats or layers, where it has those of the command
        # of the value: text, `int:1:10`, `float:0:1`, `choice:a b`, `results`, `layers`, or a function of `cli.values`
        type: str = "",
        default: Any = None,
        name: str = "",  # of the value, where it is not that of the last long flag
        repeats: str = "",  # `joined`: lists that are put together; `each`: values that are collected
        env: str = "",  # what follows VOROTOOL_ in the variable that gives the default
        complete: str = "",  # `files:csv json`, `inputs:points`, `folders`, `any` or `words:a b`: what shells offer
        # what shows it, any of: `WHAT`, `WHAT.FORMAT`, `.KIND`, `option=value` or `layer:NAME`; see `jobs.refusals`
        acts_on: str = "",
    ) -> None:
        words = flags.split()
        # flags; those of a pair of opposites, `--a/--no-a`, are one
        self.spellings = [word for word in words if word[0] == "-"]
        self.metavar = " ".join(words[len(self.spellings) :])  # what stands for the value; empty for flags
        self.is_pair = "/" in flags and not self.metavar
        self.is_flag = not (self.metavar or type or self.is_pair)  # it has neither a value nor an opposite
        long = next((word for word in self.spellings if word.startswith("--")), words[0])
        self.parameter = name or long.partition("/")[0].lstrip("-").replace("-", "_")  # name of the value
        self.unset = False if default is None and self.is_flag else default  # value where it is not given
        self.commands, self.help, self.type, self.default = commands, help, type, default
        self.repeats, self.env, self.complete, self.acts_on = repeats, env, complete, acts_on
