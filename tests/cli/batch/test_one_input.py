"""Options of many inputs with one input: each does what it can."""

import json

import pytest

POINTS = "x,y\n2,1\n7,5\n1,6\n4,3\n"


@pytest.fixture
def alone(run, tmp_path):
    """What the command writes without any of the options."""
    (tmp_path / "p.csv").write_text(POINTS)
    run("tessellate p.csv -o alone.tif")
    return (tmp_path / "alone.tif").read_bytes()


@pytest.mark.parametrize("options", ["-j 0", "--keep-going", "--shard 1/3"])
def test_options_that_change_nothing(run, tmp_path, alone, options):
    done = run(f"tessellate p.csv -o l.tif {options}")
    assert (done.out, done.err) == ("", "")
    assert (tmp_path / "l.tif").read_bytes() == alone
    text = run("delaunay p.csv")
    assert run(f"delaunay p.csv {options}").out == text.out


def test_another_part_has_nothing_to_do(run, tmp_path, alone):
    run("tessellate p.csv -o l.tif --shard 2/3", says="p.csv")
    assert not (tmp_path / "l.tif").exists()


@pytest.mark.parametrize("output", [["-o", "l.tif"], ["--what", "table"], ["--out-dir", "out"]])
def test_the_plan_is_printed(run, tmp_path, alone, output):
    done = run("tessellate p.csv --dry-run", *output)
    assert done.err == ""
    path = {"-o": "l.tif", "--out-dir": "out/p.png", "--what": "-"}[output[0]]
    assert json.loads(done.out) == {"input": "p.csv", "status": "planned", "outputs": [path]}
    assert sorted(each.name for each in tmp_path.iterdir()) == ["alone.tif", "p.csv"]


@pytest.mark.parametrize("table", ["t.json", "-"])
def test_a_table_beside_another_output(run, tmp_path, alone, table):
    done = run(f"tessellate p.csv -o l.tif --table {table} --stats s.json")
    assert done.err == ""
    assert (tmp_path / "l.tif").read_bytes() == alone
    written = done.out if table == "-" else (tmp_path / table).read_text()
    only = "only.csv" if table == "-" else f"only-{table}"
    run(f"tessellate p.csv --table {only}")
    assert (tmp_path / only).read_text() == written
    assert json.loads((tmp_path / "s.json").read_text())["seeds"] == 4
    assert [each.name for each in tmp_path.iterdir() if each.name.startswith(".")] == []


@pytest.mark.parametrize("source", ["p.csv", "-"])
def test_a_cluster_beside_a_table_needs_a_store_to_write(run, tmp_path, alone, source):
    run(f"tessellate {source} -o l.tif --table t.csv --cluster local", data=POINTS.encode(), code=2, says="--cluster")
    assert not (tmp_path / "l.tif").exists()


def test_a_failure_has_the_code_that_it_has_alone(run, tmp_path):
    (tmp_path / "bad.csv").write_text("x,y\n1,nonsense\n")
    for options in ([], ["-j", "2"], ["--table", "t.csv"], ["--keep-going", "--table", "t.csv"]):
        run("tessellate bad.csv -o l.tif", *options, code=3)
    assert [each.name for each in tmp_path.iterdir()] == ["bad.csv"]


def test_a_folder_with_a_readme_and_links_is_done(run, tmp_path):
    (tmp_path / "in").mkdir()
    (tmp_path / "in/p.csv").write_text(POINTS)
    (tmp_path / "in/readme.txt").write_text("Dots.\n\nNobody knows whose.\n")
    (tmp_path / "in/back").symlink_to(".")
    for options in ([], ["--resume"], ["--follow", "--resume"]):
        done = run("delaunay in --out-dir out", *options, says=["1/1 in/p.csv", "in/readme.txt"])
        assert ("in/back" in done.err) is ("--follow" not in options)
    run("info in", says="in/readme.txt")
