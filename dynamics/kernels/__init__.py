"""Compiled loops of the dynamics, the only numba in this package: plain numbers and arrays in and out.

Slices one by one, for the harmonic balance: ``contact`` names the packed tables and sums the contacts of a flank that
``flank_contacts`` chooses, ``reactions`` evaluates meshes at given states, with what the teeth see behind bodies that
all pairs share.

The same law from contact tables, for the time integration: ``contact_table`` sums the slices at its nodes,
``table_lookup`` contracts a flank at its place on the path to rows, ``contact_force`` sums these, ``table_reactions``
evaluates at given states.
``linear_step`` takes the modes over one step (``modal_step``), ``flank_lookup`` and ``mesh_solve`` the meshes, ``drag``
the drag torques, ``wrench`` tooth forces beside the ports, ``time_integration`` joins them and adds up their work;
``integrator_state`` is the state of the meshes that they share.
"""

from dynamics.kernels.contact import N_COUNTS, N_PHASE, N_VALUES, VECTOR, PackedMeshes
from dynamics.kernels.drag import DragLaws
from dynamics.kernels.integration_data import N_PORTS, Carried, Commands, Histories, Steps
from dynamics.kernels.linear_step import FOUR, DiscreteModes, DragModes
from dynamics.kernels.modal_step import WIDTH
from dynamics.kernels.reactions import MeshStates, mesh_reactions, tooth_pair_forces
from dynamics.kernels.time_integration import integrate
from dynamics.kernels.wrench import WrenchModes

__all__ = [
    "FOUR",
    "N_COUNTS",
    "N_PHASE",
    "N_PORTS",
    "N_VALUES",
    "VECTOR",
    "WIDTH",
    "Carried",
    "Commands",
    "DiscreteModes",
    "DragLaws",
    "DragModes",
    "Histories",
    "MeshStates",
    "PackedMeshes",
    "Steps",
    "WrenchModes",
    "integrate",
    "mesh_reactions",
    "tooth_pair_forces",
]
