"""Compiled loops of the dynamics, the only numba in this package: plain numbers and arrays in and out.

The disk cache of a compiled function is keyed by its own file: after an edit of ``contact`` touch ``march`` too.
"""

from dynamics.kernels.contact import (
    N_COUNTS,
    N_VALUES,
    Tables,
    mesh_reactions,
    tooth_pair_forces,
)
from dynamics.kernels.march import march

__all__ = ["N_COUNTS", "N_VALUES", "Tables", "march", "mesh_reactions", "tooth_pair_forces"]
