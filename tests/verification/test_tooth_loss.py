"""Loss of teeth and emergency stop against closed forms: free flight of a gear, section torque, rigid run-down."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError
from dynamics.rotor.assembly import assemble_rig
from dynamics.rotor.bearing_state import RunningState
from dynamics.rotor.craig_bampton import SeenRig, elastic_twist_rows, mesh_directions, mesh_ports
from dynamics.rotor.graph import assemble, shaft_chains, torsional_twist_rows
from dynamics.rotor.linear_system import LinearSystem, line_shapes
from dynamics.rotor.reduction import reduce_rig
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.mesh_force import tooth_forces
from dynamics.vibration.event_march import (
    Brake,
    EventMarch,
    SteadyStart,
    Trip,
    Watched,
    bearing_channels,
    steady_start,
    teeth_in_mesh,
    time_to_standstill,
    torque_channels,
    without_teeth,
)
from dynamics.vibration.initial_state import pinion_ratios
from tests.builders.elastic_rig import bearings, prototype_rig
from tests.builders.rig import prototype, prototype_laws

Array = NDArray[np.float64]
RPM = math.pi / 30.0
SPEED, TORQUE = 6000.0 * RPM, 180.0


@pytest.fixture(scope="module")
def torsional() -> tuple[LinearSystem, tuple[MeshLaw, ...], SteadyStart, Watched]:
    drivetrain = prototype()
    system, laws = assemble(drivetrain), prototype_laws()
    return (
        system,
        laws,
        steady_start(system, laws, SPEED, TORQUE, {}),
        Watched(torque_channels(torsional_twist_rows(drivetrain))),
    )


@pytest.mark.parametrize("member", ["pinion", "wheel"])
@pytest.mark.parametrize("back", [False, True])
def test_lost_teeth_are_those_that_carry_and_carry_nothing_after(member: str, back: bool) -> None:
    """By the force of every tooth pair, over a turn of the pinion, on the flank that carries."""
    (law, _), approach = prototype_laws(), 40e-6
    law = law._replace(tooth_offset_2=5, offset=0.0)
    x = -approach - law.backlash if back else approach
    for angle in np.linspace(0.0, 2.0 * math.pi, 23):
        (tooth,) = teeth_in_mesh(law, angle, x, member, 1)  # type: ignore[arg-type]
        whole = tooth_forces(law, angle, x)
        force = (whole.back if back else whole.front)[0].sum(axis=1)
        pairs = whole.pair[0]
        number = pairs % law.teeth_1 if member == "pinion" else (pairs + 5 + back) % law.teeth_2
        assert force[number == tooth].sum() == force.max() > 0.0
        broken = tooth_forces(without_teeth(law, member, (tooth,)), angle, x)  # type: ignore[arg-type]
        left = (broken.back if back else broken.front)[0].sum(axis=1)
        assert left[number == tooth].sum() == 0.0
        assert left[number != tooth] == pytest.approx(force[number != tooth])


def test_no_mesh_without_teeth() -> None:
    law = prototype_laws()[0]
    with pytest.raises(DynamicsInputError, match="no tooth carries"):
        teeth_in_mesh(law, 0.0, -1e-6, "pinion", 1)
    with pytest.raises(DynamicsInputError, match="must be from 1 to 98 of 99"):
        without_teeth(law, "pinion", tuple(range(99)))


def test_a_gear_without_any_contact_flies_freely(
    torsional: tuple[LinearSystem, tuple[MeshLaw, ...], SteadyStart, Watched],
) -> None:
    """All teeth but one gone: from then on the mesh transmits nothing, and kinetic plus elastic energy of the wound
    loop moves the gear body as its own inertia under the torque of its seat."""
    system, laws, start, watched = torsional
    march = EventMarch(system, laws, start, watched)
    kept = (march.carrying_teeth(0, "pinion", 1)[0] + 50) % 99
    gone = tuple(tooth for tooth in range(99) if tooth != kept)
    history = march.run(1e-3, laws=[without_teeth(laws[0], "pinion", gone), laws[1]])
    assert np.all(history.greatest[0, 1:] == 0.0) and np.all(history.least[0, 1:] == 0.0)
    # the section next to the gear unwinds from the mean torque towards the other side within its own half period
    rows = torsional_twist_rows(prototype())
    ends = shaft_chains(prototype())["test_pinion"].positions
    own = [i for i, section in enumerate(rows.sections) if section.part == "test_pinion"]
    middles = 0.5 * (ends[:-1] + ends[1:])
    at = next(i for i, middle in zip(own, middles, strict=True) if 0.19 <= middle < 0.2)
    values = history.values[at]
    assert abs(history.before[at]) == pytest.approx(TORQUE, rel=0.03)
    assert values.min() < -0.9 * abs(history.before[at]) and values.max() > 0.3 * abs(history.before[at])


@pytest.mark.parametrize("teeth", [1, 2])
def test_more_lost_teeth_hit_harder(
    torsional: tuple[LinearSystem, tuple[MeshLaw, ...], SteadyStart, Watched], teeth: int
) -> None:
    """Where one tooth is lost the next pair already carries for part of the pitch: contact ratio 1.26 and above."""
    system, laws, start, watched = torsional
    march = EventMarch(system, laws, start, watched)
    lost = march.carrying_teeth(0, "pinion", teeth)
    history = march.run(0.012, laws=[without_teeth(laws[0], "pinion", lost), laws[1]])
    quiet = march.run(0.012)
    assert history.greatest[0].max() > (1.2 if teeth == 1 else 1.8) * quiet.greatest[0].max()
    # the gap comes back after one turn of the pinion: 10 ms
    period = 2.0 * math.pi / SPEED
    early = history.greatest[0][history.time < 0.3e-3].min()
    late = history.greatest[0][np.abs(history.time - period - 0.15e-3) < 0.15e-3].min()
    assert early < 20.0 and late < 60.0


def test_monitor_trips_at_the_first_crossing_and_the_brake_follows(
    torsional: tuple[LinearSystem, tuple[MeshLaw, ...], SteadyStart, Watched],
) -> None:
    system, laws, start, watched = torsional
    march = EventMarch(system, laws, start, watched)
    lost = march.carrying_teeth(0, "pinion", 2)
    channel = watched.index("pinion side", "coupling")
    history = march.run(
        0.006, laws=[without_teeth(laws[0], "pinion", lost), laws[1]],
        trip=Trip(channel=channel, limit=200.0, delay=1e-3), brake=Brake(torque=20.0),
    )  # fmt: skip
    amount = np.abs(history.values[channel])
    first = int(np.argmax(amount > 200.0))
    assert history.tripped == pytest.approx(history.time[first])
    assert history.braked == pytest.approx(history.time[first] + 1e-3)
    assert history.braked is not None
    braked = history.time >= history.braked
    assert history.drive[braked] == pytest.approx(-20.0) and history.drive[~braked] == pytest.approx(
        start.drive_torque
    )


def test_standstill_of_a_rigid_rotor_under_a_constant_torque_and_linear_drag() -> None:
    """J / c ln(1 + c omega / M) (Newton), with J of both lines on the drive."""
    system, laws = assemble(prototype()), prototype_laws()
    ratios = pinion_ratios(system, laws) / pinion_ratios(system, laws)[system.drive_dof]
    inertia, drag, brake = float(ratios @ system.inertia @ ratios), 2e-3, 5.0
    exact = inertia / drag * math.log1p(drag * SPEED / brake)
    found = time_to_standstill(system, laws, SPEED, Brake(torque=brake), lambda speed: drag * speed)
    assert found == pytest.approx(exact, rel=1e-4)
    with pytest.raises(DynamicsInputError, match="give a brake torque"):
        time_to_standstill(system, laws, SPEED, Brake(torque=0.0), lambda speed: 0.0)


def test_stop_under_load_slows_as_a_rigid_rotor(
    torsional: tuple[LinearSystem, tuple[MeshLaw, ...], SteadyStart, Watched],
) -> None:
    """Over a stop much longer than the motor shaft swings: impulse of motor, brake and losses over the inertia."""
    system, laws, start, watched = torsional
    ratios = pinion_ratios(system, laws)
    inertia = float(ratios @ system.inertia @ ratios) / float(ratios[system.drive_dof])
    brake = 40.0
    history = EventMarch(system, laws, start, watched).run(
        0.02, trip=Trip(channel=None), brake=Brake(torque=brake)
    )
    mean = history.speed[-160:].mean()
    lost = (brake + start.drive_torque) / inertia * (history.time[-160:].mean())
    assert SPEED - mean == pytest.approx(lost, rel=0.05)


def test_bearings_of_the_elastic_rig_carry_the_mesh_force() -> None:
    """Mean forces of both bearings of a shaft add up to the tooth force along the line of action."""
    rig, laws = prototype_rig(0.03), prototype_laws()
    model = assemble_rig(rig)
    seen = SeenRig(
        reduced=reduce_rig(model, bearings(rig), 50e3),
        ports={mesh.name: mesh_ports(model, mesh.name) for mesh in rig.drivetrain.meshes},
    )
    state = RunningState(speed=SPEED, bearings=bearings(rig))
    system = seen.system(state)
    channels = torque_channels(elastic_twist_rows(seen)) + bearing_channels(seen, system, state)
    watched = Watched(channels)
    start = steady_start(system, laws, SPEED, TORQUE, {})
    history = EventMarch(system, laws, start, watched).run(1e-3)
    own = [watched.index(f"test_pinion {end}", "bearing") for end in ("front", "rear")]
    force = abs(history.before_torque[0]) / laws[0].base_radius_1
    assert mesh_directions(rig, "test").pressure_angle > 0.0
    # both forces are parallel but for the share of coupling and friction
    assert history.before[own].sum() == pytest.approx(force, rel=0.05)
    coupling = watched.index("pinion side", "coupling")
    assert abs(history.before[coupling]) == pytest.approx(TORQUE, rel=0.03)


def test_channels_of_a_rigid_rotation_show_nothing() -> None:
    drivetrain = prototype()
    system = assemble(drivetrain)
    watched = Watched(torque_channels(torsional_twist_rows(drivetrain)))
    rigid = line_shapes(np.argmax(np.abs(system.rigid), axis=1))
    for shape in rigid.T:
        for channel in watched.channels:
            assert np.abs(channel.angle @ shape).max() < 1e-9 * np.abs(channel.angle).max()
    with pytest.raises(KeyError):
        watched.index("nowhere", "shaft")
