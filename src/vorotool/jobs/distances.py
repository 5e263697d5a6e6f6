"""How far two inputs are apart, and what that can be written as (``--what``)."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from vorotool.convert.sites import as_sites
from vorotool.errors import InputError
from vorotool.formats.opening import opened
from vorotool.jobs.inputs import JobInput, naming, read_opened, report_no_geometry
from vorotool.jobs.job import Results
from vorotool.jobs.options import Options
from vorotool.jobs.picture_world import bounds_of, world_of_polygons
from vorotool.jobs.pixel_sizes import unit_of_vectors
from vorotool.jobs.run_log import Run
from vorotool.jobs.second_files import in_first_unit
from vorotool.numeric.crs import crs_name, same_crs
from vorotool.numeric.parallel import Progress
from vorotool.types.distances.distances import SMALLEST, Distances
from vorotool.types.images import Raster

if TYPE_CHECKING:
    from vorotool.render.drawing import Drawing
    from vorotool.types.polygons.polygon_set import PolygonSet


class DistanceProducts(Results):
    """Results of one comparison."""

    def __init__(self, run: Run, options: Options, given: JobInput) -> None:
        super().__init__(run, options)
        other, self.read_beside = JobInput(options.other), (options.other,)
        with run.phase("read"):
            a = self._read(given)
            with naming(other):
                b = self._read(other)
            a, b = self._in_one_system((given, a), (other, b))
        self.found = self._measured(a, b)
        bounds = bounds_of(np.concatenate([a.xy, b.xy]))
        self.world = world_of_polygons(run, options, replace(a, frame=None), bounds=bounds, is_cut=False)

    def _read(self, given: JobInput) -> PolygonSet:
        with opened(given.path, geometry="sites", **self.options.opening) as source:
            o = self.options
            _, value = read_opened(self.run, o, given, source, columns=o.columns, wants_unit=True, properties=False)
        unit = None if self.run.coordinates is None else self.run.coordinates.unit
        try:
            polygons = replace(as_sites(value).polygons, unit=unit)
        except InputError as error:
            if not isinstance(value, Raster):
                raise
            how = f"skeleton-exact {given.name} --threshold otsu --prune none --what shape -o outlines.geojson"
            said = str(error).partition(": use ")[0]
            raise InputError(f"{said}: write its outlines first, such as with vorotool {how}") from None
        if not len(polygons):
            report_no_geometry(self.run, self.options, given.name)
        return polygons

    def _in_one_system(
        self, first: tuple[JobInput, PolygonSet], second: tuple[JobInput, PolygonSet]
    ) -> tuple[PolygonSet, PolygonSet]:
        """Both in one coordinate reference system: one that names none is taken to be in that of the other."""
        (one, a), (other, b) = first, second
        if a.crs is not None and b.crs is not None and not same_crs(a.crs, b.crs):
            error = InputError(
                f"{one.name} is in {crs_name(a.crs)}, but {other.name} in {crs_name(b.crs)}: reproject both to one "
                f"system with --crs {crs_name(a.crs)}"
            )
            error.source = one.path
            raise error
        unit = unit_of_vectors(self.options, a)
        b = in_first_unit(self.run, self.options, (other.name, b), (one.name, unit), crs=a.crs)
        self.run.coordinates = unit_of_vectors(self.options, a, with_system=False)
        for which, mine, its in ((one, a, b), (other, b, a)):
            if mine.crs is None and its.crs is not None:
                self.run.note(f"{which.name} states no coordinate reference system: {crs_name(its.crs)} is assumed")
        crs = b.crs if a.crs is None else a.crs
        return replace(a, crs=crs), replace(b, crs=crs)

    def _measured(self, a: PolygonSet, b: PolygonSet) -> Distances:
        o = self.options
        found = Distances(None, None, None, (a, b), o.boundary)
        if not len(a) or not len(b):
            return found
        if {"distances", "hausdorff"} & set(o.what):
            found = self.call("engines.distances.hausdorff:hausdorff", a, b, boundary=o.boundary)
        if {"distances", "smallest"} & set(o.what):
            how = {"phase": "smallest", "boundary": o.boundary}
            closest: Distances = self.call("engines.distances.hausdorff:distance", a, b, **how)
            found = replace(found, smallest=closest.smallest)
        return found

    def value(self, what: str) -> Distances:
        """Give all distances, of which each result has its own rows."""
        return self.found

    def written(self, what: str, fmt: str) -> Distances:
        """Give the same: they are in the coordinates of the first input."""
        return self.found

    def drawing(self, what: str, fmt: str) -> Drawing:
        """Prepare a picture, which shows the lines of one result."""
        from vorotool.render.drawing import drawing_of

        found, product = self.found, self.products[what]
        if what == "hausdorff":
            found = replace(found, smallest=None)
        elif what == "smallest":
            found = replace(found, from_a=None, from_b=None)
        return drawing_of(found, product, self.wanted, fmt)

    def verify(self, progress: Progress) -> None:
        """Check the distances, with nothing that they were computed by."""
        self.call("engines.distances.hausdorff:verify_distances", self.found, phase=None)

    def stats(self) -> dict[str, Any]:
        """Counts and sizes."""
        a, b = self.found.shapes
        rows = self.found.rows
        return {
            "features": [as_sites(shape).count for shape in (a, b)],
            "vertices": [len(shape.xy) for shape in (a, b)],
            "boundary": self.options.boundary,
            "hausdorff": rows["hausdorff"].distance if "hausdorff" in rows else None,
            "smallest": rows[SMALLEST].distance if SMALLEST in rows else None,
            "threads": self.options.threads,
        }
