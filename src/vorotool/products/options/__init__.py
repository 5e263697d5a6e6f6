"""The table of options: help, completion, defaults, refusals and documents are made from it."""

from __future__ import annotations

from functools import cache
from typing import Any

from vorotool.products.options.inputs import FRAME, INPUT, METHOD
from vorotool.products.options.output import CHECKS, MANY, OUTPUT, PICTURES
from vorotool.products.options.row import Option

GROUPS: dict[str, tuple[Option, ...]] = {
    "Output": OUTPUT,
    "Method": METHOD,
    "Input": INPUT,
    "Frame": FRAME,
    "Pictures": PICTURES,
    "Many inputs": MANY,
    "Checks and resources": CHECKS,
}
"""All options, under the titles that help has."""
DEFAULTS: dict[str, Any] = {each.parameter: each.unset for rows in GROUPS.values() for each in rows}
"""Values of options that are not given, by parameter, where a command has none of its own."""


@cache
def options_of(command: str) -> dict[str, Option]:
    """Return the options of a command by parameter, in the order of help."""
    own = (each for rows in GROUPS.values() for each in rows if command in each.commands.split())
    return {each.parameter: each for each in own}


def flags_of(command: str) -> set[str]:
    """Return all spellings of the options of a command."""
    return {each for row in options_of(command).values() for pair in row.spellings for each in pair.split("/")}


def flag(command: str, parameter: str, value: Any = None) -> str:
    """Return an option as users type it, by its short flag if it has no other, and its opposite for False."""
    row = options_of(command)[parameter]
    first = next((each for each in row.spellings if each.startswith("--")), row.spellings[0])
    if parameter == "distance":
        first = "-d"
    yes, slash, no = first.partition("/")
    return no if slash and value is False else yes
