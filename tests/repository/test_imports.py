"""What is imported when: `--help` loads nothing heavy, a usual run nothing that only an extra brings."""

import os
from pathlib import Path

import pytest

from support.processes.ended import ended_python

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize(
    ("line", "completed"),
    [
        *((f"{name} --help", False) for name in ("", "tessellate", "delaunay", "alphashape", "draw")),
        *(("--version", False), ("vorotool skeleton-exact --prune angle=30 --what ", True), ("vorotool draw ", True)),
    ],
)
def test_neither_help_nor_completion_loads_a_heavy_module(line, completed):
    script = (
        "import sys\n"
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
    assert done.stdout if completed else "Usage" in done.stdout or "version" in done.stdout


EXTRAS = {"zarr", "numcodecs", "dask", "distributed", "networkx", "pandas", "geopandas", "pyarrow", "matplotlib"}
UNUSED = EXTRAS | {"imageio", "svgelements", "ezdxf"}  # which is for inputs of other kinds


@pytest.mark.parametrize(
    "arguments",
    [
        ["tessellate", "data/dots.csv", "-o", "{}.png"],
        ["tessellate", "data/blobs.png", "-o", "{}.npy"],
        ["delaunay", "data/dots.csv", "-o", "{}.geojson"],
        ["alphashape", "data/blobs.png", "-o", "{}.svg"],
        ["skeleton-exact", "data/ne_110m_lakes.geojson", "-o", "{}.csv"],
        ["skeleton-approx", "data/shape.json", "--step", "5", "-o", "{}.json"],
        ["draw", "data/great-lakes.geojson", "-o", "{}.png"],
    ],
    ids=lambda arguments: arguments[0] + Path(arguments[1]).suffix,
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


def test_importing_the_package_loads_no_heavy_module():
    script = "import sys, vorotool; sys.exit('numpy' in sys.modules or 'vorotool._core' in sys.modules)"
    assert ended_python("-c", script).returncode == 0
