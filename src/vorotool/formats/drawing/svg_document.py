"""A drawing in SVG: its XML, the styles of its elements, and what is shown, how often."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, NamedTuple
from xml.parsers import expat

from vorotool.errors import INPUT_FORMAT, InputError, LimitError, VorotoolError
from vorotool.formats.drawing.svg_shapes import SHAPES
from vorotool.formats.parsing.reader_options import shortened
from vorotool.frozen import frozen
from vorotool.types.values import counted

NAMESPACE = "http://www.w3.org/2000/svg"
_LINK = "http://www.w3.org/1999/xlink}href"
GROUPS = ("g", "a", "svg", "switch")
"""Elements that show what is in them."""
MOST_REPEATED = 2**17
"""Elements that are drawn, or pieces of curves, where some are used many times: a kilobyte could ask for billions."""
_DEEPEST = 250
NO_SHAPES = {
    "text": "only its font has its outline; to read it convert it to paths, in Inkscape with Path > Object to Path",
    "image": "read it as a file of its own",
    "foreignObject": "it is not SVG",
}
"""Elements that are skipped with a note, and what a user may do."""
_CLIPPED = {
    "clip-path": "is clipped: apply the clip to it, in Inkscape with Object > Clip > Release and Path > Intersection",
    "mask": "has a mask: apply it, in Inkscape with Object > Mask > Release and Path > Intersection",
}


@dataclass
class Document:
    """A drawing."""

    name: str
    root: Element  # its outermost element
    hidden: int = 0  # counts elements that are not displayed
    skipped: dict[str, list[int]] = field(default_factory=dict)  # lines of elements that are no shapes, by their tags
    _most: int = 0
    _counted: dict[Element, tuple[int, int] | None] = field(default_factory=dict)

    @classmethod
    def parsed(cls, name: str, data: bytes) -> Document:
        """Parse a file, and count what it shows before anything of it is made."""
        root = parse_xml(name, data, NAMESPACE)
        if root.tag != "svg":
            raise InputError(
                f"{name} is not an SVG file: it begins with <{root.tag[:40]}>; name the format with {INPUT_FORMAT}"
            )
        made = cls(name, root, _most=max(MOST_REPEATED, sum(1 for _ in root.walk())))
        made._count(root, 0)
        return made

    @cached_property
    def by_id(self) -> dict[str, Element]:
        """Elements by their ids, of equal ones the first."""
        found: dict[str, Element] = {}
        for element in self.root.walk():
            if "id" in element.attributes:
                found.setdefault(element.attributes["id"], element)
        return found

    @cached_property
    def styles(self) -> StyleSheet:
        """The rules of its style elements."""
        return StyleSheet.of(self.root)

    def place(self, element: Element) -> str:
        """Words for the place of an element: ``logo.svg, line 3, path #a``."""
        identity = element.attributes.get("id")
        return f"{self.name}, line {element.line}, {element.tag}{'' if identity is None else f' #{identity[:40]}'}"

    def target(self, use: Element) -> Element:
        """Give what an element uses."""
        link = use.attributes.get("href", use.attributes.get(_LINK, ""))
        if link and not link.startswith("#"):
            raise InputError(
                f"{self.place(use)}: {shortened(link)} is outside the drawing and is never loaded; copy it into the "
                "drawing"
            )
        found = self.by_id.get(link[1:])
        if found is None:
            raise InputError(
                f"{self.place(use)}: the element {link or '#'} does not exist; correct or remove the reference"
            )
        return found

    def shown(self, element: Element) -> list[Element]:
        """Give the children that are drawn: of a switch the first that asks for nothing."""
        if element.tag != "switch":
            return element.children
        free = (each for each in element.children if not _asks(each))
        return [first] if (first := next(free, None)) is not None else []

    def _count(self, element: Element, level: int) -> tuple[int, int]:
        """Elements that are drawn for one, and how deep: each use counts what it uses again."""
        known = self._counted.get(element, (0, 0))
        if known is None:
            raise InputError(f"{self.place(element)} is used within itself; remove that use")
        if element not in self._counted:
            self._counted[element] = None
            parts = self.shown(element) if element.tag in (*GROUPS, "symbol") else []
            if element.tag == "use":
                parts = [self.target(element)]
            if level + 1 > _DEEPEST:
                raise self._too_deep(element)
            counts = [self._count(part, level + 1) for part in parts]
            known = (1 + sum(count for count, _ in counts), 1 + max((depth for _, depth in counts), default=0))
            self._counted[element] = known
        if known[0] > self._most:
            raise LimitError(
                f"{self.place(element)}: more than {self._most} elements are drawn for it, because some are used many "
                "times; split the drawing"
            )
        if level + known[1] > _DEEPEST:
            raise self._too_deep(element)
        return known

    def _too_deep(self, element: Element) -> InputError:
        return InputError(
            f"{self.place(element)}: elements are nested more than {_DEEPEST} deep by what they use; ungroup them"
        )

    # ---- what is refused --------------------------------------------------------------------------
    def note_skipped(self, note: Callable[[str], None]) -> None:
        """Count hidden elements and those that are no shapes."""
        if self.hidden:
            note(f"{self.name}: {counted(self.hidden, 'hidden element')} skipped")
        for tag, lines in self.skipped.items():
            first = f"in line {lines[0]}" if len(lines) == 1 else f"the first in line {lines[0]}"
            note(f"{self.name}: {counted(len(lines), tag)} skipped, {first}: {NO_SHAPES[tag]}")

    def check_own(self, element: Element, own: dict[str, str], style: Style) -> None:
        """Refuse what makes an element another shape than its curves are."""
        for name, advice in _CLIPPED.items():
            if own.get(name, "none") not in ("none", ""):
                raise InputError(f"{self.place(element)} {advice}")
        if "transform-origin" in own:
            raise InputError(f"{self.place(element)} has a transform-origin: save the drawing as plain SVG")
        for paint in (style.fill, style.stroke) if element.tag in SHAPES else ():
            name = (referred(paint) or "")[1:]
            if name in self.by_id and self.by_id[name].tag == "pattern":
                raise InputError(
                    f"{self.place(element)} is painted with a pattern (#{name[:40]}): convert it to objects, in "
                    "Inkscape with Object > Pattern > Pattern to Objects, or give it a flat fill"
                )

    def note_styles(self, note: Callable[[str], None]) -> None:
        """Say what of the rules is left out."""
        if self.styles.others:
            note(
                f"{self.name}: {counted(len(self.styles.others), 'style rule')} skipped: only selectors of a tag, a "
                f"class or an id are supported, not {shortened(self.styles.others[0])}"
            )


def _asks(element: Element) -> bool:
    """Whether an element of a switch is for programs with extensions, or of a language."""
    names = element.attributes
    return bool(names.get("requiredExtensions") or names.get("systemLanguage")) or element.tag == "foreignObject"


# ---- styles --------------------------------------------------------------------------------------
_COMMENT = re.compile(r"/\*.*?(?:\*/|\Z)", re.DOTALL)  # one without an end goes on to that of the text
_SELECTOR = re.compile(r"(\*|[A-Za-z][\w-]*)?(?:([.#])([\w-]+))?")
_HAVE_STYLE = ("fill", "stroke", "fill-rule", "display", "visibility", "opacity", "clip-path", "mask", "transform")
_NO_OPACITY = r"[+-]?(0+\.?0*|\.0+)%?"
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


def is_hidden(own: dict[str, str]) -> bool:
    """Whether an element of this style shows nothing, nor do those within it."""
    return (
        own.get("display", "").lower() == "none"
        or re.fullmatch(_NO_OPACITY, own.get("opacity", "").strip()) is not None
    )


def referred(value: str) -> str | None:
    """Give what a paint, a clip or a mask refers to by url(); None if it does not."""
    _, sign, rest = value.partition("url(")
    name, end, _ = rest.partition(")")
    return name.strip(" \t\r\n'\"") if sign and end else None


@frozen
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


# ---- XML -----------------------------------------------------------------------------------------
MOST_LEVELS = 200
"""Of elements in elements; drawings have a dozen."""

MOST_ELEMENTS = 2**21
"""Of a file."""

_LONGEST_NAMESPACE = 255
"""The name of every element and attribute in a namespace begins with it."""


@dataclass(eq=False, slots=True)
class Element:
    """An element."""

    tag: str  # its name; one of another namespace begins with this and a brace
    attributes: dict[str, str]  # as given; those of a namespace begin with it and a brace
    line: int  # of the file, from 1
    children: list[Element] = field(default_factory=list)
    text: list[str] = field(default_factory=list)  # pieces of the text right in it

    def walk(self) -> Iterator[Element]:
        """Give it and all that is in it, in the order of the file."""
        waiting = [self]
        while waiting:
            element = waiting.pop()
            yield element
            waiting.extend(reversed(element.children))


def parse_xml(name: str, data: bytes, namespace: str) -> Element:
    """Parse a file; elements of its namespace, and of none, go by their bare names."""
    builder = _Builder(name, f"{namespace}}}")
    parser = expat.ParserCreate(namespace_separator="}")
    builder.parser = parser
    parser.buffer_text = True
    parser.specified_attributes = True  # no defaults, which a declaration would give to every element
    parser.StartNamespaceDeclHandler = builder.check_namespace
    parser.StartElementHandler = builder.start
    parser.EndElementHandler = builder.end
    parser.CharacterDataHandler = builder.characters
    parser.EntityDeclHandler = builder.refuse_entity
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        what = expat.ErrorString(error.code)
        raise InputError(
            f"{name}, line {error.lineno}: the file is not well-formed XML ({what}); save the drawing again"
        ) from None
    except VorotoolError:
        raise
    except (ValueError, LookupError) as error:  # encodings that are not known
        raise InputError(f"{name} is not readable XML ({error}); save the drawing again as UTF-8") from None
    assert builder.root is not None  # the parser refuses files without elements
    return builder.root


class _Builder:
    """What the parser tells of."""

    def __init__(self, name: str, namespace: str) -> None:
        self.name, self.namespace = name, namespace
        self.parser: Any = None
        self.root: Element | None = None
        self.open: list[Element] = []
        self.count = 0

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        self.count += 1
        line = self.parser.CurrentLineNumber
        if self.count > MOST_ELEMENTS:
            raise LimitError(f"{self.name} holds more than {MOST_ELEMENTS} elements: split the drawing")
        if len(self.open) >= MOST_LEVELS:
            raise InputError(
                f"{self.name}, line {line}: elements are nested more than {MOST_LEVELS} deep; ungroup the drawing"
            )
        element = Element(tag.removeprefix(self.namespace), attributes, line)
        if self.open:
            self.open[-1].children.append(element)
        else:
            self.root = element
        self.open.append(element)

    def end(self, tag: str) -> None:
        self.open.pop()

    def characters(self, text: str) -> None:
        if self.open[-1].tag == "style":
            self.open[-1].text.append(text)

    def check_namespace(self, _: str | None, name: str | None) -> None:
        if name is not None and len(name) > _LONGEST_NAMESPACE:
            raise InputError(
                f"{self.name}, line {self.parser.CurrentLineNumber}: the namespace {name[:40]!r}… has more than "
                f"{_LONGEST_NAMESPACE} characters; save the drawing as plain SVG"
            )

    def refuse_entity(self, entity: str, *_: object) -> None:
        raise InputError(
            f"{self.name}, line {self.parser.CurrentLineNumber}: the drawing declares an entity ({entity[:40]}), and "
            "entities are not expanded; save it as plain SVG"
        )
