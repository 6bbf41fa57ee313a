"""Piecewise-linear oscillator with backlash: both branches of the jump by harmonic balance.

x'' + 2 zeta x' + g(x) = F_m + F_a W^2 cos(W t), g = x -+ 1 outside |x| > 1, 0 inside; zeta 0.05, F_m 0.1,
F_a 0.05. Parameters: Kahraman & Singh, J. Sound Vib. 142 (1990) 49. Half peak-to-peak amplitudes: integration
with DOP853 at 1e-9 over 400 periods of a continued sweep.

The oscillator is one mesh of stiffness 1 between a body of inertia 1 with a grounded damper and a wheel
too heavy to move; a soft spring leads to the drive, a drag torque of 0.1 loads the wheel.
"""

import numpy as np
import pytest

from dynamics.harmonic_balance import HarmonicGrid, HarmonicSolution, Problem, solve_periodic, waveform
from dynamics.linear_system import LinearSystem
from dynamics.mesh_law import MeshLaw
from dynamics.modal_form import modal_form
from dynamics.static_loop import NotConverged, port_model

ZETA, F_MEAN, F_AMPLITUDE = 0.05, 0.1, 0.05
UP = {
    0.5: 0.0166,
    0.7: 0.0476,
    0.75: 0.0634,
    0.80: 0.0868,
    0.85: 0.2555,
    0.90: 0.2292,
    1.0: 0.1870,
    1.3: 0.1150,
}
DOWN = {0.75: 0.3183, 0.80: 0.2857, 0.85: 0.2555, 0.95: 0.2065, 1.10: 0.1559}
TEETH = 1000
HEAVY, SOFT = 1e8, 1e-5


def oscillator() -> tuple[LinearSystem, MeshLaw]:
    pitch = 2.0 * np.pi / TEETH
    law = MeshLaw(
        base_radius_1=1.0,
        base_radius_2=1.0,
        base_pitch=pitch,
        teeth_1=TEETH,
        teeth_2=TEETH,
        tooth_offset_2=0,
        path_start=0.0,
        path_step=pitch / 4,
        stiffness=np.ones((1, 5)),
        gap=np.ones((1, 5)),
        slice_shift=np.zeros(1),
        deviation_1=np.zeros((1, 5)),
        deviation_2=np.zeros((1, 5)),
        scale_1=np.ones(1),
        scale_2=np.ones(1),
        backlash=0.0,
        offset=0.0,
        phase=0.0,
        back_phase=0.0,
        damping=0.0,
        mean_stiffness=1.0,
        friction=0.0,
        rolling_radius_1=1.0,
        rolling_radius_2=1.0,
        friction_reversal_speed=1.0,
    )
    spring = np.zeros((3, 3))
    spring[0, 0] = spring[2, 2] = SOFT
    spring[0, 2] = spring[2, 0] = -SOFT
    system = LinearSystem(
        inertia=np.array([1.0, HEAVY, HEAVY]),
        damping=np.diag([2.0 * ZETA, 0.0, 0.0]),
        stiffness=spring,
        dofs=("pinion", "wheel", "drive"),
        mesh_ports=np.array([[0, 1]], dtype=np.int64),
        lines=np.array([0, 1, 0], dtype=np.int64),
        drive_dof=2,
        twist_load=np.zeros(3),
        drag_loads={"load": np.array([0.0, -1.0, 0.0])},
    )
    return system, law


def sweep(frequencies: list[float]) -> dict[float, float]:
    """Half peak-to-peak amplitude over a continued sweep; where a branch ends, from beyond the gap."""
    system, law = oscillator()
    model = port_model(system, [law])
    problem = Problem(
        model=model,
        form=modal_form(system.inertia, system.damping, system.stiffness, system.lines),
        torque=None,
        twist=0.0,
    )
    grid = HarmonicGrid(cells=1, harmonics=24, samples=512, cell_angle=2.0 * np.pi / TEETH)
    rest = np.zeros((2, grid.top + 1), complex)
    rest[:, 0] = -F_MEAN / SOFT, -F_MEAN / SOFT - 1.1
    state = HarmonicSolution(
        grid=grid, speed=0.0, ports=rest, twist=0.0, drive=F_MEAN, residual=np.inf, iterations=0
    )
    states: dict[float, HarmonicSolution] = {}
    for order in (frequencies, frequencies[::-1]):
        for frequency in order:
            if frequency not in states:
                force = np.zeros((2, grid.top + 1), complex)
                force[0, 1] = 0.5 * F_AMPLITUDE * frequency**2
                try:
                    states[frequency] = solve_periodic(
                        problem,
                        grid,
                        frequency / TEETH,
                        state,
                        drag_torques={"load": F_MEAN},
                        excitation=force,
                    )
                except NotConverged:
                    continue
            state = states[frequency]
    return {f: 0.5 * float(np.ptp(waveform(model, state).approach)) for f, state in states.items()}


@pytest.mark.parametrize(("direction", "expected"), [("up", UP), ("down", DOWN)])
def test_both_branches_of_the_jump(direction: str, expected: dict[float, float]) -> None:
    frequencies = [round(float(value), 4) for value in np.arange(0.4, 1.5001, 0.025)]
    found = sweep(frequencies if direction == "up" else frequencies[::-1])
    assert {f: found.get(f) for f in expected} == pytest.approx(expected, rel=5e-3)
