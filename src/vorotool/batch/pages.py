"""Pages of stacks, each of which is an input of a batch."""

from __future__ import annotations


class PageName(str):
    """One page of a stack as an input: its words are those of messages and tables."""

    path: str
    page: int  # which page, from 0

    def __new__(cls, text: str = "", path: str = "", page: int = 0) -> PageName:
        """Make the name."""
        made = super().__new__(cls, text)
        made.path, made.page = path, page
        return made

    @classmethod
    def of(cls, path: str, page: int) -> PageName:
        """Name a page of a file."""
        return cls(f"{path}, page {page}", path, page)


def path_of(source: str) -> str:
    """Give the file that an input is in."""
    return source.path if isinstance(source, PageName) else source
