"""Sliding on the path of contact of a gear mesh, and the tooth-loss factor H_V that follows from it.

Path positions count from the pitch point, growing to the pinion tip; the pitch point may lie outside the path
of contact, where Ohlendorf's closed formula is wrong and only the integral holds.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Self

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError
from dynamics.gear.pair import GearPair
from dynamics.mesh.friction import ToothContact
from dynamics.standards import iso_tr_14179_2_2001 as tr14179

Array = NDArray[np.float64]
PairStiffness = Callable[[Array], Array]
"""Stiffness of one tooth pair per face width over path positions; only its shape over the path matters."""

GAUSS_POINTS = 16
GAUSS = np.polynomial.legendre.leggauss(GAUSS_POINTS)
"""Its places and weights from -1 to 1."""
STIFFNESS_POINTS = 4001


class ToothPathError(DynamicsInputError):
    """A path of contact that cannot be; the message names value, limit and remedy."""


@dataclass(frozen=True, kw_only=True)
class ToothPath:
    """Path of contact of a mesh as the losses need it; path positions count from the pitch point.

    base_radius_1, base_radius_2 : [m]
    start, end : A and E, ``end`` towards the pinion tip [m]; both may lie on one side of the pitch point
    base_pitch : transverse [m]
    working_pressure_angle : transverse, alpha_wt [rad]
    face_width : common width [m]
    base_helix_angle : [rad]
    """

    base_radius_1: float
    base_radius_2: float
    start: float
    end: float
    base_pitch: float
    working_pressure_angle: float
    face_width: float
    base_helix_angle: float = 0.0

    def __post_init__(self) -> None:
        for name in ("base_radius_1", "base_radius_2", "base_pitch", "working_pressure_angle", "face_width"):
            value = getattr(self, name)
            if not value > 0.0:
                raise ToothPathError(
                    f"tooth path: {name} = {value:.6g}: must be above 0; correct the gear data"
                )
        reach = self.end - self.start + self.width_shift
        if reach < self.base_pitch * (1.0 - 1e-9):
            raise ToothPathError(
                f"tooth path: total contact ratio = {reach / self.base_pitch:.4f}: must be at least 1; "
                "lengthen the teeth or use a wider helical gear"
            )

    @classmethod
    def of_pair(cls, pair: GearPair) -> Self:
        """Path of contact of a gear pair at its present temperature, on its common face width."""
        return cls(
            base_radius_1=pair.base_radii[0],
            base_radius_2=pair.base_radii[1],
            start=pair.path.start,
            end=pair.path.end,
            base_pitch=pair.base_pitch,
            working_pressure_angle=pair.working_pressure_angle,
            face_width=pair.face_width,
            base_helix_angle=pair.base_helix_angle,
        )

    @property
    def width_shift(self) -> float:
        """Path travelled between contact at both end faces, b tan(beta_b) [m]."""
        return self.face_width * math.tan(abs(self.base_helix_angle))

    @property
    def contact_ratio(self) -> float:
        """Transverse contact ratio eps_alpha [-]."""
        return (self.end - self.start) / self.base_pitch

    @property
    def reduced_radius(self) -> float:
        """Relative radius of curvature at the pitch point, normal section [m]."""
        radius_1 = self.base_radius_1 * math.tan(self.working_pressure_angle)
        radius_2 = self.base_radius_2 * math.tan(self.working_pressure_angle)
        return radius_1 * radius_2 / ((radius_1 + radius_2) * math.cos(self.base_helix_angle))

    def contact(
        self,
        torque_1: float,
        omega_1: float,
        *,
        reference_diameter_1: float,
        roughness: float,
        viscosity: float,
    ) -> ToothContact:
        """Mesh as the friction laws see it; pinion torque [N m], speed [rad/s], Ra [m], eta [Pa s]."""
        return ToothContact(
            line_load=abs(torque_1) / self.base_radius_1 / self.face_width,
            pitch_line_speed=abs(omega_1) * self.base_radius_1 / math.cos(self.working_pressure_angle),
            working_pressure_angle=self.working_pressure_angle,
            reduced_radius=self.reduced_radius,
            pinion_diameter=reference_diameter_1,
            roughness=roughness,
            viscosity=viscosity,
        )

    def transverse_friction(self, coefficient: float) -> float:
        """Friction per force in the transverse line of action, mu / cos(beta_b) [-].

        The force normal to the flank is larger than its transverse part; a mesh law that counts transverse
        forces takes this value.
        """
        return coefficient / math.cos(self.base_helix_angle)


def tooth_loss_factor(path: ToothPath, stiffness: PairStiffness | None = None) -> float:
    """Tooth-loss factor H_V of a mesh without dynamics [-]; loss = mu H_V times the power transmitted.

    H_V = 1/p_et int_A^E (F_N / F_bt) (v_g / v_tb) ds        (Wimmer 2006; helical: over the contact lines)

    Parameters
    ----------
    path : geometry
    stiffness : the single-pair stiffness over the path, by which pairs share the load; None shares
        it evenly over the contact lines (rigid, uniform: 1/n in a spur gear)

    Returns
    -------
    H_V : exact for rigid sharing of a spur gear, converged to 1e-6 otherwise
    """
    share = _uniform if stiffness is None else stiffness
    load, moment = _spur_weights(share) if path.width_shift == 0.0 else _line_weights(path, share)
    total = 0.0
    knots, weights = GAUSS
    edges = _phase_edges(path)
    pairs = np.arange(-1, math.ceil((path.end - path.start + path.width_shift) / path.base_pitch) + 2)
    for left, right in pairwise(edges):
        if right - left < 1e-12 * path.base_pitch:
            continue
        phase = 0.5 * (left + right) + 0.5 * (right - left) * knots
        lead = path.start + phase[:, None] + pairs[None, :] * path.base_pitch
        sliding = moment(path, lead).sum(axis=1) / load(path, lead).sum(axis=1)
        total += 0.5 * (right - left) * float(weights @ sliding)
    per_radius = 1.0 / path.base_radius_1 + 1.0 / path.base_radius_2
    return total / path.base_pitch * per_radius / math.cos(path.base_helix_angle)


def ohlendorf_factor(path: ToothPath, teeth_1: int) -> float:
    """Ohlendorf's closed tooth-loss factor of the same mesh, for comparison [-].

    Raises DynamicsInputError with the pitch point outside the path (ISO/TR 14179-2). With the pitch point in a
    zone of double contact (FZG-A) it exceeds the integral of its own load sharing.
    """
    return tr14179.H_V(
        teeth_1,
        path.base_radius_2 / path.base_radius_1,
        path.base_helix_angle,
        path.end / path.base_pitch,
        -path.start / path.base_pitch,
    )


def _uniform(position: Array) -> Array:
    return np.ones_like(position)


Weight = Callable[[ToothPath, Array], Array]


def _spur_weights(share: PairStiffness) -> tuple[Weight, Weight]:
    """Load weight of a spur pair at a path position, and the same times |s|."""

    def load(path: ToothPath, position: Array) -> Array:
        inside = (position >= path.start) & (position <= path.end)
        return np.where(inside, share(np.clip(position, path.start, path.end)), 0.0)

    def moment(path: ToothPath, position: Array) -> Array:
        return load(path, position) * np.abs(position)

    return load, moment


def _line_weights(path: ToothPath, share: PairStiffness) -> tuple[Weight, Weight]:
    """The same for a helical pair: integrals over its contact line, which lags by the width shift."""
    grid = np.union1d(
        np.linspace(path.start, path.end, STIFFNESS_POINTS), np.clip([0.0], path.start, path.end)
    )
    density = share(grid)
    cumulated = _integral(grid, density)
    moments = _integral(grid, density * np.abs(grid))

    def between(table: Array, path: ToothPath, lead: Array) -> Array:
        front = np.clip(lead, path.start, path.end)
        rear = np.clip(lead - path.width_shift, path.start, path.end)
        return np.asarray(np.interp(front, grid, table) - np.interp(rear, grid, table))

    return (
        lambda path, lead: between(cumulated, path, lead),
        lambda path, lead: between(moments, path, lead),
    )


def _integral(grid: Array, values: Array) -> Array:
    steps = np.diff(grid) * 0.5 * (values[1:] + values[:-1])
    return np.concatenate([[0.0], np.cumsum(steps)])


def _phase_edges(path: ToothPath) -> Array:
    """Phases within one base pitch at which a pair enters, leaves or slides through the pitch point."""
    edges = np.array([path.start, path.end, 0.0])
    edges = np.concatenate([edges, edges + path.width_shift])
    inside = np.mod(edges - path.start, path.base_pitch)
    return np.unique(np.concatenate([[0.0, path.base_pitch], inside]))
