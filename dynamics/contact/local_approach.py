"""Local approach of two flanks pressed together along a line, and the pressure there.

In the half space: Weber's logarithmic form to the depth of the tooth axes (Weber and Banaschek, VDI 1953; Johnson,
Contact Mechanics, 5.6). A tip edge near the contact makes the body softer: beyond the distance to the edge the stress
spreads in the wedge between flank and tip instead of a half space. Its displacement grows with the logarithm as well,
by a factor on the half space's that follows from Michell's wedge under a force at its apex (Timoshenko and Goodier,
Theory of Elasticity, section 38; 3.36 for a right angle, 1 for a flat). Both logarithms are joined at the distance to
the edge, at half of the contact half-width if the edge is nearer than that; a finite-element wedge confirms both in
``tests/verification/test_contact_local_approach.py``. That the effect is large close to an edge: Wang, Guo, Wong and
Zhang, Tribology Int. 114 (2017) 358.
"""

from dataclasses import dataclass
from math import atan, cos, pi, sin

import numpy as np
from numpy.typing import NDArray

from dynamics.contact.compliance import FlankCompliance
from dynamics.contact.corner import ContactPlace, TipEnd
from dynamics.errors import DynamicsInputError
from dynamics.gear.pair import GearPair

Array = NDArray[np.float64]

LEAST_EDGE = 0.02
"""Radius of an edge called sharp, in normal modules: burrs taken off (assumed)."""


@dataclass(frozen=True, kw_only=True)
class EdgeModel:
    """How tip edges act on the local approach.

    softer : the wedge between flank and tip is softer than a half space, where the compliance does not count it
    least_radius : of an edge without rounding [m]; None: 0.02 normal modules
    """

    softer: bool = True
    least_radius: float | None = None

    def __post_init__(self) -> None:
        if self.least_radius is not None and not self.least_radius > 0.0:
            raise DynamicsInputError(
                f"least_radius = {self.least_radius} m of a sharp edge must be positive; leave it out for 0.02 modules"
            )


SOFT_EDGES = EdgeModel()


def wedge_factor(angle: float) -> float:
    """Displacement of a wedge against that of the half space under the same force at its apex, normal to one face [-].

    angle : between the faces [rad], above 0. Ratio of the factors of the logarithm of the distance, plane strain.
    """
    half, lean = 0.5 * angle, 0.5 * (pi - angle)
    along, across = half + sin(half) * cos(half), half - sin(half) * cos(half)
    return 0.5 * pi * (cos(lean) ** 2 / along + sin(lean) ** 2 / across)


@dataclass(frozen=True, kw_only=True, eq=False)
class LocalContact:
    """Local approach h(F) = F (a - c ln F) of contact points, and what the pressure follows from.

    law : (n, 2) a and c with F in N [m/N]
    radius : (n,) relative radius of curvature [m]
    length : (n,) of the contact line that each point stands for [m]
    modulus : (1 - nu1^2)/E1 + (1 - nu2^2)/E2 [1/Pa]
    """

    law: Array
    radius: Array
    length: Array
    modulus: float

    def half_width(self, force: Array) -> Array:
        """Half width of the contact (n,) under normal forces (n,) [m]."""
        load = np.maximum(force, 0.0) / self.length
        return np.asarray(np.sqrt(4.0 * load * self.radius * self.modulus / pi))

    def pressure(self, force: Array) -> Array:
        """Largest Hertzian pressure (n,) under normal forces (n,) [Pa]."""
        load = np.maximum(force, 0.0) / self.length
        return np.asarray(np.sqrt(load / (pi * self.radius * self.modulus)))


def elastic_moduli(pair: GearPair) -> tuple[float, float]:
    """(1 - nu^2)/E of pinion and wheel [1/Pa]."""
    first, second = ((1.0 - nu**2) / e for nu, e in zip(pair.poisson_ratios, pair.youngs_moduli, strict=True))
    return first, second


@dataclass(frozen=True, kw_only=True, eq=False)
class LocalModel:
    """Local approach of a pair: its flanks, edges and the line load at which the width of the contact is taken.

    gears : compliance of pinion and wheel, for the depth of their teeth
    tips : ends of both flanks
    line_load : mean force per length of contact [N/m]
    """

    pair: GearPair
    gears: tuple[FlankCompliance, FlankCompliance]
    tips: tuple[TipEnd, TipEnd]
    edges: EdgeModel
    line_load: float

    def at(self, place: ContactPlace, width: Array) -> LocalContact:
        """Local contact of points (n,) that stand for face widths ``width`` (n,) [m]."""
        moduli = elastic_moduli(self.pair)
        total = sum(moduli)
        length = width / cos(self.pair.base_helix_angle)
        radius = self._radius(place)
        reference = np.sqrt(4.0 * self.line_load * radius * total / pi)
        bracket = np.zeros_like(radius)
        for index in (0, 1):
            nu, depth = self.pair.poisson_ratios[index], self.gears[index].depth(place.roll[index])
            half_space = np.log(pi * depth**2 / (radius * total)) - nu / (1.0 - nu)
            tooth = self.gears[index].excess(place.roll[index]) + self._edge(index, place, depth, reference)
            bracket += moduli[index] * (half_space + tooth)
        law = np.stack([(bracket + total * np.log(length)) / (pi * length), total / (pi * length)], axis=-1)
        return LocalContact(law=law, radius=radius, length=length, modulus=total)

    def _radius(self, place: ContactPlace) -> Array:
        """Relative radius of curvature (n,) in the normal section [m].

        At a corner it goes over from that of the flanks to that of the edge as the flank, carried on, would touch
        further from its end than a half-width.
        """
        slant = cos(self.pair.base_helix_angle)
        curvature = slant * (1.0 / place.roll[0] + 1.0 / place.roll[1] + place.bend)
        least = self.edges.least_radius or LEAST_EDGE * self.pair.normal_module
        wide = 4.0 * self.line_load * sum(elastic_moduli(self.pair)) / (pi * curvature)
        share = place.beyond**2 / (place.beyond**2 + wide)
        for index in (0, 1):
            own = place.corner == 1 + index
            edge = 1.0 / max(self.tips[index].rounding, least) - slant / place.roll[index]
            curvature = curvature + np.where(own, share * edge, 0.0)
        return np.asarray(1.0 / curvature)

    def _edge(self, index: int, place: ContactPlace, depth: Array, half_width: Array) -> Array:
        """Addition of the tip edge of gear ``index`` to the logarithm of the half space (n,) [-]."""
        if self.gears[index].edge_counted or not self.edges.softer:
            return np.zeros_like(depth)
        tip, base = self.tips[index], self.pair.base_radii[index]
        factor = wedge_factor(0.5 * pi + atan(tip.roll / base))
        along = np.maximum(tip.roll**2 - place.roll[index] ** 2, 0.0) / (2.0 * base) + tip.rounding
        distance = np.hypot(along, 0.5 * half_width)
        return np.asarray(2.0 * (factor - 1.0) * np.maximum(np.log(depth / distance), 0.0))
