"""Reading and describing an input changes neither it nor its folder, whatever its format."""

import os
import tempfile
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import vorotool
from fuzz.byte_seeds import seeds
from support.refusals import refused
from vorotool.cli.main import main
from vorotool.errors import VorotoolError
from vorotool.products.inputs import INPUTS

SEEDS = seeds()
"""Small valid files of all formats."""


def state(folder):
    """Names, contents and times of all that is in a folder, and of the folder."""
    held = {}
    for path in [folder, *folder.rglob("*")]:
        found = path.stat()
        held[str(path)] = (found.st_mtime_ns, found.st_ino, found.st_mode, path.is_file() and path.read_bytes())
    return held


def outcomes(path):
    """What comes of reading a file as whatever it may hold: types of values, or messages."""
    found = []
    ways = (vorotool.read, vorotool.voronoi, vorotool.tessellate)
    for way in ways:
        try:
            found.append(type(way(str(path))).__name__)
        except VorotoolError as error:
            found.append(str(error))
    with pytest.raises(SystemExit) as end:
        main(["info", str(path)])
    return [*found, end.value.code]


def made(folder, bundle):
    for name, data in bundle.files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(data)
    for path in [folder, *folder.rglob("*")]:
        os.utime(path, (10**9, 10**9))
    return folder / bundle.name


def test_there_is_a_file_of_every_format():
    endings = {each.name.rpartition(".")[2] for each in SEEDS}
    missing = {each.name for each in INPUTS.values() if not endings & set(each.names)}
    assert not missing - {"csv-wkt"}  # which is a .csv, too


@pytest.mark.parametrize("bundle", SEEDS, ids=[f"{number}-{each.name}" for number, each in enumerate(SEEDS)])
def test_what_is_read_stays_as_it_is_and_may_be_write_protected(bundle):
    if bundle.name.endswith(".laz") and os.geteuid() == 0:
        pytest.skip("whoever root is meanwhile may not start Python, which decompresses it")
    with tempfile.TemporaryDirectory() as folder:
        path = made(Path(folder), bundle)
        before = state(Path(folder))
        free = outcomes(path)
        assert state(Path(folder)) == before
        with protected(Path(folder)):
            before = state(Path(folder))
            assert outcomes(path) == free
            assert state(Path(folder)) == before


@contextmanager
def protected(folder):
    """Let nothing be written in a folder; root may, and is somebody else meanwhile."""
    inner = [path for path in folder.rglob("*") if path.is_dir()]
    for path in folder.rglob("*"):
        path.chmod(0o555 if path.is_dir() else 0o444)
    folder.chmod(0o555)
    is_root = os.geteuid() == 0
    if is_root:
        os.seteuid(65534)
    try:
        refused(PermissionError, "", (folder / "new").touch)
        yield
    finally:
        if is_root:
            os.seteuid(0)
        for path in (folder, *inner):
            path.chmod(0o755)


def test_files_beside_an_image_stay(tmp_path):
    Image.fromarray(np.eye(9, dtype=np.uint8)).save(tmp_path / "a.tif")
    (tmp_path / "a.tfw").write_text("2\n0\n0\n-2\n10\n20\n")
    (tmp_path / "a.tif.aux.xml").write_text("<PAMDataset/>")
    before = state(tmp_path)
    assert vorotool.read(tmp_path / "a.tif").grid.width == 2
    assert state(tmp_path) == before
