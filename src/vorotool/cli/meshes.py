"""What a triangulation can be written as (``--what``)."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from functools import cached_property
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, BinaryIO

from vorotool.cli.pictures import write_layers
from vorotool.cli.run import Run
from vorotool.cli.targets import Target
from vorotool.engines.delaunay import delaunay, verify_triangulation
from vorotool.errors import VorotoolWarning
from vorotool.geometry.points import PointSet
from vorotool.geometry.seeds import SeedSet

if TYPE_CHECKING:
    from vorotool.render.layers import Page

DEFAULT_LAYERS = {"edges": ("edges", "points"), "triangles": ("triangles", "edges", "points")}
"""Layers of the picture of each result."""


class MeshProducts:
    """Results of one triangulation.

    Parameters
    ----------
    points : PointSet or SeedSet
        What to triangulate.
    options : namespace
        Options of the command line.
    run : Run
        Takes notes and seconds.
    """

    def __init__(self, points: PointSet | SeedSet, options: SimpleNamespace, run: Run) -> None:
        self.options, self.run = options, run
        progress = run.progress("triangulating")
        with run.phase("triangulate"):
            self.mesh = delaunay(points, strict=options.strict, threads=options.threads, progress=progress)

    def check(self, target: Target) -> None:
        """Refuse what cannot be written, and say what will be empty, before anything is written."""
        if target.fmt == "png":
            from vorotool.render.layers_png import check_picture_size

            check_picture_size(self.page, self.options.max_pixels)
        rows = {"edges": len(self.mesh.edges), "triangles": len(self.mesh.triangles)}.get(target.what)
        if rows == 0:
            warnings.warn(f"there are no {target.what}: {self._shape()}", VorotoolWarning, stacklevel=2)

    def _shape(self) -> str:
        count = len(self.mesh.points) - self.mesh.duplicates
        if count < 3:
            return f"{count} distinct point{'s' * (count != 1)}"
        return f"all {count} distinct points lie on a line"

    def write(self, target: Target, *, inputs: Sequence[str]) -> None:
        """Write one result."""
        from vorotool.formats.outputs import open_output

        with open_output(
            target.path, binary=target.is_binary, no_clobber=self.options.no_clobber, inputs=inputs
        ) as out:
            getattr(self, f"_write_{target.what}")(out, target.fmt)

    def _write_edges(self, out: BinaryIO, fmt: str) -> None:
        self._write_mesh(out, fmt, "edges")

    def _write_triangles(self, out: BinaryIO, fmt: str) -> None:
        self._write_mesh(out, fmt, "triangles")

    def _write_table(self, out: BinaryIO, fmt: str) -> None:
        self._write_mesh(out, fmt, "table")

    def _write_mesh(self, out: BinaryIO, fmt: str, what: str) -> None:
        from vorotool.formats.mesh_files import write_mesh

        if fmt in ("svg", "png"):
            self._write_picture(out, fmt, DEFAULT_LAYERS[what])
            return
        write_mesh(out, self.mesh, fmt, what=what, precision=self.options.precision, threads=self.options.threads)

    @cached_property
    def page(self) -> Page:
        """Where pictures show what."""
        from vorotool.render.mesh_layers import mesh_page

        return mesh_page(self.mesh, width=self.options.width or 1000, y_up=self.options.y_up)

    def _write_picture(self, out: BinaryIO, fmt: str, layers: Sequence[str]) -> None:
        from vorotool.render.mesh_layers import mesh_layers

        write_layers(
            out,
            mesh_layers(self.mesh, self.page, self.options.layers or layers),
            self.page,
            fmt=fmt,
            threads=self.options.threads,
        )

    def verify(self) -> None:
        """Check the triangulation exactly, from its arrays alone."""
        verify_triangulation(self.mesh, threads=self.options.threads, progress=self.run.progress("verifying"))

    def stats(self) -> dict[str, Any]:
        """Counts and sizes."""
        mesh = self.mesh
        return {
            "points": len(mesh.points),
            "duplicates": mesh.duplicates,
            "edges": len(mesh.edges),
            "triangles": len(mesh.triangles),
            "hull": len(mesh.hull),
            "collinear": len(mesh.triangles) == 0,
            "method": self.options.method,
            "threads": self.options.threads,
        }
