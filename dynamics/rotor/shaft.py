"""Stepped shafts in torsion: cylinders and discs turned into a chain of lumped inertias and springs."""

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError

Array = NDArray[np.float64]

STEEL_SHEAR_MODULUS = 79.3e9
"""Shear modulus of steel [Pa] (E 206 GPa, nu 0.30)."""
STEEL_DENSITY = 7850.0
"""Density of steel [kg/m3]."""
STEEL_POISSON_RATIO = 0.30
"""Poisson's ratio of steel [-]."""


class DrivetrainError(DynamicsInputError):
    """A drivetrain that cannot be built; the message names part, value, limit and remedy."""


@dataclass(frozen=True, kw_only=True)
class Section:
    """Cylinder of a stepped shaft: length, outer and inner diameter [m]."""

    length: float
    outer_diameter: float
    inner_diameter: float = 0.0

    def __post_init__(self) -> None:
        if not self.length > 0.0:
            raise DrivetrainError(f"section length = {self.length} m: must be above 0; correct it")
        if not 0.0 <= self.inner_diameter < self.outer_diameter:
            raise DrivetrainError(
                f"section inner diameter = {self.inner_diameter} m: must be at least 0 and below the outer "
                f"diameter {self.outer_diameter} m; correct one of the two"
            )

    @property
    def polar_moment(self) -> float:
        """Polar second moment of area pi (D^4 - d^4) / 32 [m4]."""
        return math.pi * (self.outer_diameter**4 - self.inner_diameter**4) / 32.0


@dataclass(frozen=True, kw_only=True)
class Disc:
    """Rigid disc on a shaft (coupling flange, nut, torque flange half): inertia [kg m2] at a position [m].

    mass [kg], diametral_inertia [kg m2] and width [m] are those of the elastic rig; torsion does not read them.
    """

    name: str
    position: float
    inertia: float
    mass: float = 0.0
    diametral_inertia: float | None = None
    width: float = 0.0

    def __post_init__(self) -> None:
        if not self.inertia > 0.0:
            raise DrivetrainError(
                f"disc {self.name!r}: inertia = {self.inertia} kg m2: must be above 0; else leave it out"
            )

    @property
    def tilting_inertia(self) -> float:
        """Inertia about a diameter [kg m2]: as given, else that of a cylinder, I_p / 2 + m b^2 / 12."""
        return tilting_inertia(f"disc {self.name!r}", self)


class RigidBody(Protocol):
    """What the inertia of a disc or gear about a diameter follows from."""

    @property
    def inertia(self) -> float:
        """Polar [kg m2]."""

    @property
    def mass(self) -> float:
        """[kg]"""

    @property
    def width(self) -> float:
        """Along the axis [m]."""

    @property
    def diametral_inertia(self) -> float | None:
        """As given [kg m2]."""


def tilting_inertia(part: str, body: RigidBody) -> float:
    """Inertia about a diameter [kg m2]: as given, else that of a cylinder, I_p / 2 + m b^2 / 12.

    Raises DrivetrainError for one below half of the polar inertia, which no body has.
    """
    thin = 0.5 * body.inertia
    if body.diametral_inertia is None:
        return thin + body.mass * body.width**2 / 12.0
    if body.diametral_inertia < (1.0 - 1e-9) * thin:
        raise DrivetrainError(
            f"{part}: diametral inertia = {body.diametral_inertia} kg m2: must be at least half of the polar "
            f"inertia, {thin:.6g} kg m2; correct one, or leave it out for that of a cylinder"
        )
    return body.diametral_inertia


@dataclass(frozen=True, kw_only=True)
class Shaft:
    """Stepped shaft from its left end at 0 m to its right end, in running direction of its own axis.

    ``element_length`` [m] is the longest element. Lumped inertia makes a frequency low by the share
    (omega h / c)^2 / 24 with c = sqrt(G/rho) = 3180 m/s: 0.3 % at 13 kHz for the default 10 mm.
    ``damping_time`` [s] is the damping of every element over its stiffness: the loss factor at omega over omega.
    ``poisson_ratio`` gives the elastic modulus of bending; torsion does not read it.
    """

    name: str
    sections: tuple[Section, ...]
    discs: tuple[Disc, ...] = ()
    shear_modulus: float = STEEL_SHEAR_MODULUS
    density: float = STEEL_DENSITY
    element_length: float = 0.010
    damping_time: float = 0.0
    poisson_ratio: float = STEEL_POISSON_RATIO

    def __post_init__(self) -> None:
        if not self.sections:
            raise DrivetrainError(f"shaft {self.name!r}: has no section; give at least one")
        for quantity in ("shear_modulus", "density", "element_length"):
            if not getattr(self, quantity) > 0.0:
                raise DrivetrainError(
                    f"shaft {self.name!r}: {quantity} = {getattr(self, quantity)}: must be above 0"
                )
        if not self.damping_time >= 0.0:
            raise DrivetrainError(
                f"shaft {self.name!r}: damping_time = {self.damping_time} s: must not be negative; correct the sign"
            )
        if not 0.0 <= self.poisson_ratio < 0.5:
            raise DrivetrainError(
                f"shaft {self.name!r}: poisson_ratio = {self.poisson_ratio}: must lie within 0 and 0.5; correct it"
            )
        for disc in self.discs:
            self.check_position(disc.position, f"disc {disc.name!r}")

    @property
    def elastic_modulus(self) -> float:
        """Elastic modulus 2 G (1 + nu) [Pa]."""
        return 2.0 * self.shear_modulus * (1.0 + self.poisson_ratio)

    @property
    def length(self) -> float:
        """Total length [m]."""
        return math.fsum(section.length for section in self.sections)

    @property
    def wave_speed(self) -> float:
        """Speed of torsional waves sqrt(G / rho) [m/s]."""
        return math.sqrt(self.shear_modulus / self.density)

    @property
    def inertia(self) -> float:
        """Polar inertia of sections and discs [kg m2]."""
        body = math.fsum(self.density * s.polar_moment * s.length for s in self.sections)
        return body + math.fsum(disc.inertia for disc in self.discs)

    def check_position(self, position: float, part: str) -> None:
        """Raise DrivetrainError when a part sits beyond the ends of the shaft."""
        if not -1e-9 <= position <= self.length + 1e-9:
            raise DrivetrainError(
                f"{part} on shaft {self.name!r}: position = {position} m: must lie within 0 and "
                f"{self.length:.6g} m; move the part or lengthen the shaft"
            )


@dataclass(frozen=True)
class ShaftChain:
    """Lumped chain of a shaft: positions [m], inertia [kg m2], both (n,); springs (n - 1,) [N m/rad]."""

    positions: Array
    inertia: Array
    springs: Array

    def node(self, position: float) -> int:
        """Index of the node at a position that was asked for when the chain was built."""
        return int(np.argmin(np.abs(self.positions - position)))


def discretise(shaft: Shaft, stations: tuple[float, ...] = ()) -> ShaftChain:
    """Chain of lumped inertias with a node at every step, disc and station, none further apart than asked.

    stations : positions of attached parts [m]; each gets a node of its own, so nothing is moved.

    Element stiffness G J / h; half of the inertia rho J h goes to either end. The disc inertias are added.
    """
    steps = _steps(shaft)
    nodes = np.concatenate(
        [steps, np.clip(stations, 0.0, steps[-1]), [disc.position for disc in shaft.discs]]
    )
    nodes = np.unique(np.round(np.clip(nodes, 0.0, steps[-1]), 9))
    pieces = [
        np.linspace(a, b, max(1, math.ceil((b - a) / shaft.element_length - 1e-9)) + 1)[:-1]
        for a, b in pairwise(nodes)
    ]
    positions = np.concatenate([*pieces, nodes[-1:]])
    lengths = np.diff(positions)
    moment = np.array([section.polar_moment for section in element_sections(shaft, positions)])
    inertia = np.zeros(positions.size)
    half = 0.5 * shaft.density * moment * lengths
    inertia[:-1] += half
    inertia[1:] += half
    chain = ShaftChain(positions, inertia, shaft.shear_modulus * moment / lengths)
    for disc in shaft.discs:
        inertia[chain.node(disc.position)] += disc.inertia
    return chain


def element_sections(shaft: Shaft, positions: Array) -> tuple[Section, ...]:
    """Section of each element between neighbouring positions (n,) [m] of a chain: n - 1 of them."""
    middle = 0.5 * (positions[:-1] + positions[1:])
    index = np.clip(np.searchsorted(_steps(shaft), middle) - 1, 0, len(shaft.sections) - 1)
    return tuple(shaft.sections[i] for i in index)


def _steps(shaft: Shaft) -> Array:
    """Positions [m] of the ends of the sections, from 0 on."""
    return np.cumsum([0.0] + [section.length for section in shaft.sections])


def free_frequencies(shaft: Shaft, attached: tuple[tuple[float, float], ...] = (), count: int = 3) -> Array:
    """First elastic torsional frequencies [Hz] of the free-free shaft with rigidly attached inertias.

    At most ``count``, fewer where the shaft has fewer nodes.

    attached : (position [m], inertia [kg m2]) of every body that counts as rigid with the shaft.
    """
    from scipy.linalg import eigh_tridiagonal

    chain = discretise(shaft, tuple(position for position, _ in attached))
    inertia = chain.inertia.copy()
    for position, value in attached:
        inertia[chain.node(position)] += value
    diagonal = np.zeros(inertia.size)
    diagonal[:-1] += chain.springs
    diagonal[1:] += chain.springs
    scale = 1.0 / np.sqrt(inertia)
    squared = eigh_tridiagonal(
        diagonal * scale**2,
        -chain.springs * scale[:-1] * scale[1:],
        eigvals_only=True,
        select="i",
        select_range=(0, min(count, inertia.size - 1)),
    )
    return np.asarray(np.sqrt(np.maximum(squared[1:], 0.0)) / (2.0 * math.pi))
