"""What the README and the pages of docs say of each other, and of the package, is so."""

import re

import pytest

import vorotool
from cli_reference import reference
from support.documents import DOCUMENTS, FENCE, ROOT, read

TEXT = ("docs/architecture.md",)
"""Its block of text is a drawing."""


def test_every_block_is_of_a_kind_that_is_run():
    known = {"console", "python", "make", "sh", "{toctree}", "{include}", "{eval-rst}"}
    for name in DOCUMENTS:
        opened = re.findall(r"^```([^\n]*)", read(name), re.MULTILINE)[::2]
        assert {words.split(" ")[0] for words in opened} <= (known | {"text"} if name in TEXT else known), name


def test_the_readme_is_short():
    readme = read("README.md")
    assert readme.count("\n") <= 150
    assert re.findall(r"^```sh\n(make figures .*)\n(make test .*)\n```", readme, re.MULTILINE)


def links(name):
    """Paths that a document leads to, with the headings that are meant in them."""
    text = FENCE.sub("", read(name))
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        if not target.startswith("https://"):
            path, _, heading = target.partition("#")
            yield ((ROOT / name).parent / path).resolve() if path else ROOT / name, heading


def headings(path):
    """Anchors of the headings of a document, as GitHub and the site make them."""
    page = reference() if path == ROOT / "docs/cli.md" else path.read_text(encoding="utf-8")
    text = re.sub(r"^```.*?^```", "", page, flags=re.MULTILINE | re.DOTALL)
    titles = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


@pytest.mark.parametrize("name", DOCUMENTS)
def test_links_lead_somewhere(name):
    for path, heading in links(name):
        made = ROOT / "build/figures"
        assert path.exists() or made in path.parents, path
        assert not heading or heading in headings(path), f"{path}#{heading}"


def test_every_page_is_three_links_from_the_readme():
    reached = {ROOT / "README.md"}
    for _ in range(3):
        reached |= {path for name in reached if name.suffix == ".md" for path, _ in links(name.relative_to(ROOT))}
    for user in ("microscopy", "maps", "drawing", "geometry", "shell"):
        assert ROOT / f"docs/start/{user}.md" in {path for path, _ in links("README.md")}
    included = {ROOT / f"docs/{name}.md" for name in ("index", "changes", "contributing", "data")}
    assert {ROOT / name for name in DOCUMENTS} - included <= reached


def test_the_library_is_documented_by_topic():
    pages = (ROOT / "docs/reference/python").glob("*.md")
    named = [name for page in pages for name in re.findall(r"^\.\. auto\w+:: (\w+)$", page.read_text(), re.MULTILINE)]
    assert sorted(named) == sorted(name for name in vorotool.__all__ if name != "__version__")


def test_pictures_of_start_pages_are_drawn_there():
    for page in (ROOT / "docs/start").glob("*.md"):
        text = page.read_text(encoding="utf-8")
        for picture in re.findall(r"!\[[^]]+\]\(\.\./images/([^)]+)\)", text):
            assert f" -o {picture}\n" in text.partition("![")[0]
