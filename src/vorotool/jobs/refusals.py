"""Refusals by the tables of options, and contradictions between options and the input."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from vorotool.errors import InputError, UsageError, meant
from vorotool.jobs.options import OF_SHAPES, Measured, Options
from vorotool.jobs.pixel_sizes import unit_of_grid
from vorotool.jobs.targets import Target
from vorotool.jobs.units import check_frame
from vorotool.numeric.length_units import unit_of
from vorotool.products.commands import COMMANDS
from vorotool.products.formats import ANIMATIONS, FORMATS, PICTURES, SHOWN_AS, TABLES, resolved
from vorotool.products.options import flag, options_of
from vorotool.products.options.row import Option
from vorotool.products.options.rules import EXCLUDING, NEEDING, ONLY
from vorotool.products.registry import NAMING_FEATURES, PRODUCTS

if TYPE_CHECKING:
    from fractions import Fraction

    from vorotool.jobs.run_log import Run
    from vorotool.jobs.units import PixelSize
    from vorotool.types.pixels import PixelGrid
    from vorotool.types.volumes.volume import VoxelGrid

_DRAWN = "?may_be_drawn"
_KINDS = {
    ".picture": "pictures (-f {})",
    ".page": "pictures (-f {})",
    ".amounts": "pictures of thickness",
    ".sized": "pictures (-f svg)",
    ".animation": "animations (-f gif, apng, webp)",
    ".coordinates": "coordinates in tables, GeoJSON, WKT and GIS files, not in drawings",
    ".digits": "formats of text, such as csv",
    ".parts": "tables and GeoJSON whose rows are parts of features or pairs (--what branches, points, edges, ...)",
    ".curves": "formats that have no curves, such as GeoJSON and WKT",
    _DRAWN: "inputs that are drawings",
    ".ome-zarr": "OME-Zarr (-o NAME.ome.zarr)",
}
"""Words for kinds of outputs, with a place for the formats of pictures."""


def check_options(o: Options, targets: Sequence[Target]) -> None:
    """Refuse what the table of options and its rules exclude, and what no output shows."""
    rows = options_of(o.command)
    given = {name: row for name, row in rows.items() if getattr(o, name) is not None and getattr(o, name) != row.unset}
    # conditions that hold: see `vorotool.products.options.rules`
    held = {"inputs", *given, *(f"what:{what}" for what in o.what), *(f"layer:{layer}" for layer in o.layers or ())}
    held |= {f"{name}={value}" for name, value in vars(o).items() if isinstance(value, str)}
    held |= {each for each in _PROPERTIES if getattr(o, each[1:])}
    held |= {each for each, names in ONLY.items() if names.issuperset(o.what)}
    for target in targets:
        held |= _kinds_of(o, target)
    for rules in (EXCLUDING, NEEDING):
        for rule in (each for each in rules if o.command in each.commands.split()):
            these, others = (
                [each for each in conditions.split() if held.issuperset(each.split("+"))]
                for conditions in (rule.these, rule.others)
            )
            if these and others and rules is EXCLUDING:
                first, second = _words(o, these[0]), _words(o, others[0])
                raise UsageError(f"{second} cannot be combined with {first}: {rule.why}; {rule.instead}")
            if these and not others and rules is NEEDING:
                possible = [each for each in rule.others.split() if not each.startswith("?")]
                words = [f"{_words(o, each)} {rows[each].metavar if each in rows else ''}" for each in possible]
                needed = " or ".join(each.rstrip() for each in words)
                what = o.command if these[0] == "inputs" else _words(o, these[0])
                raise UsageError(f"{what} needs {needed}" + (f": {rule.why}" if rule.why else ""))
    for name, row in given.items():
        shown_by = [word if any(sign in word for sign in "=:.?") else f"what:{word}" for word in row.acts_on.split()]
        is_shown = not shown_by or not held.isdisjoint(shown_by) or (_DRAWN in shown_by and o.may_be_drawn)
        if not is_shown:
            raise UsageError(f"{flag(o.command, name, getattr(o, name))} applies only to {_where(o, row)}")
    if o.window is not None or o.frame is not None:
        _check_frames(o)
    if o.layers or o.colors or o.line_widths:
        _check_layers(o, targets)
    if COMMANDS[o.command].check:
        resolved(COMMANDS[o.command].check)(o, targets)


def _kinds_of(o: Options, target: Target) -> set[str]:
    """Give what an output is, as conditions name it: with its result, and without."""
    product = o.products[target.what]
    fmt, shown = FORMATS[target.fmt], SHOWN_AS.get(target.fmt, target.fmt)
    layers = product.layers.get(shown) if shown in PICTURES else None
    is_drawn = target.what != "diagram" or o.command != "tessellate" or o.draws_diagram
    is_picture = bool(layers) and target.what != "thickness" and is_drawn
    is_sized = shown == "svg" if o.command == "tessellate" else is_picture or layers == ()
    facts = {
        target.fmt: True,
        "picture": is_picture,
        "png-picture": is_picture and target.fmt == "png",
        "page": is_picture and o.overlay is None,
        "amounts": target.what == "thickness" and target.fmt == "png",
        "sized": layers is not None and is_sized,
        "animation": target.fmt in ANIMATIONS,
        "coordinates": fmt.has_digits or bool(fmt.made_from),
        "digits": fmt.has_digits,
        "curves": product.is_curved and fmt.flattens,
        "parts": target.what in NAMING_FEATURES
        and (target.fmt in (*TABLES, "geojson", "graphml") or bool(fmt.made_from)),
        "ome-zarr": target.fmt == "zarr" and target.path.lower().endswith(".ome.zarr"),
    }
    return {f"{what}.{name}" for name, holds in facts.items() if holds for what in ("", target.what)}


# ---- words ---------------------------------------------------------------------------------------
_PROPERTIES = {
    "?is_of_space": "an input with z",
    "?is_digital": "--method digital",
    "?has_pixel_size": "--pixel-size",
    "?is_automatic": "the automatic choice of r",
    "?has_bands_on_cluster": "--cluster",
    "?has_several_results": "other results",
    "?scale_in_millimeters": "--scale S",
}
"""Words for what follows from several options."""


def _words(o: Options, condition: str) -> str:
    """Write a condition as the user typed it."""
    condition = condition.partition("+")[0]
    kind, colon, name = condition.partition(":")
    if kind == "only":
        return f"--what {','.join(o.what)}"
    if colon:
        return f"--{'what' if kind == 'what' else 'layers'} {name}"
    if condition.startswith("?"):
        if condition == "?is_of_space" and (o.volume or o.space):
            return "--volume" if o.volume else "--space"
        return _PROPERTIES[condition]
    what, dot, fmt = condition.partition(".")
    if dot:
        word = {"animation": "an animation", "png-picture": "-f png"}.get(fmt, f"-f {fmt}")
        return f"--what {what} {word}" if what else word
    name, equals, value = condition.partition("=")
    return f"{flag(o.command, name, getattr(o, name))}{' ' if equals else ''}{value}"


def _where(o: Options, row: Option) -> str:
    """Say what shows an option."""
    results: dict[str, list[str]] = {}
    others = []
    for word in row.acts_on.split():
        if word.startswith(".") and word[1:] in FORMATS:
            others.append(f"{FORMATS[word[1:]].title} (-f {word[1:]})")
        elif word.startswith((".", "?")):
            others.append(_KINDS[word].format(", ".join(_picture_formats(o))))
        elif "=" in word or ":" in word:
            others.append(_words(o, word))
        else:
            what, _, fmt = word.partition(".")
            results.setdefault(what, []).extend([fmt] if fmt else [])
    plain = [what for what, formats in results.items() if not formats and what in PRODUCTS[o.command]]
    said = [f"--what {', '.join(plain)}"] if plain else []
    said += [f"--what {what} as {', '.join(formats)}" for what, formats in results.items() if formats]
    *first, last = dict.fromkeys([*said, *others])
    return f"{', '.join(first)} or {last}" if first else last


def _picture_formats(o: Options) -> Sequence[str]:
    """Give the formats in which the results are drawn; if none is, all that draw others."""
    products = [PRODUCTS[o.command][what] for what in o.what if what in PRODUCTS[o.command]]
    return [fmt for fmt in PICTURES if any(each.layers.get(fmt) for each in products)] or PICTURES


# ---- values --------------------------------------------------------------------------------------
def _check_frames(o: Options) -> None:
    """Refuse a window in pixels that is no integers, and a frame too far away to compute with."""
    if o.window is not None and o.cell_size is None and not all(isinstance(number, int) for number in o.window):
        shown = ",".join(f"{float(number):g}" for number in o.window)
        raise UsageError(f"invalid --window '{shown}': expected four integers X,Y,W,H, such as -10,-10,640,480")
    if o.frame is not None and o.command in OF_SHAPES and not any(isinstance(each, Measured) for each in o.frame):
        check_frame(o.frame)


def _check_layers(o: Options, targets: Sequence[Target]) -> None:
    """Refuse layers, and colors and widths of layers, that a picture has not, or does not show."""
    known: list[str] = []
    drawn: list[str] = []
    for target in targets:
        product = o.products[target.what]
        layers = product.layers.get(SHOWN_AS.get(target.fmt, target.fmt), ())
        known += layers
        if layers:
            drawn += product.usual_layers or layers
            _check_chosen(o, target.fmt, target.what, layers)
    _check_styles(o, known, drawn)


def check_drawn_layers(o: Options, fmt: str, what: str, layers: Sequence[str], usual: Sequence[str]) -> None:
    """Refuse layers that the picture of an input that is drawn again has not, or does not show."""
    _check_chosen(o, fmt, what, layers)
    _check_styles(o, layers, usual)


def _check_chosen(o: Options, fmt: str, what: str, layers: Sequence[str]) -> None:
    for layer in (each for each in (o.layers or ()) if each not in layers):
        raise UsageError(f"--layers {layer}: a picture of {what} in {fmt.upper()} has {', '.join(layers)}")


def _check_styles(o: Options, layers: Sequence[str], usual: Sequence[str]) -> None:
    """Refuse colors and widths of layers that no picture has or shows; the scale bar has a color, too."""
    if not o.colors and not o.line_widths:
        return
    from vorotool.render.drawing import SCALE_BAR

    shown = o.layers or [each for each in usual if each in layers]
    drawn = list(dict.fromkeys([*shown, *(["labels"] if o.label_by is not None else [])]))
    for option, chosen in (("color", o.colors), ("line-width", o.line_widths)):
        bar = [SCALE_BAR] if o.scale_bar and option == "color" else []
        names = list(dict.fromkeys([*layers, *bar]))
        for layer in (layer for layer, _ in chosen if layer not in names):
            raise UsageError(
                f"--{option} {layer}: there is no such layer; the picture has {', '.join(names)}{meant(layer, names)}"
            )
        for layer in (layer for layer, _ in chosen if layer not in (*drawn, *bar)):
            raise UsageError(
                f"--{option} {layer}: the picture shows only {', '.join(drawn)}; add the layer with "
                f"--layers {','.join([*drawn, layer])}"
            )


def refuse(o: Options, names: Iterable[str], reason: str) -> None:
    """Refuse options that are given although they mean nothing here."""
    for name in names:
        value = getattr(o, name)
        if value is not None and value is not False:  # 0 is given, too
            raise UsageError(f"{flag(o.command, name)} {reason}")


_WITH_SYSTEM = frozenset({"geojson", "jsonl", "json", "npz", "gpkg", "fgb", "shp", "parquet"})
"""Formats that hold a coordinate reference system."""

ALIKE = 100
"""Sides that differ by no more than this part of their length are one: users round them."""


def check_image_size(run: Run, o: Options, name: str, grid: PixelGrid | None) -> None:
    """Warn of a size that contradicts that of an image, or has its sides in another order."""
    unit = None if grid is None or o.pixel_size is None else unit_of_grid(grid)
    if grid is not None and unit is not None:
        own = (unit.side * grid.height, unit.side * grid.width)
        _check(run, o, name, f"pixels of {grid.size_text()}", (unit.unit, own))


def check_system(run: Run, o: Options, targets: Sequence[Target]) -> None:
    """Warn of a size that scales coordinates, which are no longer in their reference system then."""
    size = o.unit
    if size is None or size.is_auto or size.is_spacing or size.factor == 1:
        return
    if any(target.fmt in _WITH_SYSTEM and "geojson" in o.products[target.what].written for target in targets):
        text = f"--pixel-size {_text(size)} scales the coordinates: results state no coordinate reference system"
        instead = "leave out --pixel-size for a map"
        if o.strict:
            raise InputError(f"{text}; {instead}")
        run.warn(f"{text}; {instead}")


def check_voxel_size(run: Run, o: Options, name: str, grid: VoxelGrid | None) -> None:
    """Warn of sides that contradict those of a volume, or are in another order."""
    if grid is not None and grid.unit is not None:
        _check(run, o, name, f"voxels of {grid.size_text()}", (grid.unit, grid.sides))


def check_unit(run: Run, o: Options, name: str, value: Any) -> None:
    """Warn of a size that contradicts the unit of the coordinates of points, lines or polygons."""
    unit = None if o.pixel_size is None or o.pixel_size.unit is None else unit_of(value)
    if unit is not None:
        _check(run, o, name, f"coordinates in {unit.text}", (unit.unit, (unit.side,) * 2))


def _check(run: Run, o: Options, name: str, has: str, stated: tuple[str, tuple[Fraction, ...]]) -> None:
    from vorotool.numeric.length_units import ratio

    size, (unit, own) = o.pixel_size, stated
    if size is None or size.is_auto or size.unit is None:
        return
    factor = ratio(size.unit, unit)
    if factor is None:
        return
    sides = (size.factor,) * len(own) if size.sides is None else size.sides.lengths
    given = tuple(side * factor for side in sides)
    if len(given) != len(own) or _are_alike(given, own):
        return
    text = f"{size.option} {_text(size)} contradicts {name}, which has {has}"
    if _are_alike(given[::-1], own):
        order = "SX,SY" if len(own) == 2 else "SX,SY,SZ"
        text = f"{text}, perhaps because its sides are not in the order {order}"
    if o.strict:
        raise InputError(f"{text}: leave out {size.option} or --strict")
    run.warn(text)


def _are_alike(sides: tuple[Fraction, ...], own: tuple[Fraction, ...]) -> bool:
    return all(ALIKE * abs(one - other) <= other for one, other in zip(sides, own, strict=True))


def _text(size: PixelSize) -> str:
    sides = [size.factor] if size.sides is None else size.sides.lengths[::-1]
    return ",".join(f"{float(side):.10g}" for side in sides) + (size.unit or "")
