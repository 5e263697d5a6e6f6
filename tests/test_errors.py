"""Messages have two readings: options as they are typed on the command line, and parameters in Python."""

import copy
import io
import pickle
import warnings
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import orjson
import pytest
import shapely

import vorotool
from vorotool import errors
from vorotool.errors import (
    InputError,
    Kind,
    LimitError,
    Message,
    OutputError,
    UsageError,
    VerificationError,
    VorotoolError,
    VorotoolWarning,
    option,
)
from vorotool.jobs.run_log import Run
from vorotool.jobs.terminal import explained

WINDOW = option("--window X,Y,W,H", "window=(x, y, w, h)")
TEXT = f"3..12: use {WINDOW}, or leave out {errors.STRICT}"
IN_PYTHON = "3..12: use window=(x, y, w, h), or leave out strict=True"
TYPED = "3..12: use --window X,Y,W,H, or leave out --strict"
CLASSES = (VorotoolError, UsageError, InputError, OutputError, LimitError, VerificationError)


def fail():
    """Fail in another thread or process."""
    raise InputError(TEXT)


@pytest.mark.parametrize("kind", CLASSES)
def test_an_error_reads_as_python_and_keeps_what_is_typed(kind):
    error = kind(TEXT)
    assert str(error) == IN_PYTHON == f"{error}" == error.args[0]
    assert "ufdd" not in ascii(error)
    assert error.typed == TYPED
    assert explained(error) == (TYPED, kind.exit_code)


@pytest.mark.parametrize("kind", CLASSES)
@pytest.mark.parametrize("how", [lambda error: pickle.loads(pickle.dumps(error)), copy.copy, copy.deepcopy])
def test_an_error_is_the_same_after_pickling_and_copying(kind, how):
    error = kind(TEXT)
    error.source = "a.csv"
    again = how(error)
    assert (type(again), str(again), again.typed, again.typed.source) == (kind, IN_PYTHON, TYPED, "a.csv")


@pytest.mark.parametrize("pool", [ThreadPoolExecutor, ProcessPoolExecutor])
def test_an_error_has_both_readings_when_it_comes_from_a_pool(pool):
    with pool(1) as workers, pytest.raises(InputError) as caught:
        workers.submit(fail).result()
    assert str(caught.value) == IN_PYTHON
    assert caught.value.typed == TYPED


def test_an_error_made_of_another_keeps_both_readings():
    error = InputError(f"a.csv: {InputError(TEXT).marked}")
    assert str(error) == f"a.csv: {IN_PYTHON}"
    assert error.typed == f"a.csv: {TYPED}"


@pytest.mark.parametrize("said", [TEXT, Message(TEXT, Kind.EMPTY_RESULT, source="a.csv")])
def test_a_warning_reads_as_python_and_a_run_says_what_is_typed(said, capsys):
    with pytest.warns(VorotoolWarning) as caught:
        warnings.warn(said, VorotoolWarning, stacklevel=1)
    assert [str(each.message) for each in caught] == [IN_PYTHON]
    again = pickle.loads(pickle.dumps(caught[0].message))
    assert again.message.typed == TYPED
    with Run("test", quiet=False, verbose=False, stats=None) as run:
        warnings.warn(VorotoolWarning(said), stacklevel=1)
        run.note(Message(TEXT))
    assert run.warnings == run.notes == [TYPED]
    assert capsys.readouterr().err == f"warning: {TYPED}\nnote: {TYPED}\n"
    assert orjson.loads(orjson.dumps(run.warnings)) == [TYPED]


def test_a_message_keeps_kind_source_and_both_readings():
    said = Message.of(Message(TEXT, Kind.DEGREES, source="a.csv"))
    for each in (said, pickle.loads(pickle.dumps(said)), copy.deepcopy(said), Message(said, said.kind, source="a.csv")):
        assert (each, each.kind, each.source, each.typed) == (IN_PYTHON, Kind.DEGREES, "a.csv", TYPED)
        assert (each.typed.kind, each.typed.source) == (Kind.DEGREES, "a.csv")
    assert Message.of("plain").typed == "plain"


@pytest.mark.parametrize(
    ("typed", "parameter"),
    [("--strict", "strict"), ("--max-sites 7", "max_sites=7"), ("--page all", "page=all"), ("-r 2", "r=2")],
)
def test_a_parameter_follows_from_the_option(typed, parameter):
    assert str(UsageError(option(typed))) == parameter
    assert UsageError(option(typed)).typed == typed


@pytest.mark.parametrize("name", ["\ufdd0", "a\ufdd0b\ufdd1", "\ufdd2\ufdd1\ufdd0", "\ufdd0\ufdd0--x\ufdd1"])
def test_file_names_with_the_marks_stay_as_they_are(name):
    error = InputError(f"{name}: {TEXT}")
    assert str(error) == f"{name}: {IN_PYTHON}"
    assert error.typed == f"{name}: {TYPED}"


def test_an_error_without_words_has_none():
    assert str(VorotoolError()) == VorotoolError().typed == ""
    assert io.StringIO(str(OutputError(TEXT))).read() == IN_PYTHON


def test_a_warning_names_the_line_that_called_the_library():
    with pytest.warns(VorotoolWarning) as said:
        vorotool.delaunay([[0, 0], [4, 0], [0, 3], [0, 0]])
    assert [each.filename for each in said] == [__file__]


SQUARE = [[0, 0], [4, 0], [4, 4], [0, 4]]
EMPTY = np.zeros((4, 4), np.uint8)


@pytest.mark.parametrize(
    ("misuse", "parameter"),
    [
        (lambda: vorotool.tessellate([[-1, 2], [3, 4]]), "window=(x, y, w, h)"),
        (lambda: vorotool.seeds_from_raster(EMPTY), "invert=True"),
        (lambda: vorotool.seeds_from_raster(EMPTY, strict=True), "strict=True"),
        (lambda: vorotool.delaunay([[1, 1], [1, 1]], strict=True), "strict=True"),
        (lambda: vorotool.alpha_shape(SQUARE, alpha=0.1), "r=10"),
        (lambda: vorotool.skeleton_exact(shapely.LineString([(0, 0), (1, 1)])), 'side="exterior"'),
        (lambda: vorotool.read("data/dots.csv", columns="x,z"), "columns"),
        (lambda: vorotool.write(vorotool.tessellate([[1, 1]], shape=(1999, 999)), "build/v.svg"), 'fmt="png"'),
    ],
)
@pytest.mark.filterwarnings("error::vorotool.errors.VorotoolWarning")
def test_errors_of_the_library_name_parameters(misuse, parameter):
    with pytest.raises((VorotoolError, VorotoolWarning)) as caught:
        misuse()
    assert parameter in str(caught.value)
    assert " --" not in str(caught.value)


def test_notes_of_the_library_name_parameters():
    said = []
    vorotool.seeds_from_raster(np.array([[0, 7]]), note=said.append)
    vorotool.outlines(np.array([[0, 255]], np.uint16), note=said.append)
    assert [word in line for word, line in zip(('mode="components"', 'mode="labels"'), said, strict=True)] == [True] * 2
    assert not any(" --" in line for line in said)
