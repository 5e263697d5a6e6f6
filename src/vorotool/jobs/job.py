"""What a command does with one input: the steps that all commands have in common."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from vorotool.errors import UsageError
from vorotool.formats.io.atomic_output import spoken
from vorotool.formats.io.sources import suffix_of
from vorotool.jobs.inputs import JobInput, naming, read_backdrop, refuse_several
from vorotool.jobs.options import Options, changed
from vorotool.jobs.run_log import Run
from vorotool.jobs.targets import Target, check_targets
from vorotool.jobs.units import in_stated_unit, shows_units, unit_stats
from vorotool.products.formats import FORMATS, format_named, resolved
from vorotool.signals import end_by_exceptions

if TYPE_CHECKING:
    from vorotool.jobs.results import Results


def options_of_line(command: str, given: Mapping[str, Any], sources: Mapping[str, str]) -> Options:
    """Return what a command line asks for, with what follows where options are left out."""
    values = dict(given)
    if command == "distance":
        a, b = values.pop("a"), values.pop("b")
        refuse_several({"A": a, "B": b})
        values |= {"inputs": (a,), "other": b}
        sources = {name: source for name, source in sources.items() if name in values}
    ending = suffix_of(values.get("output") or "")
    if values.get("animate") and values.get("format") is None:
        values["format"] = {"": "gif", ".png": "apng"}.get(ending)
    o = Options(command, sources=sources, **values)
    own = o.products
    if "what" not in sources:
        fmt = format_named(o.format or ending)
        usual = (what for what, each in own.items() if fmt in each.usual_for)
        return changed(o, what=(next(usual, next(iter(own))),))
    for what in (what for what in o.what if what not in own):
        raise UsageError(f"--what {what} needs points in the plane: with --space use {', '.join(own)}")
    return o


def process_input(run: Run, options: Options, path: str, targets: Sequence[Target]) -> None:
    """Read one input, compute, check and write its results, which take their places together."""
    from vorotool.formats.io.atomic_output import make_folder
    from vorotool.formats.io.temporaries import committed_together
    from vorotool.jobs.refusals import check_system
    from vorotool.numeric.coordinates import writing

    check_targets(options, targets, path)
    with run.phase("read"):
        has_units, has_page = shows_units(targets) or options.scale_bar, any(each.fmt == "html" for each in targets)
        backdrop = None if options.overlay is None else read_backdrop(options)
        given = JobInput(path, backdrop, has_units, has_page)
    with naming(given):
        products: Results = resolved(options.job)(run, options, given)
    check_system(run, products.options, targets)
    for target in targets:
        products.check(target)
    if options.verify:
        with run.phase("verify") as progress:
            products.verify(progress)
    end_by_exceptions()
    size, deviation = options.unit, 0.0
    unit = None if size is None else run.stats.get("unit") if size.is_auto else size.unit
    stated = unit if size is not None or run.coordinates is None else run.coordinates.unit
    system = run.crs if size is None else getattr(products.options.unit, "crs", None)  # of tables
    how: dict[str, Any] = {
        "decimals": options.decimals,
        "is_verified": options.verify,
        "columns": options.with_columns,
        "unit": unit,
        "coordinate_unit": stated,
        "is_safe": options.safe_csv,
    }
    in_crs: dict[str, Any] = {}
    with committed_together():
        for target in targets:
            if options.out_dir is not None:
                from pathlib import Path

                make_folder(Path(target.path).parent)
            with run.phase(f"write {target.what}"), writing(**how) as written:
                products.write(target, inputs=(path,))
            deviation = max(deviation, written.deviation)
            if written.system_unread is not None:
                _note_system(run, target, written.system_unread)
            if written.has_y_down:
                _note_y_down(run, target)
            has_places = target.fmt == "wkt" or (target.fmt in ("csv", "tsv") and written.has_places)
            if has_places and (written.crs or system) is not None:
                in_crs[spoken(target.path)] = written.crs or system
    if in_crs:
        _note_no_system(run, in_crs)
    if options.stats is not None:
        with run.phase("count"):
            found = in_stated_unit(products.options.unit, products.stats())
            run.stats.update({**found, **unit_stats(options.unit)})
            if deviation:
                run.stats["deviation"] = deviation


def _note_system(run: Run, target: Target, crs: Any) -> None:
    """Say that readers take JSON lines to be longitude and latitude."""
    from vorotool.numeric.crs import crs_name, is_geographic

    if not is_geographic(crs):
        run.note(
            f"{spoken(target.path)} is in {crs_name(crs)}, but GDAL reads JSON lines as longitude and latitude: give "
            f"GDAL -a_srs {crs_name(crs)}, or write a GeoPackage"
        )


def _note_no_system(run: Run, crs: Mapping[str, Any]) -> None:
    """Say once which files do not state the coordinate reference system that their coordinates are in."""
    from vorotool.numeric.crs import crs_name

    verb, them = ("states", "it") if len(crs) == 1 else ("state", "them")
    name = crs_name(next(iter(crs.values())))
    run.note(f"{', '.join(crs)} {verb} no coordinate reference system: read {them} as {name} (--input-crs)")


def _note_y_down(run: Run, target: Target) -> None:
    """Say what becomes of y in a format whose readers take it to go upwards."""
    if FORMATS[target.fmt].is_map:
        run.note(f"y goes down in {spoken(target.path)}, as in the input: read it with --y-down")
    elif target.fmt == "dxf" and run.reads_image:
        run.note(f"y is negated in {spoken(target.path)}, since it goes up in DXF and down in images")
