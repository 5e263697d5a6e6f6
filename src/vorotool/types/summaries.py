"""Columns of numbers in a few: how many, their mean, how much they differ, and quantiles."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from vorotool.types.table import Table

MEASURE = "measure"
"""The first column of summaries: the name of what a row sums up."""
_QUANTILES = {"min": 0.0, "lower_quartile": 0.25, "median": 0.5, "upper_quartile": 0.75, "max": 1.0}


_POWERS = {"perimeter": "", "nearest_distance": "", "tree_length": "", "area": "2"}


def unit_of_measure(name: str, unit: str) -> str | None:
    """Return the unit of a row: of a length the unit, of an area its square, of counts and ratios none."""
    return f"{unit}{_POWERS[name]}" if name in _POWERS else None


def summary_table(measures: Mapping[str, NDArray[np.float64]]) -> Table:
    """Return one row a measure."""
    rows = [_row(np.asarray(values, dtype=np.float64)) for values in measures.values()]
    names = ("mean", "sd", "cv", *_QUANTILES, "homogeneity", "disorder")
    columns = np.array(rows).reshape(len(rows), len(names)).T
    numbers = {name: np.ma.masked_invalid(column) for name, column in zip(names, columns, strict=True)}
    counts = np.array([len(values) for values in measures.values()], dtype=np.int64)
    return Table({MEASURE: list(measures), "count": counts, **numbers})


def _row(values: NDArray[np.float64]) -> list[float]:
    if not len(values):
        return [np.nan] * (5 + len(_QUANTILES))
    mean, sd = float(values.mean()), float(values.std())
    cv = sd / mean if mean > 0 else np.nan
    homogeneity = 1 / (1 + cv)
    quantiles = np.quantile(values, list(_QUANTILES.values())).tolist()
    return [mean, sd, cv, *quantiles, homogeneity, 1 - homogeneity]
