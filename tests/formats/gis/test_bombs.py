"""Small files that announce or become much are refused before memory is taken."""

import io
import zipfile

import numpy as np
import pyarrow
import pyarrow.parquet
import pytest

import vorotool
from support.families.vector_files import frame, save
from support.processes.ended import ended_python
from support.refusals import refused
from vorotool.errors import InputError, LimitError


def parquet(path, **columns):
    pyarrow.parquet.write_table(pyarrow.table(columns), path, compression="zstd")
    return path


@pytest.mark.parametrize("kind", ["text", "lists", "rows"])
def test_parquet(tmp_path, kind):
    text = pyarrow.DictionaryArray.from_arrays(np.zeros(3000, "i4"), ["x" * 400_000])
    columns = {
        "text": {"x": np.zeros(3000), "y": np.zeros(3000), "t": text},
        "lists": {"x": np.zeros(3000), "t": pyarrow.ListArray.from_arrays(np.arange(3001, dtype="i4"), text)},
        "rows": {"x": np.zeros(2 * 10**7, bool), "y": np.zeros(2 * 10**7, bool)},
    }[kind]
    path = parquet(tmp_path / "a.parquet", **columns)
    assert path.stat().st_size < 2 * 10**5
    refused(LimitError, r"a\.parquet", vorotool.read, path)


def test_parquet_in_a_process_that_has_imported_nothing(tmp_path):
    path = parquet(tmp_path / "a.parquet", x=np.arange(5.0), y=np.arange(5.0), t=["a"] * 5)
    script = f"import vorotool; print(vorotool.read({str(path)!r}).properties)"
    done = ended_python("-c", script)
    assert (done.stdout.strip(), done.stderr) == ("{'t': ['a', 'a', 'a', 'a', 'a']}", "")


def test_rows_of_parquet_are_counted_first(tmp_path):
    path = parquet(tmp_path / "a.parquet", x=np.arange(50.0), y=np.arange(50.0), t=["a"] * 50)
    assert vorotool.read(path, max_sites=50).properties["t"] == ["a"] * 50
    refused(LimitError, "50 points, more than the limit of 49", vorotool.read, path, max_sites=49)


def test_archives(tmp_path):
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        for part in (".shp", ".shx", ".dbf"):
            with archive.open(f"a{part}", "w") as member:
                for _ in range(20):
                    member.write(bytes(10**7))
    (tmp_path / "a.zip").write_bytes(out.getvalue())
    refused(LimitError, r"a\.zip", vorotool.read, tmp_path / "a.zip")


def test_an_index_whose_entries_are_one_shape(tmp_path):
    path = save(frame(), tmp_path / "a.shp")
    index = path.with_suffix(".shx")
    data = index.read_bytes()
    index.write_bytes(data[:100] + data[100:108] * 1000)
    refused(InputError, r"a\.shp", vorotool.read, path)
    index.write_bytes(data)
    refused(LimitError, "3 points, more than the limit of 2", vorotool.read, path, max_sites=2)
