"""The types of arrays, for annotations."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]
Numbers = NDArray[np.intp]
Booleans = NDArray[np.bool_]
