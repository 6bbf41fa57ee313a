"""Compiled loops of the dynamics, the only numba in this package: plain numbers and arrays in and out.

``contact`` lists and sums the tooth contacts of a flank, ``reactions`` evaluates meshes at given states,
``linear_step`` takes the modes over one step, ``mesh_solve`` the meshes, ``march`` joins them. The disk cache of
a compiled function is keyed by its own file: after an edit of one of the others touch ``reactions`` and
``march`` too.
"""

from dynamics.kernels.contact import LANES, N_COUNTS, N_PHASE, N_VALUES, PackedMeshes
from dynamics.kernels.linear_step import WIDTH, DiscreteModes
from dynamics.kernels.march import Carried, Orders, march
from dynamics.kernels.reactions import mesh_reactions, tooth_pair_forces

__all__ = [
    "LANES",
    "N_COUNTS",
    "N_PHASE",
    "N_VALUES",
    "WIDTH",
    "Carried",
    "DiscreteModes",
    "Orders",
    "PackedMeshes",
    "march",
    "mesh_reactions",
    "tooth_pair_forces",
]
