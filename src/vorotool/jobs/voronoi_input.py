"""What Voronoi maps are made of: points, lines and polygons, or the outlines of an image; and what cuts them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.formats.io.sources import reading
from vorotool.jobs.cuts import check_image_crs, in_one_crs, in_unit_of_image, polygons_among, read_cut
from vorotool.jobs.inputs import JobInput, opened_input, read_opened, report_no_geometry
from vorotool.jobs.options import Options
from vorotool.jobs.refusals import refuse
from vorotool.jobs.run_log import Run
from vorotool.jobs.second_files import in_first_unit, unit_of_vectors
from vorotool.jobs.skeleton_input import outlined
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.polygons.ring_arrays import RingArrays

if TYPE_CHECKING:
    from vorotool.convert.sites import Sites
    from vorotool.types.pixel_grid import PixelGrid


class ReadSites(NamedTuple):
    """What a map is made of."""

    sites: Sites  # of the input; not yet joined
    is_image: bool  # whether they are the objects of an image
    options: Options  # with the size of pixels, and lengths and places, as the image has them
    grid: PixelGrid | None = None  # what the image says of its pixels


def read_sites(run: Run, o: Options, given: JobInput) -> ReadSites:
    """Read points, lines and polygons, each feature a site, or the objects of an image."""
    from vorotool.convert.sites import as_sites
    from vorotool.types.points.raster import Raster

    with opened_input(o, given, "sites") as source:
        o, value = read_opened(run, o, given, source, columns=o.columns)
    if not isinstance(value, Raster):
        refuse({**o.for_images, "simplify": o.simplify}, "is for images, but the input holds points, lines or polygons")
        sites = as_sites(value)
        if not len(sites.polygons):
            report_no_geometry(run, o)
        return ReadSites(sites, is_image=False, options=o)
    refuse({"columns": o.columns}, "is for lists of points, but the input is an image")
    polygons, _, o, _, grid = outlined(run, o, given, value)
    return ReadSites(as_sites(polygons), is_image=True, options=o, grid=grid)


def read_cuts(run: Run, read: ReadSites, given: JobInput) -> tuple[ReadSites, dict[str, PolygonSet]]:
    """Read the files of ``--clip`` and ``--enclosures``, in the coordinates of the sites."""
    o, cuts = read.options, {}
    for name, path in (("clip", o.clip), ("enclosures", o.enclosures)):
        if path is None:
            continue
        with reading(path):  # messages name the file
            value = read_cut(run, o, f"--{name}", path)
            source = (given.name, read.sites.polygons)
            if read.is_image:
                check_image_crs((path, value), given.name, source[1].crs)
                value = in_unit_of_image(run, o, (path, value), given, read.grid)
            else:
                first = (given.name, unit_of_vectors(o, read.sites))
                value = in_first_unit(run, o, (path, value), first, crs=source[1].crs)
                placed = in_one_crs(run, (path, value), source)
                read = read._replace(sites=replace(read.sites, polygons=placed))
            if name == "clip":
                value = _chosen(value, np.flatnonzero(polygons_among(run, path, value)))
        cuts[name] = _in_pixels(o, value)
    return read, cuts


def _chosen(polygons: PolygonSet, chosen: NDArray[np.int64]) -> PolygonSet:
    return RingArrays.of(polygons).taken(chosen)[0].polygons(polygons, chosen)


def _in_pixels(o: Options, cut: PolygonSet) -> PolygonSet:
    """What is on the map where results are, in pixels, or in steps."""
    size = o.pixel_size
    if size is None or (size.origin is None and size.sides is None):
        return cut
    return replace(cut, xy=(cut.xy - (size.origin or (0.0, 0.0))) / float(size.factor))
