"""Shells complete commands, options, their values, and files of the kinds that are read."""

import shutil
import sys
from pathlib import Path

import pytest

from support.few import few
from support.processes.ended import ended

ENVIRONMENT = {"PATH": f"{Path(sys.executable).parent}:/usr/local/bin:/usr/bin:/bin", "LC_ALL": "C"}
needs_bash = pytest.mark.skipif(shutil.which("bash") is None, reason="bash is not there")

BASH = """
source ./script
complete -p vorotool > /dev/null || exit 1
while IFS= read -r line; do
    IFS=' ' read -r -a COMP_WORDS <<< "$line"
    [[ $line == *' ' ]] && COMP_WORDS+=('')
    COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
    _vorotool_completion vorotool 2> /dev/null
    echo "${COMPREPLY[*]}"
done
"""
"""Words are apart as readline has them: at blanks and around =. Without readline there is no compopt."""

LINES = {
    "vorotool sk": "skeleton-approx skeleton-exact",
    "vorotool tessellate --what labels,ta": "labels,table",
    "vorotool tessellate --what = dist": "distance distance2",
    "vorotool delaunay --what = cells -f ": "geojson csv tsv json npz wkt jsonl gpkg fgb shp parquet dxf svg png html",
    "vorotool skeleton-exact --prune = angle = 30 --sid": "--side",
    "vorotool skeleton-exact --prune s": "scale=",
    "vorotool skeleton-exact ": "more dots.csv a.json b.PNG",
    "vorotool delaunay --out-dir ": "more",
    "vorotool delaunay --overlay = more/x": "more/x y.png",
    "vorotool tessellate --what table -f ": "csv tsv json npz jsonl gpkg parquet",
    "vorotool tessellate --clu": "--cluster",
    "vorotool alphashape ": "more dots.csv a.json b.PNG",
    "vorotool draw more/": "more/x y.png",
    "vorotool delaunay dots.csv -o ": "more dots.csv a.json b.PNG",
    "vorotool completion f": "fish",
}


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "more").mkdir()
    for name in ("dots.csv", "a.json", "b.PNG", "notes.txt.bak", "more/x y.png", "more/z.doc"):
        (tmp_path / name).touch()
    return tmp_path


@pytest.fixture
def script(run):
    """Give the path of the script for a shell."""

    def write(shell):
        done = run(f"completion {shell}")
        assert done.err == ""
        Path("script").write_text(done.out)
        return "./script"

    return write


@needs_bash
@pytest.mark.parametrize("lines", few([list(LINES)[:9], list(LINES)[9:]], 1))
def test_bash(folder, script, lines):
    script("bash")
    done = ended("bash", "--norc", "-c", BASH, cwd=folder, env=ENVIRONMENT, input="\n".join(lines) + "\n", check=True)
    assert done.stdout.splitlines() == [LINES[line] for line in lines]


def test_fish(folder, script):
    if shutil.which("fish") is None:
        pytest.skip("fish is not there")
    script("fish")
    lines = ("vorotool sk", "vorotool tessellate --what=labels,ta", "vorotool alphashape ", "vorotool draw more/")
    text = "source ./script; " + "; ".join(f"complete -C {line!r}" for line in lines)
    done = ended("fish", "--no-config", "-c", text, cwd=folder, env={**ENVIRONMENT, "HOME": folder}, check=True)
    words = [line.partition("\t")[0] for line in done.stdout.splitlines()]
    assert words == [
        *("skeleton-approx", "skeleton-exact", "--what=labels,table"),
        *("a.json", "b.PNG", "dots.csv", "more/", "more/x y.png"),
    ]


def test_zsh_reads_the_script(script):
    if shutil.which("zsh") is None:
        pytest.skip("zsh is not there")
    ended("zsh", "-n", script("zsh"), check=True)
