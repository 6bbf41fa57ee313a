"""Timoshenko beam element of a hollow cylinder in twelve freedoms: mass, stiffness and gyroscopic matrix.

Freedoms of an element are those of its two nodes, front node first, six each in the order of `DIRECTIONS`. The x axis
runs along the shaft, rotations are right-handed: without shear u_y' = theta_z and u_z' = -theta_y.

Sources: Friswell, Penny, Garvey, Lees, Dynamics of Rotating Machines, 2010, section 5.4 (matrices); Przemieniecki,
Theory of Matrix Structural Analysis, 1968 (the same without gyroscopics); Cowper, J. Appl. Mech. 33, 1966, 335 and
Hutchinson, J. Appl. Mech. 68, 2001, 87 (shear coefficient).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.shaft import Section, Shaft

Array = NDArray[np.float64]
ShearRule = Literal["cowper", "hutchinson", "rigid"]
TorsionalInertia = Literal["lumped", "consistent"]

DIRECTIONS = ("u_x", "u_y", "u_z", "turn", "theta_y", "theta_z")
"""Order of the freedoms of a node and of the rows of a place."""
PLANES = ((np.array([1, 5, 7, 11]), np.ones(4)), (np.array([2, 4, 8, 10]), np.array([1.0, -1.0, 1.0, -1.0])))
"""Bending in the planes xy and xz: freedoms (deflection, slope at either node) and their signs."""
AXIAL, TORSION = np.array([0, 6]), np.array([3, 9])


@dataclass(frozen=True, kw_only=True)
class BeamElements:
    """Elements of one shaft, all arrays (n_elements,): length, outer and inner diameter [m].

    elastic_modulus, shear_modulus [Pa]; poisson_ratio [-]; density [kg/m3]; shear : rule of the shear coefficient,
    ``rigid`` leaves shear out; torsional_inertia : half of it at either node, or consistent with linear twist.
    """

    length: Array
    outer: Array
    inner: Array
    elastic_modulus: float
    shear_modulus: float
    poisson_ratio: float
    density: float
    shear: ShearRule = "cowper"
    torsional_inertia: TorsionalInertia = "lumped"

    @property
    def area(self) -> Array:
        """Area of the section [m2]."""
        return 0.25 * math.pi * (self.outer**2 - self.inner**2)

    @property
    def second_moment(self) -> Array:
        """Second moment of area about a diameter [m4]; twice that is the polar one."""
        return math.pi / 64.0 * (self.outer**4 - self.inner**4)

    @property
    def shear_share(self) -> Array:
        """Phi = 12 E I / (kappa G A L^2) [-]: deflection by shear over that by bending, with fixed end slopes."""
        if self.shear == "rigid":
            return np.zeros_like(self.length)
        kappa = shear_coefficient(self.inner / self.outer, self.poisson_ratio, self.shear)
        bending = 12.0 * self.elastic_modulus * self.second_moment
        return np.asarray(bending / (kappa * self.shear_modulus * self.area * self.length**2))


def elements_of(
    shaft: Shaft,
    lengths: Array,
    sections: Sequence[Section],
    shear: ShearRule = "cowper",
    torsional_inertia: TorsionalInertia = "lumped",
) -> BeamElements:
    """Elements of a shaft with these lengths (n,) [m] and sections, one each."""
    return BeamElements(
        length=lengths,
        outer=np.array([section.outer_diameter for section in sections]),
        inner=np.array([section.inner_diameter for section in sections]),
        elastic_modulus=shaft.elastic_modulus,
        shear_modulus=shaft.shear_modulus,
        poisson_ratio=shaft.poisson_ratio,
        density=shaft.density,
        shear=shear,
        torsional_inertia=torsional_inertia,
    )


def shear_coefficient(ratio: Array, poisson_ratio: float, rule: ShearRule = "cowper") -> Array:
    """Shear coefficient of hollow circles of a ratio (n,) of inner to outer diameter [-]."""
    m, nu = ratio**2, poisson_ratio
    square = (1.0 + m) ** 2
    top = 6.0 * (1.0 + nu) * square
    if rule == "cowper":
        return np.asarray(top / ((7.0 + 6.0 * nu) * square + (20.0 + 12.0 * nu) * m))
    hollow = 4.0 * m * (5.0 + 6.0 * nu + 2.0 * nu**2)
    return np.asarray(top / (square * (7.0 + 12.0 * nu + 4.0 * nu**2) + hollow))


def stiffness_matrices(elements: BeamElements) -> Array:
    """Stiffness matrices (n, 12, 12) [N/m, N, N m/rad]."""
    length, phi = elements.length, elements.shear_share
    whole = np.zeros((length.size, 12, 12))
    scale = elements.elastic_modulus * elements.second_moment / ((1.0 + phi) * length**3)
    unit = np.ones_like(length)
    bending = scale[:, None, None] * _symmetric(
        length,
        (12.0 * unit, 6.0 * unit, -12.0 * unit, 6.0 * unit, 4.0 + phi, -6.0 * unit, 2.0 - phi),
    )
    for index, sign in PLANES:
        whole[:, index[:, None], index] += bending * np.outer(sign, sign)
    bar = np.array([[1.0, -1.0], [-1.0, 1.0]])
    for index, value in (
        (AXIAL, elements.elastic_modulus * elements.area / length),
        (TORSION, 2.0 * elements.shear_modulus * elements.second_moment / length),
    ):
        whole[:, index[:, None], index] += value[:, None, None] * bar
    return whole


def mass_matrices(elements: BeamElements) -> Array:
    """Consistent mass matrices with rotary inertia (n, 12, 12) [kg, kg m, kg m2]."""
    length, phi = elements.length, elements.shear_share
    whole = np.zeros((length.size, 12, 12))
    scale = elements.density * elements.area * length / (1260.0 * (1.0 + phi) ** 2)
    a, b = (39.0 + 94.5 * phi + 52.5 * phi**2), (66.0 + 115.5 * phi + 52.5 * phi**2)
    translation = scale[:, None, None] * _symmetric(
        length,
        (
            468.0 + 882.0 * phi + 420.0 * phi**2,
            b,
            162.0 + 378.0 * phi + 210.0 * phi**2,
            -a,
            12.0 + 21.0 * phi + 10.5 * phi**2,
            a,
            -(9.0 + 21.0 * phi + 10.5 * phi**2),
        ),
    )
    bending = translation + _rotary(elements)
    for index, sign in PLANES:
        whole[:, index[:, None], index] += bending * np.outer(sign, sign)
    consistent = np.array([[2.0, 1.0], [1.0, 2.0]]) / 6.0
    twist = consistent if elements.torsional_inertia == "consistent" else 0.5 * np.eye(2)
    polar = 2.0 * elements.density * elements.second_moment * length
    for index, value, shape in (
        (AXIAL, elements.density * elements.area * length, consistent),
        (TORSION, polar, twist),
    ):
        whole[:, index[:, None], index] += value[:, None, None] * shape
    return whole


def gyroscopic_matrices(elements: BeamElements) -> Array:
    """Gyroscopic matrices (n, 12, 12) [kg m2 and its derivatives] per rad/s of rotation about +x; skew."""
    whole = np.zeros((elements.length.size, 12, 12))
    (y, sign_y), (z, sign_z) = PLANES
    block = 2.0 * _rotary(elements) * np.outer(sign_y, sign_z)
    whole[:, y[:, None], z] += block
    whole[:, z[:, None], y] -= np.swapaxes(block, 1, 2)
    return whole


def _rotary(elements: BeamElements) -> Array:
    """Rotary inertia in one plane (n, 4, 4)."""
    length, phi = elements.length, elements.shear_share
    scale = elements.density * elements.second_moment / (210.0 * length * (1.0 + phi) ** 2)
    unit, slope = np.ones_like(length), 21.0 - 105.0 * phi
    return np.asarray(
        scale[:, None, None]
        * _symmetric(
            length,
            (
                252.0 * unit,
                slope,
                -252.0 * unit,
                slope,
                28.0 + 35.0 * phi + 70.0 * phi**2,
                -slope,
                -(7.0 + 35.0 * phi - 35.0 * phi**2),
            ),
        )
    )


def _symmetric(length: Array, entries: Sequence[Array]) -> Array:
    """Matrices (n, 4, 4) in (deflection, slope) of two nodes from seven entries without their powers of the length.

    entries : ww, ws, wW, wS, ss, sW, sS, capitals for the second node; the rest follows from the mirror image.
    """
    ww, ws, w_w, w_s, ss, s_w, s_s = entries
    ws, w_s, s_w = ws * length, w_s * length, s_w * length
    ss, s_s = ss * length**2, s_s * length**2
    rows = ((ww, ws, w_w, w_s), (ws, ss, s_w, s_s), (w_w, s_w, ww, -ws), (w_s, s_s, -ws, ss))
    return np.moveaxis(np.array(rows), 2, 0)
