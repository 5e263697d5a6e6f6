"""Files that are read are never replaced, and records of batches neither."""

import errno
import os

import pytest

from vorotool.formats.zarr.store import is_folder, is_store


@pytest.mark.parametrize(("device", "fmt"), [("/dev/null", "tiff"), ("/dev/zero", "npy")])
def test_devices_are_written_in_order(run, folder, device, fmt):
    assert run(f"tessellate dots.csv -f {fmt} -o {device}").err == ""


def test_what_must_not_be_looked_at_is_no_folder_and_no_store(run, folder, monkeypatch):
    look = os.stat

    def sealed(path, **options):
        if "sealed" in str(path).split("/"):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
        return look(path, **options)

    (folder / "sealed").mkdir()
    (folder / "sealed/dots.csv").write_bytes((folder / "dots.csv").read_bytes())
    monkeypatch.setattr(os, "stat", sealed)
    assert not is_folder("sealed/a")
    assert not is_store("sealed")
    assert run("tessellate sealed/dots.csv --what table").err == ""
    run("tessellate dots.csv -o sealed/x.png", code=4, says="sealed/x.png")
