"""Radial internal clearance of a mounted bearing at temperature.

Interference of the inner ring on the shaft widens its raceway, interference of the outer ring in the housing narrows
its own, and temperatures of shaft, rings, rolling elements and housing move both. Rings, hollow shaft and housing are
thick-walled cylinders (Lame); with one material this is the formula of the NSK catalogue (15.2 (1)):

    raceway expansion of the inner ring = interference k (1 - k_0^2) / (1 - k^2 k_0^2) ,  k = d / D_i, k_0 = d_0 / d
"""

import math
from dataclasses import dataclass

from dynamics.errors import DynamicsInputError
from dynamics.rotor.bearing import BearingError
from dynamics.rotor.rolling_kinds import CatalogueBearing
from dynamics.standards import iso5753_1_2009
from dynamics.standards.iso5753_1_2009 import ClearanceClass

REFERENCE_TEMPERATURE = 293.15
"""At which dimensions and clearance classes are stated [K]."""


@dataclass(frozen=True, kw_only=True)
class SeatMaterial:
    """Elasticity and expansion of a shaft, a ring or a housing.

    young_modulus : [Pa]
    poisson_ratio : [-]
    expansion : coefficient of linear thermal expansion [1/K]
    """

    young_modulus: float = 2.08e11
    poisson_ratio: float = 0.3
    expansion: float = 11.7e-6


RING = SeatMaterial(expansion=12.5e-6)
"""Rolling bearing steel; expansion of the NSK catalogue."""


@dataclass(frozen=True, kw_only=True)
class Fit:
    """Seats of both rings, on the diameter at 293.15 K and after smoothing of the surfaces.

    shaft_interference, housing_interference : negative where loose [m]
    shaft_bore : of a hollow shaft, 0 if solid [m]
    housing_outside : outside diameter of the housing round the seat; infinite is rigid [m]
    shaft, housing : their materials
    """

    shaft_interference: float = 0.0
    housing_interference: float = 0.0
    shaft_bore: float = 0.0
    housing_outside: float = math.inf
    shaft: SeatMaterial = SeatMaterial()
    housing: SeatMaterial = SeatMaterial()


@dataclass(frozen=True, kw_only=True)
class RingTemperatures:
    """Temperatures that change the clearance [K]; all at 293.15 K changes nothing."""

    shaft: float = REFERENCE_TEMPERATURE
    inner_ring: float = REFERENCE_TEMPERATURE
    elements: float = REFERENCE_TEMPERATURE
    outer_ring: float = REFERENCE_TEMPERATURE
    housing: float = REFERENCE_TEMPERATURE


@dataclass(frozen=True, kw_only=True)
class OperatingClearance:
    """Radial internal clearance as it runs and what took it there [m].

    clearance : = initial - fit_inner - fit_outer + thermal; negative is preload
    shaft_interference, housing_interference : at temperature; 0 where the seat is loose
    """

    clearance: float
    initial: float
    fit_inner: float
    fit_outer: float
    thermal: float
    shaft_interference: float
    housing_interference: float


def class_clearance(bearing: CatalogueBearing, clearance_class: ClearanceClass) -> tuple[float, float]:
    """Least and largest radial internal clearance of the unmounted bearing [m] (ISO 5753-1).

    Raises DynamicsInputError for a kind or a bore without a class.
    """
    table = bearing.rules.clearance_classes
    if table is None:
        raise DynamicsInputError(
            f"clearance class {clearance_class}: a bearing of kind {bearing.kind} has none, its clearance is set at "
            "assembly; give the clearance itself"
        )
    least, largest = iso5753_1_2009.radial_internal_clearance(table, bearing.bore * 1e3, clearance_class)
    return 1e-6 * least, 1e-6 * largest


def operating_clearance(
    bearing: CatalogueBearing, initial: float, fit: Fit, temperatures: RingTemperatures | None = None
) -> OperatingClearance:
    """Radial internal clearance of the mounted bearing at temperature from its ``initial`` one [m].

    Raises BearingError for a shaft bore or a housing that does not fit the bearing.
    """
    hot = temperatures or RingTemperatures()
    bore, outside = bearing.bore, bearing.outside_diameter
    if not 0.0 <= fit.shaft_bore < bore:
        raise BearingError(
            f"fit: shaft_bore = {fit.shaft_bore:.6g} m: must lie between 0 and the bore {bore:.6g} m of the bearing"
        )
    if not fit.housing_outside > outside:
        raise BearingError(
            f"fit: housing_outside = {fit.housing_outside:.6g} m: must be above the outside diameter {outside:.6g} m "
            "of the bearing"
        )
    elements = bearing.elements
    inner_race, outer_race = elements.inner_raceway, elements.outer_raceway
    on_shaft = fit.shaft_interference + bore * (_strain(fit.shaft, hot.shaft) - _strain(RING, hot.inner_ring))
    in_housing = fit.housing_interference + outside * (
        _strain(RING, hot.outer_ring) - _strain(fit.housing, hot.housing)
    )
    inner = inner_raceway_expansion(max(on_shaft, 0.0), bore, inner_race, fit)
    outer = outer_raceway_contraction(max(in_housing, 0.0), outside, outer_race, fit)
    thermal = (
        outer_race * _strain(RING, hot.outer_ring)
        - inner_race * _strain(RING, hot.inner_ring)
        - 2.0 * elements.diameter * math.cos(elements.contact_angle) * _strain(RING, hot.elements)
    )
    return OperatingClearance(
        clearance=initial - inner - outer + thermal,
        initial=initial,
        fit_inner=inner,
        fit_outer=outer,
        thermal=thermal,
        shaft_interference=max(on_shaft, 0.0),
        housing_interference=max(in_housing, 0.0),
    )


def inner_raceway_expansion(interference: float, bore: float, raceway: float, fit: Fit) -> float:
    """Expansion of the inner raceway diameter [m] by an interference on the shaft [m], both on the diameter."""
    ring = (raceway**2 + bore**2) / (raceway**2 - bore**2) + RING.poisson_ratio
    shaft = (bore**2 + fit.shaft_bore**2) / (bore**2 - fit.shaft_bore**2) - fit.shaft.poisson_ratio
    pressure = interference / bore / (ring / RING.young_modulus + shaft / fit.shaft.young_modulus)
    return pressure / RING.young_modulus * 2.0 * bore**2 * raceway / (raceway**2 - bore**2)


def outer_raceway_contraction(interference: float, outside: float, raceway: float, fit: Fit) -> float:
    """Contraction of the outer raceway diameter [m] by an interference in the housing [m], both on the diameter."""
    ring = (outside**2 + raceway**2) / (outside**2 - raceway**2) - RING.poisson_ratio
    thickness = (outside / fit.housing_outside) ** 2
    housing = (1.0 + thickness) / (1.0 - thickness) + fit.housing.poisson_ratio
    pressure = interference / outside / (ring / RING.young_modulus + housing / fit.housing.young_modulus)
    return pressure / RING.young_modulus * 2.0 * outside**2 * raceway / (outside**2 - raceway**2)


def _strain(material: SeatMaterial, temperature: float) -> float:
    return material.expansion * (temperature - REFERENCE_TEMPERATURE)
