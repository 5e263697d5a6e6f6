"""The core's own functions, tested in C++ by programs that are built with the core."""

import subprocess
from pathlib import Path

from vorotool import _core

BUILT = Path(_core.__file__).parent


def run(program):
    return subprocess.run([BUILT / program], capture_output=True, text=True, check=False)


def test_functions_of_the_core():
    end = run("core_tests")
    assert end.returncode == 0, end.stdout + end.stderr
    assert end.stdout.endswith(" tests, 0 failed\n")


def test_checks_that_fail_are_seen():
    end = run("core_tests_that_fail")
    first, second, *rest = end.stdout.splitlines()
    assert end.returncode == 1
    assert first.endswith("failing.cpp:11: 4, not 5")
    assert second.endswith("failing.cpp:12: not 2 > 3")
    failed = ["FAILED two_that_do_not", "thrown", "FAILED one_that_ends_early"]
    assert rest == [*failed, "3 tests, 2 failed"]
