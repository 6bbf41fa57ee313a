"""Columns of the small-rank part of a Jacobian: what one mean temperature does to a whole surface."""

from collections.abc import Sequence

import numpy as np
from scipy import sparse

from thermal.fe.elements import SurfaceElements
from thermal.fe.mesh import FloatArray, IndexArray

DIFFERENCE = 0.01
"""Half step of the central difference that gives the slope of a law [K]."""

Column = tuple[IndexArray, FloatArray]
"""Nodes and values of a sparse column; nodes may occur twice."""


def mean_of(surface: SurfaceElements) -> Column:
    """The area mean as a functional of the nodal temperatures [-]."""
    return surface.nodes, surface.shares[surface.nodes] / surface.area


def combined(parts: Sequence[tuple[float, Column]]) -> Column:
    """The sum of columns times a factor each."""
    nodes = np.concatenate([np.empty(0, dtype=np.int32), *(column[0] for _, column in parts)])
    values = np.concatenate([np.empty(0), *(factor * column[1] for factor, column in parts)])
    return nodes.astype(np.int32), values


def stack(columns: Sequence[Column], n_rows: int) -> sparse.csc_array:
    """(n_rows, len(columns)) matrix; values of equal nodes are added."""
    rows = np.concatenate([nodes for nodes, _ in columns])
    values = np.concatenate([values for _, values in columns])
    which = np.repeat(np.arange(len(columns)), [len(nodes) for nodes, _ in columns])
    return sparse.csc_array(sparse.coo_array((values, (rows, which)), shape=(n_rows, len(columns))))
