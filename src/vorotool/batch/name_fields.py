"""Columns that the names of inputs tell: those of the named groups of a regular expression."""

from __future__ import annotations

import re
from collections.abc import Sequence

from vorotool.errors import UsageError
from vorotool.plain import plain

EXAMPLE = "(?P<well>[A-H]\\d+)_(?P<field>\\d+)"


@plain
class NameFields:
    """Named groups that are looked for in the names of inputs."""

    pattern: re.Pattern[str] | None = None

    @staticmethod
    def of(text: str | None) -> NameFields:
        """Read a regular expression with named groups; None has no columns."""
        if text is None:
            return NameFields()
        try:
            pattern = re.compile(text)
        except (re.error, OverflowError, RecursionError) as error:
            raise UsageError(
                f"invalid --fields {text!r}: {error}; expected a regular expression, such as '{EXAMPLE}'"
            ) from None
        if not pattern.groupindex:
            raise UsageError(f"invalid --fields {text!r}: no group has a name; write (?P<name>...), as in '{EXAMPLE}'")
        return NameFields(pattern)

    @property
    def names(self) -> list[str]:
        """The names of the groups, in order."""
        return [] if self.pattern is None else list(self.pattern.groupindex)

    def values(self, source: str) -> list[str | None]:
        """Return what the groups match in the path of an input; None where they match nothing."""
        found = None if self.pattern is None else self.pattern.search(source.replace("\\", "/"))
        return [None if found is None else found[name] for name in self.names]

    def note_unmatched(self, sources: Sequence[str]) -> str | None:
        """Say which names do not match; None if all do."""
        if self.pattern is None:
            return None
        left = [source for source in sources if self.pattern.search(source.replace("\\", "/")) is None]
        if not left:
            return None
        return (
            f"--fields does not match {len(left)} of {len(sources)} inputs, such as {left[0]}: their fields are empty"
        )
