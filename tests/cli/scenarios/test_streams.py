"""Pipes and descriptors on both sides of every command: a smoke of `tests/fuzz/streams.py`, and what is said."""

import os
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from support.families.stream_cases import CASES, INPUTS, OUTPUTS, Expected, fault
from support.processes.ended import ended_bash
from support.processes.leftovers import leftovers

COMMANDS = sorted({case.command for case in CASES})


RUNS = 3
"""Of each command, of two of its cases: all commands together are given each way of each side."""


def smoke(command):
    """What is run of a command: cases, and ways of both sides."""
    first = RUNS * COMMANDS.index(command)
    cases = [case for case in CASES if case.command == command]
    chosen = [cases[first % len(cases)], cases[(first + len(cases) // 2) % len(cases)]]
    return [
        (chosen[number % 2], INPUTS[number % len(INPUTS)], OUTPUTS[number % len(OUTPUTS)])
        for number in range(first, first + RUNS)
    ]


def test_each_way_is_tried():
    runs = [each for command in COMMANDS for each in smoke(command)]
    assert ({given for _, given, _ in runs}, {left for _, _, left in runs}) == (set(INPUTS), set(OUTPUTS))


@pytest.fixture(scope="module")
def expected(tmp_path_factory):
    return Expected(tmp_path_factory.mktemp("expected"))


@pytest.mark.slow
@pytest.mark.parametrize("command", COMMANDS)
def test_streams_are_as_good_as_files(expected, tmp_path, command):
    def run(numbered):
        number, (case, given, left) = numbered
        folder = tmp_path / str(number)
        folder.mkdir()
        wrong = fault(expected, case, given, left, folder)
        return wrong and f"{case}, from {given} to {left}: {wrong}"

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        assert [wrong for wrong in pool.map(run, enumerate(smoke(command))) if wrong] == []


def bash(folder, line):
    """Run a line of a shell; V is the command."""
    script = f'V() {{ "{sys.executable}" -m vorotool "$@"; }}\n{line}'
    return ended_bash(script, folder, text=False)


TABLE = "V tessellate dots.csv -q --what table"
WANTED = {}
"""What lines gave that are run for comparison, by the line."""


def wanted_of(line, run, folder):
    """Run the command here, and what follows it in a shell."""
    command, _, rest = line.removeprefix("V ").partition("; ")
    done = run(command)
    assert done.err == ""
    WANTED[line] = done.out.encode() + bash(folder, rest).stdout
    return WANTED[line]


@pytest.mark.parametrize(
    ("line", "same"),
    [
        (f"{{ echo h; {TABLE} -o /dev/stdout; echo f; }} > x; sed '1d;$d' x", TABLE),
        ("cp dots.csv x; V tessellate x -q --what table -o /dev/stdout >> x; sed 1,4d x", TABLE),
        (f"echo old > x; {TABLE} -o /dev/stderr 2>> x; sed 1d x", TABLE),
        (f"{TABLE} -o >(cat > x; touch done); until [ -e done ]; do sleep 0.01; done; cat x", TABLE),
        (f"ln -s /dev/stdout x.csv; {TABLE} -o x.csv | cat; [ -L x.csv ]", TABLE),
        ("V tessellate <(cat dots.csv) -f text -q", "V tessellate dots.csv -f text -q"),
        ("ls *.csv | V tessellate --files-from /dev/stdin --table - -q", f"{TABLE} --table x.csv; cat x.csv"),
        (f"{TABLE} -o x --stats >(grep seeds > y; touch done); until [ -e done ]; do sleep 0.01; done; cat y x",
         f"{TABLE} -o x --stats y; grep seeds y; cat x"),
    ],
)  # fmt: skip
def test_lines_of_a_shell(run, folder, line, same):
    done = bash(folder, line)
    assert done.returncode == 0, done
    assert (done.stdout, done.stderr) == (WANTED.get(same) or wanted_of(same, run, folder), b"")
    assert len(done.stdout) > 20
    assert leftovers(folder) == []


REFUSED = [
    ("V tessellate - --overlay /dev/stdin --what color -o y.png", 2, "--overlay /dev/stdin"),
    ("V delaunay - --what cells --clip /dev/fd/0", 2, "are the same stream"),
    ("V tessellate --files-from - - --out-dir x", 2, "--files-from -"),
    ("mkfifo x; V tessellate x dots.csv --table y.csv", 2, "x is a pipe, which only this process can read"),
    (f"{TABLE} -o - --stats /dev/stdout", 2, "--stats /dev/stdout"),
    (f"{TABLE} -o /dev/fd/1 --stats -", 2, "/dev/fd/1"),
    ("mkfifo x; V tessellate dots.csv -o x --stats x", 2, "--stats"),
    (f"{TABLE} --out-dir x --table /dev/stdout --stats -", 2, "/dev/stdout"),
    ("V tessellate dots.csv -q -o /dev/fd/999", 4, "/dev/fd/999"),
    ("V tessellate /dev/fd/999 -o y.png", 3, "/dev/fd/999"),
    ("ln -s b a; ln -s a b; V tessellate dots.csv -o a -f npy", 4, "a cannot be written: its links lead back"),
    ("V delaunay dots.csv --clip x.json --what cells -o x.json", 3, "x.json"),
    ("cp dots.csv x; V delaunay dots.csv --clip x --what cells -f csv -o x", 2, "x is also an input"),
]

REFUSED_OF_A_SHELL = [
    ("V tessellate <(cat dots.csv) <(cat dots.csv) --out-dir x", 2, "which only this process can read"),
    ("V tessellate dots.csv -q -o /dev/stdout >&-", 4, "/dev/stdout"),
    ("V tessellate dots.csv -q -o /dev/stdin < dots.csv", 4, "open for reading only"),
    ("V tessellate /dev/stdin -o y.png <&-", 3, "/dev/stdin"),
    ("mkfifo x.csv; : > x.csv & V tessellate x.csv -o y.png", 3, "x.csv"),
]


@pytest.mark.parametrize(("line", "code", "words"), REFUSED)
def test_what_is_refused(run, folder, line, code, words):
    """A shell makes the files, and the command runs here."""
    before, _, command = line.rpartition("V ")
    assert bash(folder, before).returncode == 0
    run(command, data=(folder / "dots.csv").read_bytes(), code=code, says=words)
    check_that_nothing_is_left(folder)


@pytest.mark.parametrize(("line", "code", "words"), REFUSED_OF_A_SHELL)
def test_what_is_refused_to_a_shell(folder, line, code, words):
    done = bash(folder, line)
    assert (done.returncode, done.stdout) == (code, b""), done
    assert words in done.stderr.decode()
    assert b"Traceback" not in done.stderr
    check_that_nothing_is_left(folder)


def check_that_nothing_is_left(folder):
    assert leftovers(folder) == []
    assert not (folder / "y.png").exists()
    assert (folder / "dots.csv").read_text().startswith("x,y,name\n2,1,a")


def test_pipes_in_a_folder_are_left_out(run, folder):
    (folder / "inputs").mkdir()
    (folder / "dots.csv").rename(folder / "inputs/dots.csv")
    os.mkfifo(folder / "inputs/pipe.csv")
    note = "note: inputs/pipe.csv is a pipe: skipped\n"
    assert run("tessellate inputs --out-dir out -f npy").err == f"{note}1/1 inputs/dots.csv: done\n"
    done = run("tessellate inputs/* --out-dir out -f npy --dry-run")
    assert (done.err, len(done.out.splitlines())) == (note, 1)
    assert run("tessellate inputs --out-dir out -f npy -q").err == ""
    assert Path("out/dots.npy").exists()


def test_standard_input_that_does_not_wait(run, folder, process):
    reading, writing = os.pipe()
    os.set_blocking(reading, False)
    child = process("tessellate", "-", "--size", "9x9", "-f", "text", stdin=reading)
    os.close(reading)
    lines = (folder / "dots.csv").read_bytes().splitlines(keepends=True)
    for line in lines:
        os.write(writing, line)
        time.sleep(0.2)
    os.close(writing)
    out, err = child.communicate(timeout=600)
    assert (child.returncode, err) == (0, b"")
    assert out.decode() == run("tessellate dots.csv --size 9x9 -f text -q").out
