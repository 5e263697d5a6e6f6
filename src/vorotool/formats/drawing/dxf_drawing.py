"""A DXF drawing in memory, whose bytes depend only on what is added to it; and the import of ezdxf."""

from __future__ import annotations

import io
import logging
import sys
from collections.abc import Sequence
from configparser import ConfigParser
from typing import Any, BinaryIO

from vorotool.convert.extras import needed
from vorotool.numeric.arrays import Floats
from vorotool.types.fields import DOWN, YAxis

UNITS = {
    **{1: "in", 2: "ft", 3: "mi", 4: "mm", 5: "cm", 6: "m", 7: "km", 9: "mil", 10: "yd"},
    **{11: "Å", 12: "nm", 13: "um", 14: "dm", 21: "ftUS"},
}
"""Units of length by their numbers in the header."""
_NUMBERS = {name: number for number, name in UNITS.items()} | {"µm": 13, "μm": 13}
_VERSION = "R2000"
_COLORS = (1, 5, 3, 6, 4, 2, 30, 7)
"""Of layers, in the order in which they come: red, blue, green, magenta, cyan, yellow, orange, black on white."""
_PLANAR = 8
_FORBIDDEN = '<>/\\":;?*|=`,'


class DxfDrawing:
    """Entities on layers, in the coordinates of the data."""

    def __init__(self, *, unit: str | None, y_axis: YAxis) -> None:
        ezdxf = self._library = ezdxf_module()
        self._turn = -1.0 if y_axis == DOWN else 1.0
        with self._fixed():
            self._document = ezdxf.new(_VERSION, units=_NUMBERS.get(unit or "", 0))
        self._space = self._document.modelspace()
        self._layers: dict[str, str] = {}

    def _fixed(self) -> Any:
        return _FixedMetadata(self._library.options)

    def _on(self, layer: str) -> dict[str, Any]:
        """Attributes of what is on a layer, which is made when it is first there."""
        if layer not in self._layers:
            name = "".join("_" if sign in _FORBIDDEN or not sign.isprintable() else sign for sign in layer)[:255] or "0"
            if name not in self._document.layers:
                self._document.layers.add(name, color=_COLORS[len(self._layers) % len(_COLORS)])
            self._layers[layer] = name
        return {"layer": self._layers[layer]}

    def _placed(self, points: Floats) -> list[tuple[float, ...]]:
        placed = points + 0.0
        placed[:, 1] = placed[:, 1] * self._turn + 0.0  # no -0
        return [tuple(point) for point in placed.tolist()]

    def polyline(
        self, layer: str, points: Floats, *, is_closed: bool = False, bulges: Sequence[float] | None = None
    ) -> None:
        """Add straight lines along points, or arcs, by the bulge at the start of each."""
        placed = self._placed(points)
        if len(placed) == 2 and not is_closed and bulges is None:
            self._space.add_line(*placed, dxfattribs=self._on(layer))
        elif len(placed) > 1:
            turned = [bulge * self._turn for bulge in bulges or [0.0] * len(placed)]
            rows = [(*point, bulge) for point, bulge in zip(placed, turned, strict=True)]
            self._space.add_lwpolyline(rows, format="xyb", close=is_closed, dxfattribs=self._on(layer))
        elif placed:
            self._space.add_point(placed[0], dxfattribs=self._on(layer))

    def parabolas(self, layer: str, points: Floats) -> None:
        """Add parabolas that follow each other, as one spline of degree 2: end, control point, end, and so on."""
        self._spline(layer, points, 2)

    def cubics(self, layer: str, points: Floats) -> None:
        """Add cubic curves that follow each other, as one spline of degree 3: end, two control points, end."""
        self._spline(layer, points, 3)

    def _spline(self, layer: str, points: Floats, degree: int) -> None:
        spline = self._space.add_spline(degree=degree, dxfattribs=self._on(layer))
        count = len(points) // degree
        spline.control_points = [(x, y, 0.0) for x, y in self._placed(points)]
        spline.knots = [0.0, *(float(k) for k in range(count + 1) for _ in range(degree)), float(count)]
        spline.dxf.flags = _PLANAR

    def line_in_space(self, layer: str, points: Floats) -> None:
        """Add straight lines along points with heights."""
        if len(points) > 1:
            self._space.add_polyline3d(self._placed(points), dxfattribs=self._on(layer))

    def points(self, layer: str, points: Floats) -> None:
        """Add places, which may have heights."""
        attributes = self._on(layer)
        for point in self._placed(points):
            self._space.add_point(point, dxfattribs=attributes)

    def write(self, out: BinaryIO) -> None:
        """Write all of it."""
        text = io.StringIO()
        with self._fixed():
            self._document.write(text)
        out.write(text.getvalue().encode(self._document.output_encoding, errors="dxfreplace"))


class _FixedMetadata:
    """While this lasts, drawings have no times, names of programs, and random numbers in them."""

    def __init__(self, options: Any) -> None:
        self._options = options

    def __enter__(self) -> None:
        self._before = self._options.write_fixed_meta_data_for_testing
        self._options.write_fixed_meta_data_for_testing = True

    def __exit__(self, *_: object) -> None:
        self._options.write_fixed_meta_data_for_testing = self._before


def ezdxf_module(module: str = "ezdxf") -> Any:
    """Import ezdxf, or a module of it."""
    if "ezdxf" in sys.modules:
        return needed(module, "cad", "DXF drawings")
    logger = logging.getLogger("ezdxf")
    if not logger.handlers:  # without one, what it ignores in damaged drawings goes to standard error
        logger.addHandler(logging.NullHandler())
    own = ConfigParser.read
    try:
        ConfigParser.read = lambda *_, **__: []  # type: ignore[method-assign]
        return needed(module, "cad", "DXF drawings")
    finally:
        ConfigParser.read = own  # type: ignore[method-assign]
