"""What values of pixels and voxels have in common with arrays."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray


class Elements:
    """A value that is an image or a volume: what takes an array takes it."""

    def _array(self) -> NDArray[Any]:
        raise NotImplementedError

    def __array__(self, dtype: DTypeLike | None = None, copy: bool | None = None) -> NDArray[Any]:
        return np.array(self._array(), dtype=dtype, copy=copy)

    def __getitem__(self, place: Any) -> Any:
        return self._array()[place]

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of the pixels or voxels."""
        return self._array().dtype

    @property
    def ndim(self) -> int:
        """Number of axes."""
        return self._array().ndim
