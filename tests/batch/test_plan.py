"""Outputs replace neither inputs nor one another, and stay in their folder."""

import os

import pytest

from support.refusals import refused
from vorotool import OutputError, UsageError
from vorotool.batch.inputs import Input
from vorotool.batch.plan import check_outputs, output_paths, share
from vorotool.batch.workers import Task


def test_names_of_outputs():
    assert output_paths("a.b.png", [".csv"], "out") == ("out/a.b.csv",)
    assert output_paths("x/plain", [".table.csv", ".labels.png"], "o/p") == (
        *("o/p/x/plain.table.csv", "o/p/x/plain.labels.png"),
    )
    assert output_paths("x/../a.png", [".csv"], "out/../o") == ("out/../o/a.csv",)


def test_two_inputs_with_one_output(tmp_path):
    tasks = [Task("x/a.png", (f"{tmp_path}/a.csv",)), Task("y/a.tif", (f"{tmp_path}/a.csv",))]
    refused(UsageError, r"x/a\.png", check_outputs, tasks, tmp_path, {}, {})
    check_outputs(tasks[:1], tmp_path, {"--stats": "-"}, {})
    refused(UsageError, r"x/a\.png", check_outputs, tasks[:1], tmp_path, {"--table": f"{tmp_path}/b/../a.csv"}, {})


def test_capitals_are_no_difference_on_macos(tmp_path, monkeypatch):
    tasks = [Task("a.png", (f"{tmp_path}/a.csv",)), Task("A.tif", (f"{tmp_path}/A.csv",))]
    check_outputs(tasks, tmp_path, {}, {})
    monkeypatch.setattr("sys.platform", "darwin")
    refused(UsageError, "both", check_outputs, tasks, tmp_path, {}, {})


@pytest.mark.parametrize("link", [os.link, os.symlink])
def test_an_output_that_is_an_input(tmp_path, link):
    (tmp_path / "a.csv").write_text("x")
    link(tmp_path / "a.csv", tmp_path / "b.csv")
    task = Task(str(tmp_path / "a.csv"), (str(tmp_path / "b.csv"),))
    refused(UsageError, r"b\.csv", check_outputs, [task], tmp_path, {}, {})
    with pytest.raises(UsageError, match=r"--stats"):
        check_outputs([Task(task.source, ())], tmp_path, {"--stats": str(tmp_path / "b.csv")}, {})


def test_outputs_stay_in_their_folder(tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "else").mkdir()
    (tmp_path / "out/sub").symlink_to(tmp_path / "else")
    (tmp_path / "out/file.csv").symlink_to(tmp_path / "else/file.csv")
    for name in ("sub/a.csv", "file.csv"):
        with pytest.raises(OutputError, match="outside"):
            check_outputs([Task("a.png", (f"{tmp_path}/out/{name}",))], tmp_path / "out", {}, {})
    check_outputs([Task("a.png", (f"{tmp_path}/out/new/a.csv",))], tmp_path / "out", {}, {})


@pytest.mark.parametrize(("count", "parts"), [(300, 7), (8, 8), (3, 5), (1, 1)])
def test_shares_are_a_partition_into_equal_parts(count, parts):
    inputs = [Input(f"masks/{number}.png", f"{number}.png") for number in range(count)]
    shares = [share(inputs, part, parts) for part in range(1, parts + 1)]
    assert sorted(each.source for part in shares for each in part) == sorted(each.source for each in inputs)
    sizes = sorted(len(part) for part in shares)
    assert sizes[-1] - sizes[0] <= 1
    moved = [Input(f"/elsewhere/{each.name}", each.name) for each in reversed(inputs)]
    for part, chosen in enumerate(shares, 1):
        assert {each.name for each in share(moved, part, parts)} == {each.name for each in chosen}
    names = sorted(each.name for each in inputs)
    assert sorted(each.name for each in shares[0]) == names[::parts]
