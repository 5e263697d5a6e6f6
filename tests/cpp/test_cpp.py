"""The core's own functions, tested in C++: one program, built by CMake in build/cpp."""

import os
import subprocess
import sysconfig
from pathlib import Path

HERE = Path(__file__).parent


def run(program, folder):
    """Build a program of CMakeLists.txt, each in a folder of its own: tests run at the same time. Give how it ended."""
    scripts = sysconfig.get_path("scripts")
    environment = os.environ | {"PATH": os.pathsep.join([scripts, os.environ["PATH"]])}
    for step in ("-S", HERE, "-B", folder, "-G", "Ninja"), ("--build", folder, "--target", program):
        build = subprocess.run(["cmake", *step], env=environment, capture_output=True, text=True, check=False)
        assert build.returncode == 0, build.stdout + build.stderr
    return subprocess.run([folder / program], capture_output=True, text=True, check=False)


def test_functions_of_the_core():
    end = run("core_tests", HERE.parents[1] / "build" / "cpp")
    assert end.returncode == 0, end.stdout + end.stderr
    assert end.stdout.endswith(" tests, 0 failed\n")


def test_checks_that_fail_are_seen(tmp_path):
    end = run("failing", tmp_path)
    first, second, *rest = end.stdout.splitlines()
    assert end.returncode == 1
    assert first.endswith("failing.cpp:11: 4, not 5")
    assert second.endswith("failing.cpp:12: not 2 > 3")
    failed = ["FAILED two_that_do_not", "thrown", "FAILED one_that_ends_early"]
    assert rest == [*failed, "3 tests, 2 failed"]
