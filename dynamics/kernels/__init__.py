"""Compiled loops of the dynamics, the only numba in this package: plain numbers and arrays in and out.

Slices one by one, for the harmonic balance: ``mesh_tables`` names the packed tables, ``flank_contacts`` chooses the
contacts of a flank, ``contact`` sums them, ``shared_body`` finds what the teeth see behind bodies that all pairs share,
``reactions`` evaluates meshes at given states.

The same law from contact tables, for the march: ``contact_nodes`` sums the slices at the nodes of ``contact_table``,
``hold_path`` and ``hold_phase`` contract a flank at its place on the path (``knots``), ``press_rows`` sums what is
held, ``table_reactions`` evaluates at given states. ``linear_step`` takes the modes over one step (``mode_pass``),
``held_flanks``, ``mesh_solve`` and ``meet_meshes`` the meshes, ``drag`` the drag torques, ``wrench`` tooth forces
beside the ports, ``march`` joins them and ``march_accounts`` adds up their work; ``mesh_workspace`` is the state of the
meshes that they share.

The disk cache of a compiled function is keyed by the content of its own file: a hash of all sources in each file that
takes from another goes with it (``tests/unit/dynamics_package/kernels/test_kernel_cache.py`` says what to write).
"""

from pathlib import Path

from dynamics.kernels.drag import DragLaws
from dynamics.kernels.linear_step import FOUR, DiscreteModes, DragModes
from dynamics.kernels.march import march
from dynamics.kernels.march_state import N_PORTS, Carried, Commands, MarchRecord, Steps
from dynamics.kernels.mesh_tables import N_COUNTS, N_PHASE, N_VALUES, VECTOR, PackedMeshes
from dynamics.kernels.mesh_workspace import port_place
from dynamics.kernels.mode_layout import WIDTH
from dynamics.kernels.reactions import MeshStates, mesh_reactions, tooth_pair_forces
from dynamics.kernels.wrench import WrenchModes
from thermal.fe.kernel_cache import remove_outdated

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
    "MarchRecord",
    "MeshStates",
    "PackedMeshes",
    "Steps",
    "WrenchModes",
    "march",
    "mesh_reactions",
    "port_place",
    "tooth_pair_forces",
]

remove_outdated(Path(__file__).parent)
