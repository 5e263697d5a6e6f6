"""Every rule of the table of options refuses what it is about, and every row what no output shows."""

from types import SimpleNamespace

import pytest

from support.refusals import refused
from vorotool.errors import UsageError
from vorotool.jobs.options import Options
from vorotool.jobs.refusals import check_options
from vorotool.jobs.targets import Target
from vorotool.products.options import options_of
from vorotool.products.options.rules import EXCLUDING, NEEDING
from vorotool.products.registry import PRODUCTS

PROPERTIES = {
    "?is_of_space": {"volume": True},
    "?is_digital": {"method": "digital"},
    "?has_pixel_size": {"pixel_size": SimpleNamespace(is_spacing=False)},
    "?scale_in_millimeters": {"scale": SimpleNamespace(is_ratio=False)},
    "?has_bands_on_cluster": {"cluster": "local"},
    "?is_automatic": {},
    "?has_several_results": {"what": ("edges",)},
}
FORMATS = {"animation": "gif", "png-picture": "png"}


def check(command, *conditions, **values):
    """Check options and outputs for which conditions hold."""
    what, fmt = [], None
    for part in (each for condition in conditions for each in condition.split("+") if each != "inputs"):
        kind, colon, names = part.partition(":")
        if part.startswith("?"):
            what += PROPERTIES[part].get("what", ())
            values |= {name: value for name, value in PROPERTIES[part].items() if name != "what"}
        elif colon:
            what += [names.split(",")[0]] if kind != "layer" else []
            values |= {"layers": (names,)} if kind == "layer" else {}
        elif "." in part:
            name, _, fmt = part.partition(".")
            what += [name] if name else []
        elif "=" in part:
            values |= dict([part.split("=")])
        else:
            values.setdefault(part, SimpleNamespace(is_ratio=True) if part == "scale" else (0.5, 0.5))
    what = what or [next(iter(PRODUCTS[command]))]
    targets = [Target(name, "a", FORMATS.get(fmt, fmt) or PRODUCTS[command][name].formats[0]) for name in what]
    check_options(Options(command, what=tuple(what), **values), targets)


def is_known(command, condition):
    known = {*options_of(command), "inputs"} | {f"what:{name}" for name in PRODUCTS[command]}
    return all(
        each[0] in "?." or each.partition("=")[0] in known or each.startswith(("only:", "layer:")) or each[-4] == "."
        for each in condition.split("+")
    )


@pytest.mark.parametrize("rule", EXCLUDING, ids=lambda rule: f"{rule.these} {rule.others}"[:60])
def test_what_excludes_each_other(rule):
    for command in rule.commands.split():
        for one in filter(lambda each: is_known(command, each), rule.these.split()):
            for other in filter(lambda each: is_known(command, each), rule.others.split()):
                refused(UsageError, "cannot be combined with", check, command, one, other)


@pytest.mark.parametrize("rule", NEEDING, ids=lambda rule: f"{rule.these} {rule.others}"[:60])
def test_what_needs_another(rule):
    for command in rule.commands.split():
        for one in filter(lambda each: is_known(command, each), rule.these.split()):
            refused(UsageError, " needs ", check, command, one)


@pytest.mark.parametrize("command", PRODUCTS)
def test_options_of_some_results_are_refused_with_others(command):
    for row in options_of(command).values():
        shown = set(row.acts_on.split())
        others = [name for name in PRODUCTS[command] if name not in shown]
        if shown and others and not any(set(word) & set("=:.?") for word in shown):
            with pytest.raises(
                UsageError, match=rf"({'|'.join(row.spellings)})\b.* applies only to|cannot be combined| needs "
            ):
                check(command, f"what:{others[-1]}", row.parameter)


def test_layers_and_their_colors_are_those_of_the_picture():
    for values in ({"layers": ("roads",)}, {"colors": (("roads", "red"),)}, {"line_widths": (("roads", 2.0),)}):
        refused(UsageError, "roads", check, "delaunay", "edges.svg", **values)
