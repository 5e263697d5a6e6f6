"""The table of options: rows that resolve, conditions that exist, and all that follows from a row."""

import re
from importlib import import_module

import click
import pytest

from support.processes.ended import ended_python
from vorotool.cli.main import vorotool
from vorotool.cli.values.lengths import spacing
from vorotool.jobs.options import Options
from vorotool.jobs.refusals import _KINDS, _PROPERTIES
from vorotool.jobs.units import lengths_in_steps, with_spacing
from vorotool.products.commands import COMMANDS
from vorotool.products.formats import FORMATS, resolved
from vorotool.products.options import DEFAULTS, GROUPS, options_of
from vorotool.products.options.rules import EXCLUDING, NEEDING
from vorotool.products.registry import PRODUCTS, VOLUME_PRODUCTS, all_layers

ROWS = [row for rows in GROUPS.values() for row in rows]
KNOWN = {*COMMANDS, "info"}


@pytest.mark.parametrize("group", GROUPS)
def test_rows_name_what_there_is(group):
    for row in GROUPS[group]:
        check_row(row)


def check_row(row):
    assert set(row.commands.split()) <= KNOWN
    kind = row.type.partition(":")[0]
    if kind not in ("", "choice", "int", "float", "results", "layers"):
        module, name = kind.split(".")
        assert callable(getattr(import_module(f"vorotool.cli.values.{module}"), name))
    assert row.repeats in ("", "joined", "each")
    assert row.is_flag + row.is_pair + bool(row.metavar or row.type) == 1
    for command in set(row.commands.split()) & set(COMMANDS):
        for word in row.acts_on.split():
            check_condition(command, word if set(word) & set("=:.?") else f"what:{word}", of_row=True)


@pytest.mark.parametrize("rule", [*EXCLUDING, *NEEDING], ids=lambda rule: f"{rule.these} {rule.others}"[:60])
def test_a_rule_names_what_there_is(rule):
    """In one of its commands at least: the options of others may lack."""
    for condition in (each for text in (rule.these, rule.others) for each in text.split()):
        fitting = [command for command in rule.commands.split() if fits(command, condition)]
        assert fitting, condition


def fits(command, condition):
    try:
        check_condition(command, condition)
    except AssertionError:
        return False
    return True


def check_condition(command, condition, *, of_row=False):
    for part in condition.split("+"):
        kind, colon, names = part.partition(":")
        results = {**PRODUCTS[command], **(VOLUME_PRODUCTS if command == "tessellate" else {})}
        if colon:
            known = all_layers(command) if kind == "layer" else results
            assert kind in ("what", "only", "layer")
            assert set(names.split(",")) <= set(known) or of_row
        elif part.startswith("?"):
            assert hasattr(Options, part[1:])
            assert part in {**_PROPERTIES, **_KINDS}
        elif part.startswith("."):
            assert part in _KINDS or part[1:] in FORMATS or part == ".png-picture"
        elif "=" in part:
            name, value = part.split("=")
            if of_row and name not in options_of(command):
                continue
            assert value in options_of(command)[name].type.partition(":")[2].split()
        elif "." in part:
            what, fmt = part.split(".")
            assert fmt in FORMATS
            assert of_row or fmt in results[what].formats
        else:
            assert part == "inputs" or part in options_of(command)


@pytest.mark.parametrize("command", COMMANDS)
def test_options_of_a_command_have_names_of_their_own(command):
    rows = [row for row in ROWS if command in row.commands.split()]
    assert len(options_of(command)) == len(rows)
    flags = [flag for row in rows for spelling in row.spellings for flag in spelling.split("/")]
    assert len(set(flags)) == len(flags)
    assert callable(resolved(COMMANDS[command].job))
    assert not COMMANDS[command].check or callable(resolved(COMMANDS[command].check))


def test_defaults_are_those_of_every_row():
    """What a command lacks has the default that others have."""
    for row in ROWS:
        assert DEFAULTS[row.parameter] == row.unset or row.parameter in ("method", "side", "complete"), row


@pytest.mark.parametrize("command", COMMANDS)
def test_click_has_what_the_table_has(command):
    context = click.Context(vorotool)
    made = {each.name: each for each in vorotool.get_command(context, command).params if isinstance(each, click.Option)}
    assert [name for name in made if name != "short_help_page"] == list(options_of(command))
    for name, row in options_of(command).items():
        assert {*made[name].opts, *made[name].secondary_opts} == {f for s in row.spellings for f in s.split("/")}


def made_for(command, *arguments):
    """The parameters of a command that is made for some arguments."""
    return {each.name for each in vorotool.resolve_command(click.Context(vorotool), [command, *arguments])[1].params}


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_has_the_options_that_its_arguments_name(command):
    rows = options_of(command)
    for name, row in rows.items():
        for flag in (flag for spelling in row.spellings for flag in spelling.split("/")):
            for typed in (
                flag,
                f"{flag}=1",
                f"{flag}1" if flag[1] != "-" else flag,
                flag if len(flag) > 2 else f"-q{flag[1]}",
            ):
                assert name in made_for(command, "a.csv", typed), typed
    assert rows.keys() <= made_for(command, "--help")
    assert rows.keys() <= made_for(command, "-qh")
    assert not rows.keys() & made_for(command, "a.csv")


def test_a_command_has_the_options_of_the_environment(monkeypatch):
    monkeypatch.setenv("VOROTOOL_MAX_SITES", "3")
    assert "max_sites" in made_for("delaunay", "a.csv")
    assert "max_sites" not in made_for("draw", "a.png")


ADDED = """
import sys
from vorotool.products import options
from vorotool.products.options.row import Option
options.GROUPS["Method"] += (
    Option("--wobble D", "delaunay voronoi", "Shake by D.", "lengths.length", acts_on="edges.csv cells"),
)
options.DEFAULTS["wobble"] = None
from vorotool.cli.main import main
for line in sys.stdin.read().splitlines():
    try:
        main(line.split())
    except SystemExit as end:
        print(f"= {end.code}", flush=True)
"""
SAID = {
    "delaunay --help": "--wobble D",
    "delaunay a.csv --wobble 2 -f csv": "= 0",
    "delaunay a.csv --wobble 2 -f npz -o a.npz": "--wobble applies only to --what cells or --what edges as csv",
    "delaunay a.csv --wobble -1": "'--wobble': '-1': expected more than 0",
    "draw a.csv --wobble 1": "draw has no --wobble: delaunay, voronoi have it",
}


def test_an_option_is_one_row(tmp_path):
    (tmp_path / "a.csv").write_text("x,y\n0,0\n4,0\n0,3\n")
    done = ended_python("-c", ADDED, input="\n".join(SAID), cwd=tmp_path, capture_output=False, stdout=-1, stderr=-2)
    ends = re.findall("^= (.)$", done.stdout, re.MULTILINE)
    assert ends == ["0", "0", "2", "2", "2"]
    assert all(text in done.stdout for text in SAID.values())


NOT_IN_STEPS = {"pixel_size", "spacing", "min_area", "fill_holes", "prune"}
"""Sizes of pixels, areas, which are those of pixels, and a pruning, which may be a length."""
LENGTHS = [
    (command, name)
    for command in ("delaunay", "voronoi", "skeleton-approx", "skeleton-exact")
    for name, row in options_of(command).items()
    if row.type.startswith("lengths.") and name not in NOT_IN_STEPS
]


def test_every_length_is_counted_in_the_steps_of_spacing():
    for command, name in LENGTHS:
        o = with_spacing(Options(command, spacing=spacing("0.5,0.25um"), **{name: (3.0, 1.5)}))
        assert getattr(lengths_in_steps(o), name) == (12.0, 6.0), (command, name)
