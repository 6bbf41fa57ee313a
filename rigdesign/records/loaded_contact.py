"""Loaded contact of the meshes from influence numbers: quasi-static, warm, at the test.

All teeth alike, with their modifications; axes parallel. The dynamic loads are those of the mesh law, which this does
not enter yet; K_Hbeta of the ratings is still that of the case.
"""

from collections.abc import Iterator
from math import radians

from dynamics.contact.contact_ratio import unloaded_contact_ratio
from dynamics.contact.face import FaceGrid, default_positions
from dynamics.contact.flank_gap import modified_gap
from dynamics.contact.loaded_mesh import LoadedMesh
from dynamics.contact.local_approach import EdgeModel
from dynamics.contact.root_course import root_course
from dynamics.mesh.pair_gap import PairGap
from rigdesign.coupling.loads import LEAST_TORQUE, mesh_microgeometry
from rigdesign.coupling.loop import PointResult
from rigdesign.records.gauge_stress import ElasticGear, gauge_stresses
from rigdesign.results.loaded_contact import LoadedContact
from rigdesign.rig.model import Rig

FIDELITIES = ("reference",)
"""At which influence numbers are computed: half a minute a gear, once. The others have the analytic teeth alone."""
ROOT = radians(15.0)
"""Least angle between fillet and tooth axis of the root: nearer to the flank the stress is that of the contact."""
FINE = 1024
"""Positions of a mesh cycle for the contact ratio without load."""


def loaded_contact(rig: Rig, point: PointResult, mesh: int) -> LoadedContact | None:
    """Contact of one mesh, by its number, at a held point; None without load and where the fidelity has none."""
    response = point.last.response
    if rig.fidelity not in FIDELITIES or response is None:
        return None
    torque = float(response.mean[mesh])
    if abs(torque) < LEAST_TORQUE:
        return None
    name, pair = rig.mesh_names[mesh], point.last.models[mesh].pair
    gap = PairGap.of_pair(pair, mesh_microgeometry(rig, name, pair))
    grid = FaceGrid.over(pair.face_width, default_positions(pair, gap_varies=True))
    numbers, compliances = (
        rig.tooth_influence.of_pair(rig.pairs[name]),
        rig.tooth_influence.compliances(rig.pairs[name]),
    )
    loaded = LoadedMesh(
        pair=pair, gears=compliances, grid=grid, gap=modified_gap(gap), edges=EdgeModel(softer=False)
    )
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
        gauges=gauge_stresses(
            rig,
            name,
            cycle,
            (ElasticGear(numbers[0], compliances[0]), ElasticGear(numbers[1], compliances[1])),
        ),
    )


def missing_numbers(rig: Rig) -> Iterator[str]:
    """Meshes whose influence numbers are wanted and not stored."""
    if rig.fidelity in FIDELITIES and rig.drivetrain is not None:
        yield from (name for name in rig.mesh_names if not rig.tooth_influence.stored(rig.pairs[name]))
