"""One run of a command: notes, warnings, progress, seconds, and the statistics it leaves behind."""

from __future__ import annotations

import sys
import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack, contextmanager, nullcontext
from functools import cache
from inspect import signature
from types import TracebackType
from typing import TYPE_CHECKING, Any, TypeVar

from vorotool import __version__
from vorotool.errors import Kind, Message, RepairWarning, VorotoolWarning
from vorotool.jobs.terminal import tell
from vorotool.numeric.coordinates import writing
from vorotool.numeric.parallel import Progress, Report
from vorotool.products.formats import resolved
from vorotool.signals import end_by_exceptions

if TYPE_CHECKING:
    from vorotool.jobs.options import Options
    from vorotool.numeric.length_units import InputUnit
    from vorotool.types.pixels import PixelGrid

PROGRESS_AFTER = 1.0
"""Seconds before a progress bar appears on a terminal."""
OF_MANY = ("strict", "threads", "max_pixels", "max_sites")
"""Options that many functions of the library take under the same name."""

Made = TypeVar("Made")

MakeBar = Callable[[str], AbstractContextManager[Report]]
"""Make a bar with a label."""


@cache
def parameters_of(function: Callable[..., Any]) -> tuple[str, ...]:
    """Return the names of what a function takes."""
    return tuple(signature(function).parameters)


class Run:
    """What a command says besides its result."""

    def __init__(
        self,
        command: str,
        *,
        quiet: bool,
        verbose: bool,
        stats: str | None,
        no_clobber: bool = False,
        bar: MakeBar | None = None,
    ) -> None:
        self._quiet, self._verbose = quiet, verbose and not quiet
        self._target, self._no_clobber = stats, no_clobber
        self._make_bar = None if quiet else bar
        self.warnings: list[Message] = []
        self.notes: list[Message] = []
        self.seconds: dict[str, float] = {}
        self._inner: list[float] = []
        self._stack = ExitStack()
        self.source: str | None = None  # what messages call the input; None where there are several
        self.reads_image = False
        self.stats: dict[str, Any] = {"command": command, "version": __version__}
        # the unit of the coordinates of points, lines and polygons, where no reference system states it
        self.coordinates: InputUnit | None = None
        self.pixel: InputUnit | None = None  # the side of a pixel of the input, where that is known
        self.grid: PixelGrid | None = None  # the pixels of the input, or the cells that are laid over it
        self.crs: Any = None  # the coordinate reference system that points, lines and polygons name

    def __enter__(self) -> Run:
        """Collect warnings from here on."""
        self._stack.enter_context(warnings.catch_warnings())
        warnings.simplefilter("always", VorotoolWarning)
        warnings.showwarning = self._show_warning
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Write the statistics of a run that went well."""
        self._stack.close()
        if self._verbose:
            for name, seconds in self.seconds.items():
                tell(f"{name}: {seconds:.3f} s")
        if kind is None and self._target is not None:
            self._write_stats(self._target)

    def note(self, message: str) -> None:
        """Say something useful on standard error, once; that lengths are in degrees is about the result: a warning."""
        said = Message.of(message).typed
        if said.kind is Kind.DEGREES:
            self.warn(message)
            return
        if said in self.notes:
            return
        self.notes.append(said)
        if not self._quiet:
            tell(f"note: {said}")

    def warn(self, message: str) -> None:
        """Say what was repaired, snapped or guessed: on standard error and in the statistics, each once."""
        said = Message.of(message).typed
        is_empty = said.kind is Kind.EMPTY_RESULT
        if said in self.warnings or (is_empty and any(each.kind is Kind.EMPTY_INPUT for each in self.warnings)):
            return
        self.warnings.append(said)
        if not self._quiet:
            tell(f"warning: {said}")

    @contextmanager
    def phase(self, name: str) -> Iterator[Progress]:
        """Measure a part of the run, and give its progress; time spent in a part of this part counts there only."""
        start = time.perf_counter()
        self._inner.append(0.0)
        try:
            yield self.progress(name)
        finally:
            elapsed = time.perf_counter() - start
            self.seconds[name] = self.seconds.get(name, 0.0) + elapsed - self._inner.pop()
            if self._inner:
                self._inner[-1] += elapsed

    def call(self, o: Options, function: str, *sources: Any, phase: str | None = "", **more: Any) -> Made:  # type: ignore[type-var]  # the caller says what is made
        """Call a function with those options of many that it takes; its time is that of a phase, unless that is None.

        `function` is ``module:function``; its name is the phase where no other one is given.
        """
        made = resolved(function)
        takes = parameters_of(made)
        known = {name: getattr(o, name) for name in OF_MANY} | {"note": self.note}
        with nullcontext() if phase is None else self.phase(phase or made.__name__) as progress:
            known = known | {"progress": progress} | more
            with writing():  # however a file is written that asks for it
                result: Made = made(*sources, **{name: known[name] for name in known if name in takes or name in more})
        return result

    def progress(self, label: str, *, after: float = PROGRESS_AFTER) -> Progress:
        """Return what shows a bar on a terminal, once the work has taken a second; a phase has its own."""
        make_bar = self._make_bar
        if make_bar is None or not sys.stderr.isatty():
            return None
        start = time.monotonic()
        bar: list[Report] = []

        def show(fraction: float) -> None:
            if not bar:
                if time.monotonic() - start < after:
                    return
                end_by_exceptions()  # a bar that is left as it is hides the cursor
                bar.append(self._stack.enter_context(make_bar(label)))
            bar[0](fraction)

        return show

    def _show_warning(self, message: Warning | str, category: type[Warning], *_: Any, **__: Any) -> None:
        if isinstance(message, VorotoolWarning):  # a library's own remark says nothing about the user's data
            if isinstance(message, RepairWarning) and self.source is not None:
                said = Message.of(message.message)
                self.warn(Message(f"{self.source}: {said.marked}", said.kind, source=self.source))
            else:
                self.warn(message.message)

    def _write_stats(self, target: str) -> None:
        import orjson

        from vorotool.formats.io.atomic_output import open_output
        from vorotool.numeric.length_units import ascii_unit

        self.stats["seconds"] = {name: round(value, 6) for name, value in self.seconds.items()}
        self.stats["warnings"] = self.warnings
        units = (name for name in ("unit", "unit_of_distance2") if self.stats.get(name) is not None)
        self.stats |= {name: ascii_unit(self.stats[name]) for name in units}
        with open_output(target, no_clobber=self._no_clobber, option="--stats") as out:
            out.write(orjson.dumps(self.stats, option=orjson.OPT_INDENT_2 | orjson.OPT_APPEND_NEWLINE))
