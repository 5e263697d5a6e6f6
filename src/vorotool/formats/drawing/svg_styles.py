"""What of the style of SVG elements decides what is drawn: fill, stroke, fill rule, whether it is shown at all."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import NamedTuple

from vorotool.formats.drawing.xml_tree import Element

_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
_RULE = re.compile(r"([^{}]+)\{([^{}]*)\}")
_SELECTOR = re.compile(r"(\*|[A-Za-z][\w-]*)?(?:([.#])([\w-]+))?")
_URL = re.compile(r"url\(\s*['\"]?([^'\")]*)['\"]?\s*\)")
_HAVE_STYLE = ("fill", "stroke", "fill-rule", "display", "visibility", "clip-path", "mask", "transform")


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
        """Give the style of an element in one of this style that says something of its own.

        Examples
        --------
        >>> Style().inherited_by({"fill": "none", "stroke": "inherit"})
        Style(fill='none', stroke='none', rule='nonzero', visibility='visible')
        """
        given = [own.get(name, "inherit") for name in ("fill", "stroke", "fill-rule", "visibility")]
        return Style(*(old if new == "inherit" else new for old, new in zip(self, given, strict=True)))


def referred(value: str) -> str | None:
    """Give what a paint, a clip or a mask refers to by url(); None if it does not.

    Examples
    --------
    >>> referred("url(#a) none"), referred("none")
    ('#a', None)
    """
    match = _URL.search(value)
    return None if match is None else match[1]


@dataclass(frozen=True)
class StyleSheet:
    """The rules of the style elements of a drawing.

    Parameters
    ----------
    rules : tuple of (int, str, str, dict)
        How much each counts, the tag it is for, its class or id with the sign before it, and what it says.
    others : tuple of str
        Selectors that are left out: those of elements within others, and pseudo-classes.
    """

    rules: tuple[tuple[int, str, str, dict[str, str]], ...]
    others: tuple[str, ...]

    @classmethod
    def of(cls, root: Element) -> StyleSheet:
        """Collect those of a drawing."""
        rules: list[tuple[int, str, str, dict[str, str]]] = []
        others: list[str] = []
        for element in root.walk():
            if element.tag != "style":
                continue
            for selectors, body in _RULE.findall(_COMMENT.sub("", "".join(element.text))):
                said = _declarations(body)
                for selector in (each.strip() for each in selectors.split(",") if said):
                    match = _SELECTOR.fullmatch(selector)
                    if match is None or not selector:
                        others.append(selector)
                        continue
                    tag, sign, name = (part or "" for part in match.groups())
                    weight = {"": 0, ".": 10, "#": 100}[sign] + (tag not in ("", "*"))
                    rules.append((weight, tag if tag != "*" else "", sign + name, said))
        return cls(tuple(sorted(rules, key=lambda rule: rule[0])), tuple(others))

    def of_element(self, element: Element) -> dict[str, str]:
        """Give what is said of an element: by its attributes, over them by rules, over these by its own style."""
        attributes = element.attributes
        own = {name: attributes[name].strip() for name in _HAVE_STYLE if name in attributes}
        names = {f".{name}" for name in attributes.get("class", "").split()} | {"#" + attributes.get("id", "")}
        for _, tag, name, said in self.rules:
            if tag in ("", element.tag) and (not name or name in names):
                own |= said
        return own | _declarations(attributes.get("style", ""))


def _declarations(text: str) -> dict[str, str]:
    """Give what is said of the properties that matter."""
    pairs = (part.partition(":") for part in text.split(";"))
    said = ((name.strip().lower(), value.partition("!")[0].strip()) for name, _, value in pairs)
    return {name: value for name, value in said if value and (name in _HAVE_STYLE or name == "transform-origin")}
