"""What `make` does with the sources of the core, in whatever folder they are: all are built, all are formatted."""

import os
import subprocess
from pathlib import Path

ROOT = Path(__file__).parents[2]
SOURCES = {str(path.relative_to(ROOT)) for path in (ROOT / "src").rglob("*.[ch]pp")}


def make(*arguments):
    environment = {name: value for name, value in os.environ.items() if not name.startswith("MAKE")}
    run = ["make", "--dry-run", *arguments]
    return subprocess.run(run, cwd=ROOT, env=environment, capture_output=True, text=True, check=True).stdout


def test_every_source_is_checked_by_clang_format():
    [check] = [line for line in make("lint").splitlines() if "clang-format" in line]
    tests = {str(path.relative_to(ROOT)) for path in (ROOT / "tests").rglob("*.[ch]pp")}
    assert {word for word in check.split() if word.endswith((".cpp", ".hpp"))} == SOURCES | tests


def test_the_build_depends_on_every_source():
    [rule] = [line for line in make("--print-data-base", "help").splitlines() if line.startswith("build/.installed:")]
    assert set(rule.split()) >= SOURCES
