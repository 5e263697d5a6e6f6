"""The job of ``vorotool delaunay --space``: tetrahedra of points in space."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any

from vorotool.engines.delaunay.delaunay import delaunay, verify_triangulation
from vorotool.errors import Kind, Message
from vorotool.formats.volumes.points import read_xyz
from vorotool.jobs.inputs import JobInput, note_repeated_labels, report_no_geometry
from vorotool.jobs.options import Options
from vorotool.jobs.results import Results
from vorotool.jobs.run_log import Run
from vorotool.jobs.targets import Target
from vorotool.numeric.parallel import Progress
from vorotool.products.registry import SPACE_PRODUCTS, Product
from vorotool.types.volumes.volume_points import VolumePoints

_SHAPES = {-1: "there are no points", 0: "there is one place", 1: "all points lie on a line", 2: "all lie in a plane"}


class TetrahedraProducts(Results):
    """Results of one triangulation in space."""

    def __init__(self, run: Run, options: Options, given: JobInput) -> None:
        super().__init__(run, options)
        with run.phase("read"):
            points = _read(run, options, given)
        with run.phase("triangulate") as progress:
            self.mesh = delaunay(points, strict=options.strict, threads=options.threads, progress=progress)
        note_repeated_labels(run, points, self.mesh)

    @cached_property
    def products(self) -> Mapping[str, Product]:
        """All results of points in space."""
        return SPACE_PRODUCTS

    def value(self, what: str) -> Any:
        """Give the triangulation, which has all results."""
        return self.mesh

    def check(self, target: Target) -> None:
        """Say what will be empty."""
        if target.what != "table" and not len(getattr(self.mesh, target.what)):
            why = _SHAPES[self.mesh.dimension]
            self.run.warn(Message(f"the result has no {target.what}: {why}", Kind.EMPTY_RESULT))

    def verify(self, progress: Progress) -> None:
        """Check the triangulation exactly, from its arrays alone."""
        verify_triangulation(self.mesh, threads=self.options.threads, progress=progress)

    def stats(self) -> dict[str, Any]:
        """Counts."""
        mesh = self.mesh
        return {
            "points": len(mesh.points),
            "duplicates": mesh.duplicates,
            "dimension": mesh.dimension,
            "tetrahedra": len(mesh),
            "triangles": len(mesh.triangles),
            "edges": len(mesh.edges),
            "hull": len(mesh.hull),
            "threads": self.options.threads,
        }


def _read(run: Run, o: Options, given: JobInput) -> VolumePoints:
    points = read_xyz(
        given.path,
        input_format=o.input_format,
        columns=o.columns,
        max_sites=o.max_sites,
        properties=not o.no_properties and "table" in o.what,
        threads=o.threads,
        note=run.note,
    )
    if not len(points):
        report_no_geometry(run, o)
    return points
