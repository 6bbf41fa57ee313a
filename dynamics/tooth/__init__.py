"""Teeth in mesh: influence numbers, loaded contact, mesh law with forces, friction and sliding, root stress.

With the pair of `dynamics.gear`, under load stage 10 of the FZG test:

>>> from dynamics.gear import Microgeometry
>>> from dynamics.tooth import MeshDissipation, mesh_law, pair_stiffness, static_cycle
>>> force = 302.0 / pair.base_radii[0]
>>> relieved = Microgeometry(tip_relief=35e-6, tip_relief_length=2.5e-3)
>>> law = mesh_law(
...     pair,
...     pair_stiffness(pair, force / pair.face_width),
...     (relieved, relieved),
...     dissipation=MeshDissipation(damping=1.5e3, friction=0.05),
... )
>>> cycle = static_cycle(law, force)
>>> print(f"transmission error {1e6 * (cycle.approach.max() - cycle.approach.min()):.0f} um")
transmission error 18 um
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from dynamics.tooth.elastic_pair import influence_law
    from dynamics.tooth.friction import friction_coefficient, tooth_loss_factor
    from dynamics.tooth.law import MeshLaw
    from dynamics.tooth.loaded_mesh import LoadedMesh
    from dynamics.tooth.mesh_force import evaluate_mesh, static_cycle, tooth_forces
    from dynamics.tooth.mesh_laws import ContactDiscretisation, MeshDissipation, MeshPosition, mesh_law
    from dynamics.tooth.root_field import RootField
    from dynamics.tooth.stiffness import PairStiffness, pair_stiffness

__all__ = [
    "ContactDiscretisation",
    "LoadedMesh",
    "MeshDissipation",
    "MeshLaw",
    "MeshPosition",
    "PairStiffness",
    "RootField",
    "evaluate_mesh",
    "friction_coefficient",
    "influence_law",
    "mesh_law",
    "pair_stiffness",
    "static_cycle",
    "tooth_forces",
    "tooth_loss_factor",
]

_HOMES = {
    "ContactDiscretisation": "mesh_laws",
    "LoadedMesh": "loaded_mesh",
    "MeshDissipation": "mesh_laws",
    "MeshLaw": "law",
    "MeshPosition": "mesh_laws",
    "PairStiffness": "stiffness",
    "RootField": "root_field",
    "evaluate_mesh": "mesh_force",
    "friction_coefficient": "friction",
    "influence_law": "elastic_pair",
    "mesh_law": "mesh_laws",
    "pair_stiffness": "stiffness",
    "static_cycle": "mesh_force",
    "tooth_forces": "mesh_force",
    "tooth_loss_factor": "friction",
}


def __getattr__(name: str) -> object:
    """Import a name on first use."""
    if name in _HOMES:
        return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
