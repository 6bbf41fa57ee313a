"""A loop whose torque reverses presses its shafts along the normal of the flanks that carry then.

The same rig under reversed torque, once with its ports on the flanks in front, which then let go, and once on those on
the back, where the lateral force of a port is that of its normal by construction. Friction is in.
"""

from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

from dynamics.rotor.craig_bampton import Face, SeenRig, mesh_directions, mesh_ports
from dynamics.rotor.static_loop import LoopLoad
from dynamics.vibration.initial_state import wound_state
from dynamics.vibration.march_inputs import DriveLoads, MarchSettings
from dynamics.vibration.time_integration import TimeMarch
from tests.builders.rig import prototype_laws
from tests.unit.dynamics_package.rotor.test_seen_system import films, seen

Array = NDArray[np.float64]
SPEED, TORQUE = 600.0, -180.0
SAMPLES = 1600


@cache
def bearing_forces(face: Face) -> tuple[dict[str, Array], Array]:
    """Mean force of the shaft on each bearing, (y, z) first, and of the meshes [N]; ``face`` of the test mesh."""
    front = seen()
    model = front.reduced.model
    faces = dict(zip(front.ports, (face, "front" if face == "back" else "back"), strict=True))
    rig = SeenRig(
        reduced=front.reduced, ports={name: mesh_ports(model, name, faces[name]) for name in front.ports}
    )
    state, laws = films(SPEED), prototype_laws(friction=0.04)
    system = rig.system(state)
    start, drive, _ = wound_state(system, laws, SPEED, LoopLoad(torque=TORQUE))
    settings = MarchSettings(step=1.0 / 320e3, substeps=8, accounts=False)
    march = TimeMarch(system, laws, start, settings, DriveLoads(drive_torque=drive))
    given = np.array([[drive, start.twist, 0.0, 0.0]])
    march.advance(np.repeat(given, SAMPLES, axis=0))
    whole = rig.reduced.basis @ np.linalg.inv(system.coordinates.freedoms)
    angles, forces = [], []
    for _ in range(SAMPLES // 16):
        forces.append(march.advance(np.repeat(given, 7, axis=0)).force.mean(axis=1))
        angles.append(march.state().angles)
    moved = whole @ np.mean(angles, axis=0)
    found = {name: film.padded()[0] @ (model.ports[name] @ moved) for name, film in state.bearings.items()}
    return found, np.mean(forces, axis=0)


def test_back_flanks_press_along_their_own_normal() -> None:
    own, mesh = bearing_forces("back")
    other, same = bearing_forces("front")
    assert mesh[0] < 0.0 < mesh[1]
    # the twist is that of the stiffness along the normals of the ports
    assert same == pytest.approx(mesh, rel=6e-3)
    for name, force in own.items():
        print(name, force / mesh[1], other[name] / same[1])
        assert other[name] / same[1] == pytest.approx(force / mesh[1], abs=3e-4), name


def test_the_force_on_the_pinion_shaft_has_the_direction_of_the_back_normal() -> None:
    """Its bearings carry the force of the teeth, but for what the couplings pass on."""
    found, mesh = bearing_forces("front")
    model = seen().reduced.model
    directions = mesh_directions(model.rig, next(iter(seen().ports)))
    held = (found["test_pinion front"] + found["test_pinion rear"])[:2]
    along = {name: normal[1:] / np.linalg.norm(normal[1:]) for name, normal in
             (("front", directions.front), ("back", directions.back))}  # fmt: skip
    turned = {
        name: float(np.degrees(np.arccos(held @ line / np.linalg.norm(held)))) for name, line in along.items()
    }
    print(held, mesh, turned)
    # the pinion is pushed against the normal with which it presses the wheel; friction is in
    assert turned["back"] > 180.0 - 4.0
    assert 30.0 < turned["front"] < 150.0
