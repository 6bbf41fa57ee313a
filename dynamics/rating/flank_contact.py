"""Contact of the flanks along the path: curvature, speeds, line load, pressure. Basis of scuffing and micropitting.

Load sharing is that of ISO/TS 6336-20 and -22 (method B). A tooth contact analysis may give its own `line_load`
instead: what follows from it does not change.
"""

from dataclasses import dataclass
from functools import cached_property
from math import cos, pi, sin, sqrt, tan

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError
from dynamics.gear.pair import GearPair
from dynamics.standards import iso_ts_6336_20_2017 as scuffing

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class ContactFactors:
    """K factors of ISO 6336 for contact: application, dynamic, face load and transverse load factor."""

    application: float = 1.0
    dynamic: float = 1.0
    face_load: float = 1.0
    """K_Hbeta."""
    transverse: float = 1.0
    """K_Halpha."""

    @property
    def product(self) -> float:
        """All of them."""
        return self.application * self.dynamic * self.face_load * self.transverse


@dataclass(frozen=True, kw_only=True)
class FlankLoad:
    """Operating point of a mesh.

    torque, speed : of the pinion, both above 0 [N m], [rad/s]; pinion_drives : whether it gives the power
    factors : what raises the local load over the nominal one
    grade : ISO 1328-1 flank tolerance class of the coarser gear
    tip_reliefs : C_a of pinion and wheel [m]; optimum : C_eff, the relief the load asks for [m]
    """

    torque: float
    speed: float
    pinion_drives: bool = True
    factors: ContactFactors = ContactFactors()
    grade: int = 5
    tip_reliefs: tuple[float, float] = (0.0, 0.0)
    optimum: float = 0.0

    def __post_init__(self) -> None:
        for name in ("torque", "speed"):
            value = getattr(self, name)
            if not value > 0.0:
                raise DynamicsInputError(
                    f"flank load: {name} = {value:g}: must be above 0; rate an operating point that turns under load"
                )

    @property
    def relief_shares(self) -> tuple[float, float]:
        """C_a/C_eff of wheel and pinion, at most 1: what is relieved at A and at E [-]."""
        if self.optimum <= 0.0:
            return (0.0, 0.0)
        pinion, wheel = (min(relief / self.optimum, 1.0) for relief in self.tip_reliefs)
        return wheel, pinion


@dataclass(frozen=True)
class FlankContact:
    """A gear pair under a load; path positions count from the pitch point, growing to the pinion tip [m]."""

    pair: GearPair
    load: FlankLoad

    @property
    def base_load(self) -> float:
        """Nominal transverse load in the line of action over the common face width, F_bt/b [N/m]."""
        return self.load.torque / self.pair.base_radii[0] / self.pair.face_width

    @property
    def pitch_line_speed(self) -> float:
        """At the working pitch circle [m/s]."""
        return self.load.speed * self.pair.working_radii[0]

    @cached_property
    def reduced_modulus(self) -> float:
        """E_r = 2/sum((1 - nu^2)/E) [Pa]."""
        (e_1, e_2), (nu_1, nu_2) = self.pair.youngs_moduli, self.pair.poisson_ratios
        return 2.0 / ((1.0 - nu_1**2) / e_1 + (1.0 - nu_2**2) / e_2)

    @cached_property
    def points(self) -> dict[str, float]:
        """The seven points of ISO/TS 6336-22 by name: A, AB, B, C, D, DE, E [m]; C where it lies on the path."""
        path = self.pair.path
        start, end = path.start, path.end
        inner, outer = path.inner_single_contact, path.outer_single_contact
        found = {
            "A": start,
            "AB": 0.5 * (start + inner),
            "B": inner,
            "C": 0.0,
            "D": outer,
            "DE": 0.5 * (outer + end),
            "E": end,
        }
        return {name: s for name, s in found.items() if start <= s <= end}

    def radii(self, s: Array) -> tuple[Array, Array]:
        """Transverse radii of curvature of pinion and wheel flank [m], shape of ``s``."""
        reach_1, reach_2 = self.pair.rolling_radii
        return reach_1 + s, reach_2 - s

    def reduced_radius(self, s: Array) -> Array:
        """Relative radius of curvature in the normal section [m], shape of ``s``."""
        first, second = self.radii(s)
        return np.asarray(first * second / ((first + second) * cos(self.pair.base_helix_angle)))

    def rolling_speeds(self, s: Array) -> tuple[Array, Array]:
        """Speeds of both flanks along the profile [m/s], shape of ``s``."""
        first, second = self.radii(s)
        return self.load.speed * first, self.load.speed / self.pair.gear_ratio * second

    def path_parameter(self, s: Array) -> Array:
        """Gamma of ISO/TS 6336-20, path position over T1C [-]."""
        return np.asarray(s / self.pair.rolling_radii[0])

    @cached_property
    def parameters(self) -> scuffing.PathParameters:
        """Gamma of A, B, D, E."""
        path, reach = self.pair.path, self.pair.rolling_radii[0]
        return scuffing.PathParameters(
            A=path.start / reach,
            B=path.inner_single_contact / reach,
            D=path.outer_single_contact / reach,
            E=path.end / reach,
            AU=scuffing.BUTTRESS_LENGTH * sin(self.pair.base_helix_angle),
        )

    def sharing(self, s: Array) -> Array:
        """X_Gamma, share of the load of one tooth pair [-], shape of ``s``.

        Raises DynamicsInputError for a transverse contact ratio of 2 or more.
        """
        sharing = scuffing.Sharing(
            epsilon_alpha=self.pair.transverse_contact_ratio,
            epsilon_beta=self.pair.overlap_ratio,
            grade=self.load.grade,
            relief=self.load.relief_shares,
        )
        return scuffing.X_Gamma(self.path_parameter(s), self.parameters, sharing)

    def line_load(self, s: Array, least_share: float = 0.0) -> Array:
        """Normal load per length of contact with all K factors [N/m], shape of ``s``.

        The normal force is F_bt/cos(beta_b) and the contact line of a pair longer than b by the same: they cancel.

        least_share : share of the load that counts where the load sharing has less
        """
        return np.maximum(self.sharing(s), least_share) * self.base_load * self.load.factors.product

    def pressure(self, s: Array, least_share: float = 0.0) -> Array:
        """Hertzian pressure of that load [Pa], shape of ``s``."""
        loaded = self.line_load(s, least_share) * self.reduced_modulus / (2.0 * pi * self.reduced_radius(s))
        return np.asarray(np.sqrt(loaded))

    @property
    def sum_speed_factor(self) -> float:
        """Sum of both rolling speeds at the pitch point over the pitch line speed, 2 sin(alpha_wt) [-]."""
        return 2.0 * sin(self.pair.working_pressure_angle)

    @property
    def approach_excess(self) -> float:
        """C_eff less the tip relief of the driven gear [m]."""
        driven = 1 if self.load.pinion_drives else 0
        return self.load.optimum - self.load.tip_reliefs[driven]


def thermal_contact(conductivity: float, density: float, heat_capacity: float) -> float:
    """B_M = sqrt(lambda rho c) [W s^0.5/(m2 K)]; 13.6e3 for steels of gears."""
    return sqrt(conductivity * density * heat_capacity)


def single_contact_ratio(pair: GearPair, index: int) -> float:
    """M_1 or M_2 of ISO 6336-2: sqrt(rho_C/rho) at the inner point of single contact of pinion (0) or wheel (1) [-]."""
    reach_1, reach_2 = pair.rolling_radii
    s = pair.path.inner_single_contact if index == 0 else pair.path.outer_single_contact
    first, second = (reach_1 + s) / pair.base_radii[0], (reach_2 - s) / pair.base_radii[1]
    if min(first, second) <= 0.0:
        return 1.0
    return tan(pair.working_pressure_angle) / sqrt(first * second)
