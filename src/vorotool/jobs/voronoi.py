"""What a Voronoi map can be written as (``--what``)."""

from __future__ import annotations

import warnings
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from vorotool.convert.sites import as_sites
from vorotool.errors import STRICT, InputError, Kind, Message, RepairWarning, silent
from vorotool.formats.opening import opened
from vorotool.jobs.inputs import (
    JobInput,
    check_columns,
    read_opened,
    report_no_geometry,
    tell_empty_cells,
)
from vorotool.jobs.job import Results
from vorotool.jobs.options import OF_IMAGES, Options
from vorotool.jobs.pixel_sizes import placed_backdrop, unit_of_vectors
from vorotool.jobs.refusals import refuse
from vorotool.jobs.run_log import Run
from vorotool.jobs.second_files import First, read_cut, unit_of_image
from vorotool.jobs.targets import Target
from vorotool.jobs.units import Amount, box_amounts, in_units, unit_columns
from vorotool.numeric.parallel import Progress
from vorotool.products.formats import resolved
from vorotool.products.registry import is_of
from vorotool.types.voronoi.voronoi_map import VoronoiMap

if TYPE_CHECKING:
    from vorotool.convert.sites import Sites
    from vorotool.jobs.outlined_images import ReadPolygons
    from vorotool.render.drawing import World
    from vorotool.types.polygons.polygon_set import PolygonSet
    from vorotool.types.skeleton.discs import Discs


class VoronoiProducts(Results):
    """Results of one Voronoi map."""

    def __init__(self, run: Run, options: Options, given: JobInput) -> None:
        with run.phase("read"):
            sites, self.image, options = self._read(run, options, given)
        super().__init__(run, options)
        cuts: dict[str, PolygonSet] = {}
        for name, path in (("clip", options.clip), ("enclosures", options.enclosures)):
            if path is not None:
                with run.phase("read polygons"):
                    polygons, cuts[name] = read_cut(run, options, f"--{name}", path, self._first(given, sites))
                sites = replace(sites, polygons=polygons)
        if given.backdrop is not None:
            self.backdrop = placed_backdrop(run, self.options, given.backdrop)
        self.features = sites.count
        self._sites, self._clip = sites, cuts.get("clip")
        self.cells = self._made(sites, cuts)
        has_place = np.zeros(len(self.cells), dtype=bool)
        has_place[self.cells.polygon_site] = True  # of the others it was told when they were read
        tell_empty_cells(run, self.cells.labels, (self.cells.components == 0) & has_place)
        check_columns(self.options, self.cells.properties)

    @cached_property
    def world(self) -> World:
        """Where what is drawn lies."""
        from vorotool.jobs.picture_world import world_of_polygons

        return world_of_polygons(self.run, self.options, self.cells.polygons, size=self.options.pixel_size)

    def _read(self, run: Run, o: Options, given: JobInput) -> tuple[Sites, ReadPolygons | None, Options]:
        """Read points, lines and polygons, each feature a site, or the objects of an image, whose outlines are kept."""
        with opened(given.path, geometry="sites", **o.opening) as source:
            o, value = read_opened(run, o, given, source, columns=o.columns)
        if is_of(value, "Raster"):
            refuse(o, ["columns"], "applies to lists of points, but the input is an image")
            image: ReadPolygons = resolved("jobs.outlined_images:outlined")(run, o, given, value)
            return as_sites(image.polygons), image, image.options
        of_images = ("spacing", *OF_IMAGES, "simplify")
        refuse(o, of_images, "applies to images, but the input holds points, lines or polygons")
        sites = as_sites(value)
        if not len(sites.polygons):
            report_no_geometry(run, o)
        return sites, None, o

    def _first(self, given: JobInput, sites: Sites) -> First:
        """Return what second files go with."""
        o, image = self.options, self.image
        unit = unit_of_vectors(o, sites) if image is None else unit_of_image(o, image.grid)
        return First(given.name, sites.polygons, unit, image is not None, sites.polygons.crs)

    def _made(self, sites: Any, cuts: dict[str, Any]) -> VoronoiMap:
        o = self.options
        how = {"by": o.by, "frame": o.frame, "max_distance": o.max_distance}
        with warnings.catch_warnings():
            if o.strict:
                warnings.simplefilter("error", RepairWarning)
            try:
                return self.call("engines.voronoi.voronoi:voronoi", sites, **how, **cuts)
            except RepairWarning as warning:
                raise InputError(f"{warning}: repair them, or leave out {STRICT}") from None

    @cached_property
    def discs(self) -> Discs:
        """The largest discs between all sites, with centers in what is shared out."""
        o, given = self.options, self._sites.polygons
        region = resolved("engines.from_skeleton.empty_discs:shared_region")(given, self._clip, o.frame)
        how = {"phase": "discs", "within": region, "count": o.count or 1}
        with silent(RepairWarning):  # told of the map
            return self.call("engines.from_skeleton.empty_discs:largest_empty_discs", given, **how)

    def value(self, what: str) -> VoronoiMap | Discs:
        """Give the map, or the discs between its sites."""
        return self.discs if what == "discs" else self.cells

    def check_page(self) -> None:
        """Refuse a page of too many cells."""
        resolved("render.pages.html:check_cells_size")(len(self.cells), len(self.cells.ring_arcs))

    def check(self, target: Target) -> None:
        """Refuse what cannot be written, and say what will be empty, before anything is written."""
        super().check(target)
        if not self.features:
            self.run.warn(Message("the result has no cells: the input is empty", Kind.EMPTY_RESULT))

    def emptiness(self, what: str) -> str:
        """Say why there are no discs, or no borders."""
        if what == "discs" and not len(self.discs):
            return "no point is outside of all sites"
        if not self.features or what not in ("edges", "neighbors") or self.cells.is_border.any():
            return ""
        count = len(self.cells)
        return f"the input has {count} site{'s' * (count != 1)}"

    def verify(self, progress: Progress) -> None:
        """Check the map, with nothing that it was made by."""
        self.call("engines.voronoi.verify_voronoi:verify_voronoi", self.cells, phase=None)
        if "discs" in self.options.what:
            self.call("engines.from_skeleton.verify_discs:verify_discs", self.discs, phase=None, progress=progress)

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
        found: dict[str, Any] = {"features": self.features, "sites": len(cells)}
        found |= {
            "empty_cells": int((cells.components == 0).sum()),
            "sites_without_geometry": int((~there).sum()),
            "cells_in_parts": int((cells.components > 1).sum()),
            "vertices": len(cells.vertices),
            "arcs": len(cells.arcs),
            **{f"{name}s": int(getattr(cells, f"is_{name}").sum()) for name in ("border", "parabola", "circle")},
            **resolved("engines.voronoi.voronoi:ties")(cells),
            "frame": box_amounts(cells.frame),
            "threads": o.threads,
        }
        if "discs" in o.what:
            radius = self.discs.radius
            found |= {"discs": len(radius), "largest_radius": Amount(float(radius.max())) if len(radius) else None}
        if self.image is not None:
            found |= {"outline": o.outline or "crack", "connectivity": int(o.connectivity or 8)}
        return found
