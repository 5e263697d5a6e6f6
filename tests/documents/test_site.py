"""The check of the built site finds what it is there to find. `make docs` builds the site, and runs it."""

import subprocess
import sys

import pytest

import check_site
from support.documents import ROOT

GOOD = '<h1 id="top">Top</h1><a href="other.html#there">there</a><img src="a.png"><a href="https://example.org">out</a>'


@pytest.fixture
def site(tmp_path):
    """A site without a fault."""
    (tmp_path / "index.html").write_text(GOOD)
    (tmp_path / "other.html").write_text('<p id="there"></p><a href="index.html#top"></a><link href="a.css">')
    (tmp_path / "a.css").write_text("p { background: url(a.png) }")
    (tmp_path / "a.png").touch()
    return tmp_path


def test_a_good_site_has_no_faults(site):
    assert list(check_site.faults(site)) == []


@pytest.mark.parametrize(
    ("name", "text", "fault"),
    [
        (
            "index.html",
            '<script src="https://example.org/a.js"></script>',
            "index.html: loads https://example.org/a.js",
        ),
        ("index.html", '<link rel="stylesheet" href="//example.org/a.css">', "index.html: loads //example.org/a.css"),
        ("index.html", '<img src="http://example.org/a.png">', "index.html: loads http://example.org/a.png"),
        ("index.html", '<a href="gone.html">', "index.html: gone.html leads nowhere"),
        ("index.html", '<a href="other.html#gone">', "index.html: other.html#gone leads nowhere"),
        ("index.html", '<img src="gone.png">', "index.html: gone.png leads nowhere"),
        ("a.css", "@import 'https://example.org/font.css'", "a.css: loads https://example.org/font.css"),
    ],
)
def test_each_fault_is_found(site, name, text, fault):
    (site / name).write_text((site / name).read_text() + text)
    assert list(check_site.faults(site)) == [fault]
    done = subprocess.run(
        [sys.executable, ROOT / "tools/check_site.py", site], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stdout) == (1, f"{fault}\n")
