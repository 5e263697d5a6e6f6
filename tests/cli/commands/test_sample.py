"""``vorotool sample``: the files of the package, byte by byte, and what is said where there is none."""

from pathlib import Path

import pytest

from support.documents import ROOT
from support.refusals import refused
from vorotool import UsageError
from vorotool.formats import read, sample
from vorotool.products.samples import SAMPLES


def test_the_list_has_all_files_and_what_is_in_them(run):
    lines = run("sample").out.splitlines()
    assert [line.split()[0] for line in lines] == list(SAMPLES)
    assert all(text in line for line, text in zip(lines, SAMPLES.values(), strict=True))


def test_the_package_has_each_file_and_no_other():
    assert {path.name for path in (ROOT / "src/vorotool/samples").iterdir()} == set(SAMPLES)


@pytest.mark.parametrize("name", SAMPLES)
def test_what_is_written_is_the_file_of_the_repository(run, tmp_path, name):
    for given in (Path(name).stem, name):  # the name without its extension is enough
        done = run(f"sample {given} -o", "out" + Path(name).suffix)
        assert (done.out, done.err) == ("", "")
    assert sample(Path(name).stem) == sample(name)
    made = (tmp_path / f"out{Path(name).suffix}").read_bytes()
    assert made == (ROOT / "data" / name).read_bytes(), f"copy data/{name} to src/vorotool/samples"
    assert len(read(tmp_path / f"out{Path(name).suffix}").shape if name.endswith("png") else made) > 0


@pytest.mark.parametrize(
    ("words", "code", "named"),
    [
        ("cells.png", 2, ["cells.png", "-o"]),
        ("blobs", 2, ["-o blobs.png"]),
        ("../dots.csv/..", 2, ["'../dots.csv/..'", "dots.csv"]),
        ("qqqq", 2, ["'qqqq'", *SAMPLES]),
        ("-o dots.csv", 2, ["-o dots.csv", "--all"]),
        ("dots.csv --all", 2, ["dots.csv", "--all"]),
        ("--all -o -", 2, ["--all", "-o"]),
        ("dots.csv -o no/such/folder.csv", 4, ["no/such/folder.csv"]),
    ],
)
def test_what_cannot_be_written(run, words, code, named):
    done = run(f"sample {words}", code=code)
    assert all(text in done.err for text in named), done.err


# ---- names without extensions, all samples -------------------------------------------------------


def test_the_library_refuses_other_names():
    for name in ("", "dot", "DOTS", "nuclei.ome.", "samples/dots.csv"):
        refused(UsageError, "sample", sample, name)


@pytest.mark.parametrize("folder", [None, "new/folder"])
def test_all_samples_are_written_at_once_and_again(run, tmp_path, folder):
    words = ["sample", "--all", *(["-o", folder] if folder else [])]
    for _ in range(2):
        done = run(*words)
        assert (done.out, done.err) == ("", "")
        written = {path.name: path.read_bytes() for path in (tmp_path / (folder or ".")).iterdir() if path.is_file()}
        assert written == {name: sample(name).read_bytes() for name in SAMPLES}
    (tmp_path / (folder or ".") / "logo.svg").unlink()
    run(*words)
    assert (tmp_path / (folder or ".") / "logo.svg").read_bytes() == sample("logo").read_bytes()


def occupy(path, kind):
    """Put something other than a sample in its place."""
    if kind == "folder":
        path.mkdir()
    elif kind == "link":
        path.symlink_to("nowhere")
    else:
        path.write_text("mine")


@pytest.mark.parametrize(
    ("name", "kind"), [("dots.csv", "file"), ("great-lakes.geojson", "folder"), ("dots.csv", "link")]
)
def test_all_samples_replace_nothing_that_is_there(run, tmp_path, name, kind):
    occupy(tmp_path / name, kind)
    run("sample --all", code=4, says=name)
    assert [path.name for path in tmp_path.iterdir()] == [name]
    assert kind != "file" or (tmp_path / name).read_text() == "mine"


def test_all_samples_need_a_folder(run, tmp_path):
    (tmp_path / "a").write_text("")
    run("sample --all -o a", code=4, says="'a'")
