import math

import pytest

from dynamics.errors import DynamicsNotConverged
from dynamics.rotor import bracing
from dynamics.rotor.bracing import LoopBracing, ShiftedGear, brace, drift
from dynamics.rotor.graph import assemble
from dynamics.rotor.static_loop import LoopLoad, PortModel
from tests.builders.rig import TRANSVERSE_ANGLE, prototype, prototype_laws

HELIX = math.radians(18.0)
BASE_HELIX = math.asin(math.sin(HELIX) * math.cos(math.radians(20.0)))
WORKING_RADIUS = 0.0995 * 99 / 201


def shifted(floating: bool = True, halves: int = 2) -> ShiftedGear:
    return ShiftedGear(
        mesh=1,
        helix_angle=HELIX,
        base_helix_angle=BASE_HELIX,
        working_radius=WORKING_RADIUS,
        halves=halves,
        floating_partner=floating,
        spline_friction=0.1,
        spline_radius=0.020,
    )


def test_every_mode_makes_the_asked_torque() -> None:
    system, laws = assemble(prototype()), prototype_laws()
    for mode in ("twist_held", "shift_held", "torque_controlled"):
        state = brace(system, laws, 180.0, LoopBracing(mode=mode, gear=shifted()))  # type: ignore[arg-type]
        assert state.torque[0] == pytest.approx(180.0, rel=1e-9)
        assert state.torque[1] == pytest.approx(-180.0, rel=1e-3)


def test_shift_turns_the_loop_as_far_as_the_twist_would() -> None:
    """s tan(beta) / (2 r_w) with a floating partner stands for the same windup."""
    system, laws = assemble(prototype()), prototype_laws()
    by_twist = brace(system, laws, 180.0, LoopBracing(mode="twist_held"))
    by_shift = brace(system, laws, 180.0, LoopBracing(mode="shift_held", gear=shifted()))
    assert by_shift.twist == pytest.approx(0.0, abs=1e-10)
    assert abs(by_shift.rotation) == pytest.approx(by_twist.twist, rel=0.02)
    assert by_shift.rotation == pytest.approx(by_shift.shift * math.tan(HELIX) / (2.0 * WORKING_RADIUS))
    fixed = brace(system, laws, 180.0, LoopBracing(mode="shift_held", gear=shifted(floating=False)))
    assert fixed.shift == pytest.approx(0.5 * by_shift.shift, rel=1e-9)


def test_forces_on_the_moved_half() -> None:
    """About 600 N per half at 180 Nm, about 450 N of spline friction (mu 0.1, r 20 mm)."""
    state = brace(
        assemble(prototype()), prototype_laws(), 180.0, LoopBracing(mode="torque_controlled", gear=shifted())
    )
    assert state.actuator_force == pytest.approx(600.0, rel=0.02)
    assert state.friction_force == pytest.approx(450.0, rel=0.02)


@pytest.mark.parametrize(("floating", "share"), [(True, 0.5), (False, 1.0)])
def test_uncompensated_growth_changes_a_held_torque(floating: bool, share: float) -> None:
    """0.1 mm changes the torque by the rotation it makes times the loop stiffness."""
    system, laws = assemble(prototype()), prototype_laws()
    found = drift(
        system,
        laws,
        laws,
        180.0,
        LoopBracing(mode="shift_held", gear=shifted(floating)),
        axial_expansion=1e-4,
    )
    expected = share * 1e-4 * math.tan(HELIX) / WORKING_RADIUS * found.initial.loop_stiffness
    assert abs(found.torque_change) == pytest.approx(expected, rel=0.03)


def test_growth_in_the_bracing_direction_raises_the_torque() -> None:
    system, laws = assemble(prototype()), prototype_laws()
    along = math.copysign(
        1e-4, brace(system, laws, 180.0, LoopBracing(mode="shift_held", gear=shifted())).shift
    )
    assert (
        drift(
            system, laws, laws, 180.0, LoopBracing(mode="shift_held", gear=shifted()), axial_expansion=along
        ).torque_change
        > 5.0
    )
    assert (
        drift(
            system, laws, laws, 180.0, LoopBracing(mode="shift_held", gear=shifted()), axial_expansion=-along
        ).torque_change
        < -5.0
    )


def test_less_backlash_raises_a_held_torque_by_its_windup() -> None:
    """The reference mesh carries on its back flank: 20 um less play wind the loop by 20 um / r_b1."""
    system, laws = assemble(prototype()), prototype_laws()
    hot = (laws[0], laws[1]._replace(backlash=laws[1].backlash - 20e-6))
    found = drift(system, laws, hot, 180.0, LoopBracing(mode="twist_held"))
    expected = 20e-6 / laws[1].base_radius_1 * found.initial.loop_stiffness
    assert found.torque_change == pytest.approx(expected, rel=0.02)
    assert found.warm.twist == pytest.approx(found.initial.twist, rel=1e-12)


def test_controlled_torque_does_not_drift_but_the_shift_does() -> None:
    system, laws = assemble(prototype()), prototype_laws()
    hot = (laws[0], laws[1]._replace(backlash=laws[1].backlash - 20e-6))
    found = drift(system, laws, hot, 180.0, LoopBracing(mode="torque_controlled", gear=shifted()))
    assert found.torque_change == 0.0
    assert found.warm.torque[0] == pytest.approx(180.0, rel=1e-9)
    change = found.warm.rotation - found.initial.rotation
    assert abs(change) == pytest.approx(20e-6 / laws[1].base_radius_1, rel=0.02)


def test_setting_inside_the_backlash_carries_nothing() -> None:
    system, laws = assemble(prototype()), prototype_laws()
    hot = (laws[0], laws[1]._replace(backlash=laws[1].backlash + 1e-3))
    found = drift(system, laws, hot, 10.0, LoopBracing(mode="twist_held"))
    assert not found.warm.torque.any()
    assert found.torque_change == pytest.approx(-10.0)


def test_a_twist_moves_no_gear() -> None:
    """The case may name the gear of its load unit and brace by twist all the same: nothing pushes then."""
    system, laws = assemble(prototype()), prototype_laws()
    found = drift(system, laws, laws, 180.0, LoopBracing(mode="twist_held", gear=shifted()))
    for state in (found.initial, found.warm):
        assert (state.actuator_force, state.friction_force, state.shift, state.rotation) == (0.0,) * 4


def test_controlled_torque_without_a_gear_is_made_by_the_twist() -> None:
    system, laws = assemble(prototype()), prototype_laws()
    state = brace(system, laws, 180.0, LoopBracing(mode="torque_controlled"))
    assert state.mode == "torque_controlled"
    assert state.twist == brace(system, laws, 180.0, LoopBracing(mode="twist_held")).twist
    assert state.actuator_force == 0.0


def test_a_stalled_solve_is_not_reported_as_open_flanks(monkeypatch: pytest.MonkeyPatch) -> None:
    system, laws = assemble(prototype()), prototype_laws()
    solve = bracing.solve_static

    def stalling(model: PortModel, load: LoopLoad, **options: object) -> object:
        if load.twist is not None:
            raise DynamicsNotConverged("static loop: residual 1")
        return solve(model, load, **options)  # type: ignore[arg-type]

    monkeypatch.setattr(bracing, "solve_static", stalling)
    with pytest.raises(DynamicsNotConverged, match="residual 1"):
        drift(system, laws, laws, 180.0, LoopBracing(mode="twist_held"))
    loose = (laws[0], laws[1]._replace(backlash=laws[1].backlash + 1e-3))
    assert not drift(system, laws, loose, 10.0, LoopBracing(mode="twist_held")).warm.torque.any()


def test_what_cannot_be_braced() -> None:
    system, laws = assemble(prototype()), prototype_laws()
    with pytest.raises(ValueError, match="needs the shifted helical gear"):
        brace(system, laws, 180.0, LoopBracing(mode="shift_held"))
    with pytest.raises(ValueError, match="a spur gear braces nothing"):
        ShiftedGear(mesh=1, helix_angle=0.0, base_helix_angle=0.0, working_radius=0.05)
    with pytest.raises(ValueError, match="halves = 3"):
        shifted(halves=3)
    assert issubclass(DynamicsNotConverged, RuntimeError)
    assert math.cos(TRANSVERSE_ANGLE) < 1.0
