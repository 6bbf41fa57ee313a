"""The steady state of a loop that turns so slowly that nothing of it oscillates: the windup balances the tooth forces.

Unlike the start of the harmonic balance it runs over the whole period, so that teeth that differ are in it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import pi

from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.drivetrain.loop_load import LoopLoad
from dynamics.drivetrain.static_loop import port_model
from dynamics.mesh.law import MeshLaw
from dynamics.response.harmonic_problem import BalanceProblem, HarmonicGrid
from dynamics.response.harmonic_walk import LEAST_SAMPLES, mesh_cells, quasi_static_start
from dynamics.response.periodic_response import Period
from dynamics.response.response_curve import CurvePoint, point_of

HARMONICS = 24
"""Harmonics of each tooth mesh that the windup keeps."""


def quasi_static_point(
    system: LinearSystem,
    laws: Sequence[MeshLaw],
    speed: float,
    load: LoopLoad,
    drag_torques: Mapping[str, float] | None = None,
    period: Period = "mesh",
) -> CurvePoint:
    """State at a mean speed of the pinion of the first mesh [rad/s] without inertia; loads that alternate left out.

    Parameters are those of `dynamics.response.speed_sweep.periodic_response`.

    Raises
    ------
    DynamicsNotConverged
        No windup balances the tooth forces.
    DynamicsInputError
        The mesh frequencies have no common period.
    """
    model = port_model(system, laws)
    problem = BalanceProblem(model=model, form=system.form, load=load)
    cells, cell_angle = mesh_cells(model, period, load.control_mesh)
    turned = cells * cell_angle
    meshes = max(
        law.teeth_1 * abs(float(model.ratios[pinion])) for law, pinion in zip(laws, model.pinions)
    ) * turned / (2.0 * pi)  # fmt: skip
    harmonics = round(HARMONICS * meshes)
    samples = 1 << (round(LEAST_SAMPLES * meshes) - 1).bit_length()
    grid = HarmonicGrid(cells=1, harmonics=harmonics, samples=samples, cell_angle=turned)
    solution = quasi_static_start(problem, grid, speed / float(model.ratios[0]), drag_torques)
    return replace(point_of(model, replace(solution, residual=0.0)), method="quasi_static")
