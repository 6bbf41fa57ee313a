"""Damping of a mesh: a constant of the case, or a share of the critical damping of its two gear bodies."""

import math

from dynamics.mesh.law import MeshLaw
from rigdesign.rig.drivetrain import gear_inertia
from rigdesign.rig.model import Rig


def mesh_damping(rig: Rig, name: str, law: MeshLaw) -> float:
    """Damping along the line of action, of one half of a double-helical mesh [N s/m].

    c = 2 zeta sqrt(k m_red), k the mean stiffness of the mesh and m_red = 1 / (r_b1^2/J_1 + r_b2^2/J_2) the gear
    bodies reduced to the line of action: the ratio that the damping audit of `dynamics.drivetrain.modes` reports.

    name : of the mesh, ``gearbox.mesh``; law : with mean stiffness and base radii
    """
    box_name, own = name.split(".")
    box = rig.case.gearboxes[box_name]
    mesh = box.meshes[own]
    if mesh.damping is not None:
        return mesh.damping
    assert mesh.damping_ratio is not None
    first, second = (
        gear_inertia(rig.case, box_name, gear, rig.pairs, rig.materials) for gear in (mesh.pinion, mesh.wheel)
    )
    mobility = mesh.sharing * (law.base_radius_1**2 / first + law.base_radius_2**2 / second)
    return 2.0 * mesh.damping_ratio * math.sqrt(law.mean_stiffness / mobility)
