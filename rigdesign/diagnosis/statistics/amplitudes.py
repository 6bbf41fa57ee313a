"""Amplitudes of what is not an effect: dimensionless, fitted to healthy sets of an independent simulator.

They are relative spreads and ratios to the level of a series, so that what one rig taught serves another; how well
they transfer is part of the score (README, diagnosis).
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np
from scipy.optimize import minimize

from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.covariance import inverse_of_factor


@dataclass(frozen=True, kw_only=True)
class Amplitudes:
    """Standard deviation of each kind of cause, relative."""

    constant_loss: float = 1.0
    """Factor on the healthy spreads of losses as the catalogue states them."""
    constant_film: float = 1.0
    """Factor on the healthy spreads of films, contacts and the division of heat."""
    constant_oil: float = 1.0
    """Factor on the healthy spreads of properties and ways of the oil."""
    constant_loop: float = 1.0
    """Factor on the healthy spreads of stiffness, damping and inertia."""
    tooth: float = 1.0
    """Factor on the healthy errors of the teeth, from their quality grade."""
    exponent: float = 0.15
    """Error of the exponent of a loss law over speed and torque."""
    link: float = 0.25
    """Error of the logarithm of every local conductance."""
    link_speed: float = 0.10
    """Error of the logarithm of every local conductance per factor e of speed."""
    answer: float = 0.15
    """Error of the answers to constants of the heat, over the answers at their healthy spreads."""
    source: float = 0.03
    """Heat that enters elsewhere than the model says, over all losses of the point."""
    channel: float = 0.02
    """Smooth error of one channel over its level: place of a sensor, what the mesh does not resolve."""
    channel_speed: float = 0.01
    """Smooth error of one channel per factor e of speed."""
    point: float = 0.01
    """Error of one number by itself over its level."""
    series_mean: float = 0.01
    """Error of a mean torque over its level."""
    series_mesh: float = 0.25
    """Orders of the meshes over their own level: coherent over the points."""
    series_mesh_point: float = 0.15
    """Orders of the meshes over their own level: point by point."""
    series_shaft: float = 0.01
    """Orders of the shafts and sidebands over the level of the mesh orders: coherent."""
    series_shaft_point: float = 0.01
    """Orders of the shafts and sidebands over the level of the mesh orders: point by point."""
    frequency: float = 0.02
    """Error of natural frequencies, relative."""
    sensor: float = 1.0
    """Factor on the systematic uncertainties of sensors that the measurement states."""
    input: float = 1.0
    """Factor on the systematic uncertainties of settings that the measurement states."""

    def as_dict(self) -> dict[str, float]:
        """By name."""
        return asdict(self)

    def with_values(self, values: dict[str, float]) -> "Amplitudes":
        """Some of them changed."""
        return replace(self, **values)


# Amplitudes of a covariance by marginal likelihood, with what the data leave open of each.
#
# C = N + sum_k a_k^2 S_k; the logarithms of the amplitudes have a normal prior around given values.
#
# Source: type II maximum likelihood, Rasmussen and Williams 2006, ch. 5.4; the gradient is eq. (5.9). The spread is
# that of the normal distribution with the curvature at the maximum (Laplace's approximation, ibid. ch. 3.4).

PRIOR = 1.5
"""Standard deviation of the logarithm of an amplitude around the value known before."""

FARTHEST = 5.0
"""Logarithm by which an amplitude may leave the value known before, where no handbook limits it."""

CURVATURE_STEP = 1e-3
"""Step in the logarithm of an amplitude for the curvature of the likelihood."""


@dataclass(frozen=True, kw_only=True)
class Group:
    """Residuals of one covariance.

    noise : (n, n) without any amplitude; parts : amplitude -> (n, n); residuals : (n, k)
    weight : of each residual in the likelihood, below one where they are not independent
    """

    noise: Array
    parts: Mapping[str, Array]
    residuals: Array
    weight: float = 1.0


@dataclass(frozen=True, kw_only=True)
class Fit:
    """Amplitudes with the highest posterior density, and the standard deviation of the logarithm of each.

    misfit : -ln of likelihood and prior there, up to a constant of the data
    """

    values: Mapping[str, float]
    spreads: Mapping[str, float]
    misfit: float


def fit(
    groups: Sequence[Group],
    start: Mapping[str, float],
    prior: Mapping[str, float],
    reach: Mapping[str, float],
    fixed: Mapping[str, float],
) -> Fit:
    """The amplitudes that make the residuals most likely together with the prior.

    start : amplitudes to be fitted and where the search starts; prior : their value known before; reach : logarithm by
    which each may leave it, `FARTHEST` where left out; fixed : amplitudes that stay as they are
    """
    names = sorted(start)
    centre = np.log([prior[name] for name in names])

    def misfit(logs: Array) -> tuple[float, Array]:
        amplitudes = {**fixed, **dict(zip(names, np.exp(logs).tolist(), strict=True))}
        value = 0.5 * float(np.sum(((logs - centre) / PRIOR) ** 2))
        slope = (logs - centre) / PRIOR**2
        for group in groups:
            of_group, by_amplitude = group_misfit(group, amplitudes, names)
            value += of_group
            slope = slope + by_amplitude
        return value, slope

    reaches = [reach.get(name, FARTHEST) for name in names]
    minimum = minimize(
        misfit,
        np.log([start[name] for name in names]),
        jac=True,
        method="L-BFGS-B",
        bounds=[(c - far, c + far) for c, far in zip(centre, reaches, strict=True)],
        options={"maxiter": 60},
    )
    return Fit(
        values=dict(zip(names, np.exp(minimum.x).tolist(), strict=True)),
        spreads=dict(zip(names, _spreads(lambda logs: misfit(logs)[1], minimum.x), strict=True)),
        misfit=float(minimum.fun),
    )


def group_misfit(group: Group, amplitudes: Mapping[str, float], names: Sequence[str]) -> tuple[float, Array]:
    """-ln likelihood of a group and its derivative by the logarithms of the named amplitudes."""
    matrix: Array = group.noise + sum(amplitudes[kind] ** 2 * part for kind, part in group.parts.items())
    lower: Array = np.asarray(np.linalg.cholesky(matrix))
    precision = inverse_of_factor(lower)
    weighted = precision @ group.residuals
    count = group.residuals.shape[1]
    value = count * float(np.log(np.diagonal(lower)).sum()) + 0.5 * float(np.sum(group.residuals * weighted))
    rise = count * precision - weighted @ weighted.T
    slopes = [
        amplitudes[name] ** 2 * float(np.vdot(rise, group.parts[name])) if name in group.parts else 0.0
        for name in names
    ]
    return group.weight * value, group.weight * np.array(slopes)


def _spreads(slope: Callable[[Array], Array], logs: Array) -> list[float]:
    """Standard deviation of each logarithm from the curvature; never wider than the prior."""
    steps = CURVATURE_STEP * np.eye(len(logs))
    curvature = np.array(
        [(slope(logs + step) - slope(logs - step)) / (2.0 * CURVATURE_STEP) for step in steps]
    )
    values, vectors = np.linalg.eigh(0.5 * (curvature + curvature.T))
    inverse = (vectors / np.maximum(values, PRIOR**-2)) @ vectors.T
    return [float(variance) for variance in np.sqrt(np.diagonal(inverse))]
