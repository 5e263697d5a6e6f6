"""Values of options: a function each takes the text that is typed and returns the value."""

from __future__ import annotations


class UnexpectedError(ValueError):
    """A text that is no value of an option; carries what was expected."""
