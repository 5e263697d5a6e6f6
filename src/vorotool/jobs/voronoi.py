"""What a Voronoi map can be written as (``--what``)."""

from __future__ import annotations

import warnings
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, BinaryIO, NamedTuple

import numpy as np

from vorotool.engines.voronoi.voronoi import voronoi
from vorotool.errors import STRICT, InputError, Kind, Message, RepairWarning
from vorotool.jobs.inputs import (
    JobInput,
    check_columns,
    opened_input,
    read_opened,
    report_no_geometry,
    tell_empty_cells,
)
from vorotool.jobs.options import Options
from vorotool.jobs.picture_world import world_of_polygons
from vorotool.jobs.pixel_sizes import placed_backdrop
from vorotool.jobs.refusals import refuse
from vorotool.jobs.results import Results
from vorotool.jobs.run_log import Run
from vorotool.jobs.second_files import First, read_cut, unit_of_image, unit_of_vectors
from vorotool.jobs.skeleton_input import outlined
from vorotool.jobs.targets import Target
from vorotool.jobs.units import in_units, unit_columns
from vorotool.numeric.parallel import Progress
from vorotool.products.formats import resolved
from vorotool.types.voronoi.voronoi_map import VoronoiMap

if TYPE_CHECKING:
    from vorotool.convert.sites import Sites
    from vorotool.types.pixels import PixelGrid
    from vorotool.types.polygons.polygon_set import PolygonSet
    from vorotool.types.skeleton.discs import Discs


class ReadSites(NamedTuple):
    """What a map is made of."""

    sites: Sites  # of the input; not yet joined
    is_image: bool  # whether they are the objects of an image
    options: Options  # with the size of pixels, and lengths and places, as the image has them
    grid: PixelGrid | None = None  # what the image says of its pixels


def _read_sites(run: Run, o: Options, given: JobInput) -> ReadSites:
    """Read points, lines and polygons, each feature a site, or the objects of an image."""
    from vorotool.convert.sites import as_sites
    from vorotool.types.images import Raster

    with opened_input(o, given, "sites") as source:
        o, value = read_opened(run, o, given, source, columns=o.columns)
    if not isinstance(value, Raster):
        refuse(
            {**o.for_images, "simplify": o.simplify}, "applies to images, but the input holds points, lines or polygons"
        )
        sites = as_sites(value)
        if not len(sites.polygons):
            report_no_geometry(run, o)
        return ReadSites(sites, is_image=False, options=o)
    refuse({"columns": o.columns}, "applies to lists of points, but the input is an image")
    polygons, _, o, _, grid = outlined(run, o, given, value)
    return ReadSites(as_sites(polygons), is_image=True, options=o, grid=grid)


def _first(given: JobInput, read: ReadSites, sites: Sites) -> First:
    """Return what second files go with."""
    o, polygons = read.options, sites.polygons
    unit = unit_of_image(o, read.grid) if read.is_image else unit_of_vectors(o, sites)
    return First(given.name, polygons, unit, read.is_image, polygons.crs)


class VoronoiProducts(Results):
    """Results of one Voronoi map."""

    def __init__(self, run: Run, options: Options, given: JobInput) -> None:
        with run.phase("read"):
            read = _read_sites(run, options, given)
        super().__init__(run, read.options)
        self.is_image = read.is_image
        sites = read.sites
        cuts: dict[str, PolygonSet] = {}
        for name, path in (("clip", options.clip), ("enclosures", options.enclosures)):
            if path is not None:
                with run.phase("read polygons"):
                    first = _first(given, read, sites)
                    polygons, cuts[name] = read_cut(run, self.options, f"--{name}", path, first)
                sites = replace(sites, polygons=polygons)
        self.backdrop = placed_backdrop(run, self.options, given.backdrop)
        self.features = sites.count
        self._sites, self._clip = sites, cuts.get("clip")
        self.cells = self._made(sites, cuts)
        has_place = np.zeros(len(self.cells), dtype=bool)
        has_place[self.cells.polygon_site] = True  # of the others it was told when they were read
        tell_empty_cells(run, self.cells.labels, (self.cells.components == 0) & has_place)
        check_columns(self.options, self.cells.properties)
        self.world = world_of_polygons(run, self.options, self.cells.polygons, size=self.options.pixel_size)

    def _made(self, sites: Any, cuts: dict[str, Any]) -> VoronoiMap:
        o = self.options
        with self.run.phase("voronoi") as progress, warnings.catch_warnings():
            if o.strict:
                warnings.simplefilter("error", RepairWarning)
            try:
                return voronoi(
                    sites,
                    by=o.by,
                    frame=o.frame,
                    threads=o.threads,
                    progress=progress,
                    max_distance=o.max_distance,
                    **cuts,
                )
            except RepairWarning as warning:
                raise InputError(f"{warning}: repair them, or leave out {STRICT}") from None

    @cached_property
    def discs(self) -> Discs:
        """The largest discs between all sites, with centers in what is shared out."""
        from vorotool.engines.from_skeleton.empty_discs import largest_empty_discs, shared_region

        o = self.options
        given = self._sites.polygons
        region = shared_region(given, self._clip, o.frame)
        with self.run.phase("discs") as progress, warnings.catch_warnings():
            warnings.simplefilter("ignore", RepairWarning)  # told of the map
            return largest_empty_discs(given, within=region, count=o.count or 1, threads=o.threads, progress=progress)

    def value(self, what: str) -> VoronoiMap | Discs:
        """Give the map, or the discs between its sites."""
        return self.discs if what == "discs" else self.cells

    def check(self, target: Target) -> None:
        """Refuse what cannot be written, and say what will be empty, before anything is written."""
        super().check(target)
        if target.fmt == "html":
            from vorotool.render.pages.html import check_cells_size

            check_cells_size(len(self.cells), len(self.cells.ring_arcs))
        if target.what == "discs" and not len(self.discs):
            self.run.warn(Message("the result has no discs: no point is outside of all sites", Kind.EMPTY_RESULT))
        if not self.features:
            self.run.warn(Message("the result has no cells: the input is empty", Kind.EMPTY_RESULT))
        elif target.what in ("edges", "neighbors") and not self.cells.is_border.any():
            count = len(self.cells)
            self.run.warn(
                Message(
                    f"the result has no {target.what}: the input has {count} site{'s' * (count != 1)}",
                    Kind.EMPTY_RESULT,
                )
            )

    def verify(self, progress: Progress) -> None:
        """Check the map, with nothing that it was made by."""
        from vorotool.engines.voronoi.verify_voronoi import verify_voronoi

        verify_voronoi(self.cells)
        if "discs" in self.options.what:
            from vorotool.engines.from_skeleton.verify_discs import verify_discs

            verify_discs(self.discs, progress=progress)

    def write_page(self, out: BinaryIO) -> None:
        """Write a page that shows the cells."""
        from vorotool.render.layers.voronoi import map_colors
        from vorotool.render.pages.html import shapes_of_map, write_cells_html

        cells = in_units(self.options.pixel_size, self.cells)
        shapes = shapes_of_map(cells)
        columns = {name: column for name, column in cells.table().items() if name not in ("label", "id")}
        write_cells_html(out, shapes, map_colors(cells), columns | unit_columns(self.options.pixel_size, len(cells)))

    def stats(self) -> dict[str, Any]:
        """Counts and sizes."""
        cells, o = self.cells, self.options
        there = np.zeros(len(cells), dtype=bool)
        there[cells.polygon_site] = True
        found: dict[str, Any] = {
            "features": self.features,
            "sites": len(cells),
            "empty_cells": int((cells.components == 0).sum()),
            "sites_without_geometry": int((~there).sum()),
            "cells_in_parts": int((cells.components > 1).sum()),
            "vertices": len(cells.vertices),
            "arcs": len(cells.arcs),
            "borders": int(cells.is_border.sum()),
            "parabolas": int(cells.is_parabola.sum()),
            "circles": int(cells.is_circle.sum()),
            **resolved("engines.voronoi.voronoi:ties")(cells),
            "frame": list(cells.frame),
            "threads": o.threads,
        }
        if "discs" in o.what:
            radius = self.discs.radius
            found |= {"discs": len(radius), "largest_radius": float(radius.max()) if len(radius) else None}
        if self.is_image:
            found |= {"outline": o.outline or "crack", "connectivity": int(o.connectivity or 8)}
        return found
