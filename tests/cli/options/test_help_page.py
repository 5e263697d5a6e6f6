"""Help: each option has one group, the short page has the common options, and types show as they are written."""

import re

import click
import pytest
from click.testing import CliRunner

from vorotool.cli.command import COMMON, MOST, GroupedCommand
from vorotool.cli.main import COMMANDS, vorotool
from vorotool.products.options import GROUPS

ROOT = click.Context(vorotool)
GROUPED = [name for name in COMMANDS if isinstance(vorotool.get_command(ROOT, name), GroupedCommand)]
OWN_HELP = {"help", "short_help_page"}


def options(name):
    return {param.name for param in vorotool.get_command(ROOT, name).params if isinstance(param, click.Option)}


def said(*arguments):
    done = CliRunner().invoke(vorotool, [*arguments], prog_name="vorotool")
    assert done.exit_code == 0, done.output
    return done.output


def test_each_option_has_one_group_and_no_group_has_more():
    own = [{row.parameter for row in rows} for rows in GROUPS.values()]
    listed = [name for names in own for name in names]
    assert len(listed) == len(set(listed))
    assert set(listed) == set.union(*map(options, GROUPED)) - OWN_HELP
    assert set(COMMON) < set(listed)


@pytest.mark.parametrize("name", GROUPED)
def test_help_lists_every_option_under_its_title(name):
    text = said(name, "--help")
    titles = [line[:-1] for line in text.splitlines() if re.fullmatch(r"[A-Z][a-z ]+:", line)]
    assert titles == [title for title in GROUPS if options(name) & {row.parameter for row in GROUPS[title]}] + ["Help"]
    for param in vorotool.get_command(ROOT, name).params:
        assert isinstance(param, click.Argument) or f"{param.opts[-1]}" in text
    assert "RANGE" not in text


@pytest.mark.parametrize("name", GROUPED)
def test_the_short_page_has_ten_options_and_names_the_long_one(name):
    text = said(name, "-h")
    rows = re.findall(r"^  -", text.partition("Common options:")[2], re.MULTILINE)
    assert (4 if name == "distance" else 5) <= len(rows) <= MOST
    assert f"vorotool {name} --help" in text
    assert "vorotool sample " in text
    assert f"\n    vorotool {name} " in text
    assert len(text) < len(said(name, "--help")) / 2


def test_every_page_is_ascii():
    pages = [["--help"], *([name, "--help"] for name in COMMANDS), *([name, "-h"] for name in GROUPED)]
    for arguments in pages:
        text = said(*arguments)
        assert text.isascii(), [line for line in text.splitlines() if not line.isascii()]


@pytest.mark.parametrize(
    "arguments",
    [["--method", "Exact"], ["--what", "LABELS"], ["-f", "PNG"], ["--dtype", "UInt16", "-f", "tiff"]],
    ids=lambda each: each[0],
)
def test_choices_may_be_in_capitals(arguments, tmp_path):
    said("tessellate", "data/dots.csv", "--size", "20x20", "-o", str(tmp_path / "out"), *arguments)
    assert (tmp_path / "out").stat().st_size
