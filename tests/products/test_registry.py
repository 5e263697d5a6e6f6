"""What can be written: names that resolve, formats that fit, and all that is made from this one list."""

import inspect

import pytest
from click.testing import CliRunner

import vorotool
from cli_reference import reference
from support.documents import ROOT
from support.processes.ended import ended_python
from vorotool.cli.main import vorotool as vorotool_command
from vorotool.products.formats import EXTENSIONS, FORMATS, GENERAL, PICTURES, resolved
from vorotool.products.registry import PRODUCTS, all_layers, formats_of

ALL = [each for own in PRODUCTS.values() for each in own.values()]


def test_products_have_what_they_name():
    for product in ALL:
        assert set(product.types) <= set(vorotool.__all__)
        assert set(product.formats) <= set(FORMATS)
        assert len(set(product.formats)) == len(product.formats)
        assert set(product.layers) <= set(PICTURES)
        assert set(product.usual_for) <= set(product.formats)
        for layers in product.layers.values():
            assert set(product.usual_layers) <= set(layers)


def test_writers_are_there_and_take_what_they_are_given():
    writers = {writer for own in PRODUCTS.values() for each in own.values() for writer in each.own.values()}
    writers |= {writer for each in FORMATS.values() for writer in each.writers.values()}
    for writer in (*writers, GENERAL):
        assert writer.function.startswith("formats."), "what is drawn is no data"
        parameters = list(inspect.signature(resolved(writer.function)).parameters)
        assert set(writer.takes) == set(parameters[2:]) - {"by"}
    for each in FORMATS.values():
        assert bool(each.maker) == bool(each.made_from)
        if each.maker:
            assert callable(resolved(each.maker))


def test_extensions_stand_for_one_format_each():
    assert len(EXTENSIONS) == sum(len(each.extensions or (each.name,)) for each in FORMATS.values())
    assert all(ending == ending.lower() and ending.startswith(".") for ending in EXTENSIONS)


def test_the_all_layers_a_command_are_those_of_its_pictures():
    for command, own in PRODUCTS.items():
        shown = {layer for each in own.values() for layers in each.layers.values() for layer in layers}
        assert set(all_layers(command)) == shown


# ---- a format more -------------------------------------------------------------------------------
ADDED = """
import sys, types
from pathlib import Path
from vorotool.products import formats

def write(out, value):
    out.write(b"%d curves\\n" % len(value))

module = types.ModuleType("vorotool.formats.results.drawings")
module.write = write
sys.modules[module.__name__] = module
writers = {"offset": formats.Writer("formats.results.drawings:write", ())}
added = formats.Format("drawing", "Drawing", ("drw",), writers=writers)
formats.FORMATS["drawing"] = added
formats.EXTENSIONS[".drw"] = "drawing"
"""
"""What one line in the list of formats and one file do."""

READ = {
    "help": "from vorotool.cli.main import main; main(['skeleton-exact', '--help'])",
    "documents": "sys.path.append('docs/scripts'); import cli_reference; print(cli_reference.reference())",
    "refusal": "from vorotool.cli.main import main; main(['skeleton-exact', '--what', 'offset', '-f', 'obj', '-'])",
    "writing": "from vorotool.cli.main import main; "
    "main(['skeleton-exact', 'data/two-shapes.json', '--what', 'offset', '-d', '1', '-f', 'drw'])",
    "library": "import vorotool; "
    "vorotool.write(vorotool.offset([[0, 0], [4, 0], [0, 4]], 1), '/dev/stdout', fmt='drawing')",
}
EXPECTED = {
    "help": "html, drawing,",
    "documents": "| `offset` | JSON (`.json`), CSV (`.csv`), TSV (`.tsv`), GeoJSON (`.geojson`), NPZ (`.npz`), "
    "WKT (`.wkt`), JSON lines (`.jsonl`, `.ndjson`), GeoPackage (`.gpkg`), FlatGeobuf (`.fgb`), Shapefile (`.shp`), "
    "GeoParquet (`.parquet`, `.geoparquet`), DXF (`.dxf`), Drawing (`.drw`)",
    "refusal": "offset cannot be written as obj: use one of json, csv, tsv, geojson, npz, wkt, jsonl, gpkg, fgb, shp, "
    "parquet, dxf, drawing, svg, png, gif, apng, webp\n",
    "writing": " curves\n",
    "library": "1 curves\n",
}


APART = "\n---- apart ----\n"


@pytest.fixture(scope="module")
def said_with_a_format_more():
    """What one process says in each place."""
    lines = [
        f"try:\n    exec({code!r})\n"
        "except SystemExit:\n    pass\n"
        f"sys.stdout.flush(); sys.stderr.flush(); os.write(1, {APART.encode()!r})\n"
        for code in READ.values()
    ]
    done = ended_python(
        "-c", ADDED + "import os\n" + "".join(lines), cwd=ROOT, capture_output=False, stdout=-1, stderr=-2
    )
    return dict(zip(READ, done.stdout.split(APART), strict=False))


@pytest.mark.parametrize("place", READ)
def test_a_format_is_one_file_and_one_line(place, said_with_a_format_more):
    text = said_with_a_format_more[place]
    assert EXPECTED[place] in (" ".join(text.split()) if place == "help" else text)


def test_completion_offers_a_format_more():
    words = "vorotool skeleton-exact --what offset -f dr"
    asked = {"_VOROTOOL_COMPLETE": "bash_complete", "COMP_WORDS": words, "COMP_CWORD": "5"}
    code = ADDED + "from vorotool.cli.main import main; main([])"
    done = ended_python("-c", code, env=asked)
    assert done.stdout == "plain,drawing\n"


@pytest.fixture(scope="module")
def documents():
    return reference()


@pytest.mark.parametrize("command", PRODUCTS)
def test_help_and_documents_name_all_formats(command, documents):
    formats = dict.fromkeys(fmt for those in formats_of(command).values() for fmt in those)
    shown = CliRunner().invoke(vorotool_command, [command, "--help"])
    assert f"Format of the output: {', '.join(formats)};" in " ".join(shown.output.split())
    section = documents.partition(f"## vorotool {command}\n")[2].partition("\n## ")[0]
    for what, those in formats_of(command).items():
        (row,) = (line for line in section.splitlines() if line.startswith(f"| `{what}` |"))
        assert all(ending in row for fmt in those for ending in FORMATS[fmt].extensions or (fmt,))
