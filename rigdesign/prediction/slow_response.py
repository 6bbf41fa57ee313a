"""The response behind a prediction: as in a check, but for points so slow that harmonic balance has too many harmonics
below the highest mode, and for the number of harmonics of rigs with root gauges.

An excitation that slow hardly moves the modes: the loop follows quasi-statically, as P1 takes its 100 rpm. Following it
in time instead takes minutes and as a rule does not settle; it is what remains where friction leaves no
quasi-static state. Loads that alternate with a shaft are left out there.
"""

from dataclasses import replace

from dynamics.drivetrain.loop_load import LoopLoad
from dynamics.drivetrain.static_loop import port_model
from dynamics.errors import DynamicsNotConverged
from dynamics.response.harmonic_problem import HarmonicSolution
from dynamics.response.harmonic_walk import LEAST_HARMONICS, MOST_HARMONICS, highest_mode, mesh_cells
from dynamics.response.quasi_static import quasi_static_point
from dynamics.response.response_curve import CurvePoint
from rigdesign.coupling.braced_loop import LoadedCircuit, respond, shifted_laws, signed_torque
from rigdesign.coupling.iteration import SOLVED
from rigdesign.coupling.mesh_models import laws_of
from rigdesign.coupling.tooth_deviations import periodic_laws
from rigdesign.rig.model import Rig

REACH = 1.5
"""Harmonics go up to this times the highest mode that counts (`dynamics.response.speed_sweep`)."""
GAUGE_HARMONICS = 192
"""Harmonics of the common mesh period of a rig with root gauges at least: the highest stress answers to their number
by some tenths of a per cent, which a mode that just counts or does not would change from rig to rig."""
FOLLOWED = 2.0
"""Times the harmonics that harmonic balance takes at most from which a point is quasi-static; nearer to them it is
followed in time, as in a check."""


def respond_at_any_speed(
    rig: Rig, circuit: LoadedCircuit, near: HarmonicSolution | None = None
) -> CurvePoint:
    """As `rigdesign.coupling.braced_loop.respond`, slow points quasi-static.

    Raises
    ------
    DynamicsNotConverged
        Neither harmonic balance nor time integration converges.
    """
    period = rig.case.numerics.response_period
    ports = port_model(circuit.system, laws_of(circuit.models))
    _, cell_angle = mesh_cells(ports, period, 0)
    cells_a_second = rig.drive_speed(circuit.point.speed) / cell_angle
    highest = highest_mode(ports, circuit.system.form, rig.highest_mode)
    if REACH * highest <= FOLLOWED * MOST_HARMONICS * cells_a_second:
        return respond(rig, circuit, near, GAUGE_HARMONICS if rig.strain_gauges else LEAST_HARMONICS)
    try:
        return _quasi_static(rig, circuit)
    except DynamicsNotConverged:
        return respond(rig, circuit, near)


def _quasi_static(rig: Rig, circuit: LoadedCircuit) -> CurvePoint:
    """Raises DynamicsNotConverged where an angle has no state, as when friction reverses at the pitch point."""
    setting = circuit.bracing
    controlled = setting.mode == "torque_controlled"
    return quasi_static_point(
        circuit.system,
        periodic_laws(rig, shifted_laws(rig, circuit.models, setting)),
        rig.pinion_speed(circuit.point.speed),
        LoopLoad(
            torque=signed_torque(rig, circuit.point) if controlled else None,
            twist=None if controlled else setting.twist,
        ),
        circuit.drags,
        rig.case.numerics.response_period,
    )


AT_ANY_SPEED = replace(SOLVED, response=respond_at_any_speed)
"""Parts of an iteration, every one solved in full, with that response."""
