"""Modes, whirl and forces at a running state against rigid rotors on two equal bearings."""

import math
from dataclasses import replace

import numpy as np
import pytest

from dynamics.rotor.assembly import assemble_rig
from dynamics.rotor.bearing import LateralCoefficients
from dynamics.rotor.bearing_state import BearingCoefficients, RunningState
from dynamics.rotor.damped_modes import (
    bearing_forces,
    line_whirls,
    reduced_line_loads,
    rig_modes,
    whirl_at,
)
from dynamics.rotor.reduction import ReducedElasticRig, reduce_rig
from dynamics.rotor.rotor_model import ShaftUnbalance
from dynamics.rotor.shaft import Disc, Section
from tests.builders.elastic_rig import bearings, single_shaft
from tests.builders.rotor_stability import rotor_stability

SPEED = 800.0
FILM = LateralCoefficients(
    stiffness=np.array([[2.0e7, 3.0e7], [-4.0e7, 1.5e7]]),
    damping=np.array([[8e4, -1e4], [-1e4, 9e4]]),
    position=np.zeros(2),
    regime="hydrodynamic",
)
"""Of a lightly loaded journal: cross-coupling above its direct stiffness."""


def rigid_rotor(mass: float, moment: float = 0.0) -> ReducedElasticRig:
    """Light thick tube with a mass in its middle, all but rigid, on bearings at its ends, bouncing before it tilts."""
    unbalance = ShaftUnbalance(shaft="rotor", position=0.1, moment=moment)
    rig = single_shaft(
        (Section(length=0.2, outer_diameter=0.3),),
        (0.0, 0.2),
        0.1,
        discs=(
            Disc(name="disc", position=0.1, inertia=1e-3 * mass, mass=mass, diametral_inertia=2e-3 * mass),
        ),
        density=1e-3,
    )
    model = assemble_rig(replace(rig, rotating=(unbalance,)))
    return reduce_rig(model, bearings(rig, 1e8))


def state(coefficients: LateralCoefficients, speed: float = SPEED) -> RunningState:
    both = BearingCoefficients(stiffness=coefficients.stiffness, damping=coefficients.damping)
    return RunningState(speed=speed, bearings={"b0": both, "b1": both})


def least(mass: float) -> float:
    """Least decrement of lateral modes of a rotor of a mass."""
    modes = rig_modes(rigid_rotor(mass), state(FILM), 500.0)
    return min(mode.logarithmic_decrement for mode in modes if mode.family == "lateral")


def test_a_rotor_whirls_from_the_critical_mass_on() -> None:
    """Routh and Hurwitz for a rigid rotor on one film carries half of the mass; the shaft yields by 1e-4."""
    critical = 2.0 * rotor_stability(FILM).critical_mass
    assert least(0.98 * critical) > 0.0 > least(1.02 * critical)
    modes = rig_modes(rigid_rotor(critical), state(FILM), 500.0)
    lateral = [mode for mode in modes if mode.family == "lateral"]
    whirl = min(lateral, key=lambda mode: abs(mode.logarithmic_decrement))
    assert 2.0 * math.pi * whirl.frequency == pytest.approx(rotor_stability(FILM).whirl_frequency, rel=1e-2)
    assert whirl.whirl > 0.5 and whirl.shaft == "rotor"
    grown = min(
        rig_modes(rigid_rotor(2.0 * critical), state(FILM), 500.0), key=lambda m: m.logarithmic_decrement
    )
    assert grown.amplification == math.inf


def test_whirl_and_bearing_force_of_a_rigid_rotor_in_closed_form() -> None:
    """(2 K + i 2 C Omega - m Omega^2) u = U Omega^2 (1, -i); either bearing feels half of K u + i Omega C u."""
    mass, moment = 20.0, 2e-4
    rig = rigid_rotor(mass, moment)
    running = state(FILM)
    (whirl,) = whirls = line_whirls(rig, running, reduced_line_loads(rig))
    assert (whirl.line, whirl.frequency) == ("rotor", pytest.approx(SPEED))
    film = FILM.stiffness + 1j * SPEED * FILM.damping
    motion = np.linalg.solve(
        2.0 * film - mass * SPEED**2 * np.eye(2), moment * SPEED**2 * np.array([1.0, -1j])
    )
    orbit = whirl_at(whirls, rig.ports["b0"][:2], 1.0)["rotor"]
    turn = np.exp(1j * np.linspace(0.0, 2.0 * math.pi, 721))
    radius = np.hypot(*np.real(motion[:, None] * turn))
    assert (orbit.major, abs(orbit.minor)) == pytest.approx((radius.max(), radius.min()), rel=2e-3)
    force = np.hypot(*np.real((film @ motion)[:, None] * turn))
    assert bearing_forces(rig, running, whirls, "b1")["rotor"].major == pytest.approx(force.max(), rel=2e-3)


def test_amplification_is_that_of_the_damping_ratio() -> None:
    """A round bearing of k and c under m: damping ratio c / sqrt(2 k m) of two of them."""
    mass, stiffness, damping = 20.0, 1e7, 2e3
    film = LateralCoefficients(
        stiffness=stiffness * np.eye(2), damping=damping * np.eye(2), position=np.zeros(2), regime="constant"
    )
    modes = rig_modes(rigid_rotor(mass), state(film), 500.0)
    ratio = 2.0 * damping / (2.0 * math.sqrt(2.0 * stiffness * mass))
    bounce = min(modes, key=lambda mode: abs(mode.damping_ratio - ratio))
    assert bounce.damping_ratio == pytest.approx(ratio, rel=1e-2)
    assert bounce.amplification == pytest.approx(0.5 / ratio, rel=1e-2)
