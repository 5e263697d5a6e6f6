"""What is imported when: `--help` loads nothing heavy, a usual run nothing that only an extra brings."""

import re

from support.documents import ROOT
from support.processes.ended import ended_python


def test_neither_help_nor_completion_loads_a_heavy_module():
    """One process does all three: what any of them loads is still there."""
    completed = "vorotool skeleton-exact --prune angle=30 --what "
    asked = {"_VOROTOOL_COMPLETE": "bash_complete", "COMP_WORDS": completed, "COMP_CWORD": str(completed.count(" "))}
    script = (
        "import os, sys, vorotool\n"
        "from vorotool.cli.main import main\n"
        "for line in ('--version', 'tessellate --help', ''):\n"
        f"    os.environ.update({{}} if line else {asked})\n"
        "    try:\n        main(line.split())\n"
        "    except SystemExit as end:\n"
        "        heavy = {'numpy', 'vorotool._core', 'PIL', 'skimage', 'shapely', 'orjson'} & set(sys.modules)\n"
        "        print(f'ended: {line} {end.code} {heavy}')\n"
    )
    done = ended_python("-c", script)
    assert done.returncode == 0, done.stderr
    ends = [line for line in done.stdout.splitlines() if line.startswith("ended: ")]
    assert ends == [f"ended: {line} 0 set()" for line in ("--version", "tessellate --help", "")]
    first, second, third = re.split("^ended: .*$", done.stdout, flags=re.MULTILINE)[:3]
    assert "version" in first
    assert "Usage: " in second
    assert "plain,table" in third


UNUSED = {"zarr", "numcodecs", "dask", "distributed", "networkx", "pandas", "geopandas", "pyarrow", "pyogrio", "pyproj"}
UNUSED |= {"imageio", "svgelements", "ezdxf", "matplotlib"}  # which are for inputs of other kinds
UNUSED |= {"vorotool.batch"}  # for many inputs


USUAL = (
    "tessellate data/blobs.png -o {}/a.png",
    "delaunay data/dots.csv -o {}/a.geojson",
    "skeleton-exact data/ne_110m_lakes.geojson -o {}/a.svg",
)


def test_a_usual_run_loads_no_extra(tmp_path):
    """One process does all of them: what any of them loads is still there."""
    script = (
        "import sys\n"
        "from vorotool.cli.main import main\n"
        f"for line in {USUAL}:\n"
        "    try:\n        main([*line.format(sys.argv[1]).split(), '-q'])\n"
        "    except SystemExit as end:\n"
        f"        print(line.split()[0], end.code, *{UNUSED} & set(sys.modules))\n"
    )
    done = ended_python("-c", script, tmp_path, cwd=ROOT)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.splitlines() == [f"{line.split()[0]} 0" for line in USUAL]
