"""A drawing in SVG as its elements refer to each other: what is shown, how often, and what cannot be."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

from vorotool.errors import INPUT_FORMAT, InputError, LimitError
from vorotool.formats.drawing.svg_shapes import SHAPES
from vorotool.formats.drawing.svg_styles import Style, StyleSheet, referred
from vorotool.formats.drawing.xml_tree import Element, parse_xml
from vorotool.formats.parsing.reader_options import shortened
from vorotool.types.values import counted

NAMESPACE = "http://www.w3.org/2000/svg"
_LINK = "http://www.w3.org/1999/xlink}href"
GROUPS = ("g", "a", "svg", "switch")
"""Elements that show what is in them."""
MOST_REPEATED = 2**17
"""Elements that are drawn, or pieces of curves, where some are used many times: a kilobyte could ask for billions."""
_DEEPEST = 250
_REFUSED = {
    "text": "is not outlined: convert it to paths, in Inkscape with Path > Object to Path",
    "image": "is not a shape: remove the image, and read it as a separate file",
    "foreignObject": "holds elements that are not SVG: remove them, or save the drawing as plain SVG",
}
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
    def check_drawn(self, element: Element) -> None:
        """Refuse what would be drawn and is no shape."""
        if element.tag in _REFUSED:
            raise InputError(f"{self.place(element)} {_REFUSED[element.tag]}")

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
