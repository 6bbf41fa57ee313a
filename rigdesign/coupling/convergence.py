"""When the iterations at an operating point have converged, and what is said where they do not."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from rigdesign.base.errors import NotConvergedError
from rigdesign.case.numerics import Numerics
from rigdesign.coupling.state import (
    CouplingState,
    OperatingPoint,
    length_change,
    temperature_change,
    torque_change,
)
from rigdesign.coupling.state_vector import scaled_change

COARSE_ABOVE = 8.0
"""Change of temperature in an iteration [K] below which the next one may be the last: it is solved in full."""
SHOWN = 4
"""Residuals that a message shows."""


@dataclass(frozen=True, kw_only=True)
class Residual:
    """Largest changes of one iteration: temperature [K], length [m], mean torque relative [-]."""

    temperature: float
    length: float
    torque: float

    @classmethod
    def between(cls, old: CouplingState, new: CouplingState, heat: float = 0.0) -> "Residual":
        """Changes from the coupling state of an iteration to what it proposes.

        heat : temperature error [K] of the heats of the iteration, see `relaxation.heat_residual`
        """
        return cls(
            temperature=max(temperature_change(old, new), heat),
            length=length_change(old, new),
            torque=torque_change(old, new),
        )


class Convergence(Protocol):
    """Criterion that ends the iterations at an operating point."""

    @property
    def iterations(self) -> int:
        """Iterations at most."""

    @property
    def remedy(self) -> str:
        """What to do where they do not suffice."""

    @property
    def limits(self) -> str:
        """The tolerances, formatted."""

    def final(self, residuals: Sequence[Residual]) -> bool:
        """Whether the next iteration may be the last, after those with these residuals."""

    def reached(self, state: CouplingState, proposal: CouplingState, residual: Residual) -> bool:
        """Whether an iteration from ``state`` that proposes ``proposal`` ends the loop."""


class CaseTolerances:
    """Temperatures, lengths and torques within the tolerances of the case; coarse iterations while it is far off."""

    def __init__(self, numerics: Numerics) -> None:
        self._numerics = numerics
        self.iterations = numerics.coupling_passes
        self.remedy = "raise numerics.coupling_passes, or feed more oil if a film or stream oscillates"

    @property
    def limits(self) -> str:
        """The tolerances, formatted."""
        own = self._numerics
        return f"{own.temperature_tolerance:g} K, {1e6 * own.growth_tolerance:g} um, {own.torque_tolerance:g}"

    def final(self, residuals: Sequence[Residual]) -> bool:
        """The first iteration, and those after a small change of temperature."""
        return not residuals or residuals[-1].temperature < COARSE_ABOVE

    def reached(self, state: CouplingState, proposal: CouplingState, residual: Residual) -> bool:
        """Whether all three residuals are within their tolerances."""
        return (
            residual.temperature <= self._numerics.temperature_tolerance
            and residual.length <= self._numerics.growth_tolerance
            and residual.torque <= self._numerics.torque_tolerance
        )


@dataclass(frozen=True)
class ScaledTolerance:
    """No part of the coupling state moves by more than ``limit`` in units of `state_vector.SCALES`."""

    limit: float
    iterations: int = 40
    remedy: str = "feed more oil if a film or stream oscillates"

    @property
    def limits(self) -> str:
        """The tolerance, formatted."""
        return f"{self.limit:g} K, {self.limit:g} um, {10.0 * self.limit:g} W, {self.limit:g} N m"

    def final(self, residuals: Sequence[Residual]) -> bool:
        """Every iteration may be the last."""
        return True

    def reached(self, state: CouplingState, proposal: CouplingState, residual: Residual) -> bool:
        """Whether the largest change is within the limit."""
        return scaled_change(state, proposal) <= self.limit


def not_converged(
    point: OperatingPoint, residuals: Sequence[Residual], convergence: Convergence
) -> NotConvergedError:
    """The error of a point whose iterations are used up, with the history of its residuals."""
    last = "; ".join(
        f"iteration {len(residuals) - back}: {r.temperature:.3g} K, {1e6 * r.length:.3g} um, "
        f"{r.torque:.2g} of the torque"
        for back, r in enumerate(reversed(residuals[-SHOWN:]))
    )
    message = (
        f"coupling at stage {point.stage!r} did not converge in {len(residuals)} iterations (limits "
        f"{convergence.limits}): {last}; {convergence.remedy}"
    )
    rows = [
        {"temperature_K": r.temperature, "growth_um": 1e6 * r.length, "torque_relative": r.torque}
        for r in residuals
    ]
    return NotConvergedError(message, {"stage": point.stage, "residuals": rows})
