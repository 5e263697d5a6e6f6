"""Public names have types that mypy sees: what is right passes, and each misuse in `typed_uses.py` is an error."""

import os
import subprocess
import sys
import typing
from pathlib import Path

import pytest

import vorotool.typing
from support.documents import ROOT


@pytest.mark.slow
def test_uses_pass_and_misuses_are_errors(tmp_path):
    wrong = tmp_path / "wrong.py"
    wrong.write_text("import vorotool\n\nvorotool.delaunay([[0, 1]])  # type: ignore[call-arg]\n", encoding="utf-8")
    uses = Path(__file__).parent / "typed_uses.py"
    options = ["--strict", "--warn-unused-ignores", "--no-error-summary", "--cache-dir", ROOT / "build/mypy-of-users"]
    run = subprocess.run(
        [sys.executable, "-m", "mypy", "--config-file=", *options, uses, wrong],
        env={**os.environ, "MYPYPATH": str(ROOT / "src")},
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    ours = [line for line in run.stdout.splitlines() if line.startswith((str(uses), "wrong.py"))]
    assert run.stderr == ""
    assert [line.startswith("wrong.py:3: ") and "unused-ignore" in line for line in ours] == [True], run.stdout


def test_aliases_are_types_at_run_time():
    names = [name for name in vars(vorotool.typing) if name.endswith(("Like", "Kind", "Choice"))]
    assert names
    for each in map(vars(vorotool.typing).get, names):
        assert isinstance(each, type) or typing.get_origin(each) is not None or typing.get_args(each)
