"""Necks of polygons, and the parts between them."""

from __future__ import annotations

from typing import Any

from vorotool.engines.necks.necks import NARROW, necks
from vorotool.engines.necks.parts import NARROWEST, parts
from vorotool.jobs.skeletons.result import Result
from vorotool.numeric.progress import Progress
from vorotool.types.skeleton.necks import Necks
from vorotool.types.skeleton.parts import Parts


class NeckCuts(Result):
    """Necks up to a ratio."""

    value: Necks

    @property
    def _neck(self) -> float:
        neck = self.origin.exact_options.neck
        return NARROW if neck is None else neck

    def _make(self) -> Necks:
        skeleton = self.origin.whole()
        with self.run.phase("necks") as progress:
            return necks(skeleton, neck=self._neck, threads=self.options.threads, progress=progress)

    def verify(self, progress: Progress) -> None:
        """Check them."""
        from vorotool.engines.necks.verify_necks import verify_necks

        verify_necks(self.value, threads=self.options.threads, progress=progress)

    def stats(self) -> dict[str, Any]:
        """Count them."""
        return {"necks": len(self.value)}


class CutParts(Result):
    """Pieces between narrow necks."""

    value: Parts

    @property
    def _neck(self) -> float:
        neck = self.origin.exact_options.neck
        return NARROWEST if neck is None else neck

    def _make(self) -> Parts:
        skeleton = self.origin.whole()
        with self.run.phase("parts") as progress:
            return parts(skeleton, neck=self._neck, threads=self.options.threads, progress=progress)

    def verify(self, progress: Progress) -> None:
        """Check them."""
        from vorotool.engines.necks.verify_necks import verify_parts

        verify_parts(self.value, threads=self.options.threads, progress=progress)

    def stats(self) -> dict[str, Any]:
        """Count pieces and cuts."""
        return {"neck": self._neck, "pieces": len(self.value), "cuts": len(self.value.necks)}
