"""``--page all``: each page of a stack or an animation is an input of a batch."""

import json

import numpy as np
import pytest
import tifffile

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
    pytest.importorskip("distributed")
    options = ["tessellate", "stack.tif", "--page", "all", "-f", "npy", "-q", "--out-dir"]
    run(*options, "one")
    run(*options, "two", "--cluster", "local", "-j", "1")
    for path in (stack / "one").glob("*.npy"):
        assert path.read_bytes() == (stack / "two" / path.name).read_bytes()
