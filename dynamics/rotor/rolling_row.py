"""One row of rolling elements: what displaces its rings presses the elements, and they press back.

Every element is pressed by what the displacement takes off its space and gives its force back along its contact angle.
Balls change their contact angle with the load, rollers keep theirs. A roller is cut into laminae along its length,
each with its share of the line contact (ISO/TS 16281), so that a tilted ring presses one end of it; rollers without
profile. Source: T. A. Harris, Rolling Bearing Analysis, chapters 6 and 7; ISO/TS 16281.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from dynamics.rotor.rolling_elements import RollingElements

# Load against approach of a rolling element between both raceways.
#
# Balls: Hertz point contact of a ball in a groove, the ellipse from the complete elliptic integrals (T. A. Harris,
# Rolling Bearing Analysis, chapter 6). Rollers: line contact after A. Palmgren, delta = 3.84e-5 Q^0.9 / L^0.8 (N, mm)
# for each of the two contacts. Steel on steel.

YOUNG_MODULUS = 2.08e11
"""Rolling bearing steel [Pa]."""
POISSON_RATIO = 0.3
INNER_CONFORMITY = 0.52
OUTER_CONFORMITY = 0.53
"""Groove radius over ball diameter, the largest that ISO 281 rates in full; assumed where not known."""
POINT_EXPONENT = 1.5
LINE_EXPONENT = 10.0 / 9.0
PALMGREN_COMPLIANCE = 3.84e-5
"""One line contact, N and mm."""


@dataclass(frozen=True, kw_only=True)
class ContactLaw:
    """Q = stiffness delta^exponent of one rolling element between both raceways.

    stiffness : [N/m^exponent]
    exponent : 3/2 point, 10/9 line
    groove_distance : distance of the groove centres of a ball bearing, r_i + r_o - D_w [m]; 0 for rollers
    inner_groove_offset : of the groove centre of the inner ring from the ball centre, r_i - D_w / 2 [m]; 0 for rollers
    """

    stiffness: float
    exponent: float
    groove_distance: float = 0.0
    inner_groove_offset: float = 0.0


@dataclass(frozen=True, kw_only=True)
class BallGroove:
    """Conformities and elasticity of balls and grooves.

    inner, outer : groove radius over ball diameter, above 0.5 [-]
    young_modulus : [Pa]
    poisson_ratio : [-]
    """

    inner: float = INNER_CONFORMITY
    outer: float = OUTER_CONFORMITY
    young_modulus: float = YOUNG_MODULUS
    poisson_ratio: float = POISSON_RATIO


COMMON_GROOVE = BallGroove()


def contact_law(elements: RollingElements, groove: BallGroove = COMMON_GROOVE) -> ContactLaw:
    """Contact law of the rolling elements; ``groove`` is read for balls."""
    if elements.roller:
        length = elements.length * 1e3
        one = (1.0 / PALMGREN_COMPLIANCE) ** LINE_EXPONENT * length ** (8.0 / 9.0)
        both = one / 2.0**LINE_EXPONENT
        return ContactLaw(stiffness=both * 1e3**LINE_EXPONENT, exponent=LINE_EXPONENT)
    ball, gamma = elements.diameter, elements.gamma
    inner = _point_stiffness(ball, 2.0 * gamma / (1.0 - gamma), groove.inner, groove)
    outer = _point_stiffness(ball, -2.0 * gamma / (1.0 + gamma), groove.outer, groove)
    both = (inner ** (-2.0 / 3.0) + outer ** (-2.0 / 3.0)) ** -1.5
    return ContactLaw(
        stiffness=both,
        exponent=POINT_EXPONENT,
        groove_distance=(groove.inner + groove.outer - 1.0) * ball,
        inner_groove_offset=(groove.inner - 0.5) * ball,
    )


def _point_stiffness(ball: float, rolling: float, conformity: float, groove: BallGroove) -> float:
    """Q / delta^1.5 of a ball on one raceway [N/m^1.5].

    rolling : curvature of the raceway in the rolling direction times the ball diameter; of the groove -1 / conformity
    """
    sum_rho = (4.0 - 1.0 / conformity + rolling) / ball
    difference = (1.0 / conformity + rolling) / ball / sum_rho
    kappa = ellipse_ratio(difference)
    modulus = 1.0 - 1.0 / kappa**2
    first, second = float(ellipk(modulus)), float(ellipe(modulus))
    approach = 2.0 * first / math.pi * (math.pi / (2.0 * kappa**2 * second)) ** (1.0 / 3.0)
    compliance = 2.0 * (1.0 - groove.poisson_ratio**2) / groove.young_modulus
    unit = approach * (1.5 / sum_rho * compliance) ** (2.0 / 3.0) * 0.5 * sum_rho
    stiffness: float = unit**-1.5
    return stiffness


def ellipse_ratio(difference: float) -> float:
    """Ratio a / b of the contact ellipse at the curvature difference F(rho), 0 to below 1.

    F = ((kappa^2 + 1) E - 2 K) / ((kappa^2 - 1) E) with the complete elliptic integrals of modulus 1 - 1 / kappa^2
    """
    if difference < 1e-9:
        return 1.0

    def excess(log_kappa: float) -> float:
        square = math.exp(2.0 * log_kappa)
        modulus = 1.0 - 1.0 / square
        second = float(ellipe(modulus))
        return ((square + 1.0) * second - 2.0 * float(ellipk(modulus))) / (
            (square - 1.0) * second
        ) - difference

    return math.exp(float(brentq(excess, 1e-5, math.log(1e4), xtol=1e-13)))


FloatArray = NDArray[np.float64]

LAMINAE = 30
"""Of a roller (ISO/TS 16281: at least 30)."""


@dataclass(frozen=True, kw_only=True)
class RowOfElements:
    """One row of rolling elements with its contact law.

    clearance : radial internal clearance as it runs, negative as radial preload [m]
    axial_offset : axial approach of the rings before any load, the preload of a pair [m]
    direction : +1 takes positive axial displacement up, -1 the other
    position : of its middle along the axis from the point about which the bearing tilts [m]
    """

    elements: RollingElements
    law: ContactLaw
    clearance: float = 0.0
    axial_offset: float = 0.0
    direction: int = 1
    position: float = 0.0


@dataclass(frozen=True)
class Contacts:
    """Pressed elements of a row, or laminae of its rollers; arrays of their shape.

    load, radial, axial : force and its components on the raceway [N]
    k_rr, k_ra, k_aa : derivatives of the components by the radial and axial displacement there [N/m]
    energy : elastic, of all [J]
    """

    load: FloatArray
    radial: FloatArray
    axial: FloatArray
    k_rr: FloatArray
    k_ra: FloatArray
    k_aa: FloatArray
    energy: float


def contacts(
    row: RowOfElements, radial: FloatArray, axial: FloatArray | float, share: float = 1.0
) -> Contacts:
    """Contacts at the displacements of the inner ring against the outer one at each element or lamina.

    radial, axial : [m]; the axial one positive where it presses the row
    share : of the element's stiffness in one lamina
    """
    approach, along, across, length = _approach(row, radial, axial + row.axial_offset)
    pressed = np.maximum(approach, 0.0)
    exponent, stiffness = row.law.exponent, share * row.law.stiffness
    load = stiffness * pressed**exponent
    slope = exponent * stiffness * pressed ** (exponent - 1.0)
    geometric = load / length
    return Contacts(
        load=load,
        radial=load * along,
        axial=load * across,
        k_rr=slope * along**2 + geometric * across**2,
        k_ra=(slope - geometric) * along * across,
        k_aa=slope * across**2 + geometric * along**2,
        energy=float(np.sum(load * pressed)) / (exponent + 1.0),
    )


def _approach(
    row: RowOfElements, radial: FloatArray, axial: FloatArray | float
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Approach of the raceways at each element [m], its direction (radial, axial) and the length that turns it [m]."""
    angle = row.elements.contact_angle
    if row.elements.roller:
        ones = np.ones_like(radial)
        approach = (radial - 0.5 * row.clearance) * math.cos(angle) + axial * math.sin(angle)
        return approach, ones * math.cos(angle), ones * math.sin(angle), ones * math.inf
    distance = row.law.groove_distance
    across = distance * math.cos(angle) - 0.5 * row.clearance + radial
    along = distance * math.sin(angle) + axial
    length = np.hypot(across, along)
    return length - distance, across / length, along / length, length


@dataclass(frozen=True)
class RingLoad:
    """What displaced rings carry, in the coordinates (x, y, z, rx, ry); z is the axis of the bearing.

    load : (5,) forces [N] and moments about x and y [N m] that hold the inner ring where it is
    stiffness : (5, 5) their derivative by the displacement, symmetric [N/m, N/rad = N m/m, N m/rad]
    """

    load: FloatArray
    stiffness: FloatArray


def ring_load(rows: Sequence[RowOfElements], displacement: FloatArray) -> RingLoad:
    """Load and tangent stiffness of one or more rows on rigid rings.

    displacement : (5,) of the inner against the outer ring, x, y, z [m], rx, ry [rad], about the middle of the bearing;
        small rotations. The first element of a row stands in direction x.

    Elements do not follow each other round the ring: what they carry tangentially is neglected.
    """
    load, stiffness = np.zeros(5), np.zeros((5, 5))
    for row in rows:
        outwards, along, share = _levers(row)
        pressed = contacts(row, outwards @ displacement, along @ displacement, share)
        load += np.tensordot(pressed.radial, outwards, 2) + np.tensordot(pressed.axial, along, 2)
        mixed = np.einsum("ij,ijk,ijl->kl", pressed.k_ra, outwards, along)
        stiffness += (
            np.einsum("ij,ijk,ijl->kl", pressed.k_rr, outwards, outwards)
            + np.einsum("ij,ijk,ijl->kl", pressed.k_aa, along, along)
            + mixed
            + mixed.T
        )
    return RingLoad(load=load, stiffness=0.5 * (stiffness + stiffness.T))


def _levers(row: RowOfElements) -> tuple[FloatArray, FloatArray, float]:
    """Radial and axial displacement of the inner ring at each element and lamina for unit displacements of the ring.

    Two arrays (elements, laminae, 5) and the share of a lamina. Axial is positive where it presses the row. A point at
    azimuth phi, radius R and place zeta moves by (x + zeta ry) cos(phi) + (y - zeta rx) sin(phi) outwards and by
    z + R (rx sin(phi) - ry cos(phi)) along the axis. For a ball it is the groove centre of the inner ring, for a roller
    the middle of a lamina.
    """
    elements, angle = row.elements, row.elements.contact_angle
    laminae = LAMINAE if elements.roller else 1
    if elements.roller:
        along_roller = elements.length * ((np.arange(laminae) + 0.5) / laminae - 0.5)
        radius = 0.5 * elements.pitch_diameter - row.direction * along_roller * math.sin(angle)
        place = row.position + along_roller * math.cos(angle)
    else:
        offset = row.law.inner_groove_offset
        radius = np.array([0.5 * elements.pitch_diameter + offset * math.cos(angle)])
        place = np.array([row.position + row.direction * offset * math.sin(angle)])
    azimuth = (2.0 * math.pi / elements.count * np.arange(elements.count))[:, None]
    cosine, sine = (
        np.broadcast_to(part, (elements.count, laminae)) for part in (np.cos(azimuth), np.sin(azimuth))
    )
    none = np.zeros((elements.count, laminae))
    outwards = np.stack([cosine, sine, none, -place * sine, place * cosine], axis=-1)
    along = np.stack([none, none, none + 1.0, radius * sine, -radius * cosine], axis=-1)
    return outwards, row.direction * along, 1.0 / laminae
