"""A Dask cluster does what one machine does."""

import json
import signal
import socket
import subprocess
import sys
from contextlib import suppress

import numpy as np
import pytest

from support.families.mask_folders import write_many_points
from support.processes.leftovers import contents, wait_until


@pytest.fixture
def many(tmp_path):
    """A folder of inputs that take some milliseconds each."""
    write_many_points(tmp_path, 40)
    (tmp_path / "many/p013.csv").write_text("x,y\n1,nan\n")
    return tmp_path


@pytest.fixture
def cluster(tmp_path):
    """A scheduler and two workers, in another folder."""
    (tmp_path / "elsewhere").mkdir()
    options = {"cwd": tmp_path / "elsewhere", "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    common = ["--scheduler-file", tmp_path / "scheduler.json", "--no-dashboard", "--host", "127.0.0.1"]
    commands = [
        ["distributed.cli.dask_scheduler", "--port", "0"],
        *2 * [["distributed.cli.dask_worker", "--no-nanny", "--nthreads", "1"]],
    ]
    started = [subprocess.Popen([sys.executable, "-m", *command, *common], **options) for command in commands]
    try:
        wait_until(lambda: address_in(tmp_path / "scheduler.json"))
        yield address_in(tmp_path / "scheduler.json"), started[1:]
    finally:
        for each in started:
            each.kill()
            each.wait()


def address_in(path):
    try:
        return json.loads(path.read_text())["address"]
    except (OSError, ValueError):  # it is not there, or not all of it
        return None


def done(manifest):
    records = [json.loads(line) for line in manifest.read_text().splitlines()] if manifest.exists() else []
    return [record["input"] for record in records if record.get("status") == "done"]


@pytest.mark.slow
def test_a_lost_worker_loses_nothing(run, process, many, cluster):
    address, workers = cluster
    options = ("tessellate", "many", "--keep-going", "-q", "--what", "table", "--out-dir")
    run(*options, "here", "--table", "here.csv", code=6)
    child = process(*options, "there", "--table", "there.csv", "--cluster", address)
    manifest = many / "there/tessellate.manifest.jsonl"
    wait_until(lambda: len(done(manifest)) >= 10, child)
    workers[0].kill()
    out, err = child.communicate(timeout=600)
    assert (child.returncode, out) == (6, b""), err
    assert [line.split(b": ")[0] for line in err.splitlines()] == [b"error", b"error"]
    assert b"p013.csv, line 2" in err
    assert contents(many / "there", "*.csv") == contents(many / "here", "*.csv")
    assert (many / "there.csv").read_bytes() == (many / "here.csv").read_bytes()
    assert sorted(done(manifest)) == [f"many/p{number:03}.csv" for number in range(40) if number != 13]
    assert list((many / "there").rglob(".vorotool-*")) == []


@pytest.fixture
def usual_port():
    """The port that a scheduler usually shows itself on is taken, by us or by somebody else."""
    with socket.socket() as taken:
        with suppress(OSError):
            taken.bind(("127.0.0.1", 8787))
            taken.listen()
        yield


@pytest.mark.usefixtures("usual_port")
def test_a_cluster_that_is_started_here(run, many):
    options = ("tessellate", "many", "--keep-going", "-q", "-f", "npy", "--out-dir")
    run(*options, "there", "--cluster", "local", "-j", "1", code=6)
    run(*options, "there", "--resume", "--stats", "s.json", code=6)
    stats = json.loads((many / "s.json").read_text())
    assert (stats["done"], stats["kept"], stats["failed"]) == (0, 39, 1)


def test_what_a_cluster_needs(run, many, monkeypatch):
    monkeypatch.setattr("vorotool.batch.cluster.PATIENCE", 0.2)
    run("tessellate many --out-dir out --cluster tcp://127.0.0.1:1", code=2, says="--cluster tcp://127.0.0.1:1")
    monkeypatch.setitem(sys.modules, "distributed", None)
    run("tessellate many --out-dir out --cluster local", code=2, says="pip install 'vorotool[distributed]'")


@pytest.mark.parametrize(
    ("address", "words"),
    [
        ("", "missing port number"),
        ("host:port", "'port'"),
        (":8786", "HOST must not be empty"),
        ("host:99999", "PORT from 1 to 65535"),
        ("http://127.0.0.1:8787", "'http'"),
        ("inproc://1/2", "inproc"),
        ("tls://127.0.0.1:8786", "needs certificates"),
    ],
)
def test_what_is_no_address_is_refused_at_once(run, many, address, words):
    failed = run("tessellate many --out-dir out --cluster", address, code=2, says=words)
    assert failed.err.startswith("error: --cluster ")
    assert len(failed.err.splitlines()) == 1


# ---- the bands of one image ------------------------------------------------------------------------------------


@pytest.fixture
def dots(tmp_path):
    xy = np.random.default_rng(9).integers(-100, 3100, (4000, 2)) / 2
    np.savetxt(tmp_path / "dots.csv", xy, delimiter=",", header="x,y", comments="")
    return tmp_path


@pytest.mark.slow
def test_a_lost_worker_leaves_the_same_store(run, process, dots, cluster):
    address, workers = cluster
    options = ("tessellate", "dots.csv", "--size", "600x600", "--chunk", "512x8", "-q")
    run(*options, "-o", "here.zarr")
    child = process(*options, "-o", "there.zarr", "--cluster", address, "--stats", "s.json")
    wait_until(lambda: len(list(dots.glob(".vorotool-*.tmp/c/*"))) >= 10, child)
    workers[0].kill()
    out, err = child.communicate(timeout=600)
    assert (child.returncode, out, err) == (0, b"", b"")
    assert contents(dots / "there.zarr") == contents(dots / "here.zarr")
    assert not list(dots.glob(".*"))


@pytest.mark.slow
def test_what_bands_give_and_a_failing_cluster(run, dots, cluster, monkeypatch):
    import zarr

    address, workers = cluster
    monkeypatch.setattr("vorotool.engines.tessellation.streamed_image.BAND_PIXELS", 37 * 200)
    mask = (np.random.default_rng(3).random((150, 200)) < 0.02).astype(np.uint8)
    zarr.create_array(dots / "seeds.zarr", data=mask, chunks=(64, 64))
    options = ("dots.csv", "--size", "300x200", "--chunk", "100x64", "-q", "--what")
    for name, command in {
        "tiles of seeds": ("tessellate", "seeds.zarr", "--chunk", "64x50", "-q"),
        "distance": ("tessellate", *options, "distance"),
        "distance2": ("tessellate", *options, "distance2"),
    }.items():
        run(*command, "-o", f"here {name}.zarr")
        run(*command, "-o", f"there {name}.zarr", "--cluster", address)
        assert contents(dots / f"there {name}.zarr") == contents(dots / f"here {name}.zarr"), name
    for worker in workers:
        worker.kill()
        worker.wait()
    monkeypatch.setattr("vorotool.batch.cluster.FIRST_WORKER", 0.2)
    wait_until(
        lambda: (
            "the cluster has no workers"
            in run(*command, "-o", f"there {name}.zarr", "--cluster", address, code=None).err
        )
    )
    assert contents(dots / f"there {name}.zarr") == contents(dots / f"here {name}.zarr")
    assert not list(dots.glob(".*"))


@pytest.mark.slow
def test_an_interrupt_ends_the_cluster_that_was_started(process, dots):
    options = ("--size", "20000x20000", "--chunk", "512x16", "-q", "--cluster", "local", "-j", "1")
    child = process("tessellate", "dots.csv", "-o", "a.zarr", *options)
    wait_until(lambda: len(list(dots.glob(".vorotool-*.tmp/c/*"))) >= 5, child)
    child.send_signal(signal.SIGINT)
    out, err = child.communicate(timeout=600)
    assert (child.returncode, out, err) == (130, b"", b"")
    assert [path.name for path in dots.iterdir()] == ["dots.csv"]
