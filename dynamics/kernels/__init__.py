"""Compiled loops of the dynamics, the only numba in this package: plain numbers and arrays in and out.

The disk cache of a compiled function is keyed by its own file: after an edit of ``contact`` touch ``march``
too.
"""

from dynamics.kernels.contact import (
    LANES,
    N_COUNTS,
    N_PHASE,
    N_VALUES,
    PackedMeshes,
    mesh_reactions,
    tooth_pair_forces,
)
from dynamics.kernels.march import N_TABLE, Carried, DiscreteModes, Orders, march

__all__ = [
    "LANES",
    "N_COUNTS",
    "N_PHASE",
    "N_TABLE",
    "N_VALUES",
    "Carried",
    "DiscreteModes",
    "Orders",
    "PackedMeshes",
    "march",
    "mesh_reactions",
    "tooth_pair_forces",
]
