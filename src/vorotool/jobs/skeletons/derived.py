"""What follows from a skeleton or its diagram: what makes each result, checks it and counts it."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from inspect import signature
from typing import TYPE_CHECKING, Any

from vorotool.errors import Kind, Message
from vorotool.jobs.units import length_in_units, sides_of
from vorotool.numeric.parallel import Progress
from vorotool.products.formats import resolved

if TYPE_CHECKING:
    from vorotool.jobs.skeletons.products import SkeletonProducts
    from vorotool.products.registry import Made
    from vorotool.types.skeleton.arc_measures import ThicknessImage
    from vorotool.types.skeleton.discs import Discs
    from vorotool.types.skeleton.offsets import Offsets
    from vorotool.types.skeleton.parts import Parts
    from vorotool.types.skeleton.points_along import SkeletonPoints
    from vorotool.types.skeleton.skeleton import Skeleton


class Derived:
    """A result, made when it is asked for: by a function of the engines, or as a class below does."""

    def __init__(self, origin: SkeletonProducts, made: Made) -> None:
        self.origin, self.run, self.options, self.made = origin, origin.run, origin.options, made

    @cached_property
    def value(self) -> Any:
        """What is written, of a public type."""
        return self._make()

    def _make(self) -> Any:
        function, source = resolved(self.made.make), getattr(self.origin, self.made.of)
        with self.run.phase(self.made.counted_as or function.__name__) as progress:
            return function(source, **self._taken(function, progress))

    def _taken(self, function: Callable[..., Any], progress: Progress) -> dict[str, Any]:
        """Give a function the options that it takes and the user gives."""
        known = {**vars(self.options), "progress": progress}
        names = [name for name in list(signature(function).parameters)[1:] if name in known]
        return {name: known[name] for name in names if known[name] is not None}

    def verify(self, progress: Progress) -> None:
        """Check the value by another way than it was made, where there is one."""
        if self.made.check:
            function = resolved(self.made.check)
            function(self.value, **self._taken(function, progress))

    def stats(self) -> dict[str, Any]:
        """Counts of it."""
        return {self.made.counted_as: len(self.value)} if self.made.counted_as else {}


class OffsetCurves(Derived):
    """Offset curves of shapes, at all distances."""

    value: Offsets

    def _make(self) -> Offsets:
        distances = self.options.distance or ()
        shapes = self.origin.exact_shapes()
        with self.run.phase("offset") as progress:
            made = self.of(shapes, distances, progress)
        empty = [f"{distance:g}" for distance in distances if distance not in made.distance]
        if empty:
            self.run.warn(Message(f"no shape remains at the distance {', '.join(empty)}", Kind.EMPTY_RESULT))
        return made

    def of(self, shapes: Any, distances: Any, progress: Progress = None) -> Offsets:
        """Make the curves at some distances."""
        from vorotool.engines.offsets.offsets import offset

        o = self.options
        return offset(shapes, distances, features=o.features, strict=o.strict, threads=o.threads, progress=progress)

    def verify(self, progress: Progress) -> None:
        """Check the curves."""
        from vorotool.engines.offsets.verify_offsets import verify_offsets

        o = self.options
        verify_offsets(self.value, distances=o.distance or (), threads=o.threads, progress=progress)

    def stats(self) -> dict[str, Any]:
        """Count shapes, rings and pieces."""
        made = self.value
        counts = {"shapes": len(made), "rings": len(made.ring_kind), "pieces": len(made.site)}
        return {"distances": list(self.options.distance or ()), **counts}


class InscribedDiscs(Derived):
    """Discs of each feature, of its exact skeleton before it is pruned, whatever skeleton is asked for."""

    value: Discs

    def _make(self) -> Discs:
        from vorotool.engines.from_skeleton.largest_discs import discs_of_skeleton

        o, axis = self.options, self._axis()
        with self.run.phase("discs"):
            return discs_of_skeleton(axis, count=o.count, local=o.local, threads=o.threads)

    def _axis(self) -> Skeleton:
        from vorotool.engines.skeleton.diagrams import skeleton_in, skeleton_inside
        from vorotool.engines.skeleton.exact import ShapeDiagram

        o = self.options
        if not o.gap and o.side != "exterior":
            return self.origin.whole
        shapes = self.origin.exact_shapes()
        with self.run.phase("skeleton") as progress:
            if isinstance(shapes, ShapeDiagram):
                return skeleton_in(shapes, side="interior", features=o.features, threads=o.threads, progress=progress)
            return skeleton_inside(shapes, strict=o.strict, threads=o.threads, progress=progress).skeleton

    def stats(self) -> dict[str, Any]:
        """Count discs, and tell of the largest."""
        made = self.value
        return {"discs": len(made), "largest_radius": float(made.radius.max()) if len(made) else None}


class Steps(Derived):
    """Points at equal steps along skeletons and centerlines, and transects from foot to foot."""

    value: SkeletonPoints

    def _make(self) -> SkeletonPoints:
        from vorotool.engines.from_skeleton.points_along import points_along

        o, origin = self.options, self.origin
        lines = origin.centerlines if o.along == "centerline" else origin.skeleton
        with self.run.phase("points") as progress:
            return points_along(lines, every=o.every, threads=o.threads, progress=progress)

    def verify(self, progress: Progress) -> None:
        """Check sections: those of branches end where the discs of the skeleton, which is checked, touch."""
        if self.options.along == "centerline":
            from vorotool.engines.from_skeleton.points_along import verify_sections

            verify_sections(self.value, self.origin.centerlines, self.options.every)

    def stats(self) -> dict[str, Any]:
        """Count points."""
        return {"every": self.options.every, "along": self.options.along or "branches", "points": len(self.value)}


class CutParts(Derived):
    """Pieces between narrow necks."""

    value: Parts

    def stats(self) -> dict[str, Any]:
        """Count pieces and cuts."""
        from vorotool.engines.necks.parts import NARROWEST

        neck = NARROWEST if self.options.neck is None else float(self.options.neck)
        return {"neck": neck, "pieces": len(self.value), "cuts": len(self.value.necks)}


class Thickness(Derived):
    """The largest disc over each pixel, of the whole skeleton: discs of what pruning removes cover pixels, too."""

    value: ThicknessImage

    def _make(self) -> ThicknessImage:
        from vorotool.engines.from_skeleton.thickness import thickness_of_pixels
        from vorotool.jobs.pixel_sizes import written_grid
        from vorotool.types.skeleton.arc_measures import ThicknessImage

        frame, o = self.origin.frame, self.options
        assert frame is not None  # polygons are refused when they are read
        skeleton = self.origin.whole
        with self.run.phase("thickness") as progress:
            made = thickness_of_pixels(skeleton, frame.shape, sides=self._sides, threads=o.threads, progress=progress)
        return ThicknessImage(made, written_grid(o.pixel_size, self.origin.grid))

    @property
    def _sides(self) -> tuple[float, float]:
        sides = sides_of(self.options)
        return float(sides.y), float(sides.x)

    def verify(self, progress: Progress) -> None:
        """Check some pixels by all arcs, and by the distance from the outlines."""
        from vorotool.engines.from_skeleton.thickness import verify_thickness

        verify_thickness(self.value.values, self.origin.whole, sides=self._sides, progress=progress)

    def stats(self) -> dict[str, Any]:
        """Summarize the pixels of all objects, in the unit of the results."""
        values, size = self.value.values[self.value.values > 0], self.options.pixel_size
        found = {"mean": values.mean(), "sd": values.std(), "largest": values.max()} if len(values) else {}
        return {
            "pixels": len(values),
            **{f"thickness_{name}": length_in_units(size, float(each)) for name, each in found.items()},
        }
