"""Which options of the commands that make skeletons go together, and with which results."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from vorotool.errors import UsageError
from vorotool.jobs.animations import check_animation
from vorotool.jobs.options import Options
from vorotool.jobs.targets import Target, check_picture_options, check_precision
from vorotool.products.formats import FORMATS, PICTURES, picture_format
from vorotool.products.inputs import DRAWINGS
from vorotool.products.registry import PRODUCTS, Product, formats_of, layers_of

OF_OPEN_BORDERS = ("skeleton", "branches", "table", "centerline", "points", "transects")
"""Results that need no closed outlines."""


def check_options(o: Options, targets: list[Target]) -> None:
    """Refuse what does not go together, or what no output would show."""
    formats = {target.fmt for target in targets}
    products = PRODUCTS[o.command]
    check_precision(o, formats_of(o.command), targets)
    curved = any(products[target.what].is_curved and FORMATS[target.fmt].flattens for target in targets)
    if o.flatten is not None and not curved and "shape" not in o.what and not may_be_drawn(o):
        raise UsageError(
            "--flatten is for drawings that are read, and for what has no curves: use -f geojson, -f wkt or --what "
            "shape, or leave it out"
        )
    check_join_tolerance(o)
    _check_measure(o, "--every", o.every, {"points", "transects"})
    if o.along is not None and not {"points", "transects"} & set(o.what):
        raise UsageError("--along is for points and transects: use --what points or transects, or leave it out")
    if "shape" in o.what and o.side == "exterior":
        raise UsageError("shapes are rebuilt from inside: use --side interior or both")
    if o.command == "skeleton-exact":
        _check_exact(o, targets)
    if o.frame is not None and o.side == "interior" and "diagram" not in o.what:
        _check_page(o, formats)
    if o.frame is not None:
        check_frame(o.frame)
    _check_centerline(o)
    _check_joining(o, formats)
    _check_lines(o, targets)
    pictures = sorted({picture_format(fmt) for fmt in formats} & set(PICTURES))
    if o.layers is not None and not pictures:
        raise UsageError("--layers is for pictures: use -f svg or -f png, or leave it out")
    check_layers(o, products, targets)
    check_picture_options(
        o,
        pictures,
        layers_of(o.command),
        png_has_width=True,
    )


def _check_page(o: Options, formats: set[str]) -> None:
    """Refuse a frame that neither cuts anything nor is the page of a picture."""
    if o.overlay is not None or not formats & set(PICTURES):
        raise UsageError(
            "--frame cuts what is outside, and is the page of pictures: use --side exterior or both, -f svg or -f png, "
            "or leave it out"
        )


def _check_exact(o: Options, targets: list[Target]) -> None:
    """Refuse what does not go together with results that only exact skeletons have."""
    _check_measure(o, "-d", o.distance, {"offset"})
    _check_shapes(o)
    _check_discs(o)
    _check_thickness(o, targets)
    _check_necks(o)
    _check_border(o)
    check_animation(o, targets)


def check_join_tolerance(o: Options) -> None:
    """Refuse ``--join-tolerance`` where no input may be a drawing."""
    if o.join_tolerance is not None and not may_be_drawn(o):
        raise UsageError("--join-tolerance is for DXF drawings: leave it out")


def may_be_drawn(o: Options) -> bool:
    """Whether an input may be a drawing with curves, as far as its name tells."""
    said = o.input_format and o.input_format.lower()
    endings = {Path(path).suffix.lower().removeprefix(".") for path in o.inputs}
    return said in DRAWINGS if said else o.files_from is not None or bool(endings & {*DRAWINGS, ""})


def check_frame(frame: tuple[float, ...]) -> None:
    """Refuse a frame that is too far away."""
    from vorotool.types.magnitude import LARGEST

    if max(map(abs, frame)) > LARGEST:
        raise UsageError(f"--frame goes too far to compute with: use numbers of at most {LARGEST:g}")


def check_layers(o: Options, products: Mapping[str, Product], targets: list[Target]) -> None:
    """Refuse a layer that one of the pictures has not."""
    for target in (target for target in targets if picture_format(target.fmt) in PICTURES):
        own = products[target.what].layers[picture_format(target.fmt)]
        for layer in (layer for layer in o.layers or () if layer not in own):
            raise UsageError(
                f"--layers {layer}: a picture of {target.what} in {target.fmt.upper()} has {', '.join(own)}; "
                "choose of these"
            )


def _check_centerline(o: Options) -> None:
    has_centerline = "centerline" in o.what or o.along == "centerline"
    if has_centerline and o.side == "exterior":
        raise UsageError("centerlines are inside polygons: use --side interior or both")
    if o.ends is not None and not has_centerline and not {"skeleton", "table"} & set(o.what):
        raise UsageError(
            "--ends is for skeletons and centerlines: use --what skeleton, centerline or table, or leave it out"
        )
    if (o.start is not None or o.end is not None) and not has_centerline:
        raise UsageError("--from and --to are ends of centerlines: use --what centerline, or leave them out")


def _check_joining(o: Options, formats: set[str]) -> None:
    """Junctions are those of skeletons, branches and tables; what is measured along an axis stays on it."""
    if not o.join_junctions:
        return
    if not {"skeleton", "branches", "table"} & set(o.what):
        raise UsageError(
            "--join-junctions is for skeletons, branches and tables: use --what skeleton, branches or table, or leave "
            "it out"
        )
    if "html" in formats:
        raise UsageError("--join-junctions does not show in a page of all prunings: use -f svg, or leave it out")


def _check_border(o: Options) -> None:
    """With an open border there is what follows from the axis inside each object, and no closed outline."""
    if not o.has_open_border:
        return
    given = {
        "--side": o.side != "interior",
        "--features": o.features != "separate",
        "--gap": bool(o.gap),
        "--simplify": o.simplify is not None,
        "--frame": o.frame is not None,
    }
    for name in (name for name, is_given in given.items() if is_given):
        raise UsageError(f"--border open is for what is inside each object as it is: leave {name} out")
    for what in (what for what in o.what if what not in OF_OPEN_BORDERS):
        raise UsageError(
            f"--what {what} is of closed outlines: leave --border open out, or use {', '.join(OF_OPEN_BORDERS)}"
        )


def _check_lines(o: Options, targets: list[Target]) -> None:
    """Skeletons are led on inside polygons, and what is no graph of arcs is smooth or led on."""
    if o.ends == "middle" and "skeleton" in o.what and o.side != "interior":
        raise UsageError(
            "skeletons are led on to ends inside polygons: use --side interior, or leave out --ends middle"
        )
    if o.smooth is not None and not {"skeleton", "centerline"} & set(o.what):
        raise UsageError("--smooth is for lines: use --what skeleton or centerline, or leave it out")
    changed = [name for name, given in (("--smooth", o.smooth is not None), ("--ends", o.ends == "middle")) if given]
    graphs = [target.fmt for target in targets if target.what == "skeleton" and target.fmt in ("graphml", "html")]
    if changed and graphs:
        raise UsageError(f"{changed[0]} is for lines, and {graphs[0]} shows arcs: use -f svg, or leave it out")


def _check_measure(o: Options, name: str, value: object, users: set[str]) -> None:
    """Refuse results that lack their length, and a length that no result uses."""
    wanted = users & set(o.what)
    if wanted and value is None:
        raise UsageError(f"--what {','.join(sorted(wanted))} needs a length: use {name} D")
    if not wanted and value is not None:
        what = " or ".join(f"--what {user}" for user in sorted(users))
        raise UsageError(f"{name} is for other results: use {what}, or leave it out")


def _check_discs(o: Options) -> None:
    """How many discs are wanted matters to these alone; they are inside."""
    for name, is_given in (("--count", o.count is not None), ("--local", o.local)):
        if is_given and "discs" not in o.what:
            raise UsageError(f"{name} is for discs: use --what discs, or leave it out")
    if "discs" in o.what and o.side == "exterior":
        raise UsageError("discs are inside polygons: use --side interior or both")
    for name, is_given in (("--prune", o.prune is not None), ("--gap", bool(o.gap))):
        if is_given and set(o.what) == {"discs"}:
            raise UsageError(f"{name} is for skeletons, but discs are of the shapes: leave it out")


def _check_necks(o: Options) -> None:
    """Necks are of the whole skeleton inside polygons."""
    wanted = [what for what in ("necks", "parts") if what in o.what]
    if o.neck is not None and not wanted:
        raise UsageError("--neck is for other results: use --what necks or parts, or leave it out")
    if wanted and o.side != "interior":
        raise UsageError("necks are inside polygons: use --side interior")
    if wanted and o.gap:
        raise UsageError(f"a skeleton with a gap leaves the corners out: use --what {wanted[0]} without --gap")
    if o.prune is not None and len(wanted) == len(o.what):
        raise UsageError("--prune is for skeletons, but necks are of the shapes: leave it out")


def _check_shapes(o: Options) -> None:
    """A skeleton with a gap rebuilds no shape; offset curves are of the shapes, whatever the skeleton is."""
    if "shape" in o.what and o.gap:
        raise UsageError("a skeleton with a gap leaves the corners out: use --what shape without --gap")
    given = {"--side": o.side != "interior", "--prune": o.prune is not None, "--gap": bool(o.gap)}
    for name in (name for name, is_given in given.items() if is_given and set(o.what) == {"offset"}):
        raise UsageError(f"{name} is for skeletons, but offset curves are of the shapes: leave it out")


def _check_thickness(o: Options, targets: list[Target]) -> None:
    """Thickness is of what is inside, of the whole exact skeleton, and its picture has the pixels of the image."""
    if "thickness" not in o.what:
        return
    if o.side == "exterior":
        raise UsageError("thickness is measured inside objects: use --side interior or both")
    if o.gap:
        raise UsageError(
            "a skeleton with a gap has no discs that touch the outline: use --what thickness without --gap"
        )
    if o.prune is not None and set(o.what) == {"thickness"}:
        raise UsageError("--prune is for skeletons, but thickness is of all discs: leave it out")
    if not any((target.what, target.fmt) == ("thickness", "png") for target in targets):
        return
    given = {
        "--width": o.width is not None,
        "--overlay": o.overlay is not None,
        **{f"--{name}": name in o.looks.given() for name in ("color", "line-width", "label-by", "aspect", "extent")},
    }
    for name in (name for name, is_given in given.items() if is_given):
        raise UsageError(f"a picture of thickness has the pixels of the image and colors of its own: leave out {name}")
