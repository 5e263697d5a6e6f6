"""docs/images/front.svg, the picture of the README, is what `make front` draws."""

import shutil
import subprocess
import xml.etree.ElementTree as ET

import pytest

from support.documents import ROOT

PICTURE = ROOT / "docs/images/front.svg"


def test_it_is_drawn_by_its_rule(tmp_path, warm):
    if not (ROOT / "build" / ".installed").exists() or shutil.which("make") is None:
        pytest.skip("it is drawn by make, in an environment made by make")
    asked = ["make", "--silent", "front", f"FRONT_FOLDER={tmp_path}", f"FRONT_PICTURE={tmp_path}/front.svg"]
    asked.append(f"VOROTOOL={shutil.which('vorotool', path=warm['PATH'])}")
    subprocess.run(asked, cwd=ROOT, check=True, capture_output=True)
    assert (tmp_path / "front.svg").read_bytes() == PICTURE.read_bytes()


def test_it_has_four_panels_on_a_card_and_is_small():
    root = ET.parse(PICTURE).getroot()
    svg = "{http://www.w3.org/2000/svg}"
    assert root.find(f"{svg}rect").get("fill") == "#ffffff"
    assert len(root.findall(f"{svg}g/{svg}svg")) == len(root.findall(f"{svg}g/{svg}text")) == 4
    assert PICTURE.stat().st_size < 300_000
