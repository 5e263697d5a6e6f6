"""How large revisions are, and how long they take: `tools/house_figures.py [--run] REVISION...`.

A row a revision, as a table in Markdown: modules, lines of code (without docstrings, comments and blank lines) and of
docstrings in src/vorotool, lines of code in tests and in C++. With --run each revision is cloned into build/house, and
timed from nothing with nothing else running: the environment, the build, the number of test cases, `make test` after
the build, and `.ci/run` in a clone of its own.
"""

from __future__ import annotations

import argparse
import ast
import io
import os
import re
import shutil
import subprocess
import sys
import time
import tokenize
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
WORK = ROOT / "build/house"
SILENT = {tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.ENDMARKER}
CPP_COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("revisions", nargs="+", metavar="REVISION")
    parser.add_argument("--run", action="store_true", help="build and test each, too: up to an hour a revision")
    chosen = parser.parse_args()
    rows = []
    for revision in chosen.revisions:
        row = {"revision": git("rev-parse", "--short", revision).strip(), **sizes(revision)}
        rows.append({**row, **times(revision)} if chosen.run else row)
    lines = [list(rows[0]), ["---"] * len(rows[0]), *([str(value) for value in row.values()] for row in rows)]
    sys.stdout.writelines(f"| {' | '.join(line)} |\n" for line in lines)


def git(*arguments: str) -> str:
    """Return what git prints."""
    return subprocess.run(["git", *arguments], cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout


def sizes(revision: str) -> dict[str, int]:
    """Count the modules and lines of a revision."""
    counts: Counter[str] = Counter(dict.fromkeys(("modules", "code", "docstrings", "tests", "C++"), 0))
    for name in git("ls-tree", "-r", "--name-only", revision, "src", "tests").splitlines():
        path = Path(name)
        if path.suffix in {".cpp", ".hpp"} and path.is_relative_to("src"):
            code = CPP_COMMENT.sub("", git("show", f"{revision}:{name}"))
            counts["C++"] += sum(not line.isspace() for line in code.splitlines(keepends=True))
        elif path.suffix == ".py":
            code, docstrings = lines_of(git("show", f"{revision}:{name}"))
            if path.is_relative_to("src"):
                counts.update({"modules": 1, "code": code, "docstrings": docstrings})
            else:
                counts["tests"] += code
    return dict(counts)


def lines_of(source: str) -> tuple[int, int]:
    """Count the lines of code of a module, and those of its docstrings."""
    within = {line for first, last in docstrings_of(ast.parse(source)) for line in range(first, last + 1)}
    code = set()
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type not in SILENT:
            code.update(range(token.start[0], token.end[0] + 1))
    return len(code - within), len(within)


def docstrings_of(tree: ast.Module) -> Iterator[tuple[int, int]]:
    """Yield the first and the last line of each docstring."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef) and ast.get_docstring(node, clean=False):
            yield node.body[0].lineno, node.body[0].end_lineno or 0


def times(revision: str) -> dict[str, str]:
    """Build and test a revision; seconds, and how many cases there are."""
    found = {}
    tree = clone(revision, "tree")
    for step in ("build/.venv", "build", "build/.tests"):
        found[f"make {step}"] = timed(tree, "make", "--silent", step)
    listed = subprocess.run(
        [tree / ".venv/bin/python", "-m", "pytest", "--collect-only", "-q"],
        cwd=tree, check=True, stdout=subprocess.PIPE, text=True,
    )  # fmt: skip
    found["cases"] = listed.stdout.split("\n")[-2].split()[0]
    found["make test"] = timed(tree, "make", "--silent", "test")
    found[".ci/run"] = timed(clone(revision, "ci"), ".ci/run")
    return found


def clone(revision: str, name: str) -> Path:
    """Clone a revision into a folder in which nothing is left of earlier runs."""
    folder = WORK / name
    shutil.rmtree(folder, ignore_errors=True)
    subprocess.run(["git", "clone", "--quiet", "--no-checkout", ROOT, folder], check=True)
    commit = git("rev-parse", revision).strip()
    subprocess.run(["git", "checkout", "--quiet", "--detach", commit], cwd=folder, check=True)
    return folder


def timed(folder: Path, *command: str) -> str:
    """Run a command, and return its seconds; a failure is marked."""
    began = time.monotonic()
    environment = {name: value for name, value in os.environ.items() if name != "VIRTUAL_ENV"}
    with (WORK / "log.txt").open("a", encoding="utf-8") as log:
        done = subprocess.run(command, cwd=folder, env=environment, stdout=log, stderr=log, check=False)
    return f"{time.monotonic() - began:.0f}{'' if done.returncode == 0 else ' (failed)'}"


if __name__ == "__main__":
    main()
