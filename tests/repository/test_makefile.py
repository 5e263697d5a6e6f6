"""What `make` does with the sources of the core, in whatever folder they are: all are built, all are formatted."""

from pathlib import Path

from support.processes.ended import ENVIRONMENT, ended

ROOT = Path(__file__).parents[2]
SOURCES = {str(path.relative_to(ROOT)) for path in (ROOT / "src").rglob("*.[ch]pp")}


def make(*arguments):
    return ended("make", "--dry-run", *arguments, cwd=ROOT, env=ENVIRONMENT, check=True).stdout


def test_every_source_is_checked_by_clang_format():
    [check] = [line for line in make("lint").splitlines() if "clang-format" in line]
    tests = {str(path.relative_to(ROOT)) for path in (ROOT / "tests").rglob("*.[ch]pp")}
    assert {word for word in check.split() if word.endswith((".cpp", ".hpp"))} == SOURCES | tests


def test_the_build_depends_on_every_source():
    [rule] = [line for line in make("--print-data-base", "help").splitlines() if line.startswith("build/.installed:")]
    assert set(rule.split()) >= SOURCES
