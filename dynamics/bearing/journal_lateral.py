"""Stiffness, damping and static position of a journal bearing under a load vector.

Film: coefficients of the perturbed film (`_film_coefficients`) times B eta / psi^3; the journal stands at the
eccentricity that carries the load, the attitude angle ahead of it in the direction of rotation.

No load: no direction is marked, so the limit of the vanishing load is taken in the mean over all directions: skew
stiffness and isotropic damping, with half the speed between them (the half-frequency whirl).

Mixed friction and standstill: the film carries what it does at the thinnest gap of its theory and asperities the rest,
W_c, straight against the line of centres. They are taken to share the load by an exponential law whose decay length is
that gap, 1 % of the clearance and so of the order of the roughness (J. A. Greenwood, J. B. P. Williamson 1966: load
falls nearly exponentially with separation): W_c / (0.01 c) along the line of centres, W_c / e across it by its turning,
without friction. At standstill the asperities carry all; what is left of the film is the damping of the oil squeezed
out of that gap. Shell and housing behind it are the caller's: they are softer.
"""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from dynamics.bearing.journal_characteristic import (
    NODES,
    WIDTH_RATIO_STEP,
    Characteristic,
    characteristic,
    solved_films,
    width_steps,
)
from dynamics.bearing.journal_feed import Feed
from dynamics.bearing.journal_perturbation import FilmCoefficients, film_coefficients
from dynamics.bearing.lateral import LateralCoefficients, Regime, load_axes
from dynamics.bearing.protocol import BearingError, LateralOperation
from dynamics.kernels.journal import HIGHEST_ECCENTRICITY, node_of

# Stiffness and damping of a journal film over eccentricity, for one width ratio and feed.
#
# The film is perturbed at the eccentricities at which the characteristic is solved, when a width ratio is first met,
# and kept. Between them the coefficients over So / eps, freed of their growth towards contact, are interpolated: smooth
# from the centred journal, where K = (omega / 2) C J with J = [[0, 1], [-1, 0]] because moving with half the speed of
# rotation round the centre is the same to the film as standing off it, to the thinnest film.

Array = NDArray[np.float64]

CENTRED = 1e-6
"""Eccentricity at which the film of the centred journal is perturbed; closer in, rounding shows."""
CLOSE_IN: Array = np.array([CENTRED, 0.005, 0.015, 0.03])
"""Where the film is perturbed besides the nodes of the characteristic: the break-up of a narrow film moves quickly."""
GROWTH: Array = np.array([1.0, -0.5, 0.5, 0.0, 0.5, 0.0, 0.0, -0.5])
"""Powers of 1 / (1 - eps) with which the entries of stiffness and damping grow over So towards contact, those of the
short bearing."""


@dataclass(frozen=True, eq=False)
class CoefficientTable:
    """Coefficients of a bearing of one width ratio and feed; make it with `coefficient_table`."""

    characteristic: Characteristic
    _scaled: CubicSpline

    def at(self, eccentricity: float) -> FilmCoefficients:
        """Dimensionless stiffness and damping at eps in [0, HIGHEST_ECCENTRICITY], axes r and t."""
        eps = max(eccentricity, CENTRED)
        scale = self.characteristic.sommerfeld(eps) / eps * (1.0 - eps) ** -GROWTH
        values = scale * self._scaled(node_of(eps))
        return FilmCoefficients(values[:4].reshape(2, 2), values[4:].reshape(2, 2))


def coefficient_table(width_ratio: float, feed: Feed = "widest_gap") -> CoefficientTable:
    """Table of a width ratio B/D and a feed, solved once and kept.

    Raises
    ------
    DynamicsInputError : B/D outside 0.1 to 2, where a plain bearing of this kind is not built
    """
    return _solved(width_steps(width_ratio), feed)


@lru_cache(maxsize=64)
def _solved(steps: int, feed: Feed) -> CoefficientTable:
    width_ratio = steps * WIDTH_RATIO_STEP
    rows, nodes = [], np.sort(np.concatenate([CLOSE_IN, NODES]))
    for film in solved_films(width_ratio, feed, nodes):
        found = film_coefficients(film)
        values = np.concatenate([found.stiffness.ravel(), found.damping.ravel()])
        rows.append(values * film.eccentricity / film.sommerfeld * (1.0 - film.eccentricity) ** GROWTH)
    return CoefficientTable(characteristic(width_ratio, feed), CubicSpline(nodes, np.array(rows)))


@dataclass(frozen=True, kw_only=True)
class RunningFilm:
    """What a film is at a speed and a temperature.

    diameter, width, diametral_clearance : [m]
    viscosity : dynamic, of the film [Pa s]
    omega : magnitude of the shaft speed [rad/s]
    feed : where its oil enters
    """

    diameter: float
    width: float
    diametral_clearance: float
    viscosity: float
    omega: float
    feed: Feed = "widest_gap"

    @property
    def clearance(self) -> float:
        """Radial c [m]."""
        return 0.5 * self.diametral_clearance

    @property
    def force_scale(self) -> float:
        """B D eta omega / psi^2 [N], force of a Sommerfeld number of 1."""
        psi = self.diametral_clearance / self.diameter
        return self.width * self.diameter * self.viscosity * self.omega / psi**2

    @property
    def damping_scale(self) -> float:
        """2 B eta / psi^3 [N s/m]; times omega the scale of the stiffness."""
        psi = self.diametral_clearance / self.diameter
        return 2.0 * self.width * self.viscosity / psi**3

    @property
    def table(self) -> CoefficientTable:
        """Coefficients over eccentricity."""
        return coefficient_table(self.width / self.diameter, self.feed)


@dataclass(frozen=True, eq=False)
class _Place:
    """Coefficients in SI, axes r and t, where the journal stands; attitude from the load [rad]."""

    eccentricity: float
    attitude: float
    coefficients: FilmCoefficients
    regime: Regime


@lru_cache(maxsize=4096)
def journal_lateral(film: RunningFilm, operation: LateralOperation) -> LateralCoefficients:
    """Stiffness, damping and static position of a plain bearing.

    Raises
    ------
    BearingError : standstill without load, where nothing holds the journal
    DynamicsInputError : B/D outside 0.1 to 2
    """
    load = math.hypot(*operation.force)
    if load == 0.0:
        return _unloaded(film, operation.sense)
    limit = film.table.characteristic.sommerfeld(HIGHEST_ECCENTRICITY) * film.force_scale
    place = _carried_by_film(film, load) if load <= limit else _in_contact(film, load, limit, operation)
    turned = place.coefficients.turned(place.attitude)
    axes = load_axes(operation.force, operation.sense)
    towards = np.array([math.cos(place.attitude), math.sin(place.attitude)])
    return LateralCoefficients(
        stiffness=axes @ turned.stiffness @ axes.T,
        damping=axes @ turned.damping @ axes.T,
        position=film.clearance * place.eccentricity * axes @ towards,
        regime=place.regime,
        eccentricity=place.eccentricity,
    )


def _film_coefficients(film: RunningFilm, eccentricity: float) -> FilmCoefficients:
    found = film.table.at(eccentricity)
    return FilmCoefficients(
        film.omega * film.damping_scale * found.stiffness, film.damping_scale * found.damping
    )


def _carried_by_film(film: RunningFilm, load: float) -> _Place:
    curve = film.table.characteristic
    eccentricity = curve.eccentricity(load / film.force_scale)
    attitude = curve.attitude_angle(eccentricity)
    return _Place(eccentricity, attitude, _film_coefficients(film, eccentricity), "hydrodynamic")


def _in_contact(film: RunningFilm, load: float, limit: float, operation: LateralOperation) -> _Place:
    """Film at its thinnest, which carries ``limit`` [N], and asperities beside it."""
    film_attitude = film.table.characteristic.attitude_angle(HIGHEST_ECCENTRICITY)
    attitude = math.asin(limit * math.sin(film_attitude) / load)
    contact = load * math.cos(attitude) - limit * math.cos(film_attitude)
    gap = 1.0 - HIGHEST_ECCENTRICITY
    eccentricity = HIGHEST_ECCENTRICITY + gap * contact / load
    asperities = np.diag([contact / gap, contact / eccentricity]) / film.clearance
    thinnest = _film_coefficients(film, HIGHEST_ECCENTRICITY)
    together = FilmCoefficients(
        thinnest.stiffness + asperities, thinnest.damping + operation.structural_damping * asperities
    )
    return _Place(eccentricity, attitude, together, "mixed" if film.omega > 0.0 else "standstill")


def _unloaded(film: RunningFilm, sense: int) -> LateralCoefficients:
    if film.omega == 0.0:
        raise BearingError(
            "journal bearing: load = 0 N at standstill: neither film nor contact holds the journal; give the load with "
            "the weight of the shaft, or a speed"
        )
    damping = 0.5 * film.damping_scale * float(np.trace(film.table.at(0.0).damping))
    skew = 0.5 * film.omega * damping * sense
    return LateralCoefficients(
        stiffness=np.array([[0.0, skew], [-skew, 0.0]]),
        damping=damping * np.eye(2),
        position=np.zeros(2),
        regime="hydrodynamic",
        eccentricity=0.0,
    )
