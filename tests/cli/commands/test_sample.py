"""``vorotool sample``: the files of the package, byte by byte, and what is said where there is none."""

from pathlib import Path

import pytest

from vorotool.formats import read
from vorotool.products.samples import SAMPLES

ROOT = Path(__file__).parents[3]


def test_the_list_has_all_files_and_what_is_in_them(run):
    lines = run("sample").out.splitlines()
    assert [line.split()[0] for line in lines] == list(SAMPLES)
    assert all(text in line for line, text in zip(lines, SAMPLES.values(), strict=True))


def test_the_package_has_each_file_and_no_other():
    assert {path.name for path in (ROOT / "src/vorotool/samples").iterdir()} == set(SAMPLES)


@pytest.mark.parametrize("name", SAMPLES)
def test_what_is_written_is_the_file_of_the_repository(run, tmp_path, name):
    done = run("sample", name, "-o", "out" + Path(name).suffix)
    assert (done.code, done.out, done.err) == (0, "", "")
    made = (tmp_path / f"out{Path(name).suffix}").read_bytes()
    assert made == (ROOT / "data" / name).read_bytes(), f"copy data/{name} to src/vorotool/samples"
    assert len(read(tmp_path / f"out{Path(name).suffix}").shape if name.endswith("png") else made) > 0


def test_text_goes_to_standard_output(run):
    assert run("sample", "six-seeds.csv").out == (ROOT / "data/six-seeds.csv").read_text(encoding="utf-8")


def test_what_is_binary_goes_through_pipes_where_it_is_said(process):
    done = process("sample", "cells.png", "-o", "-")
    out, err = done.communicate()
    assert (done.returncode, out, err) == (0, (ROOT / "data/cells.png").read_bytes(), b"")


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        ("cells.png", 2, "error: cells.png is binary: say where it goes with -o cells.png"),
        ("dots", 2, "error: there is no sample 'dots': did you mean dots.csv?"),
        ("Cells.PNG", 2, "error: there is no sample 'Cells.PNG': did you mean cells.png or blobs.png?"),
        ("../dots.csv/..", 2, "error: there is no sample '../dots.csv/..': did you mean dots.csv?"),
        ("qqqq", 2, "error: there is no sample 'qqqq': use one of dots.csv, six-seeds.csv, "),
        ("-o dots.csv", 2, "error: -o dots.csv needs the name of a sample: use one of dots.csv, "),
        ("dots.csv -o no/such/folder.csv", 4, "error: no/such/folder.csv cannot be written"),
    ],
)
def test_what_cannot_be_written(run, words, code, said):
    done = run("sample", *words.split())
    assert (done.code, done.out) == (code, "")
    assert done.err.startswith(said)


def test_completion_offers_the_names(process):
    import os

    asked = {"_VOROTOOL_COMPLETE": "bash_complete", "COMP_WORDS": "vorotool sample s", "COMP_CWORD": "2"}
    done = process(env={**os.environ, **asked})
    assert done.communicate()[0].decode().split() == ["plain,six-seeds.csv", "plain,shape.json", "plain,segments.wkt"]
