"""Arrays that begin with a cache line: what a kernel reads together then stands in one line, not in two."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

LINE = 64
"""Bytes in a cache line."""


def aligned_zeros(count: int) -> Array:
    """Return ``count`` zeros."""
    room = np.zeros(count + LINE // 8)
    first = (-room.ctypes.data // 8) % (LINE // 8)
    return room[first : first + count]


def aligned(array: Array) -> Array:
    """Return a flat copy of an array."""
    copy = aligned_zeros(array.size)
    copy[:] = array.ravel()
    return copy
