"""The record of what was done survives kills, and is believed only where files are as it says."""

import json
import os
from types import SimpleNamespace

import pytest

from support.refusals import refused
from vorotool import OutputError
from vorotool.batch.records import Manifest, digest_of_values, read_history
from vorotool.batch.workers import Outcome, Task, carry_out, digest_of

DONE = Outcome(digest="d", outputs={"out/x/a.csv": "e"}, unit="um", warnings=("moved",))


@pytest.fixture
def manifest(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return Manifest("out", "t", "options")


def lines(manifest):
    return [json.loads(line) for line in manifest.path.read_text().splitlines()]


def test_what_was_written_is_read(manifest):
    with manifest:
        manifest.begin("run", 3)
        manifest.add(Task("a", ()), DONE)
        manifest.add(Task("b", ()), Outcome(code=3, message="bad", digest="f"))
        manifest.add(Task("c", ()), Outcome(kept=True))
        assert len(lines(manifest)) == 3  # nothing waits in a buffer
    assert lines(manifest)[1:] == [
        {"input": "a", "status": "done", "options": "options", "sha256": "d", "outputs": {"x/a.csv": "e"}}
        | {"unit": "um", "warnings": ["moved"]},
        {"input": "b", "status": "failed", "exit": 3, "error": "bad", "options": "options", "sha256": "f"},
    ]
    history = read_history([manifest.path, "missing"])
    assert manifest.done_before("a", history) == Outcome(digest="d", outputs={"out/x/a.csv": "e"}, unit="um")
    assert manifest.done_before("b", history) is None
    assert Manifest("out", "t", "others").done_before("a", history) is None


def test_the_last_line_of_an_input_counts(manifest):
    for outcomes, known in (((DONE,), True), ((Outcome(code=1),), False), ((DONE,), True)):
        with manifest:
            for outcome in outcomes:
                manifest.add(Task("a", ()), outcome)
        assert (manifest.done_before("a", read_history([manifest.path])) is not None) is known
    assert len(lines(manifest)) == 3


def test_any_torn_line_is_left_out(manifest):
    with manifest:
        manifest.begin("run", 1)
        manifest.add(Task("a", ()), DONE)
    whole = manifest.path.read_bytes()
    for size in range(len(whole) + 1):
        manifest.path.write_bytes(whole[:size])
        with manifest:
            manifest.add(Task("b", ()), DONE)
        history = read_history([manifest.path])
        assert set(history) == ({"a", "b"} if size >= len(whole) - 1 else {"b"})


def line(**members):
    """A line that says that a was done, but for some members."""
    whole = {"input": "a", "status": "done", "options": "o", "sha256": "d", "outputs": {"a.csv": "e"}, "unit": ""}
    return json.dumps(whole | members)


NONE_OF_OURS = [
    *("[]", "1", "null", "NaN", '"x"', "\xff", "\0\0\0{", "[" * 100_000, '{"input":' * 100_000, "9" * 10_000),
    *('{"input": [], "status": "done"}', '{"status": "done"}', '{"input": "a"}', "{" * 9 + "}" * 9),
    *('{"run": "*"}', '{"run": "x/../../victim/"}', '{"run": []}'),
    *(line(input=None), line(input=["a"]), line(options=1), line(sha256=None), line(unit=None)),
    *(line(outputs=["a.csv"]), line(outputs=None), line(outputs={"a.csv": 1})),
    line(outputs={"a.csv": "e", "../b.csv": "e"}),
    *(line(outputs={"/etc/passwd": "e"}), line(outputs={"sub/../../a.csv": "e"})),
]


@pytest.mark.parametrize("text", NONE_OF_OURS, ids=lambda text: ascii(text[:40]))
def test_lines_that_are_none_of_ours(tmp_path, text):
    (tmp_path / "m").write_text(f"{text}\n{line(input='b')}\n", encoding="latin-1")
    assert set(read_history([tmp_path / "m"])) == {"b"}


def test_lines_of_any_length(tmp_path, monkeypatch):
    monkeypatch.setattr("vorotool.batch.records.LONGEST_LINE", len(line()) + 2)
    for size in range(3 * len(line())):
        text = f"{'x' * size}\n{line()}\n{'x' * size}{line(input='b')}\n"
        (tmp_path / "m").write_text(text)
        assert set(read_history([tmp_path / "m"])) == ({"a", "b"} if size == 0 else {"a"})


def test_names_that_are_no_text(manifest):
    with manifest:
        manifest.add(Task("\udcff.csv", ()), DONE)
    assert "\udcff.csv" in read_history([manifest.path])


def test_a_manifest_that_cannot_be_written(tmp_path):
    (tmp_path / "file").write_text("x")
    (tmp_path / "draw.manifest.jsonl").mkdir()
    os.mkfifo(tmp_path / "info.manifest.jsonl")
    for folder in (tmp_path / "file", tmp_path):
        with pytest.raises(OutputError, match=str(folder)), Manifest(folder, "draw", "o"):
            pass
    assert read_history(tmp_path.glob("*.manifest.jsonl")) == {}


def test_a_full_disk_is_not_passed_over(manifest, monkeypatch):
    with manifest:
        full = SimpleNamespace(write=lambda line: len(line) - 3, close=manifest._file.close)
        monkeypatch.setattr(manifest, "_file", full)
        refused(OutputError, "No space left on device", manifest.add, Task("a", ()), DONE)


def test_options_have_one_digest():
    assert digest_of_values({"a": 1, "b": (2,)}) == digest_of_values({"b": [2], "a": 1})
    assert digest_of_values({"a": 1}) != digest_of_values({"a": 2})


def test_kept_only_if_all_is_as_it_was(tmp_path):
    source, output = tmp_path / "a", tmp_path / "b"
    source.write_text("in")
    output.write_text("out")
    calls = []

    def process(task):
        calls.append(task)
        output.write_text("out")
        return Outcome()

    done = Outcome(digest=digest_of(str(source)), outputs={str(output): digest_of(str(output))}, unit="mm")
    task = Task(str(source), (str(output),), done=done)
    kept = carry_out(process, task)
    assert (kept.kept, kept.unit) == (True, "mm")
    for spoil in (lambda: source.write_text("other"), lambda: output.write_text("other"), output.unlink):
        spoil()
        outcome = carry_out(process, task)
        assert not outcome.kept
        assert outcome.outputs == done.outputs
        source.write_text("in")
    assert not carry_out(process, Task(str(source), (str(output), "c"), done=done)).kept
    assert len(calls) == 4
