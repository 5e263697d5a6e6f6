"""The chain of the pages of a TIFF: followed once, within bounds, before any library follows it."""

import struct

import numpy as np
import pytest

import vorotool
from support.few import few
from support.processes.peak_memory import watched
from support.refusals import refused
from vorotool.errors import InputError, LimitError
from vorotool.formats.images import tiff_reader
from vorotool.formats.images.image_header import page_count
from vorotool.formats.volumes.opening import open_volume

CLASSIC, BIG = ("H", "HHI", "I"), ("Q", "HHQ", "Q")
LONG, ASCII = 4, 2
PIXEL = {256: 1, 257: 1, 258: 8, 259: 1, 262: 1, 277: 1, 278: 1, 279: 1}


def chain(tags, following, order="<", forms=CLASSIC, text=b""):
    """A file of pages of one pixel: the tags of each, and the number of the page behind it, None behind the last."""
    count_form, entry_form, next_form = (struct.Struct(order + form) for form in forms)
    head = 16 if forms is BIG else 8
    sizes = [count_form.size + (entry_form.size + next_form.size) * len(page) + next_form.size for page in tags]
    first = head + len(tags) + len(text)
    starts = np.cumsum([first, *sizes]).tolist()
    places = {"text": head + len(tags)} | {f"page {page}": start for page, start in enumerate(starts)}
    made = {"<": b"II", ">": b"MM"}[order] + struct.pack(order + "H", 43 if forms is BIG else 42)
    made += struct.pack(order + "HHQ", 8, 0, first) if forms is BIG else struct.pack(order + "I", first)
    made += bytes(range(1, len(tags) + 1)) + text if len(tags) < 256 else bytes(len(tags)) + text
    for index, (page, after) in enumerate(zip(tags, following, strict=True)):
        made += count_form.pack(len(page))
        for tag, value in sorted(page.items()):
            kind, count, content = value if isinstance(value, tuple) else (LONG, 1, value)
            content = head + index if content == "pixel" else places.get(content, content)
            made += entry_form.pack(tag, kind, count)
            made += struct.pack(order + "I", content).ljust(next_form.size, b"\0")
        made += next_form.pack(0 if after is None else starts[after] if isinstance(after, int) else int(after))
    return made


def pages(count):
    return [{**PIXEL, 273: "pixel"} for _ in range(count)]


def written(tmp_path, data):
    path = tmp_path / "a.tif"
    path.write_bytes(data)
    return path


@pytest.mark.parametrize("order", "<>")
@pytest.mark.parametrize("forms", [CLASSIC, BIG], ids=["classic", "big"])
@pytest.mark.parametrize(("count", "back"), few([(1, 0), (4, 2), (300, 120), (2, 0), (4, 0), (150, 149)], 3))
def test_pages_in_a_circle(tmp_path, order, forms, count, back):
    path = written(tmp_path, chain(pages(count), [*range(1, count), back], order, forms))
    for read in (vorotool.read, lambda path: vorotool.read(path, page=0), open_volume_and_look):
        refused(InputError, rf"{back}\b", read, path)
    assert page_count(str(path)) == 1  # for the command that reads it then


def open_volume_and_look(path):
    return open_volume(path).shape


@pytest.mark.parametrize(
    "command",
    few(
        [
            ["info", "a.tif"],
            ["info", "--page", "1", "a.tif"],
            ["tessellate", "a.tif", "-o", "b.tif"],
            ["tessellate", "--volume", "a.tif", "-o", "b.tif"],
            ["tessellate", "a.tif", "--page", "all", "--out-dir", "out"],
            ["skeleton-exact", "a.tif", "-o", "b.json"],
        ],
        2,
    ),
)
def test_a_circle_through_a_page_without_tags(tmp_path, command):
    written(tmp_path, chain([*pages(1), {}, *pages(1)], [1, 2, 1]))
    code, errors, peak = watched(command, tmp_path)
    assert (code, peak < 2**29) == (6 if "--out-dir" in command else 3, True), errors
    assert "a.tif" in "".join(errors)
    assert not (tmp_path / "b.tif").exists()


@pytest.mark.parametrize("cut", [1, 4, 5, 100, 113])
def test_tags_that_are_cut_off(tmp_path, cut):
    data = chain(pages(3), [1, 2, None])[:-cut]
    for read in (vorotool.read, open_volume_and_look):
        refused(InputError, rf"{len(data)}", read, written(tmp_path, data))


def test_more_pages_than_are_read(tmp_path, monkeypatch):
    monkeypatch.setattr(tiff_reader, "MOST_ENTRIES", 100)
    assert open_volume(written(tmp_path, chain(pages(10), [*range(1, 10), None]))).shape == (10, 1, 1)
    path = written(tmp_path, chain(pages(11), [*range(1, 11), None]))
    for read in (vorotool.read, open_volume_and_look):
        refused(LimitError, r"a\.tif", read, path)


def test_pages_that_share_a_long_text(tmp_path, monkeypatch):
    """Each page would read it anew: the time is that of their product."""
    text = b"x" * 10_000
    shared = [{**page, 270: (ASCII, len(text), "text")} for page in pages(40)]
    path = written(tmp_path, chain(shared, [*range(1, 40), None], text=text))
    assert open_volume(path).shape == (40, 1, 1)
    monkeypatch.setattr(tiff_reader, "_SPARE", 0)
    with pytest.raises(InputError, match=rf"a\.tif.* {path.stat().st_size} bytes"):
        open_volume(path).shape  # noqa: B018
