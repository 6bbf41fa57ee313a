"""Static closure of the power loop: twist times loop stiffness is the torque, stiffness by series sum."""

import math
from dataclasses import replace

import numpy as np
import pytest

from dynamics.errors import DynamicsInputError
from dynamics.rotor.graph import assemble
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.shaft import STEEL_SHEAR_MODULUS
from dynamics.rotor.static_loop import LoopLoad, SlowRotation, port_model, solve_static
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.mesh_force import evaluate_mesh, static_cycle
from dynamics.vibration.initial_state import wound_state
from tests.builders.rig import BASE_RADIUS_REFERENCE, BASE_RADIUS_TEST, SHAFTS, prototype, prototype_laws


def constant(law: MeshLaw) -> MeshLaw:
    """The same mesh with one pair of constant stiffness, no gap, no backlash and no friction."""
    return law._replace(
        path_start=0.0,
        path_step=law.base_pitch / 4,
        stiffness=np.full((1, 5), law.mean_stiffness),
        gap=np.zeros((1, 5)),
        slice_shift=np.zeros(1),
        deviation_1=np.zeros((1, 5)),
        deviation_2=np.zeros((1, 5)),
        backlash=0.0,
        friction=0.0,
        damping=0.0,
    )


def series_stiffness() -> float:
    """Stiffness of the loop on the pinion line by hand: sections from gear to coupling, meshes, splines."""
    compliance = {"pinion": 0.0, "wheel": 0.0}
    for name, (sections, flange, gear) in SHAFTS.items():
        line = name.split("_")[1]
        low, high = sorted((gear[0], flange[0]))
        start = 0.0
        for length, diameter in sections:
            inside = max(0.0, min(start + length, high) - max(start, low)) * 1e-3
            compliance[line] += inside / (STEEL_SHEAR_MODULUS * math.pi * (diameter * 1e-3) ** 4 / 32.0)
            start += length
        compliance[line] += 1.0 / 1e6
    compliance["pinion"] += 1.0 / 138e3
    compliance["wheel"] += 1.0 / 290e3
    ratio = 102 / 99
    meshes = 1.0 / (1.14e8 * BASE_RADIUS_TEST**2) + 1.0 / (7.09e8 * BASE_RADIUS_REFERENCE**2)
    # the wheel line carries ratio times the torque and turns by 1 / ratio as seen from the pinion line
    return 1.0 / (compliance["pinion"] + compliance["wheel"] * ratio**2 + meshes)


def rig() -> tuple[LinearSystem, tuple[MeshLaw, MeshLaw]]:
    first, second = prototype_laws(friction=0.0)
    return assemble(prototype()), (constant(first), constant(second))


@pytest.mark.parametrize("torque", [180.0, 10.0, -90.0])
def test_twist_times_loop_stiffness_is_the_torque(torque: float) -> None:
    system, laws = rig()
    state = solve_static(port_model(system, laws), LoopLoad(torque=torque))
    assert state.twist * series_stiffness() == pytest.approx(torque, rel=1e-8)
    assert state.mean_torque == pytest.approx([torque, -torque], rel=1e-9)
    assert np.abs(state.drive).max() < 1e-9 * abs(torque)


def test_backlash_adds_its_windup() -> None:
    """Front flank in one mesh, back flank in the other: the loop first turns through the play."""
    system, laws = rig()
    played = (laws[0], laws[1]._replace(backlash=50e-6))
    closed = solve_static(port_model(system, laws), LoopLoad(torque=180.0))
    open_ = solve_static(port_model(system, played), LoopLoad(torque=180.0))
    assert open_.twist - closed.twist == pytest.approx(50e-6 / BASE_RADIUS_REFERENCE, rel=1e-8)


def test_held_twist_gives_the_torque_back() -> None:
    system, laws = assemble(prototype()), prototype_laws(friction=0.0)
    model = port_model(system, laws)
    wound = solve_static(model, LoopLoad(torque=180.0))
    held = solve_static(model, LoopLoad(twist=wound.twist))
    assert held.mean_torque == pytest.approx(wound.mean_torque, rel=1e-9)


def test_drive_torque_of_slow_rotation_is_friction_over_speed() -> None:
    """Virtual work: what the motor gives over a mesh period is what friction takes."""
    system, laws = assemble(prototype()), prototype_laws(friction=0.04)
    model = port_model(system, laws)
    angles = np.arange(512) / 512 * 2.0 * np.pi / (99 * model.ratios[0])
    state = solve_static(model, LoopLoad(torque=180.0), rotation=SlowRotation(angles=angles, speed=78.5))
    lossless = solve_static(
        port_model(system, [law._replace(friction=0.0) for law in laws]),
        LoopLoad(torque=180.0),
        rotation=SlowRotation(angles=angles, speed=78.5),
    )
    assert lossless.drive.mean() == pytest.approx(0.0, abs=2e-3)
    taken = 0.0
    for m, law in enumerate(laws):
        speeds = model.ratios[2 * m : 2 * m + 2] * 78.5
        reaction = evaluate_mesh(
            law._replace(damping=0.0),
            model.ratios[2 * m] * angles + state.ports[:, 2 * m],
            state.approach[:, m],
            speeds[0],
            speeds[1],
        )
        taken += float(reaction.friction_power.mean())
    assert state.drive.mean() * 78.5 == pytest.approx(taken, rel=5e-3)
    assert taken > 20.0


def test_twist_inside_the_backlash_carries_nothing() -> None:
    system, laws = rig()
    state = solve_static(port_model(system, (laws[0], laws[1]._replace(backlash=1e-3))), LoopLoad(twist=1e-4))
    assert np.abs(state.torque).max() < 1e-9


def test_torque_or_twist_must_be_given() -> None:
    system, laws = rig()
    with pytest.raises(ValueError, match="either the torque or the twist"):
        solve_static(port_model(system, laws), LoopLoad())
    with pytest.raises(ValueError, match="1 mesh laws for 2 meshes"):
        port_model(system, laws[:1])


def test_drag_torques_wind_the_loop_as_every_line_balances() -> None:
    """The motor carries all drag torques, those of the pinion line through the meshes, at the speeds of the lines."""
    system, laws = rig()
    on_pinion, on_wheel = "test_pinion left", "test_wheel right"
    drags = {on_pinion: 0.7, on_wheel: 0.4}
    state, drive, _ = wound_state(system, laws, speed=1000.0, drag_torques=drags, load=LoopLoad(torque=180.0))
    assert drive == pytest.approx(0.4 + 0.7 * 102 / 99, rel=1e-9)
    torque = [
        law.base_radius_1
        * law.mean_stiffness
        * (law.base_radius_1 * state.angles[pinion] - law.base_radius_2 * state.angles[wheel])
        for law, (pinion, wheel) in zip(laws, system.mesh_ports)
    ]
    assert torque[0] == pytest.approx(180.0, rel=1e-9)
    assert sum(torque) == pytest.approx(-0.7, rel=1e-7)


def stiff(system: LinearSystem, n_hidden: int, order: int) -> LinearSystem:
    """The same loop with freedoms that nothing loads, of 1e8 to 1e14 N m/rad, all freedoms in another order."""
    random = np.random.default_rng(order)
    n = len(system.inertia)
    follow = (
        random.normal(size=(n_hidden, n))
        * (np.abs(system.stiffness) > 0.0)[random.integers(n, size=n_hidden)]
    )
    own = np.geomspace(1e8, 1e14, n_hidden)
    follow = np.sqrt(1e9 / own)[:, None] * (follow - follow @ system.rigid @ np.linalg.pinv(system.rigid))
    tie = own[:, None] * follow
    stiffness = np.block([[system.stiffness + follow.T @ tie, -tie.T], [-tie, np.diag(own)]])
    place = random.permutation(n + n_hidden)
    back = np.argsort(place)

    def longer(values: np.ndarray) -> np.ndarray:
        return np.concatenate([values, np.zeros((n_hidden, *values.shape[1:]))])[place]

    every = np.ix_(place, place)
    return replace(
        system,
        inertia=np.diag(np.ones(n + n_hidden)),
        damping=np.zeros((n + n_hidden, n + n_hidden)),
        stiffness=stiffness[every],
        dofs=tuple(str(i) for i in place),
        mesh_ports=back[system.mesh_ports],
        rigid=longer(system.rigid),
        drive_dof=int(back[system.drive_dof]),
        twist_load=longer(system.twist_load),
        drag_loads={name: longer(load) for name, load in system.drag_loads.items()},
    )


@pytest.mark.parametrize("torque", [1e-3, 1.0, 180.0, 180e3])
def test_static_state_does_not_depend_on_the_order_of_sums(torque: float) -> None:
    """With springs over twelve decades, whose round-off is above 1e-9 of the tooth force at small torques."""
    system, laws = assemble(prototype()), prototype_laws(friction=0.0)
    expected = wound_state(system, laws, 0.0, LoopLoad(torque=torque))
    for order in range(8):
        wound = wound_state(stiff(system, 300, order), laws, 0.0, LoopLoad(torque=torque))
        assert wound.state.twist == pytest.approx(expected.state.twist, rel=1e-8)
        assert wound.loop_stiffness == pytest.approx(expected.loop_stiffness, rel=1e-6)


def test_bracing_that_winds_nothing_is_refused() -> None:
    system, laws = rig()
    with pytest.raises(DynamicsInputError, match="twist does not load the first mesh"):
        wound_state(replace(system, twist_load=0.0 * system.twist_load), laws, 0.0, LoopLoad(torque=180.0))


LENGTHS = (
    "base_radius_1",
    "base_radius_2",
    "base_pitch",
    "path_start",
    "path_step",
    "gap",
    "slice_shift",
    "backlash",
)
LENGTHS += (
    "deviation_1",
    "deviation_2",
    "offset",
    "phase",
    "back_phase",
    "rolling_radius_1",
    "rolling_radius_2",
)
LENGTHS += ("friction_reversal_speed", "damping_depth", "stiffness", "mean_stiffness")


def similar(factor: float) -> tuple[LinearSystem, tuple[MeshLaw, ...]]:
    """The prototype with all its torques times a factor at the same stresses, lengths with its third root."""
    length, system = factor ** (1.0 / 3.0), assemble(prototype())
    laws = tuple(
        law._replace(
            damping=length**2 * law.damping, **{name: length * getattr(law, name) for name in LENGTHS}
        )
        for law in prototype_laws()
    )
    return replace(
        system,
        inertia=length**5 * system.inertia,
        damping=length**4 * system.damping,
        stiffness=factor * system.stiffness,
        twist_load=factor * system.twist_load,
    ), laws


@pytest.mark.parametrize("factor", [0.1, 1e3])
@pytest.mark.parametrize("torque", [1e-2, 180.0])
def test_a_larger_or_smaller_rig_finds_the_same_state(factor: float, torque: float) -> None:
    """No limit of an iteration is a force, torque or length as such."""
    system, laws = similar(factor)
    base_system, base_laws = similar(1.0)
    wanted, base = LoopLoad(torque=factor * torque), LoopLoad(torque=torque)
    wound = wound_state(system, laws, 0.0, wanted)
    assert wound.state.twist == pytest.approx(
        wound_state(base_system, base_laws, 0.0, base).state.twist, rel=1e-8
    )
    found = solve_static(port_model(system, laws), wanted)
    assert found.twist == pytest.approx(
        solve_static(port_model(base_system, base_laws), base).twist, rel=1e-8
    )
    cycle, like = (
        static_cycle(law, load)
        for law, load in ((laws[0], factor ** (2.0 / 3.0) * torque), (base_laws[0], torque))
    )
    assert cycle.approach == pytest.approx(factor ** (1.0 / 3.0) * like.approach, rel=1e-8)
