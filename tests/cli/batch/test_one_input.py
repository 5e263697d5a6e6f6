"""Options of many inputs with one input: each does what it can."""

import json

import imageio.v3 as imageio
import numpy as np
import pandas
import pytest
import tifffile

from support.documents import DATA
from vorotool.cli.run import progress_bar
from vorotool.jobs.run_log import Run

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


# ---- one table of many inputs ----------------------------------------
FIELDS = r"(?P<plate>P\d)/(?P<well>[A-H]\d\d)_(?P<label>\d+)"
PLACES = {"P1/A01_1": [(2, 2), (20, 30)], "P1/A02_1": [], "P2/B01_07": [(5, 5)], "P2/odd": [(5, 5), (20, 20), (30, 40)]}


@pytest.fixture
def plates(tmp_path):
    for name, places in PLACES.items():
        image = np.zeros((40, 60), np.uint8)
        for y, x in places:
            image[y : y + 6, x : x + 6] = 255
        path = tmp_path / "plates" / f"{name}.png"
        path.parent.mkdir(parents=True, exist_ok=True)
        imageio.imwrite(path, image)
    return tmp_path / "plates"


def read(path):
    if path.suffix == ".json":
        return pandas.DataFrame(json.loads(path.read_text()))
    return pandas.read_csv(path, sep="\t" if path.suffix == ".tsv" else ",", dtype=str)


@pytest.mark.parametrize(
    ("command", "what", "rows", "ending"),
    [
        ("tessellate", "neighbors", [1, 0, 0, 2], "csv"),
        ("delaunay", "statistics", [7, 7, 7, 7], "tsv"),
        ("skeleton-exact", "branches", [2, 0, 1, 3], "json"),
    ],
)
def test_rows_of_any_result_are_collected(run, plates, tmp_path, command, what, rows, ending):
    table, inputs = tmp_path / f"all.{ending}", tmp_path / f"inputs.{ending}"
    options = ("--table", table, "--table-inputs", inputs, "--fields", FIELDS, "-q")
    run(command, plates, "--what", what, *options)
    joined, found = read(table), read(inputs)
    sources = [f"{plates}/{name}.png" for name in sorted(PLACES)]
    assert found["input"].tolist() == sources
    assert list(map(int, found["count"])) == rows
    assert set(found["status"]) == {"done"}
    assert found["well"].fillna("").tolist() == ["A01", "A02", "B01", ""]
    own = next(name for name in ("voro_label", "label") if name in joined)
    counts = joined["input"].value_counts()
    assert [int(counts.get(source, 0)) for source in sources] == rows
    known = joined[joined["plate"] == "P2"]
    assert set(known[own]) <= {"07"} or ending == "json"
    assert set(joined["input"][joined["plate"].isna()]) <= {sources[-1]}


def test_results_beside_the_table(run, plates, tmp_path):
    options = ("--out-dir", tmp_path / "out", "--table", tmp_path / "all.csv", "-q")
    run(f"tessellate {plates} --what labels", *options)
    assert "area" in read(tmp_path / "all.csv")
    run(f"tessellate {plates} --what labels,neighbors", *options)
    assert "border_length" in read(tmp_path / "all.csv")
    assert (tmp_path / "out/P1/A01_1.neighbors.csv").exists()
    run(f"tessellate {plates} --what labels,neighbors", *options, "--resume", "--table-inputs", tmp_path / "i.csv")
    assert set(read(tmp_path / "i.csv")["status"]) == {"kept"}
    assert read(tmp_path / "i.csv")["count"].tolist() == ["1", "0", "0", "2"]


def test_inputs_that_fail_have_a_row(run, plates, tmp_path):
    (plates / "P1/torn.png").write_bytes((plates / "P1/A01_1.png").read_bytes()[:60])
    run(f"tessellate {plates} --table-inputs {tmp_path}/i.csv --keep-going -q", code=6)
    found = read(tmp_path / "i.csv").set_index("input").loc[f"{plates}/P1/torn.png"]
    assert found["status"] == "failed"
    assert pandas.isna(found["count"])
    assert "torn.png" in found["error"]


# ---- pages as inputs ----------------------------------------
RNG = np.random.default_rng(4)
PAGES = [((RNG.random((20, 30)) < 0.03) * 255).astype(np.uint8) for _ in range(3)]


@pytest.fixture
def stack(tmp_path):
    tifffile.imwrite(tmp_path / "stack.tif", np.array(PAGES), photometric="minisblack")
    return tmp_path


def test_outputs_are_those_of_each_page(run, stack):
    run("tessellate stack.tif --page all --out-dir out -f npy --table all.csv", says="stack.tif, page 2")
    names = sorted(path.name for path in (stack / "out").glob("*.npy"))
    assert names == [f"stack-p00{k}.npy" for k in range(3)]
    for k in range(3):
        run(f"tessellate stack.tif --page {k} -o one.npy")
        assert (stack / "one.npy").read_bytes() == (stack / f"out/stack-p00{k}.npy").read_bytes()
    rows = (stack / "all.csv").read_text().splitlines()[1:]
    assert {row.partition('",')[0] for row in rows} == {f'"stack.tif, page {k}' for k in range(3)}


def test_plans_and_what_was_done_before(run, stack):
    options = ["tessellate", "stack.tif", "--page", "all", "--out-dir", "out", "-f", "npy"]
    planned = [json.loads(line) for line in run(*options, "--dry-run").out.splitlines()]
    assert [each["input"] for each in planned] == [f"stack.tif, page {k}" for k in range(3)]
    run(*options, "-q")
    (stack / "out/stack-p001.npy").unlink()
    done = run(*options, "--resume")
    assert [line.split(": ")[1] for line in done.err.splitlines()] == ["kept", "done", "kept"]
    shards = [run(*options, "--dry-run", "--shard", f"{k}/2").out.splitlines() for k in (1, 2)]
    assert sum(map(len, shards)) == 3


@pytest.mark.usefixtures("workers")
def test_processes(run, stack):
    options = ["tessellate", "stack.tif", "--page", "all", "-f", "npy", "-q", "--out-dir"]
    run(*options, "one")
    run(*options, "two", "-j", "2")
    for path in (stack / "one").glob("*.npy"):
        assert path.read_bytes() == (stack / "two" / path.name).read_bytes()


def test_a_page_that_fails(run, stack):
    tifffile.imwrite(stack / "bad.tif", np.array([PAGES[0], np.zeros_like(PAGES[0])]), photometric="minisblack")
    run(
        "tessellate bad.tif --page all --strict --out-dir out --keep-going",
        code=6,
        says=["bad.tif, page 1", "the image has no foreground"],
    )
    (stack / "cut.tif").write_bytes((stack / "stack.tif").read_bytes()[:100])
    run("tessellate cut.tif --page all --out-dir out --keep-going", code=6, says="error: cut.tif")


@pytest.mark.slow
def test_a_cluster(run, stack):
    options = ["tessellate", "stack.tif", "--page", "all", "-f", "npy", "-q", "--out-dir"]
    run(*options, "one")
    run(*options, "two", "--cluster", "local", "-j", "1")
    for path in (stack / "one").glob("*.npy"):
        assert path.read_bytes() == (stack / "two" / path.name).read_bytes()


# ---- progress ----------------------------------------
RUNS = [
    ("tessellate", DATA / "dots.csv", "--what", "table"),
    ("delaunay", DATA / "dots.csv", "--method", "digital"),
    ("alphashape", DATA / "dots.csv"),
    ("skeleton-exact", DATA / "two-shapes.json", "--side", "both", "--what", "centerline"),
    ("skeleton-exact", DATA / "two-shapes.json", "--what", "offset", "-d", "3"),
    ("skeleton-approx", DATA / "two-shapes.json", "--step", "4"),
]


@pytest.mark.parametrize("arguments", RUNS)
def test_what_is_shown_is_called_as_phases_are(run, folder, monkeypatch, arguments):
    shown = {}
    monkeypatch.setattr(Run, "progress", lambda _, label: shown.setdefault(label, []).append)
    run(*arguments, "--verify", "--stats", "s.json", "-o", "out.csv")
    assert set(shown) <= set(json.loads((folder / "s.json").read_text())["seconds"])
    assert {"read", "verify"} < set(shown)
    assert all(0 <= fraction <= 1 for fractions in shown.values() for fraction in fractions)


def test_a_bar_shows_the_fraction_that_is_done(capfd):
    with progress_bar("sweep") as show:
        show(0.25)
        show(1)
    assert "sweep" in capfd.readouterr().err


def test_a_page_that_fails_is_named_once(run, folder):
    noise = np.random.default_rng(1).integers(0, 99, (2, 60, 100), dtype=np.uint8)
    tifffile.imwrite(folder / "pages.tif", noise, photometric="minisblack")
    made = run("tessellate pages.tif --page all --out-dir out -f npy", code=6)
    assert "error: pages.tif, page 0: the image holds" in made.err
