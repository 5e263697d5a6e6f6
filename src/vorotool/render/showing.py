"""Values as notebooks show them: SVG, small pictures, HTML, axes of matplotlib."""

from __future__ import annotations

import io
from base64 import b64encode
from collections.abc import Callable, Iterable, Sequence
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.extras import needed
from vorotool.engines.label_images.regions import object_colors
from vorotool.errors import UsageError
from vorotool.formats.images.png_writer import write_png
from vorotool.numeric.crs import is_geographic
from vorotool.numeric.curves.inverse_functions import PI, cosine_and_sine
from vorotool.products.registry import is_of
from vorotool.render.canvas.layers import (
    Arcs,
    CurvedPolygons,
    Curves,
    Layer,
    Lines,
    Page,
    Points,
    Polygons,
    Texts,
    bounds_of,
)
from vorotool.render.canvas.styles import PictureStyle, picture_palette
from vorotool.render.drawing import Drawing, Wanted, drawing_of, drawn_part
from vorotool.render.label_images.picture import LabelPicture
from vorotool.types.fields import is_up
from vorotool.types.images import LabelImage, Raster
from vorotool.types.pixels import PixelGrid
from vorotool.types.table import Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MOST_ELEMENTS = 5_000
"""Lines, corners, discs and texts of a picture that notebooks show as SVG; of more they show pixels."""

WIDTH = 480
"""Px across such a picture."""

SIDE = 320
"""Pixels a side of a small picture of an image, at most."""

ROWS = 10
"""Of a table, as it is shown."""


# ---- drawings ------------------------------------------------------------------------------------
def _drawn(value: Any, what: str | None, layers: Sequence[str] | None, width: int) -> Drawing:
    """The picture of a value, also of what is only drawn along with others."""
    made: list[Layer]
    value = value.mesh if is_of(value, "AlphaComplex") else value
    if is_of(value, "PlanarGraph"):
        places, y_up = value.coordinates(), is_up(value.polygons)
        made = [Lines("segments", places, value.segments)]
    elif is_of(value, "PointSet", "SeedSet"):
        places, y_up = value.xy if is_of(value, "PointSet") else value.sites, is_up(value)
        made = []
    else:
        return drawing_of(value, drawn_part(value, what), Wanted(layers=layers, width=width))
    if what is not None or layers is not None:
        raise UsageError(f"a picture of a {type(value).__name__} has one layer: leave what and layers out")
    page = Page(bounds_of(places), width=width, y_up=y_up)
    made.append(Points("points", places, radius=min(max(page.spacing(len(places)) / 12, 0.3), 4.0)))
    return Drawing(page, value, lambda _: made)


def _elements(layers: Sequence[Layer]) -> int:
    """Lines, corners, discs and texts of layers."""
    counts = ("pairs", "corners", "start", "points")
    return sum(len(getattr(layer, next(name for name in counts if hasattr(layer, name)))) for layer in layers)


def svg_of(value: Any) -> str | None:
    """Give the picture of a value as SVG; None of images, and of what has too many elements."""
    if isinstance(value, LabelImage | Raster):
        return None
    drawing = _drawn(value, None, None, WIDTH)
    if _elements(drawing.layers) > MOST_ELEMENTS:
        return None
    return _written(lambda out: drawing.write(out, "svg")).decode()


def html_of(value: Any) -> str | None:
    """Give a value as a small picture of pixels, with one line below; None of what `svg_of` gives."""
    if isinstance(value, LabelImage):
        png = _labels_png(value)
    elif isinstance(value, Raster):
        png = _raster_png(value)
    else:
        drawing = _drawn(value, None, None, WIDTH)
        if _elements(drawing.layers) <= MOST_ELEMENTS:
            return None
        png = _written(lambda out: drawing.write(out, "png"))
    image = f'<img alt="" src="data:image/png;base64,{b64encode(png).decode()}">'
    return f"<figure>{image}<br>{escape(repr(value))}</figure>\n"


def _written(write: Callable[[io.BytesIO], None]) -> bytes:
    out = io.BytesIO()
    write(out)
    return out.getvalue()


def _step(shape: tuple[int, int]) -> int:
    """Every how many rows and columns a small picture takes."""
    return -(-max(shape) // SIDE)


def _labels_png(image: LabelImage) -> bytes:
    step = _step(image.shape)
    small = LabelImage(np.ascontiguousarray(image.labels[::step, ::step]))
    colors = object_colors(small)
    picture = LabelPicture(small, colors, ("cells",), PictureStyle())
    return _written(lambda out: picture.write(out, "png"))


def _raster_png(raster: Raster) -> bytes:
    step = _step(raster.shape)
    seen = _visible(raster.values[::step, ::step])
    rows = np.repeat(seen[..., None], 3, axis=2) if seen.ndim == 2 else seen
    bands = [np.ascontiguousarray(rows).reshape(len(rows), -1)]
    return _written(lambda out: write_png(out, bands, rows.shape[:2], rgb=True))


def _visible(values: NDArray[Any]) -> NDArray[np.uint8]:
    """Gray or red, green and blue, from the least value, black, to the largest."""
    if values.ndim == 3:
        values = values[..., :3] if values.shape[2] > 2 else values[..., 0]
    if values.dtype == np.uint8 and values.ndim == 3:
        return values
    real = values.astype(np.float64)
    known = real[np.isfinite(real)]
    low, high = (float(known.min()), float(known.max())) if known.size else (0.0, 0.0)
    span = high / 2 - low / 2  # no largest double overflows
    share = (real / 2 - low / 2) / span if span > 0 else np.full(real.shape, float(high > 0))
    return np.round(255 * np.nan_to_num(share, nan=0.0, posinf=1.0, neginf=0.0)).astype(np.uint8)


# ---- axes ----------------------------------------------------------------------------------------
def plotted(value: Any, ax: Axes | None = None, **style: Any) -> Axes:
    """Draw a value on axes of matplotlib; see `vorotool.types.values.Pictured`."""
    needed("matplotlib", "plot", "plots")

    if ax is None:
        ax = needed("matplotlib.pyplot", "plot", "plots").subplots()[1]
    if isinstance(value, LabelImage | Raster):
        y_up = _show_image(ax, value, style)
    else:
        what, layers = style.pop("what", None), style.pop("layers", None)
        drawing = _drawn(value, what, layers, 640)
        y_up = drawing.page.y_up
        draw_on_axes(ax, drawing.layers, drawing.page, **style)
    settle_axes(ax, y_up=y_up, is_geographic=is_geographic(value.crs))
    return ax


def _show_image(ax: Axes, image: LabelImage | Raster, style: dict[str, Any]) -> bool:
    """Show pixels, those of a map where they are on it; tells whether y goes upwards."""
    height, width = image.shape
    x, y = (image.frame.x, image.frame.y) if isinstance(image, LabelImage) else (0, 0)
    across, down = (1.0, 1.0) if isinstance(image, Raster) else map(float, reversed(image.sides.lengths))
    extent = ((x - 0.5) * across, (x + width - 0.5) * across, (y + height - 0.5) * down, (y - 0.5) * down)
    grid: PixelGrid | None = image.grid
    is_map = grid is not None and grid.transform is not None and grid.is_upright
    if is_map:
        a, _, c, _, e, f = grid.transform  # type: ignore[union-attr,misc]
        extent = (c, c + a * width, f + e * height, f)
    given: dict[str, Any] = {"extent": extent, "interpolation": "nearest"}
    pixels: NDArray[Any]
    if isinstance(image, LabelImage):
        pixels = _colored(image)
    elif image.is_color:
        pixels = _visible(image.values)
    else:
        pixels, given["cmap"] = image.values, "gray"
    ax.imshow(pixels, **{**given, **style})
    return bool(is_map and grid is not None and grid.is_north_up)


def _colored(image: LabelImage) -> NDArray[np.uint8]:
    """(H, W, 3) colors of the pixels, as pictures of label images have them."""
    labels, classes = object_colors(image)
    palette = picture_palette(int(classes.max(initial=0))).colors
    known, number = np.append(0, labels), np.append(0, classes)
    return palette[number[np.searchsorted(known, np.maximum(image.labels, 0))]]


# ---- tables --------------------------------------------------------------------------------------
def table_html(table: Table) -> str:
    """Give the first rows of a table as HTML, and how many it has."""
    shown = [_first(column) for column in table.stored().values()]
    head = "".join(f"<th>{escape(name)}</th>" for name in table)
    rows = ["".join(f"<td>{escape(text)}</td>" for text in row) for row in zip(*shown, strict=True)]
    body = "".join(f"<tr>{row}</tr>\n" for row in rows)
    more = f"{table.rows} rows" if table.rows != 1 else "1 row"
    return f"<table>\n<thead><tr>{head}</tr></thead>\n{body}</table>\n<p>{more} x {len(table)} columns</p>\n"


def _first(column: Any) -> list[str]:
    """Texts of the first fields; empty where there is no value."""
    rows = column[:ROWS]
    values = rows.tolist() if isinstance(rows, np.ndarray) else list(rows)
    return ["" if value is None or value != value else _text(value) for value in values]  # noqa: PLR0124 - NaN


def _text(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)


POINTS_A_PX = 0.72
"""Of a figure of matplotlib's usual 100 px an inch."""

FINENESS = 0.25
"""Px: how far lines may be from the curves that they stand for."""


def draw_on_axes(ax: Axes, layers: Iterable[Layer], page: Page, **style: Any) -> None:
    """Draw layers from below."""
    for each in layers:
        layer = each.chords(page.distance(FINENESS)) if isinstance(each, Arcs | CurvedPolygons) else each
        if not len(layer.points):
            continue
        if isinstance(layer, Texts):
            _write_texts(ax, layer)
        elif isinstance(layer, Points):
            side = 2 * layer.radius * POINTS_A_PX
            ax.scatter(
                *layer.points.T, **{"s": side * side, "c": layer.color, "linewidths": 0, "label": layer.name, **style}
            )
        elif isinstance(layer, Polygons):
            _fill(ax, layer, style)
        else:
            _draw_lines(ax, layer, page, style)


def _draw_lines(ax: Axes, layer: Lines | Curves, page: Page, style: dict[str, Any]) -> None:
    lines = layer.chords(page.distance(FINENESS)) if isinstance(layer, Curves) else layer
    given = {"colors": layer.color, "linewidths": layer.width * POINTS_A_PX, "capstyle": "round", "label": layer.name}
    if isinstance(layer, Curves) and layer.is_broken:
        given["linestyles"] = "dashed"
    collections = needed("matplotlib.collections", "plot", "plots")
    ax.add_collection(collections.LineCollection(lines.points[lines.pairs], **_chosen(given, style)))


def _fill(ax: Axes, layer: Polygons, style: dict[str, Any]) -> None:
    """Fill the polygons of each color as one path: each ring goes back to its first vertex."""
    path_of = needed("matplotlib.path", "plot", "plots").Path
    patch_of = needed("matplotlib.patches", "plot", "plots").PathPatch
    starts = np.asarray(layer.rings, dtype=np.int64)
    sizes = np.diff(starts)
    closed = np.insert(layer.corners, starts[1:], layer.corners[starts[:-1]])
    first = starts[:-1] + np.arange(len(sizes))
    codes = np.full(len(closed), path_of.LINETO, dtype=np.uint8)
    codes[first], codes[first + sizes] = path_of.MOVETO, path_of.CLOSEPOLY
    ring_polygon = layer.polygon_of_ring
    color = np.zeros(len(ring_polygon), dtype=np.int64)
    if layer.color_of is not None:
        color = np.asarray(layer.color_of)[ring_polygon]
    of_vertex = np.repeat(color, sizes + 1)
    edge = {"linewidth": 0} if layer.edge is None else {"linewidth": layer.width * POINTS_A_PX, "edgecolor": layer.edge}
    for number in np.unique(color).tolist():
        own = of_vertex == number
        given = {"facecolor": layer.colors[number], **edge, "label": layer.name}
        ax.add_patch(patch_of(path_of(layer.points[closed[own]], codes[own]), **_chosen(given, style)))


_SAME = {
    "linewidth": ("linewidth", "linewidths", "lw"),
    "linewidths": ("linewidth", "linewidths", "lw"),
    "colors": ("color", "colors", "edgecolor", "edgecolors"),
    "edgecolor": ("color", "edgecolor", "edgecolors", "ec"),
    "facecolor": ("color", "facecolor", "facecolors", "fc"),
}
"""What is given by the user for one of ours, by any of its names."""


def _chosen(given: dict[str, Any], style: dict[str, Any]) -> dict[str, Any]:
    """Our style, but what the user chooses."""
    kept = {name: value for name, value in given.items() if not any(each in style for each in _SAME.get(name, (name,)))}
    return {**kept, **style}


def _write_texts(ax: Axes, layer: Texts) -> None:
    for (x, y), text in zip(layer.points.tolist(), layer.texts, strict=True):
        away = (0, 0) if layer.is_centered else (0, layer.size / 2)
        ax.annotate(
            text,
            (x, y),
            xytext=away,
            textcoords="offset points",
            size=layer.size * POINTS_A_PX,
            color=layer.color,
            ha="center",
            va="center" if layer.is_centered else "bottom",
        )


def settle_axes(ax: Axes, *, y_up: bool, is_geographic: bool) -> None:
    """Give axes equal scales, longitudes by the cosine of the middle latitude, and y as in our pictures."""
    ax.autoscale_view()
    if ax.yaxis_inverted() == y_up:
        ax.invert_yaxis()
    middle = sum(ax.get_ylim()) / 2
    if is_geographic and abs(middle) < 89:
        ax.set_aspect(1 / float(cosine_and_sine(abs(middle) / 180 * PI)[0]))
    else:
        ax.set_aspect(1.0)
