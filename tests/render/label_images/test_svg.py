import io
import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from vorotool.errors import LimitError
from vorotool.render.canvas.styles import CELLS
from vorotool.render.label_images.svg import write_label_svg
from vorotool.types.pixel_frame import Frame
from vorotool.types.points.label_image import LabelImage
from vorotool.types.points.seed_set import SeedSet

NS = "{http://www.w3.org/2000/svg}"
LABELS = np.array([[1, 1, 2, 2], [1, 3, 3, 2], [0, 3, 3, 12]])
COLORS = np.array([0, 1, 2, 3] + [4] * 9)
SEEDS = SeedSet(np.array([10, 13, 12, 99]), np.array([20, 20, 22, 99]), np.array([1, 2, 3, 4]))
IMAGE = LabelImage(LABELS, Frame(10, 20, 4, 3), SEEDS)


def drawn(image: LabelImage = IMAGE, **options: object) -> bytes:
    out = io.BytesIO()
    write_label_svg(out, image, color_of_label=COLORS, **options)
    return out.getvalue()


def groups(svg: bytes) -> dict[str, ET.Element]:
    return {group.attrib["id"]: group for group in ET.fromstring(svg).iter(f"{NS}g")}


def test_page_fits_the_data_and_2_percent() -> None:
    root = ET.fromstring(drawn())
    assert root.attrib["viewBox"] == "0 0 1000 760"  # 4.16 x 3.16 pixels
    assert ET.fromstring(drawn(width=500)).attrib["viewBox"] == "0 0 500 380"


def test_cells_are_paths_that_fill_the_labels() -> None:
    cells = groups(drawn())["cells"]
    assert [path.attrib["id"] for path in cells] == ["cell-1", "cell-2", "cell-3", "cell-12"]
    assert [path.attrib["fill"] for path in cells] == [CELLS[0], CELLS[1], CELLS[2], CELLS[3]]
    assert all(path.attrib["vector-effect"] == "non-scaling-stroke" for path in cells)
    scale = 1000 / 4.16
    for path in cells:
        mask, (x, y) = np.zeros(LABELS.shape, bool), (0.0, 0.0)
        for command, text in re.findall(r"([MHV])([\d. ]+)", path.attrib["d"]):
            numbers = [round(float(word) / scale - 0.08) for word in text.split()]
            if command == "M":
                x, y = numbers
                start = y
            elif command == "H":
                x = numbers[0]
            else:
                mask[min(y, numbers[0]) : max(y, numbers[0]), x:] ^= True
                y = numbers[0]
        mask[min(y, start) : max(y, start), x:] ^= True
        np.testing.assert_array_equal(mask, int(path.attrib["id"][5:]) == LABELS)


def test_many_pixels_are_refused() -> None:
    with pytest.raises(LimitError, match=r"2000"):
        drawn(LabelImage(np.ones((501, 2000), np.uint8)))
