"""The page of a volume: its runs, and what its script shows of them."""

import json
import re
import shutil
import subprocess
from base64 import b64decode

import numpy as np
import pytest

from support.readers.written import bytes_of
from support.refusals import refused
from vorotool import LimitError
from vorotool.render.pages.html import (
    MOST_RUNS,
    MOST_VOXELS,
    check_volume_page,
    runs_of,
    write_volume_html,
)

NODE = shutil.which("node")

BROWSER = """
const elements = {};
function made() {
  return {
    textContent: "", dataset: {}, heard: {}, rows: [],
    addEventListener(name, act) { this.heard[name] = act; },
    replaceChildren() { this.rows = []; },
    insertRow() {
      const cells = [];
      this.rows.push(cells);
      return { insertCell() { const cell = {}; cells.push(cell); return cell; } };
    },
    getBoundingClientRect() { return { left: 0, top: 0, width: 400, height: 300 }; },
    getContext() {
      return { putImageData() {}, setTransform() {}, drawImage(...all) { globalThis.drawn = all.slice(1); } };
    },
  };
}
globalThis.document = {
  documentElement: { dataset: {} }, getElementById(id) { return elements[id] ??= made(); }, createElement: made,
};
globalThis.getComputedStyle = () => ({ getPropertyValue() { return "#ffffff"; } });
globalThis.ImageData = class { constructor(w, h) { this.data = new Uint8ClampedArray(4 * w * h); } };
globalThis.window = { addEventListener() {}, matchMedia() { return { addEventListener() {} }; } };
globalThis.location = { hash: "#id=6&z=0" };
globalThis.history = { replaceState(a, b, where) { globalThis.where = where; } };
"""
SEEN = """
const state = () => ({
  slice: Array.from(slice), shown: { ...document.documentElement.dataset },
  values: elements.values.rows.map(row => row.map(cell => cell.textContent)), drawn, address: globalThis.where,
});
const seen = [state()];
elements.z.value = "1";
elements.z.heard.input();
elements.id.heard.input({ target: { value: " 12 " } });
seen.push(state());
console.log(JSON.stringify(seen));
"""


@pytest.fixture(scope="module")
def labels():
    return 3 * np.random.default_rng(0).integers(0, 5, (4, 6, 7))


def page_of(labels, **options):
    known = np.unique(labels[labels > 0])
    volumes = np.bincount(labels.ravel())[known]
    colors = (known, np.arange(len(known)) % 3 + 1)
    return bytes_of(write_volume_html, labels, colors, {"volume": volumes}, **options).decode()


def test_runs_are_the_volume(labels):
    known = np.unique(labels[labels > 0])
    runs = runs_of(labels, known)
    assert len(runs.rows) == 4 * 6 + 1
    values = np.append(0, known)[runs.regions]
    begins = np.append(0, runs.ends[:-1])
    begins[runs.rows[:-1]] = 0
    np.testing.assert_array_equal(np.repeat(values, runs.ends - begins), labels.ravel())


def test_data_are_in_the_page(labels):
    data = json.loads(re.search(r"const data = (.*);\n", page_of(labels, first=-2, units=(3, 1, 2)))[1])
    assert (data["width"], data["height"], data["depth"], data["first"], data["sides"]) == (7, 6, 4, -2, [2.0, 1.0])
    assert data["ids"] == ["3", "6", "9", "12"]
    assert np.frombuffer(b64decode(data["classes"]), "<i4").tolist() == [0, 1, 2, 3, 1]
    assert sum(data["columns"][0]["values"]) == (labels > 0).sum()


@pytest.mark.skipif(NODE is None, reason="no node: the script is not run (apt-get install nodejs)")
def test_the_script_shows_slices_and_values(labels):
    script = re.search("<script>(.*)</script>", page_of(labels, first=-2, units=(3, 1, 2)), re.DOTALL)[1]
    done = subprocess.run([NODE, "-e", BROWSER + script + SEEN], capture_output=True, text=True, check=True)
    known = np.unique(labels)
    for state, z, label in zip(json.loads(done.stdout), (2, 3), (6, 12), strict=True):
        np.testing.assert_array_equal(known[state["slice"]].reshape(6, 7), labels[z])
        assert state["shown"] == {"slice": z - 2, "shown": str(label)}
        assert state["values"] == [["id", str(label)], ["volume", str((labels == label).sum())]]
        x, y, width, height = state["drawn"]
        assert width / height == pytest.approx(7 * 2 / 6)
        assert (2 * x + width, 2 * y + height) == pytest.approx((400, 300))
    assert state["address"] == "#id=12&z=1"


def test_no_text_ends_the_script(labels):
    data = bytes_of(write_volume_html, np.ones((1, 1, 1), int), (np.array([1]), np.array([1])), {"name": ["</script>"]})
    assert data.count(b"</script>") == 1


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (((1025, 256, 256),), f"{MOST_VOXELS}"),
        (((2, 2, 2), 100_001), "100001"),
        (((2, 2, 2), 1, MOST_RUNS + 1), f"{MOST_RUNS + 1} runs of voxels are too many"),
    ],
)
def test_pages_are_limited(given, words):
    refused(LimitError, words, check_volume_page, *given)
