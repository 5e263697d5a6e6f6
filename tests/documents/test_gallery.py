"""docs/gallery.md shows what `make gallery` draws, each picture with the command of its rule."""

import re
import shutil
from pathlib import Path

import pytest
from PIL import Image

from support.documents import ROOT
from support.processes.drawn_figures import drawn_figures
from support.processes.ended import ended

PAGE = (ROOT / "docs/gallery.md").read_text(encoding="utf-8")
COMMANDS = re.findall(r"^```sh\n(.*)\n```$", PAGE, re.MULTILINE)


@pytest.fixture(scope="module")
def rules():
    """What make would run, with the tool's bare name."""
    if shutil.which("make") is None:
        pytest.skip("there is no make")
    done = ended("make", "-n", "-B", "-o", "build/.installed", "gallery", cwd=ROOT, check=True)
    lines = done.stdout.replace(".venv/bin/vorotool", "vorotool").splitlines()
    return [line for line in lines if line.startswith("vorotool")]


def test_each_command_is_that_of_its_rule(rules):
    assert sorted(COMMANDS) == sorted(rules)


def test_each_picture_follows_its_command():
    drawn = [command.split()[-1] for command in COMMANDS]
    pictures = [name for name in drawn if name.endswith((".svg", ".png"))]
    assert re.findall(r"!\[.+\]\(\.\./(.+)\)", PAGE) == pictures
    links = re.findall(r"(?<!\!)\[[^]]+\]\(\.\./(.+)\)", PAGE)
    assert sorted(links) == sorted(set(drawn) - set(pictures))


def test_the_pictures_are_drawn(tmp_path_factory):
    folder = drawn_figures("gallery", tmp_path_factory)
    made = {path.name: path for path in folder.glob("gallery-*")}
    assert set(made) == {Path(command.split()[-1]).name for command in COMMANDS}
    for name, path in made.items():
        if name.endswith(".svg"):
            assert re.search(
                r'<g id="(skeleton|centerline|transects|offset|cells|polygons|regions|parts)"[^>]*>\s*<(path|text)',
                path.read_text(),
            ), name
    with Image.open(made["gallery-vessels.png"]) as image:
        assert image.size == (1000, 640)
    assert made["gallery-silhouettes.csv"].read_text().count("\n") == 4
