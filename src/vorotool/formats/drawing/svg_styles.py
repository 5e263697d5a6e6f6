"""What of the style of SVG elements decides what is drawn: fill, stroke, fill rule, whether it is shown at all."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import field, replace
from typing import NamedTuple

from vorotool.formats.drawing.xml_tree import Element
from vorotool.plain import plain

_COMMENT = re.compile(r"/\*.*?(?:\*/|\Z)", re.DOTALL)  # one without an end goes on to that of the text
_SELECTOR = re.compile(r"(\*|[A-Za-z][\w-]*)?(?:([.#])([\w-]+))?")
_HAVE_STYLE = ("fill", "stroke", "fill-rule", "display", "visibility", "clip-path", "mask", "transform")
Ranked = dict[str, tuple[tuple[int, int], str]]
"""Properties, each with a value and its rank: how specific its rule is, then how late."""


class Style(NamedTuple):
    """What elements inherit."""

    fill: str = "black"
    stroke: str = "none"
    rule: str = "nonzero"
    visibility: str = "visible"

    @property
    def is_filled(self) -> bool:
        """Whether areas are painted."""
        return self.fill not in ("none", "transparent")

    @property
    def is_stroked(self) -> bool:
        """Whether lines are."""
        return self.stroke not in ("none", "transparent")

    def inherited_by(self, own: dict[str, str]) -> Style:
        """Give the style of an element in one of this style that says something of its own."""
        given = [own.get(name, "inherit") for name in ("fill", "stroke", "fill-rule", "visibility")]
        return Style(*(old if new == "inherit" else new for old, new in zip(self, given, strict=True)))


def referred(value: str) -> str | None:
    """Give what a paint, a clip or a mask refers to by url(); None if it does not."""
    _, sign, rest = value.partition("url(")
    name, end, _ = rest.partition(")")
    return name.strip(" \t\r\n'\"") if sign and end else None


@plain
class StyleSheet:
    """The rules of the style elements of a drawing."""

    # by the tag, and the class or the id with the sign before it: the value of each property, with its rank
    rules: dict[tuple[str, str], Ranked]
    others: tuple[str, ...]  # selectors that are left out: those of elements within others, and pseudo-classes
    _known: dict[Element, dict[str, str]] = field(default_factory=dict)

    @classmethod
    def of(cls, root: Element) -> StyleSheet:
        """Collect those of a drawing."""
        made = cls({}, ())
        others: list[str] = []
        count = 0
        for element in root.walk():
            for selectors, body in _rules("".join(element.text)) if element.tag == "style" else ():
                said = _declarations(body)
                for selector in (each.strip() for each in selectors.split(",") if said):
                    match = _SELECTOR.fullmatch(selector)
                    if match is None or not selector:
                        others.append(selector)
                        continue
                    tag, sign, name = (part or "" for part in match.groups())
                    weight = {"": 0, ".": 10, "#": 100}[sign] + (tag not in ("", "*"))
                    count += 1
                    ranked = made.rules.setdefault((tag if tag != "*" else "", sign + name), {})
                    ranked |= {each: ((weight, count), value) for each, value in said.items()}
        return replace(made, others=tuple(others))

    def of_element(self, element: Element) -> dict[str, str]:
        """Give what is said of an element: by its attributes, over them by rules, over these by its own style."""
        if element not in self._known:
            attributes = element.attributes
            own = {name: attributes[name].strip() for name in _HAVE_STYLE if name in attributes}
            self._known[element] = own | self._by_rules(element) | _declarations(attributes.get("style", ""))
        return self._known[element]

    def _by_rules(self, element: Element) -> dict[str, str]:
        """Give what the rules say: of each property that of the highest rank."""
        if not self.rules:
            return {}
        attributes = element.attributes
        names = {"", *(f".{name}" for name in attributes.get("class", "").split()), "#" + attributes.get("id", "")}
        best: Ranked = {}
        for key in ((tag, name) for name in names for tag in ("", element.tag)):
            for each, ranked in self.rules.get(key, {}).items():
                best[each] = max(best.get(each, ranked), ranked)
        return {name: value for name, (_, value) in best.items()}


def _rules(text: str) -> Iterator[tuple[str, str]]:
    """Give the selectors and the body of each rule that has an end."""
    *pieces, _ = _COMMENT.sub("", text).split("}")
    for piece in pieces:
        before, sign, body = piece.rpartition("{")
        selectors = before.rpartition("{")[2]
        if sign and selectors:
            yield selectors, body


def _declarations(text: str) -> dict[str, str]:
    """Give what is said of the properties that matter."""
    pairs = (part.partition(":") for part in text.split(";"))
    said = ((name.strip().lower(), value.partition("!")[0].strip()) for name, _, value in pairs)
    return {name: value for name, value in said if value and (name in _HAVE_STYLE or name == "transform-origin")}
