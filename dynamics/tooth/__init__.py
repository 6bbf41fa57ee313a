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

from typing import TYPE_CHECKING

import lazy_loader

if TYPE_CHECKING:
    from dynamics.tooth.elastic_pair import influence_law as influence_law
    from dynamics.tooth.friction import friction_coefficient as friction_coefficient
    from dynamics.tooth.friction import tooth_loss_factor as tooth_loss_factor
    from dynamics.tooth.law import MeshLaw as MeshLaw
    from dynamics.tooth.loaded_mesh import LoadedMesh as LoadedMesh
    from dynamics.tooth.mesh_force import evaluate_mesh as evaluate_mesh
    from dynamics.tooth.mesh_force import static_cycle as static_cycle
    from dynamics.tooth.mesh_force import tooth_forces as tooth_forces
    from dynamics.tooth.mesh_laws import ContactDiscretisation as ContactDiscretisation
    from dynamics.tooth.mesh_laws import MeshDissipation as MeshDissipation
    from dynamics.tooth.mesh_laws import MeshPosition as MeshPosition
    from dynamics.tooth.mesh_laws import PairStiffness as PairStiffness
    from dynamics.tooth.mesh_laws import mesh_law as mesh_law
    from dynamics.tooth.mesh_laws import pair_stiffness as pair_stiffness
    from dynamics.tooth.root_field import RootField as RootField

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "elastic_pair": ["influence_law"],
        "friction": ["friction_coefficient", "tooth_loss_factor"],
        "law": ["MeshLaw"],
        "loaded_mesh": ["LoadedMesh"],
        "mesh_force": ["evaluate_mesh", "static_cycle", "tooth_forces"],
        "mesh_laws": [
            "ContactDiscretisation",
            "MeshDissipation",
            "MeshPosition",
            "PairStiffness",
            "mesh_law",
            "pair_stiffness",
        ],
        "root_field": ["RootField"],
    },
)
