"""The bar that a terminal shows."""

from __future__ import annotations

import sys
from contextlib import AbstractContextManager

import click

from vorotool.jobs.run_log import STEPS, Bar


def progress_bar(label: str) -> AbstractContextManager[Bar]:
    """Make a bar of `STEPS` steps on standard error."""
    return click.progressbar(length=STEPS, label=label, file=sys.stderr)
