"""Bracing of a loop whose shafts bend: by twist, by shift, by torque; its stiffness is that of all parts in series."""

import math
from functools import cache

import numpy as np
import pytest

from dynamics.rotor.assembly import ElasticModel, assemble_rig
from dynamics.rotor.bracing import LoopBracing, Mode, ShiftedGear, brace, drift
from dynamics.rotor.craig_bampton import SeenRig, mesh_ports
from dynamics.rotor.graph import assemble
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.reduction import reduce_rig
from dynamics.tooth.law import MeshLaw
from tests.builders.elastic_rig import bearings, prototype_drivetrain, prototype_rig, running
from tests.builders.mesh import wavy_law
from tests.builders.rig import prototype_laws
from tests.builders.static_deflection import static_deflection

TORQUE = 180.0
MODES: tuple[Mode, ...] = ("twist_held", "shift_held", "torque_controlled")
BASE_HELIX = math.asin(math.sin(math.radians(18.0)) * math.cos(math.radians(20.0)))
GEAR = ShiftedGear(
    mesh=1,
    helix_angle=math.radians(18.0),
    base_helix_angle=BASE_HELIX,
    working_radius=0.0995 * 99 / 201,
    halves=2,
    floating_partner=True,
)


@cache
def model() -> ElasticModel:
    return assemble_rig(prototype_rig(0.03))


@cache
def system() -> LinearSystem:
    """The prototype on the bearings of P2, Table 1, all modes kept."""
    rig = model().rig
    seen = SeenRig(
        reduced=reduce_rig(model(), bearings(rig), None),
        ports={mesh.name: mesh_ports(model(), mesh.name) for mesh in rig.drivetrain.meshes},
    )
    return seen.system(running(rig))


def even_laws() -> tuple[MeshLaw, ...]:
    """Of constant stiffness, so that the loop is linear."""
    known = prototype_laws()
    return tuple(
        wavy_law(0.0, base_radius_1=law.base_radius_1, base_radius_2=law.base_radius_2, offset=0.0)
        for law in known
    )


def series_compliance(laws: tuple[MeshLaw, ...]) -> float:
    """Twist of the loop per torque at its test pinion [rad/(N m)], by the work of the tooth forces on the full model.

    The forces of both meshes hold each other: between them every shaft, spline, seat, coupling and bearing carries its
    part. The teeth themselves come on top as springs.
    """
    load = np.zeros(model().size)
    teeth = 0.0
    for mesh, law, torque in zip(model().rig.drivetrain.meshes, laws, (1.0, -1.0), strict=True):
        pinion, wheel = mesh_ports(model(), mesh.name)
        load -= torque * (pinion - law.base_radius_2 / law.base_radius_1 * wheel)
        teeth += 1.0 / (law.mean_stiffness * law.base_radius_1**2)
    moved = static_deflection(model(), running(model().rig), load)
    assert np.abs(moved.unbalanced).max() < 1e-9
    return float(load @ moved.deflection) + teeth


@pytest.mark.parametrize("mode", MODES)
def test_stiffness_of_the_loop_is_that_of_its_parts_in_series(mode: Mode) -> None:
    """dM/dtwist at the state, and over a step of the torque: torsion, bending, bearings and teeth add their yields."""
    laws = even_laws()
    low, high = (
        brace(system(), laws, torque, LoopBracing(mode=mode, gear=GEAR)) for torque in (TORQUE, 200.0)
    )
    expected = 1.0 / series_compliance(laws)
    assert low.loop_stiffness == pytest.approx(expected, rel=1e-6)
    turned = [
        one.twist + abs(one.shift) * GEAR.approach_per_shift / laws[1].base_radius_1 for one in (low, high)
    ]
    assert 20.0 / (turned[1] - turned[0]) == pytest.approx(expected, rel=1e-6)


def test_bending_and_bearings_soften_the_loop() -> None:
    """They take a third of the stiffness that the loop has in torsion alone."""
    laws = even_laws()
    torsional = brace(assemble(prototype_drivetrain(0.03)), laws, TORQUE, LoopBracing(mode="twist_held"))
    assert 0.6 < 1.0 / series_compliance(laws) / torsional.loop_stiffness < 0.75


def test_every_mode_set_to_the_same_state_carries_the_same_torque() -> None:
    """With the crowned teeth of P2: the shift moves the flanks as far as the twist turns the loop. A setting that is
    held keeps its torque as long as nothing expands, and backlash that is lost changes both alike."""
    laws = prototype_laws()
    found = {mode: brace(system(), laws, TORQUE, LoopBracing(mode=mode, gear=GEAR)) for mode in MODES}
    twist = found["twist_held"].twist
    for mode, state in found.items():
        assert state.torque[0] == pytest.approx(TORQUE, rel=1e-9), mode
        # means over a mesh period, in which the torque of the curved teeth is not a straight function of the twist
        assert state.torque[1] == pytest.approx(-TORQUE, rel=1e-4), mode
        shifted = abs(state.shift) * GEAR.approach_per_shift / laws[1].base_radius_1
        assert state.twist + shifted == pytest.approx(twist, rel=1e-4), mode
    warm = (laws[0]._replace(offset=laws[0].offset + 5e-6), laws[1])
    changes = []
    for mode in ("twist_held", "shift_held"):
        still = drift(system(), laws, laws, TORQUE, LoopBracing(mode=mode, gear=GEAR))
        assert still.torque_change == pytest.approx(0.0, abs=1e-6)
        changes.append(drift(system(), laws, warm, TORQUE, LoopBracing(mode=mode, gear=GEAR)))
    assert changes[0].torque_change == pytest.approx(changes[1].torque_change, rel=1e-4)
    by_hand = 5e-6 / laws[0].base_radius_1 * changes[0].initial.loop_stiffness
    assert abs(changes[0].torque_change) == pytest.approx(by_hand, rel=0.02)
