"""View factors of a chamber made exactly reciprocal and complete.

Light to import: the rules of a case read it before solvers and compiled kernels are loaded.
"""

from collections.abc import Sequence

import numpy as np

from thermal.conditions.boundary import ConditionError
from thermal.fe.arrays import FloatArray

OPEN = 0.02
"""Allowed gap of the sum of a surface's view factors, and of reciprocity relative to the smaller area [-]."""

CLOSED = 1e-14
"""Gap of a row sum at which the closing ends [-]."""


class EnclosureError(ConditionError):
    """View factors that cannot be made reciprocal and complete."""


def close_view_factors(
    factors: FloatArray, areas: FloatArray, names: Sequence[str], opening: bool, tolerance: float = OPEN
) -> FloatArray:
    """Make view factors (n, n) reciprocal, A_i F_ij = A_j F_ji, and complete, sum_j F_ij = 1.

    areas : (n,) [m2]
    opening : True if the rows may leave a share to the surroundings; they must still not exceed one
    tolerance : greatest allowed gap of a row sum and of reciprocity relative to the smaller area

    Exchange areas A_i F_ij are averaged over both directions, then scaled by one number for each surface
    until every row is complete, so that surfaces that do not see each other stay so. Raises EnclosureError
    naming the surface. Source of the scaling: Sinkhorn, Knopp, Pacific J. Math. 21 (1967) 343.
    """
    factors = np.asarray(factors, dtype=np.float64)
    n = len(names)
    if factors.shape != (n, n) or len(areas) != n:
        raise EnclosureError(
            f"view factors of shape {factors.shape}: need ({n}, {n}), a row for each surface"
        )
    if not np.isfinite(factors).all() or factors.min(initial=0.0) < 0.0:
        raise EnclosureError("view factors must be finite and not negative")
    exchange = np.asarray(areas)[:, None] * factors
    gap = np.abs(exchange - exchange.T) / np.minimum(areas[:, None], areas[None, :])
    if gap.max(initial=0.0) > tolerance:
        i, j = divmod(int(gap.argmax()), n)
        raise EnclosureError(
            f"{names[i]} and {names[j]}: A F = {exchange[i, j]:.5g} m2 one way and {exchange[j, i]:.5g} m2 the "
            f"other, apart by {gap[i, j]:.3g} of the smaller area, above {tolerance:g}; correct one view factor"
        )
    exchange = 0.5 * (exchange + exchange.T)
    sums = exchange.sum(axis=1) / areas
    worst = int(np.abs(sums - 1.0).argmax()) if not opening else int(sums.argmax())
    if sums[worst] > 1.0 + tolerance or (not opening and sums[worst] < 1.0 - tolerance):
        remedy = (
            "name the surface that is missing, or give an opening_temperature for the rest"
            if sums[worst] < 1.0
            else "remove a surface that is listed twice or hidden by another"
        )
        raise EnclosureError(
            f"view factors of {names[worst]} add up to {sums[worst]:.5g} and cannot close: the limit is 1 +- "
            f"{tolerance:g}; {remedy}"
        )
    target = areas * np.minimum(sums, 1.0) if opening else np.asarray(areas)
    return _scaled(exchange, target, names) / np.asarray(areas)[:, None]


def _scaled(exchange: FloatArray, target: FloatArray, names: Sequence[str]) -> FloatArray:
    """Symmetric d_i S_ij d_j with row sums ``target`` by damped Sinkhorn steps."""
    scale = np.ones(len(target))
    goal = np.maximum(target, np.finfo(np.float64).tiny)
    gap = np.zeros(len(target))
    for _ in range(2000):
        sums = scale * (exchange @ scale)
        gap = np.abs(sums - target) / goal
        if gap.max(initial=0.0) <= CLOSED:
            break
        scale *= np.sqrt(np.where(sums > 0.0, target / np.where(sums > 0.0, sums, 1.0), 1.0))
    if gap.max(initial=0.0) > 1e-10:
        raise EnclosureError(
            f"view factors of {names[int(gap.argmax())]} cannot close: no scaling makes them reciprocal and "
            "complete at once; correct the zeros among them"
        )
    return scale[:, None] * exchange * scale[None, :]
