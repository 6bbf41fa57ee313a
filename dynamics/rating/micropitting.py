"""Film thickness ratio of the flanks against micropitting, ISO/TS 6336-22:2018 method B. SI in and out."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dynamics.rating.flank_contact import FlankContact
from dynamics.rating.iso_rating import MM, UM
from dynamics.rating.scuffing import ZERO, FlankFilmState
from dynamics.standards import iso_ts_6336_22_2018 as iso

Array = NDArray[np.float64]
LEAST_SHARE = 0.01
"""Share of the load that counts at a relieved end of the path, where nothing is carried and the film has no limit."""


@dataclass(frozen=True)
class Lubricant:
    """Oil in the contact.

    viscosity : dynamic viscosity [Pa s] at a temperature [K]
    pressure_viscosity : coefficient alpha at 38 degC [1/Pa]
    """

    viscosity: Callable[[float], float]
    pressure_viscosity: float

    @classmethod
    def known_at(
        cls, viscosity: Callable[[float], float], coefficient: float, temperature: float
    ) -> "Lubricant":
        """From the coefficient [1/Pa] at another temperature [K]."""
        return cls(viscosity, iso.alpha_38(coefficient, temperature - ZERO))


@dataclass(frozen=True, kw_only=True, eq=False)
class FilmRatios:
    """Film at the points of the path.

    points : names, A to E; path : (n,) their positions [m]; film : (n,) thickness h [m]; ratio : (n,) lambda_GF [-]
    pressure : (n,) Hertzian, with all K factors [Pa]; contact_temperature : (n,) [K]; friction : mean coefficient [-]
    """

    points: tuple[str, ...]
    path: Array
    film: Array
    ratio: Array
    pressure: Array
    contact_temperature: Array
    friction: float

    @property
    def least(self) -> float:
        """lambda_GF,min [-]."""
        return float(self.ratio.min())

    @property
    def thinnest(self) -> str:
        """Point of it."""
        return self.points[int(self.ratio.argmin())]


def friction(contact: FlankContact, state: FlankFilmState) -> float:
    """mu_m of clause 7.4 [-]."""
    sum_speed = contact.sum_speed_factor * contact.pitch_line_speed
    return iso.mu_m(
        1e-3
        * contact.base_load
        * contact.load.factors.product
        * iso.K_Bgamma(contact.pair.total_contact_ratio),
        sum_speed,
        MM * float(contact.reduced_radius(np.asarray(0.0))),
        state.viscosity,
        UM * state.roughness,
        state.oil_factor,
    )


def film_ratios(contact: FlankContact, state: FlankFilmState, oil: Lubricant) -> FilmRatios:
    """lambda_GF at A, AB, B, C, D, DE, E; C only where the pitch point lies on the path.

    Raises DynamicsInputError for a transverse contact ratio of 2 or more.
    """
    names = tuple(contact.points)
    path = np.array([contact.points[name] for name in names])
    speeds, rho = contact.rolling_speeds(path), contact.reduced_radius(path)
    pressure = contact.pressure(path, LEAST_SHARE)
    modulus = contact.reduced_modulus
    mu = friction(contact, state)
    bulk = state.bulk_temperature
    flash = iso.theta_fl(mu, 1e-6 * pressure, speeds, MM * rho, 1e-6 * modulus, state.thermal_contact)
    touching = bulk + flash
    alpha_bulk = float(iso.alpha_theta(oil.pressure_viscosity, np.asarray(bulk - ZERO)))
    alpha_contact = iso.alpha_theta(oil.pressure_viscosity, touching - ZERO)
    eta_bulk = oil.viscosity(bulk)
    eta_contact = np.array([oil.viscosity(float(temperature)) for temperature in touching])
    film = iso.h_Y(
        MM * rho,
        alpha_bulk * modulus,
        eta_bulk * (speeds[0] + speeds[1]) / (2.0 * modulus * rho),
        2.0 * np.pi * (pressure / modulus) ** 2,
        alpha_contact * eta_contact / (alpha_bulk * eta_bulk),
    )
    return FilmRatios(
        points=names,
        path=path,
        film=1e-6 * film,
        ratio=1e-6 * film / state.roughness,
        pressure=pressure,
        contact_temperature=touching,
        friction=mu,
    )
