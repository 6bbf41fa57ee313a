"""Steady state of a journal bearing and what of it lies outside the theory."""

import math
from dataclasses import dataclass

from dynamics.bearing.journal_lateral import RunningFilm, journal_lateral
from dynamics.bearing.lateral import LateralCoefficients
from dynamics.bearing.protocol import BearingState, LateralOperation
from dynamics.kernels.journal import HIGHEST_ECCENTRICITY


@dataclass(frozen=True, kw_only=True)
class JournalState(BearingState):
    """Steady state of a journal bearing; beyond the common fields those of its film, SI units."""

    specific_load: float
    minimum_film: float
    transition_speed: float
    """Vogelpohl: fluid friction above this speed at this load and viscosity [rad/s]."""
    regime: str
    """``hydrodynamic``, ``mixed`` (film thinner than the solved range) or ``standstill``."""
    sommerfeld: float
    """So; infinite at standstill."""
    eccentricity: float
    attitude_angle: float
    """Load to line of centres [rad]."""
    friction_coefficient: float
    """Drag force / load [-]; infinite without load."""
    petroff_torque: float
    """Drag torque of the concentric journal 2 pi eta omega B R^3 / c, a lower bound [N m]."""
    viscosity: float
    """At the film temperature [Pa s]."""
    side_flow: float
    """Oil the film drives out of the ends [m3/s]; more than is fed means starving."""
    reynolds_number: float
    reynolds_limit: float
    film: RunningFilm
    """Its film, about which stiffness and damping are taken."""

    def lateral_coefficients(self, operation: LateralOperation) -> LateralCoefficients:
        """Stiffness, damping and static position, at the viscosity of the film and the load of the operation.

        Raises BearingError at standstill without load.
        """
        return journal_lateral(self.film, operation)


def limit_warnings(state: JournalState) -> tuple[str, ...]:
    """Sentences for what lies outside the theory: name, value, limit, remedy."""
    found = []
    if state.regime == "mixed":
        found.append(
            f"eccentricity >= {HIGHEST_ECCENTRICITY}: mixed friction, drag torque and film thickness are bounds; "
            "raise speed or viscosity or lower the load"
        )
    if 0.0 < state.omega < state.transition_speed:
        found.append(
            f"speed = {state.omega * 30.0 / math.pi:.0f} rpm: below the transition speed "
            f"{state.transition_speed * 30.0 / math.pi:.0f} rpm of this load; lower the load until it is passed"
        )
    if state.reynolds_number > state.reynolds_limit:
        found.append(
            f"Reynolds number = {state.reynolds_number:.0f}: above {state.reynolds_limit:.0f}, the film is not "
            "laminar and its drag torque is higher; reduce the clearance or use a thicker oil"
        )
    if state.side_flow > state.flow:
        found.append(
            f"oil flow = {state.flow * 6e4:.3g} l/min: below the {state.side_flow * 6e4:.3g} l/min the film drives "
            "out, the bearing starves; feed more oil"
        )
    return tuple(found)
