"""The compiled modules: one room of the core each, and what only tests call in no wheel."""

import pickle
import re
import subprocess
import sys
import tomllib
from pathlib import Path
from types import ModuleType

import cmake
import pytest

from vorotool import _core

ROOT = Path(__file__).parents[2]
ROOMS = {name for name, value in vars(_core).items() if isinstance(value, ModuleType)}


def test_each_room_is_bound_by_a_source_of_its_name():
    assert {path.stem for path in (ROOT / "src" / "bindings").glob("*.cpp")} == {"module", *ROOMS}
    assert {path.name for path in (ROOT / "src" / "core").iterdir()} > ROOMS


def test_nothing_is_beside_the_rooms():
    assert {name for name in vars(_core) if not name.startswith("__")} == ROOMS


def test_a_room_is_imported_by_its_name():
    script = "import vorotool._core.text as room; print(room.TextError.__module__, room.__name__)"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["vorotool._core.text"] * 2


@pytest.mark.parametrize(
    ("kind", "arguments"),
    [
        (_core.text.TextError, ("not_number", 3, 1, "x", 0, 0)),
        (_core.tessellation.SeedTooFarError, (7,)),
        (_core.sampled_skeleton.TooManySeedsError, ("too many",)),
        (_core.arrangement.TooManyCrossingsError, ()),
    ],
)
def test_errors_go_to_other_processes(kind, arguments):
    there = pickle.loads(pickle.dumps(kind(*arguments)))
    assert (type(there), there.args) == (kind, arguments)


def installed_modules(folder, testing):
    """Configure the build, as often as wanted in one folder, and read what it would install."""
    subprocess.run(
        [
            Path(cmake.CMAKE_BIN_DIR) / "cmake",
            *("-S", ROOT / "src", "-B", folder, f"-DPython_EXECUTABLE={sys.executable}"),
            f"-DVOROTOOL_TESTING={testing}",
        ],
        capture_output=True,
        check=True,
    )
    rules = (folder / "bindings" / "cmake_install.cmake").read_text(encoding="utf-8")
    return set(re.findall(r"/(_\w+)\.", rules))


def test_no_wheel_has_what_only_tests_call(tmp_path):
    """An editable build has, also before the wheel's in the same folder, whose cache keeps what is not stated."""
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["scikit-build"]
    [editable] = [choice for choice in settings["overrides"] if choice["if"] == {"state": "editable"}]
    both = {"_core", "_core_testing"}
    assert installed_modules(tmp_path, editable["cmake"]["define"]["VOROTOOL_TESTING"]) == both
    assert installed_modules(tmp_path, settings["cmake"]["define"]["VOROTOOL_TESTING"]) == {"_core"}
