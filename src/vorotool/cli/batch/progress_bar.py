"""The bar that a terminal shows."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

import click

from vorotool.numeric.progress import Report

STEPS = 1000
"""Steps of a bar."""


@contextmanager
def progress_bar(label: str = "") -> Iterator[Report]:
    """Show a bar on standard error, and give what is called with the fraction done."""
    with click.progressbar(length=STEPS, label=label, file=sys.stderr) as bar:
        yield lambda fraction: bar.update(int(STEPS * fraction) - bar.pos)
