"""What is imported when: `--help` loads nothing heavy, a usual run nothing that only an extra brings."""

import os
from pathlib import Path

import pytest

from support.processes.ended import ended_python

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize(
    ("line", "completed"),
    [("--version", False), ("tessellate --help", False), ("vorotool skeleton-exact --prune angle=30 --what ", True)],
)
def test_neither_help_nor_completion_loads_a_heavy_module(line, completed):
    script = (
        "import sys, vorotool\n"
        "from vorotool.cli.main import main\n"
        "try:\n    main(sys.argv[1:])\n"
        "except SystemExit as end:\n"
        "    heavy = {'numpy', 'vorotool._core', 'PIL', 'skimage', 'shapely', 'orjson'} & set(sys.modules)\n"
        "    sys.exit(f'loaded {heavy}' if heavy or end.code else 0)\n"
    )
    asked = {"_VOROTOOL_COMPLETE": "bash_complete", "COMP_WORDS": line, "COMP_CWORD": str(line.count(" "))}
    words = () if completed else line.split()
    done = ended_python("-c", script, *words, env={**os.environ, **(asked if completed else {})})
    assert done.returncode == 0, done.stderr
    assert done.stdout


UNUSED = {"zarr", "numcodecs", "dask", "distributed", "networkx", "pandas", "geopandas", "pyarrow", "matplotlib"}
UNUSED |= {"imageio", "svgelements", "ezdxf"}  # which are for inputs of other kinds


@pytest.mark.parametrize(
    "arguments",
    [
        ["tessellate", "data/blobs.png", "-o", "{}.png"],
        ["delaunay", "data/dots.csv", "-o", "{}.geojson"],
        ["skeleton-exact", "data/ne_110m_lakes.geojson", "-o", "{}.svg"],
    ],
    ids=lambda arguments: arguments[0],
)
def test_a_usual_run_loads_no_extra(arguments, tmp_path):
    script = (
        "import sys\n"
        "from vorotool.cli.main import main\n"
        "try:\n    main(sys.argv[1:])\n"
        f"finally:\n    print('loaded:', *{UNUSED} & set(sys.modules), file=sys.stderr)\n"
    )
    done = ended_python("-c", script, *(word.format(tmp_path / "out") for word in arguments), "-q", cwd=ROOT)
    assert done.returncode == 0, done.stderr
    assert done.stderr.splitlines()[-1] == "loaded:"
