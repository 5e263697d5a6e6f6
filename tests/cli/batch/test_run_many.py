"""Many inputs: each gives what it gives alone, whoever does it, and however often it is interrupted."""

import json
import os
import signal
from collections import Counter
from pathlib import Path

import pytest

from support.families.mask_folders import write_many_points
from support.few import few
from support.processes.leftovers import contents, wait_until

POINTS = "x,y,name\n{0},1,a\n7,5,b\n1,6,c\n4,{0},d\n"
SQUARES = [
    [[0, 0], [9, 0], [9, 5], [0, 5]],
    [[0, 0], [4, 0], [4, 4]],
    [[0, 0], [9, 0], [9, 9], [5, 3], [0, 9]],
]


@pytest.fixture
def inputs(tmp_path):
    """Folders of points and of shapes; some are in subfolders."""
    for number, square in enumerate(SQUARES):
        place = "sub/" if number == 1 else ""
        for folder in ("points", "shapes"):
            (tmp_path / folder / place).mkdir(parents=True, exist_ok=True)
        (tmp_path / f"points/{place}p{number}.csv").write_text(POINTS.format(number + 2))
        (tmp_path / f"shapes/{place}s{number}.json").write_text(json.dumps(square))
    return tmp_path


def files(folder):
    """Contents by paths, but those that tell how it went."""
    found = contents(folder).items()
    return {path: data for path, data in found if not path.endswith(".jsonl") and ".tables" not in path}


def records(path):
    return [json.loads(line) for line in path.read_text().splitlines()]


COMMANDS = {
    "tessellate": ["points", "--what", "labels,table,color"],
    "delaunay": ["points", "--what", "edges", "-f", "geojson"],
    "alphashape": ["points", "-f", "svg", "--what", "polygons,hull"],
    "skeleton-exact": ["shapes", "--what", "skeleton,branches"],
    "draw": ["pictures"],
}


@pytest.mark.parametrize("command", COMMANDS)
def test_each_input_gives_what_it_gives_alone(run, inputs, command):
    check_that_many_give_what_each_gives(run, inputs, command)


@pytest.mark.usefixtures("workers")
@pytest.mark.parametrize("command", few(COMMANDS, 1))
def test_workers_give_what_each_input_gives_alone(run, inputs, command):
    check_that_many_give_what_each_gives(run, inputs, command)


def check_that_many_give_what_each_gives(run, inputs, command):
    folder, *options = COMMANDS[command]
    if command == "draw":
        run("tessellate points --out-dir pictures -q -f npy")
    lines = run(command, folder, "--out-dir", "many", "-j", "2", *options).err.splitlines()
    assert sorted(line.split("/")[0] for line in lines) == ["1", "2", "3"]
    assert all(line.endswith(": done") for line in lines)
    for path in [path for path in (inputs / folder).rglob("*.*") if path.is_file() and path.suffix != ".jsonl"]:
        place = path.parent.relative_to(inputs / folder)
        run(command, path, "--out-dir", Path("alone") / place, "-q", *options)
    assert files(inputs / "many") == files(inputs / "alone")
    assert sum(record.get("status") == "done" for record in records(inputs / f"many/{command}.manifest.jsonl")) == 3


@pytest.mark.slow
def test_a_table_after_resuming(run, inputs):
    rows = run("delaunay points --table - -f json -q").out
    bad = inputs / "points/p2.csv"
    good = bad.read_text()
    bad.write_text("x,y\n1,nan\n")
    options = ("delaunay", "points", "--table", "all.json", "--out-dir", "out", "-q")
    run(*options, code=6)
    assert not (inputs / "all.json").exists()  # an input was not started, as one failed
    run(*options, "--resume", "--keep-going", code=6)
    assert [row["input"] for row in json.loads((inputs / "all.json").read_text())] == [
        *4 * ["points/p0.csv"], *4 * ["points/sub/p1.csv"]
    ]  # fmt: skip
    bad.write_text(good)
    done = run(*options[:-1], "--resume")
    assert sorted(line.split(": ")[1] for line in done.err.splitlines()) == ["done", "kept", "kept"]
    assert (inputs / "all.json").read_text() == rows
    (inputs / "all.json").unlink()
    run(*options, "--resume")
    assert (inputs / "all.json").read_text() == rows
    statuses = Counter(
        (record["input"], record["status"])
        for record in records(inputs / "out/delaunay.manifest.jsonl")
        if "input" in record
    )
    assert statuses == {
        ("points/p0.csv", "done"): 1, ("points/sub/p1.csv", "done"): 1,
        ("points/p2.csv", "failed"): 2, ("points/p2.csv", "done"): 1,
    }  # fmt: skip


@pytest.mark.slow
def test_what_was_done_by_other_options_is_done_again(run, inputs):
    options = ("alphashape", "points", "--out-dir", "out", "--resume")
    for more, status in (([], "done"), ([], "kept"), (["-r", "2"], "done"), (["-r", "2", "--threads", "1"], "kept")):
        done = run(*options, *more)
        assert {line.split(": ")[1] for line in done.err.splitlines() if "r =" not in line} == {status}
    (inputs / "out/p0.csv").write_text("changed")
    plan = [json.loads(line) for line in run(*options, "-r", "2", "--dry-run").out.splitlines()]
    assert [record["status"] for record in plan] == ["planned", "kept", "kept"]


@pytest.mark.usefixtures("workers")
def test_failures_are_told(run, inputs):
    (inputs / "points/p1.csv").write_text("x,y\n1,2\n3,abc\n")
    done = run("tessellate points --out-dir out --stats s.json --keep-going", code=6, says="points/p1.csv, line 3")
    assert done.err.splitlines()[-1] == "error: 1 of 4 inputs failed"
    assert len(files(inputs / "out")) == 3
    failures = json.loads((inputs / "s.json").read_text())["failures"]
    assert [(failure["input"], failure["exit"]) for failure in failures] == [("points/p1.csv", 3)]
    assert [record["input"] for record in records(inputs / "out/tessellate.manifest.jsonl") if "error" in record] == [
        "points/p1.csv"
    ]
    run("tessellate points --out-dir other -q", code=6, says="--keep-going")
    assert set(files(inputs / "other")) == {"p0.png"}
    done = run("tessellate points/p0.csv missing.csv --seeds labels --out-dir out --keep-going -q", code=6)
    assert [line.split(": ")[1] for line in done.err.splitlines()] == [
        *("points/p0.csv", "missing.csv", "2 of 2 inputs failed")
    ]


def test_shards_have_tables_and_statistics_of_their_own(run, inputs):
    shared = ("delaunay", "points", "--table", "all.csv", "--stats", "stats.json")
    for part in (1, 2):
        told = [f"all.{part}-of-2.csv", f"stats.{part}-of-2.json"]
        run(*shared, "--out-dir", "parts", "--shard", f"{part}/2", says=told)
    assert not (inputs / "all.csv").exists()
    tables = [(inputs / f"all.{part}-of-2.csv").read_text().splitlines() for part in (1, 2)]
    counts = [json.loads((inputs / f"stats.{part}-of-2.json").read_text())["inputs"] for part in (1, 2)]
    assert sum(counts) == len({row.split(",")[0] for table in tables for row in table[1:]})
    run(*shared, "--out-dir", "parts", "--resume", "-q")  # the whole, of the tables that are kept
    whole = (inputs / "all.csv").read_text().splitlines()
    assert sorted(whole) == sorted([*tables[0], *tables[1][1:]])
    assert run("delaunay points --table - --shard 1/2 -q").out.splitlines() == tables[0]
    run("delaunay points --table part.1-of-2.csv --shard 1/2 -q")
    assert (inputs / "part.1-of-2.csv").read_text().splitlines() == tables[0]


def test_no_clobber_lets_a_resumed_batch_write_its_table_and_statistics_anew(run, inputs):
    options = ("delaunay", "points", "--out-dir", "out", "--table", "t.csv", "--table-inputs", "i.csv", "--stats", "s")
    for more in ((), ("--resume",)):
        run(*options, "--no-clobber", "-q", *more)
    assert json.loads((inputs / "s").read_text())["kept"] == 3
    run(*options, "--no-clobber", "-q", code=4)


def test_limits_change_nothing_that_was_done(run, inputs):
    options = ("tessellate", "points", "--out-dir", "out", "--resume", "--keep-going")
    with (inputs / "points/p2.csv").open("a") as file:
        file.write("8,8,e\n")
    run(*options, "--max-sites", "4", code=6)
    done = run(*options, "--max-sites", "5", "--max-pixels", "1000")
    assert [line.split(": ")[1] for line in done.err.splitlines()] == ["kept", "done", "kept"]


def test_what_another_version_did_is_done_again(run, inputs, monkeypatch):
    options = ("delaunay", "points", "--out-dir", "out", "--resume")
    for version in ("0.1.0", "0.2.0"):
        monkeypatch.setattr("vorotool.batch.plan.__version__", version)
        assert {line.split(": ")[1] for line in run(*options).err.splitlines()} == {"done"}


def test_a_terminal_shows_a_bar(inputs):
    import pty
    import subprocess
    import sys

    (inputs / "points/p1.csv").write_text("x,y\n1,nan\n")
    master, slave = pty.openpty()
    command = ["tessellate", "points", "--out-dir", "out", "--keep-going"]
    with subprocess.Popen([sys.executable, "-m", "vorotool", *command], cwd=inputs, stderr=slave) as child:
        os.close(slave)
        shown = b""
        try:
            while piece := os.read(master, 4096):
                shown += piece
        except OSError:  # the other end is closed
            pass
    os.close(master)
    assert child.returncode == 6
    assert b"100%" in shown
    assert b"\x1b[Kerror: points/p1.csv" in shown


# ---- interrupts ------------------------------------------------------------------------------------------------
def lines_of(path):
    return path.read_bytes().count(b"\n") if path.exists() else 0


def children(pid):
    return [int(each) for each in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="looks for processes in /proc")
def test_an_interrupt_leaves_nothing_half_done(process, tmp_path):
    write_many_points(tmp_path, 2, seeds=20_000)
    options = ("--size", "60000x60000", "-f", "npy", "--out-dir", "out", "-j", "2", "-q")
    child = process("tessellate", "many", *options)
    wait_until(lambda: len(list(tmp_path.glob("out/.*.tmp"))) == 2, child)
    workers = children(child.pid)
    assert len(workers) == 2
    child.send_signal(signal.SIGINT)
    assert child.communicate(timeout=600) == (b"", b"")
    assert child.returncode == 130
    assert not any(Path(f"/proc/{pid}").exists() for pid in workers)
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["tessellate.manifest.jsonl"]


@pytest.mark.slow
def test_killed_and_resumed(process, tmp_path):
    write_many_points(tmp_path, 40)
    options = ("delaunay", "many", "-q", "-j", "2", "--table", "all.csv", "--out-dir")
    assert process(*options, "whole").communicate() == (b"", b"")
    whole = files(tmp_path / "whole") | {"all.csv": (tmp_path / "all.csv").read_bytes()}
    (tmp_path / "all.csv").unlink()
    manifest = tmp_path / "out/delaunay.manifest.jsonl"
    for kill in range(2):
        child = process(*options, "out", "--resume")
        wait_until(lambda kill=kill: lines_of(manifest) >= 14 * kill + 7, child)
        child.kill()
        child.communicate()
    assert process(*options, "out", "--resume").communicate() == (b"", b"")
    assert files(tmp_path / "out") | {"all.csv": (tmp_path / "all.csv").read_bytes()} == whole
    done = Counter(record["input"] for record in records(manifest) if record.get("status") == "done")
    assert len(done) == 40
    assert set(done.values()) == {1}


def test_a_run_beside_a_running_one_leaves_its_temporaries(run, process, tmp_path):
    write_many_points(tmp_path, 2)
    (tmp_path / "out").mkdir()
    os.mkfifo(tmp_path / "out/p000.table.csv")  # nobody reads it: the run waits there with its labels half done
    options = ("--size", "60x60", "--what", "labels,table", "--out-dir", "out", "-q")
    child = process("tessellate", "many/p000.csv", *options, "-j", "1")
    wait_until(lambda: list(tmp_path.glob("out/.*.tmp")), child)
    assert child.poll() is None
    begun = list(tmp_path.glob("out/.*.tmp"))
    run("tessellate many --what table --out-dir out -q --resume")
    left = list(tmp_path.glob("out/.*.tmp"))
    child.kill()
    child.communicate()
    assert (len(begun), left) == (1, begun)


@pytest.mark.slow
def test_two_shards_that_are_started_together_lose_nothing(process, tmp_path):
    write_many_points(tmp_path, 12)
    options = ("delaunay", "many", "-q", "-j", "2", "--out-dir")
    assert process(*options, "whole").communicate() == (b"", b"")
    for _ in range(3):
        children = [process(*options, "parts", "--resume", "--shard", f"{part}/2") for part in (1, 2)]
        assert [child.communicate() for child in children] == 2 * [(b"", b"")]
        assert [child.returncode for child in children] == [0, 0]
        assert files(tmp_path / "parts") == files(tmp_path / "whole")
        for path in (tmp_path / "parts").glob("*.csv"):
            path.unlink()


def test_what_a_killed_run_of_one_input_has_left_is_removed_by_the_next(run, process, tmp_path):
    write_many_points(tmp_path, 1, seeds=20_000)
    (tmp_path / "a.csv").write_text("old")
    child = process("tessellate", "many/p000.csv", "--size", "60000x60000", "-o", "a.npy", "-q")
    wait_until(lambda: list(tmp_path.glob(".*.tmp")), child)
    child.kill()
    child.communicate()
    assert child.returncode == -signal.SIGKILL
    assert len(list(tmp_path.glob(".*.tmp"))) == 1
    run("delaunay many/p000.csv -o a.csv -q")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.csv", "many"]


@pytest.mark.parametrize(
    "lines",
    ['{"run": "*"}', '{"run": "x/../../victim/"}', "[" * 100_000, "\0\xff\n{}", '{"run": "' + "x" * 10**6],
    ids=["pattern", "path", "deep", "bytes", "long"],  # pytest puts the name of a test into the environment
)
def test_a_manifest_that_somebody_else_wrote(run, inputs, lines):
    victims = [inputs / "victim/-important.tmp", inputs / f"out/.vorotool-0a1b2c3d-1-{16 * 'a'}.tmp"]
    for path in (*victims, inputs / "out/.vorotool-x/-y.tmp"):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("x")
    (inputs / "out/delaunay.manifest.jsonl").write_text(f"{lines}\n", encoding="latin-1")
    assert run("delaunay points --out-dir out --resume -q").err == ""
    assert all(path.exists() for path in victims)


@pytest.mark.parametrize("name", ["tessellate.manifest.jsonl", ".tessellate.tables"])
def test_records_that_links_lead_elsewhere(run, inputs, name):
    (inputs / "out").mkdir()
    (inputs / "elsewhere").mkdir()
    (inputs / "victim").write_text("x")
    (inputs / "out" / name).symlink_to(inputs / ("victim" if name.endswith("l") else "elsewhere"))
    run("tessellate points --out-dir out --table all.csv -q --resume", code=4, says="through a link: remove the link")
    assert (inputs / "victim").read_text() == "x"
    assert [*(inputs / "elsewhere").iterdir(), *inputs.glob("all.csv"), *inputs.glob("out/*.png")] == []


def test_a_geodatabase_is_not_searched(run, tmp_path):
    (tmp_path / "towns.gdb").mkdir()
    done = run("voronoi towns.gdb --out-dir out", code=3)
    assert done.err.endswith("convert it: ogr2ogr towns.gpkg towns.gdb\n")
