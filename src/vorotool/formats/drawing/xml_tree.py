"""The elements of an XML file, parsed without anything that it asks for: no entities, no other files."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any
from xml.parsers import expat

from vorotool.errors import InputError, LimitError, VorotoolError

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
