"""Which outputs a command writes, where, and in which format."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import TYPE_CHECKING, Any

from vorotool.errors import OUTPUT, UsageError, meant
from vorotool.formats.io.atomic_output import is_same_file, spoken
from vorotool.formats.io.descriptors import STANDARD, descriptor_of, is_same_output, stream_kind
from vorotool.formats.io.sources import output_name, suffix_of, without_gz
from vorotool.frozen import frozen
from vorotool.products.formats import EXTENSIONS, FORMATS, format_named
from vorotool.products.inputs import NAMES_WITH

if TYPE_CHECKING:
    from pathlib import Path

    from vorotool.jobs.options import Options
    from vorotool.products.registry import Product


@frozen
class Target:
    """One output: ``path`` is a file's name, or ``-`` for standard output."""

    what: str
    path: str
    fmt: str


def plan_targets(o: Options, source: str) -> list[Target]:
    """Lay out the outputs of one input."""
    what, output, fmt, out_dir = o.what, o.output, o.format, o.out_dir
    products = o.products
    if output is not None and out_dir is not None:
        raise UsageError("give -o or --out-dir, not both")
    several = len(what) > 1
    is_usual = fmt is None or all(fmt in products[name].formats for name in what)
    wanted = dict.fromkeys(what, fmt) if is_usual else _formats_of_results(products, what, fmt)
    if several and out_dir is None and (output is None or stream_kind(output) is not None):
        raise UsageError(
            "several results need -o STEM (files STEM.<what>.<ext>, or layers of STEM.gpkg) or --out-dir DIR"
        )
    if several or out_dir is not None:
        from pathlib import Path

        given = EXTENSIONS.get(suffix_of(output)) if out_dir is None else None
        if out_dir is not None:
            stem = Path(out_dir) / ("stdin" if source == "-" else Path(without_gz(output_name(source))).stem)
        else:
            stem = Path(output).with_suffix("") if given else Path(output)
        choose = _several_format if several else _chosen
        chosen = {name: choose(products, name, wanted[name], given) for name in what}
        # one GeoPackage holds all results that it can, as layers
        held = {name for name in what if given == chosen[name] == "gpkg"}
        paths = {name: _named(stem, name if several else None, chosen[name]) for name in what}
        return [Target(name, output if name in held else paths[name], chosen[name]) for name in what]
    name = what[0]
    path = "-" if output is None else output
    chosen_format = _chosen(products, name, wanted[name], None if path == "-" else suffix_of(path))
    target = Target(name, path, chosen_format)
    if output is None and fmt is None and not FORMATS[target.fmt].is_text:
        from vorotool.formats.io.sources import check_input

        check_input(source)
        possible = products[name].formats
        text = next((fmt for fmt in possible if FORMATS[fmt].is_text and fmt != "html"), None)
        ways = f"redirect with -f {possible[0]}" + (f", or print text with -f {text}" if text else "")
        raise UsageError(f"{name} output is binary: name a file with -o, {'' if text else 'or '}{ways}")
    return [target]


def check_stats(options: Options, targets: Sequence[Target], source: str) -> None:
    """Refuse statistics that would go where the input, another file that is read, or a result is."""
    stats = options.stats
    is_open = stats == STANDARD or descriptor_of(stats) is not None
    for role, path in () if is_open else (("the input", source), *options.files_read.items()):
        if is_same_file(stats, path):
            raise UsageError(f"--stats {stats} is also {role}, which is never replaced: choose another name")
    for target in targets:
        if not is_same_output(stats, target.path):
            continue
        if is_open and (target.path == STANDARD or descriptor_of(target.path) is not None):
            raise UsageError(f"--stats {stats} needs -o FILE: {spoken(target.path)} holds the result")
        raise UsageError(f"--stats {stats} is also the output of {target.what}: choose another name")


def check_cluster(targets: Sequence[Target]) -> None:
    """Refuse a cluster for one input unless it computes all outputs."""
    if {target.fmt for target in targets} != {"zarr"}:
        raise UsageError("--cluster with -o writes a Zarr store: name it .zarr, or a folder with --out-dir")


def check_targets(options: Options, targets: Sequence[Target], source: str) -> None:
    """Find out before any work whether the outputs and the statistics can be written."""
    from vorotool.formats.io.atomic_output import Rules, check_output
    from vorotool.formats.zarr.store import check_store

    rules: dict[str, Any] = {
        "no_clobber": options.no_clobber,
        "inputs": (source, *options.files_read.values()),
        "makes_folder": options.out_dir is not None,
    }
    named_by = OUTPUT if options.out_dir is None else "--out-dir"
    for one, other in combinations(targets, 2):
        is_of_layers = one.fmt == other.fmt == "gpkg" and one.path == other.path
        if not is_of_layers and is_same_output(one.path, other.path):
            raise UsageError(
                f"{one.path} and {other.path} are links to the same file, but {one.what} and {other.what} need a file "
                "each"
            )
    for target in targets:
        if target.fmt == "zarr":
            check_store(target.path, **rules)
        else:
            check_output(target.path, binary=not FORMATS[target.fmt].is_text, option=named_by, **rules)
            if target.fmt == "gpkg" and stream_kind(target.path) is None:
                from vorotool.formats.gis.geopackage import check_layers

                layers = [each.what for each in targets if each.path == target.path]
                check_layers(target.path, layers, overwrite=options.overwrite)
            if FORMATS[target.fmt].parts:
                from vorotool.formats.gis.vector_files import check_parts

                replaced = Rules(options.no_clobber, rules["inputs"], named_by)
                check_parts(target.path, replaced, makes_folder=rules["makes_folder"])
    if options.stats is not None:
        in_out_dir = options.out_dir is not None and _is_in(options.stats, options.out_dir)
        check_output(options.stats, no_clobber=options.no_clobber, makes_folder=in_out_dir, option="--stats")


def _is_in(name: str, folder: str) -> bool:
    from pathlib import Path

    return Path(name).parent == Path(folder)


def _formats_of_results(products: Mapping[str, Product], what: Sequence[str], listed: str) -> dict[str, str | None]:
    """Give each result the format of a list, as of ``-f tiff,csv``, that is the most usual one for it."""
    wanted = [_known_format(name.strip(), products) for name in listed.split(",")]
    fitting = {name: _most_usual(products[name].formats, wanted) for name in what}
    unused = [fmt for fmt in wanted if fmt not in fitting.values()]
    if len(wanted) > 1 and unused:
        taken = ", ".join(f"{fmt or 'nothing'} to {name}" for name, fmt in fitting.items())
        raise UsageError(f"-f {listed} assigns {taken}, but {unused[0]} to no result: leave out {unused[0]}")
    return {name: fmt or next(iter(wanted), None) for name, fmt in fitting.items()}


def _most_usual(possible: Sequence[str], wanted: Sequence[str]) -> str | None:
    """Choose among the formats that are wanted; one of the same family stands for another."""
    own = next((fmt for fmt in possible if fmt in wanted), None)
    families = {FORMATS[fmt].family for fmt in possible} - {""}
    return own or next((fmt for fmt in wanted if FORMATS[fmt].family in families), None)


def _known_format(fmt: str, products: Mapping[str, Product]) -> str:
    """Return the format that a name stands for; one of another command is refused where its result is known."""
    found = format_named(fmt)
    if found is None:
        possible = dict.fromkeys(each for own in products.values() for each in own.formats)
        raise UsageError(f"invalid -f {fmt!r}: expected one of {', '.join(possible)}{meant(fmt, possible)}")
    return found


def _chosen(products: Mapping[str, Product], what: str, fmt: str | None, extension: str | None) -> str:
    possible, chosen = products[what].formats, fmt
    if chosen is None and extension:
        chosen = EXTENSIONS.get(extension)
        if chosen is None:
            is_read = extension.removeprefix(".") in NAMES_WITH[None]
            fault = f"{extension} files can be read, but not written" if is_read else f"unknown extension {extension}"
            close = "" if is_read else meant(extension, (name for name, each in EXTENSIONS.items() if each in possible))
            raise UsageError(f"{fault}: use one of {', '.join(possible)}, or -f{close}")
    chosen = chosen or possible[0]
    if chosen not in possible and what == "picture":
        raise UsageError(
            f"draw writes pictures, but {chosen} is not a format of pictures: use one of {', '.join(possible)}, or "
            f"write {chosen} with the command that computes the result"
        )
    if chosen not in possible:
        others = [name for name, each in products.items() if chosen in each.formats]
        instead = f"use --what {' or '.join(others)}, or " if others else "use "
        raise UsageError(f"{what} cannot be written as {chosen}: {instead}one of {', '.join(possible)}")
    return chosen


def _several_format(products: Mapping[str, Product], what: str, fmt: str | None, given: str | None) -> str:
    """With several results the extension of -o holds for those that can be written so, or in a format of its family."""
    wanted = fmt or given
    family, possible = FORMATS[wanted].family if wanted else "", products[what].formats
    if family and wanted not in possible:
        fmt = next((own for own in possible if FORMATS[own].family == family), fmt)
    if fmt is None and given in possible:
        return str(given)
    return _chosen(products, what, fmt, None)


def _named(stem: Path, what: str | None, fmt: str) -> str:
    middle = f".{what}" if what else ""
    return f"{stem}{middle}{FORMATS[fmt].endings[0]}"
