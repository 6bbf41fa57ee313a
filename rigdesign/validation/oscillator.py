"""V4: the piecewise-linear oscillator with play by harmonic balance, both branches of its jump.

x'' + 2 zeta x' + g(x) = F_m + F_a W^2 cos(W t), g = x -+ 1 outside |x| > 1 and 0 inside; zeta 0.05, F_m 0.1, F_a 0.05
(Kahraman and Singh, J. Sound Vib. 142, 1990). The oscillator is one mesh of stiffness 1 between a body of inertia 1
with a grounded damper and a wheel too heavy to move; a soft spring leads to the drive, a drag torque loads the wheel.
"""

from collections.abc import Iterator, Sequence
from contextlib import suppress

import numpy as np

from dynamics.drivetrain.linear_system import LinearSystem, line_shapes
from dynamics.drivetrain.loop_load import LoopLoad
from dynamics.drivetrain.modal_form import modal_form
from dynamics.drivetrain.static_loop import port_model
from dynamics.errors import DynamicsNotConverged
from dynamics.mesh.law import MeshLaw
from dynamics.response.harmonic_balance import solve_periodic
from dynamics.response.harmonic_problem import BalanceProblem, HarmonicGrid, HarmonicSolution
from dynamics.response.waveform import waveform
from rigdesign.validation.rows import Gate, PublishedQuantity, ValidationRow, compare

ZETA, MEAN_FORCE, FORCE = 0.05, 0.1, 0.05
BOTH = {
    0.50: 0.0166,
    0.70: 0.0476,
    0.85: 0.2555,
    0.90: 0.2292,
    0.95: 0.2065,
    1.00: 0.1870,
    1.10: 0.1559,
    1.30: 0.1150,
}
UP = {**BOTH, 0.75: 0.0634, 0.80: 0.0868}
"""Half peak-to-peak amplitude at each frequency swept upwards: DOP853 at 1e-9 over 400 cycles."""
DOWN = {**BOTH, 0.75: 0.3183, 0.80: 0.2857}
"""The same swept downwards: the upper branch holds to 0.75."""
SHOWN = {"up": (0.75, 0.80, 0.85, 0.90, 1.00, 1.30), "down": (1.00, 0.85, 0.80, 0.75)}
TEETH, HEAVY, SOFT = 1000, 1e8, 1e-5


def oscillator_rows() -> Iterator[ValidationRow]:
    """Rows round the jump, swept up and down."""
    for direction, published in (("up", UP), ("down", DOWN)):
        steps = np.round(np.arange(0.60, 1.3001, 0.025), 4).tolist()
        found = sweep(steps if direction == "up" else steps[::-1])
        for frequency in SHOWN[direction]:
            yield compare(
                PublishedQuantity(
                    id=f"V4-{direction}-{frequency:.2f}",
                    text=f"piecewise-linear oscillator, half peak-to-peak at {frequency:.2f}, sweep "
                    f"{direction}",
                    source="Kahraman and Singh 1990, DOP853",
                    value=published[frequency],
                    unit="1",
                ),
                found[frequency],
                "verification",
                Gate(5e-3),
                assumptions="harmonic balance with 24 harmonics; damper grounded",
            )


def sweep(frequencies: Sequence[float]) -> dict[float, float]:
    """Half peak-to-peak amplitude by frequency over a continued sweep; where a branch ends, from beyond the gap."""
    system, law = _oscillator()
    model = port_model(system, [law])
    form = modal_form(system.inertia, system.damping, system.stiffness, system.rigid)
    problem = BalanceProblem(model=model, form=form, load=LoopLoad(twist=0.0))
    grid = HarmonicGrid(cells=1, harmonics=24, samples=512, cell_angle=2.0 * np.pi / TEETH)
    rest = np.zeros((2, grid.top + 1), complex)
    rest[:, 0] = -MEAN_FORCE / SOFT, -MEAN_FORCE / SOFT - 1.1
    state = HarmonicSolution(
        grid=grid, speed=0.0, ports=rest, twist=0.0, drive=MEAN_FORCE, residual=np.inf, iterations=0
    )
    states: dict[float, HarmonicSolution] = {}
    for order in (frequencies, frequencies[::-1]):
        for frequency in order:
            if frequency not in states:
                force = np.zeros((2, grid.top + 1), complex)
                force[0, 1] = 0.5 * FORCE * frequency**2
                with suppress(DynamicsNotConverged):
                    states[frequency] = solve_periodic(
                        problem, frequency / TEETH, state, drag_torques={"load": MEAN_FORCE},
                        excitation=force,
                    )  # fmt: skip
            state = states.get(frequency, state)
    return {f: 0.5 * float(np.ptp(waveform(model, state).approach)) for f, state in states.items()}


def _oscillator() -> tuple[LinearSystem, MeshLaw]:
    """The oscillator as a mesh of unit stiffness between a unit inertia and a wheel too heavy to move."""
    pitch = 2.0 * np.pi / TEETH
    law = MeshLaw(
        base_radius_1=1.0, base_radius_2=1.0, base_pitch=pitch, teeth_1=TEETH, teeth_2=TEETH,
        tooth_offset_2=0,
        path_start=0.0, path_step=pitch / 4, stiffness=np.ones((1, 5)), gap=np.ones((1, 5)),
        slice_shift=np.zeros(1), deviation_1=np.zeros((1, 5)), deviation_2=np.zeros((1, 5)),
        scale_1=np.ones(1),
        scale_2=np.ones(1), backlash=0.0, offset=0.0, phase=0.0, back_phase=0.0, damping=0.0,
        mean_stiffness=1.0,
        friction=0.0, rolling_radius_1=1.0, rolling_radius_2=1.0, friction_reversal_speed=1.0,
    )  # fmt: skip
    spring = np.zeros((3, 3))
    spring[0, 0] = spring[2, 2] = SOFT
    spring[0, 2] = spring[2, 0] = -SOFT
    system = LinearSystem(
        inertia=np.diag([1.0, HEAVY, HEAVY]),
        damping=np.diag([2.0 * ZETA, 0.0, 0.0]),
        stiffness=spring,
        dofs=("pinion", "wheel", "drive"),
        mesh_ports=np.array([[0, 1]], dtype=np.int64),
        rigid=line_shapes(np.array([0, 1, 0])),
        drive_dof=2,
        twist_load=np.zeros(3),
        drag_loads={"load": np.array([0.0, -1.0, 0.0])},
    )
    return system, law
