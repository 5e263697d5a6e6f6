"""Every option that is a length, with a unit, and every way to say what a pixel is: a result, or what to type."""

from pathlib import Path

import click
import numpy as np
import pytest
import tifffile

from vorotool.cli.main import vorotool
from vorotool.cli.options.lengths import Distances, Length
from vorotool.cli.options.pruning import PruningType
from vorotool.cli.options.shared import Decimal

MASK = np.zeros((40, 60), np.uint8)
MASK[5:20, 5:25] = MASK[25:36, 20:55] = 255

WITH = {
    "tessellate --max-distance": [
        "-o o.npy",
        "-o o.csv --what table",
        "-o o.npy --what distance",
        "-o o.npy --spacing 1,2um",
        "-o o.npy --volume",
    ],
    "alphashape -r": ["-o o.csv --seeds pixels", "-o o.csv --what table", "-o o.svg"],
    "voronoi --max-distance": ["-o o.csv", "-o o.csv --what table", "-o o.wkt --flatten 5um"],
    "voronoi --flatten": ["-o o.wkt"],
    "skeleton-exact -d": ["-o o.csv --what offset"],
    "skeleton-exact --every": ["-o o.csv --what points", "-o o.csv --what transects"],
    "skeleton-exact --gap": [
        "-o o.csv",
        "-o o.csv --complete",
        "-o o.csv --border open",
        "-o o.wkt --what shape",
        "-o o.csv --what discs",
        "-o o.npy --what thickness",
        "-o o.csv --what necks",
        "-o o.csv --what offset -d 5um",
    ],
    "skeleton-exact --prune": ["-o o.csv", "-o o.csv --what discs"],
    "skeleton-exact --flatten": ["-o o.wkt", "-o o.geojson --what centerline", "-o o.wkt --what shape"],
    "skeleton-exact --simplify": ["-o o.csv", "-o o.csv --outline contour", "-o o.csv --border open"],
    "skeleton-approx --every": ["-o o.csv --what points --step 1"],
    "skeleton-approx --flatten": ["-o o.wkt --what shape --step 1", "-o o.wkt --step 5um"],
    "skeleton-approx --step": ["-o o.csv", "-o o.csv --tolerance 5um"],
    "skeleton-approx --tolerance": ["-o o.csv"],
}
"""Further options with which a length is used, or looked at."""


def lengths():
    """Command, option and further options of all options that are lengths."""
    context = click.Context(vorotool)
    for command in vorotool.list_commands(context):
        for option in vorotool.get_command(context, command).params:
            if isinstance(option.type, Length | Decimal | Distances | PruningType):
                name = f"{command} {option.opts[0]}"
                plain = "-o o.csv --step 1" if command == "skeleton-approx" else "-o o.csv"
                yield from (
                    pytest.param(command, option, more, id=f"{name} {more}") for more in WITH.get(name, [plain])
                )


@pytest.fixture
def image(tmp_path):
    sizes = {"PhysicalSizeX": 0.5, "PhysicalSizeY": 0.5, "PhysicalSizeXUnit": "µm", "PhysicalSizeYUnit": "µm"}
    tifffile.imwrite(tmp_path / "in.ome.tif", MASK, ome=True, metadata={"axes": "YX", **sizes})


@pytest.mark.parametrize(("command", "option", "more"), list(lengths()))
def test_a_length_with_a_unit(run, image, command, option, more):
    """With the size typed, carried by the file, or unknown."""
    text = "length=1um" if isinstance(option.type, PruningType) else "1um"
    words, written = [command, "in.ome.tif", option.opts[0], text, *more.split()], []
    for size in ("--pixel-size 0.5µm", "--pixel-size auto", ""):
        done = run(*words, *size.split(), "-q")
        assert done.code in (0, 2, 3)
        assert "Measured(" not in done.err + done.out
        named = [text, *(word for word in (*words, *size.split()) if word.startswith("-"))]
        assert done.code == 0 or any(each in done.err for each in named)
        result = Path(words[words.index("-o") + 1])
        written.append(result.read_bytes() if done.code == 0 else done.err)
        result.unlink(missing_ok=True)
    assert written[0] == written[1]
    if option.opts[0] == "--max-distance" and "volume" not in more and "spacing" not in more:
        assert "--pixel-size auto" in written[2]
    assert option.opts[0] != "--prune" or done.code == 2


def test_units_of_lengths_that_never_come(run, image, tmp_path):
    """A drawing has no pixels, whose size could be read; so nothing else is made of its lengths."""
    (tmp_path / "in.wkt").write_text("POLYGON ((0 0, 9 0, 0 9, 0 0))\n")
    for command in ("skeleton-exact --gap", "skeleton-exact --flatten", "voronoi --flatten", "voronoi --simplify"):
        name, option = command.split()
        done = run(name, "in.wkt", option, "1um", "--pixel-size", "auto", "-o", "o.wkt")
        assert done.code == 2
        assert "--pixel-size auto" in done.err
    done = run("alphashape", "in.ome.tif", "-r", "0um", "--pixel-size", "auto", "-o", "o.csv")
    assert done.code == 2
