"""The same bytes from every machine: a few commands as on narrower machines than this one (`make fuzz` runs all)."""

import pytest

from support.processes.machine_runs import Setting, differences, narrowest, numpy_levels, run, smoke

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def usual():
    return run(Setting("usual"), smoke())


def test_the_commands_do_what_they_are_asked(usual):
    assert [command for command, result in usual.items() if not result.startswith("0 ")] == []


@pytest.mark.parametrize(
    "setting",
    [
        *(Setting(level, {"NPY_DISABLE_CPU_FEATURES": level}) for level in numpy_levels()),
        Setting("linear algebra", {"OPENBLAS_CORETYPE": "Prescott"}, threads=2),
        narrowest(),
    ],
    ids=lambda setting: setting.name.replace(" ", "-"),
)
def test_a_narrower_machine_writes_the_same_bytes(usual, setting):
    assert differences(usual, run(setting, usual)) == []
