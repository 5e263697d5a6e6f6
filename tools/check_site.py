"""Check a built site: `tools/check_site.py FOLDER`.

Nothing is loaded from elsewhere, and every link within the site leads to a file, and to a place in it.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

LOADED = {"script": "src", "img": "src", "source": "src", "iframe": "src", "object": "data", "link": "href"}
"""What a browser loads with a page, and where the address stands."""
FROM_STYLES = re.compile(r"(?:url\(|@import)\s*['\"]?((?:https?:)?//[^'\")\s]+)")


@dataclass
class Page(HTMLParser):
    """A page as it is read: its anchors, links, and what it loads."""

    anchors: set[str] = field(default_factory=set)
    links: list[str] = field(default_factory=list)
    loaded: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        super().__init__()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Note what a tag says."""
        said = dict(attrs)
        self.anchors |= {value for value in (said.get("id"), said.get("name")) if value}
        if tag == "a" and said.get("href"):
            self.links.append(said["href"] or "")
        if tag in LOADED and said.get(LOADED[tag]) and said.get("rel") not in ("canonical", "author", "copyright"):
            self.loaded.append(said[LOADED[tag]] or "")


def read(path: Path) -> Page:
    """A page of the site."""
    page = Page()
    page.feed(path.read_text(encoding="utf-8"))
    return page


def faults(folder: Path) -> Iterator[str]:
    """What is wrong with a site, in words."""
    pages = {path.resolve(): read(path) for path in sorted(folder.rglob("*.html")) if "_downloads" not in path.parts}
    for path, page in pages.items():
        name = path.relative_to(folder.resolve())
        for address in page.loaded:
            if urlsplit(address).scheme in ("http", "https") or address.startswith("//"):
                yield f"{name}: loads {address}"
        for address in [*page.links, *page.loaded]:
            parts = urlsplit(address)
            if not parts.scheme and not parts.netloc and not leads_somewhere(pages, path, parts.path, parts.fragment):
                yield f"{name}: {address} leads nowhere"
    for path in sorted(folder.rglob("*.css")):
        for address in FROM_STYLES.findall(path.read_text(encoding="utf-8")):
            yield f"{path.relative_to(folder)}: loads {address}"


def leads_somewhere(pages: dict[Path, Page], page: Path, path: str, fragment: str) -> bool:
    """Whether a link of a page leads to a file, and to an anchor of it."""
    target = (page.parent / unquote(path)).resolve() if path else page
    anchors = pages[target].anchors if target in pages else {unquote(fragment)}
    return target.exists() and (not fragment or unquote(fragment) in anchors)


def main() -> None:
    """Print what is wrong, and count the pages."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    folder = parser.parse_args().folder
    found = list(faults(folder))
    sys.stdout.write("".join(f"{fault}\n" for fault in found))
    if found or not (folder / "index.html").exists():
        sys.exit(1)


if __name__ == "__main__":
    main()
