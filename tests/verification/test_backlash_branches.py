"""Branches of a resonance bent by backlash, between their turning points, against motions marched in time.

x'' + 2 zeta x' + g(x) = F_m + F_a W^2 cos(W t), g = x -+ 1 outside |x| > 1 and 0 inside (Kahraman and Singh, J. Sound
Vib. 142, 1990), zeta 0.05, F_m 0.1, F_a 0.05, and the prototype at 10 N m.
"""

import math
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

from dynamics.errors import DynamicsNotConverged
from dynamics.rotor.graph import assemble
from dynamics.rotor.linear_system import modal_form
from dynamics.rotor.static_loop import LoopLoad, port_model
from dynamics.vibration.harmonic_balance import BalanceProblem, HarmonicGrid, HarmonicSolution, solve_periodic
from dynamics.vibration.harmonic_branches import CRAWLING, BranchTrace, SpeedProblem, instability
from dynamics.vibration.response_curve import Method, ResponseCurve, waveform
from dynamics.vibration.speed_sweep import SweepSettings, periodic_response
from dynamics.vibration.steady_motion import periodic_by_time
from tests.builders.rig import prototype, prototype_laws
from tests.published.mechanics import FORCE, MEAN_FORCE, SOFT, TEETH, ZETA, _oscillator

Array = NDArray[np.float64]
RPM = math.pi / 30.0


@cache
def oscillator() -> tuple[SpeedProblem, HarmonicSolution]:
    """The oscillator over its frequency, and its response at 0.4 of the natural one."""
    system, law = _oscillator()
    model = port_model(system, [law])
    form = modal_form(system.inertia, system.damping, system.stiffness, system.rigid)
    problem = BalanceProblem(model=model, form=form, load=LoopLoad(twist=0.0))
    grid = HarmonicGrid(cells=1, harmonics=24, samples=1024, cell_angle=2.0 * np.pi / TEETH)
    rest = np.zeros((2, grid.top + 1), complex)
    rest[:, 0] = -MEAN_FORCE / SOFT, -MEAN_FORCE / SOFT - 1.1

    def excitation(speed: float) -> NDArray[np.complex128]:
        force = np.zeros((2, grid.top + 1), complex)
        force[0, 1] = 0.5 * FORCE * (speed * TEETH) ** 2
        return force

    over = SpeedProblem(
        problem=lambda _: problem, drags=lambda _: {"load": MEAN_FORCE}, excitation=excitation
    )
    first = HarmonicSolution(
        grid=grid, speed=0.0, ports=rest, twist=0.0, drive=MEAN_FORCE, residual=np.inf, iterations=0
    )
    start = solve_periodic(
        problem, 0.4 / TEETH, first, drag_torques={"load": MEAN_FORCE}, excitation=excitation(0.4 / TEETH)
    )
    return over, start


@cache
def branch() -> tuple[Array, Array, NDArray[np.bool_]]:
    """Frequency, half peak-to-peak and stability of the points of the branch."""
    over, start = oscillator()
    model = over.problem(0.0).model
    points = [p.solution for p in BranchTrace(over, start, rising=True).points((0.0, 1.2 / TEETH), 300)]
    stable = [instability(over.equations(s.grid, s.speed), s)[0] == 0 for s in points]
    amplitude = [0.5 * float(np.ptp(waveform(model, s).approach)) for s in points]
    return np.array([s.speed * TEETH for s in points]), np.array(amplitude), np.array(stable)


def turning_points() -> tuple[float, float]:
    """Frequencies at which the branch turns down and up again."""
    frequency, _, _ = branch()
    turns = np.flatnonzero(np.diff(np.sign(np.diff(frequency)))) + 1
    assert turns.size == 2
    return float(frequency[turns[0]]), float(frequency[turns[1]])


def settled(frequency: Array, displacement: float, rate: float) -> Array:
    """Half peak-to-peak of the motions (n,) after 300 periods, by classical Runge-Kutta steps, 128 in a period."""
    step = 2.0 * np.pi / frequency / 128
    x, v = np.full_like(frequency, displacement), np.full_like(frequency, rate)
    force = FORCE * frequency**2

    def push(x: Array, v: Array, angle: float) -> Array:
        return np.asarray(
            MEAN_FORCE
            + force * np.cos(angle)
            - 2.0 * ZETA * v
            - np.where(np.abs(x) > 1.0, x - np.sign(x), 0.0)
        )

    high, low = np.full_like(x, -np.inf), np.full_like(x, np.inf)
    for k in range(300 * 128):
        angle = 2.0 * np.pi * k / 128
        half = angle + np.pi / 128
        v1, a1 = v, push(x, v, angle)
        v2 = v + 0.5 * step * a1
        a2 = push(x + 0.5 * step * v1, v2, half)
        v3 = v + 0.5 * step * a2
        a3 = push(x + 0.5 * step * v2, v3, half)
        v4 = v + step * a3
        a4 = push(x + step * v3, v4, angle + 2.0 * np.pi / 128)
        x = x + step / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4)
        v = v + step / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)
        if k >= 299 * 128:
            high, low = np.maximum(high, x), np.minimum(low, x)
    return 0.5 * (high - low)


def test_one_branch_joins_both_responses_and_is_unstable_between_its_turning_points() -> None:
    frequency, amplitude, stable = branch()
    up, down = turning_points()
    assert 0.70 < down < 0.72 and 0.82 < up < 0.84
    rising = np.diff(frequency) > 0.0
    # points next to a turning point, where one exponent is all but zero, may be on either side
    far = np.minimum(np.abs(frequency - up), np.abs(frequency - down))[1:] > 2e-3
    assert np.array_equal(stable[1:][far], rising[far])
    assert (~stable).sum() > 10
    at = int(np.argmin(np.abs(frequency - 0.75) + np.where(amplitude < 0.25, 1.0, 0.0)))
    assert amplitude[at] == pytest.approx(0.3183 - 0.64 * (frequency[at] - 0.75), abs=0.003)


def test_a_trace_is_given_up_where_the_points_left_reach_no_asked_speed() -> None:
    """Both turning points are passed on the way from 0.4 to 1; 20 points are too few, which ten steps show."""
    over, start = oscillator()
    limits, asked = (0.0, 1.2 / TEETH), np.array([1.0 / TEETH])

    def reached(most: int, asked: Array | None) -> tuple[int, float]:
        found = list(BranchTrace(over, start, rising=True).points(limits, most, asked))
        return len(found), found[-1].solution.speed

    assert reached(300, asked)[1] > asked[0]
    assert reached(20, None)[0] == 20 and reached(20, None)[1] < asked[0]
    assert CRAWLING <= reached(20, asked)[0] < 20


def test_jumps_in_time_are_the_turning_points() -> None:
    """The quiet motion, without contact loss, is left above one; the lively one falls back below the other."""
    up, down = turning_points()
    near = np.array([up - 0.008, up + 0.004])
    # from the closed form of the oscillator in contact: the quiet motion at its own amplitude
    quiet = FORCE * near**2 / np.hypot(1.0 - near**2, 2.0 * ZETA * near)
    phase = np.arctan2(2.0 * ZETA * near, 1.0 - near**2)
    ends = [
        settled(np.array([w]), 1.1 + a * math.cos(p), w * a * math.sin(p))[0]
        for w, a, p in zip(near, quiet, phase)
    ]
    assert ends[0] < 0.13 < 0.25 < ends[1]
    # the lively motion at its own state, found by harmonic balance above the jump
    over, start = oscillator()
    traced = [p.solution for p in BranchTrace(over, start, rising=True).points((0.0, 1.2 / TEETH), 300)]
    upper = int(np.argmin([abs(s.speed * TEETH - down) for s in traced]))
    state = min(traced[upper:], key=lambda s: abs(s.speed * TEETH - down - 0.02))
    wave = waveform(over.problem(0.0).model, state)
    x, v = float(wave.approach[0, 0]), float(wave.omega_1[0, 0] - wave.omega_2[0, 0])
    high, low = settled(np.array([down + 0.005, down - 0.005]), x, v)
    assert high > 0.3 and low < 0.06


def light(n: list[float], *methods: Method) -> ResponseCurve:
    """Torsional prototype at 10 N m and speeds of the pinion [rpm]."""
    return periodic_response(
        assemble(prototype()), prototype_laws(), [value * RPM for value in n], LoopLoad(torque=10.0),
        settings=SweepSettings(methods=methods),
    )  # fmt: skip


@pytest.mark.parametrize(
    ("speed", "kind", "way"),
    [
        (1960.0, "periodic", ""),
        (2200.0, "subharmonic", "period doubling"),
        (1860.0, "quasi-periodic", "second frequency"),
        (2440.0, "chaotic", "period doubling"),
    ],
)
def test_the_march_comes_to_the_motion_that_the_exponents_foretell(speed: float, kind: str, way: str) -> None:
    """Floquet exponents of the harmonic balance against marches from a wound-up rigid rotation."""
    curve = light([2600.0, 2500.0, speed], "harmonic_balance")
    failed = {round(s / RPM): reason for s, reason in curve.failed}
    marched = periodic_by_time(assemble(prototype()), prototype_laws(), speed * RPM, LoopLoad(torque=10.0))
    assert marched.motion.kind == kind
    if way:
        assert f"is unstable ({way}" in failed[round(speed)]
        (point,) = light([speed], "harmonic_balance", "time_integration").points
        assert (point.method, point.motion.kind) == ("time_integration", kind)
    else:
        found = curve.points[-1]
        assert found.lift_off_share[0] > 0.1
        peaks = np.maximum(marched.greatest_torque, -marched.least_torque)
        assert found.maximum == pytest.approx(peaks, rel=0.01)


def test_a_speed_asked_alone_is_that_of_a_curve() -> None:
    """Contact is lost at these speeds; the branch is reached from where the response is plain."""
    speeds = [1800.0, 2000.0, 2380.0]
    curve = light(list(np.arange(2600.0, 1790.0, -20.0)), "harmonic_balance")
    known = {round(p.speed / RPM): p for p in curve.points}
    for speed in speeds:
        (point,) = light([speed], "harmonic_balance").points
        assert point.dynamic_factor == pytest.approx(known[round(speed)].dynamic_factor, rel=1e-3)


def test_maps_keep_stable_states_alone_and_say_where_there_are_none() -> None:
    """Two walks without traces, as a map of contact loss asks for them: at each speed the state that a search of all
    branches finds, or none where it is left by another motion."""
    speeds = [2600.0, 2500.0, 2440.0, 2300.0, 2200.0, 2000.0, 1960.0, 1860.0, 1800.0]
    curve = periodic_response(
        assemble(prototype()), prototype_laws(), [value * RPM for value in speeds], LoopLoad(torque=10.0),
        settings=SweepSettings(methods=("harmonic_balance",), branches=False),
    )  # fmt: skip
    assert {2200, 1860, 2440} <= {round(speed / RPM) for speed in curve.unstable}
    assert not set(curve.unstable) & set(curve.speeds)
    assert any(point.lift_off_share[0] > 0.1 for point in curve.points)
    full = {point.speed: point for point in light(speeds, "harmonic_balance").points}
    for point in curve.points:
        assert point.dynamic_factor == pytest.approx(full[point.speed].dynamic_factor, rel=1e-3)


def test_a_march_at_creep_speed_is_refused_before_it_takes_the_memory() -> None:
    """A stage from 0.01 rpm asked for 100 GiB."""
    with pytest.raises(
        DynamicsNotConverged, match=r"limit 2000000; the motion is quasi-static there, give a speed"
    ):
        periodic_by_time(assemble(prototype()), prototype_laws(), 0.01 * RPM, LoopLoad(torque=10.0))
