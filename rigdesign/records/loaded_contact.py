"""Loaded contact of the meshes from influence numbers: quasi-static, warm, at the test.

All teeth alike, with their modifications; axes parallel. The dynamic loads are those of the mesh law, which this does
not enter yet; K_Hbeta of the ratings is still that of the case.
"""

from math import radians

from dynamics.contact.contact_ratio import unloaded_contact_ratio
from dynamics.contact.face import FaceGrid, default_positions
from dynamics.contact.flank_gap import modified_gap
from dynamics.contact.loaded_mesh import LoadedMesh
from dynamics.contact.root_course import root_course
from dynamics.mesh.pair_gap import PairGap
from rigdesign.coupling.loads import LEAST_TORQUE, mesh_microgeometry
from rigdesign.coupling.loop import PointResult
from rigdesign.results.loaded_contact import LoadedContact
from rigdesign.rig.model import Rig

ROOT = radians(15.0)
"""Least angle between fillet and tooth axis of the root: nearer to the flank the stress is that of the contact."""
FINE = 1024
"""Positions of a mesh cycle for the contact ratio without load."""


def loaded_contact(rig: Rig, point: PointResult, mesh: int) -> LoadedContact | None:
    """Contact of one mesh, by its number, at a held point; None without load and where the teeth are analytic."""
    response = point.last.response
    if rig.mesh_stiffness != "influence_numbers" or response is None:
        return None
    torque = float(response.mean[mesh])
    if abs(torque) < LEAST_TORQUE:
        return None
    name, pair = rig.mesh_names[mesh], point.last.models[mesh].pair
    gap = PairGap.of_pair(pair, mesh_microgeometry(rig, name, pair))
    grid = FaceGrid.over(pair.face_width, default_positions(pair, gap_varies=True))
    cold = rig.pairs[name]
    numbers, compliances = rig.tooth_influence.of_pair(cold), rig.tooth_influence.compliances(cold)
    loaded = LoadedMesh(pair=pair, gears=compliances, grid=grid, gap=modified_gap(gap))
    cycle = loaded.cycle(abs(torque) / pair.base_radii[0])
    return LoadedContact(
        stage=point.point.stage,
        torque=torque,
        cycle=cycle,
        unloaded_contact_ratio=unloaded_contact_ratio(loaded.points(cycle.points.reach, FINE)),
        roots=(
            root_course(cycle, numbers[0], compliances[0], 0).within(numbers[0].fillet.tangent >= ROOT),
            root_course(cycle, numbers[1], compliances[1], 1).within(numbers[1].fillet.tangent >= ROOT),
        ),
    )
