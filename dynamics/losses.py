"""Loss of a gear mesh by tooth sliding: P = mu F_N v_g, integrated, never looked up.

`tooth_loss_factor` integrates over the path of contact with a given load sharing; `sliding_power` takes the
tooth forces of a simulation, with the sliding speed and its smooth reversal that the mesh kernel uses, so the
heat in the box is the work that brakes the shafts. `Loss` is the record of any loss at any place.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dynamics.standards import iso_tr_14179_2_2001 as tr14179
from dynamics.tooth_friction import FrictionCoefficient, FrictionLaw, ToothContact, friction_coefficient

Array = NDArray[np.float64]
PairStiffness = Callable[[Array], Array]
"""Stiffness of one tooth pair per face width over path positions; only its relative course matters."""

GAUSS_POINTS = 16
STIFFNESS_POINTS = 4001


class LossError(ValueError):
    """Impossible input of a loss; the message names value, limit and remedy."""


@dataclass(frozen=True, kw_only=True)
class Loss:
    """Power lost at one place of the rig."""

    place: str
    """Name in the rig: ``test/mesh``, ``test/pinion shaft/bearing A`` ..."""
    kind: str
    """mesh, bearing, windage, oil_acceleration, squeeze, seal."""
    power: float
    """[W]"""
    details: dict[str, float | str] = field(default_factory=dict)
    """Numbers behind it, SI, by field name, with the source under ``source``."""
    warnings: tuple[str, ...] = ()


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
                raise LossError(f"tooth path: {name} = {value:.6g}: must be above 0; correct the gear data")
        reach = self.end - self.start + self.width_shift
        if reach < self.base_pitch * (1.0 - 1e-9):
            raise LossError(
                f"tooth path: total contact ratio = {reach / self.base_pitch:.4f}: must be at least 1; "
                "lengthen the teeth or use a wider helical gear"
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
    stiffness : course of the single-pair stiffness over the path, by which pairs share the load; None shares
        it evenly over the contact lines (rigid, uniform: 1/n in a spur gear)

    Returns
    -------
    H_V : exact for rigid sharing of a spur gear, converged to 1e-6 otherwise
    """
    share = _uniform if stiffness is None else stiffness
    load, moment = _spur_weights(share) if path.width_shift == 0.0 else _line_weights(path, share)
    total = 0.0
    knots, weights = np.polynomial.legendre.leggauss(GAUSS_POINTS)
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

    Raises ValueError with the pitch point outside the path (ISO/TR 14179-2). With the pitch point in a
    zone of double contact (FZG-A) it exceeds the integral of its own load sharing.
    """
    return tr14179.H_V(
        teeth_1,
        path.base_radius_2 / path.base_radius_1,
        path.base_helix_angle,
        path.end / path.base_pitch,
        -path.start / path.base_pitch,
    )


def sliding_speed(path: ToothPath, position: ArrayLike, omega_1: ArrayLike, omega_2: ArrayLike) -> Array:
    """Sliding speed v_g = omega_1 rho_1 - omega_2 rho_2 [m/s], rho_1 = T1C + s, rho_2 = T2C - s.

    Path positions [m] and the running speeds of both gears [rad/s] broadcast against each other.
    """
    s = np.asarray(position, dtype=np.float64)
    slope = math.tan(path.working_pressure_angle)
    first = np.asarray(omega_1) * (path.base_radius_1 * slope + s)
    second = np.asarray(omega_2) * (path.base_radius_2 * slope - s)
    return np.asarray(first - second, dtype=np.float64)


def sliding_power(
    path: ToothPath,
    force: ArrayLike,
    position: ArrayLike,
    omega_1: ArrayLike,
    omega_2: ArrayLike,
    coefficient: float,
    reversal_speed: float = 0.0,
) -> Array:
    """Sliding loss of each tooth contact of a simulated history [W].

    Parameters
    ----------
    path : geometry
    force : tooth forces in the transverse line of action, any shape, e.g. (n_times, n_pairs) [N]
    position : their path positions, same shape [m]
    omega_1, omega_2 : speeds of both gears, broadcastable to that shape [rad/s]
    coefficient : friction coefficient of the flank (of the normal force) [-]
    reversal_speed : sliding speed over which friction changes sign, as in the mesh law [m/s]

    Returns
    -------
    power : shape of ``force`` [W]; sum over pairs and slices, mean over time gives the loss of the mesh
    """
    speed = sliding_speed(path, position, omega_1, omega_2)
    ratio = np.clip(speed / reversal_speed, -1.0, 1.0) if reversal_speed > 0.0 else np.sign(speed)
    direction = ratio * (1.5 - 0.5 * ratio**2) if reversal_speed > 0.0 else ratio
    power = path.transverse_friction(coefficient) * np.asarray(force, dtype=np.float64) * direction * speed
    return np.asarray(power, dtype=np.float64)


def mesh_loss(
    place: str,
    path: ToothPath,
    torque_1: float,
    omega_1: float,
    friction: FrictionCoefficient,
    stiffness: PairStiffness | None = None,
) -> Loss:
    """Sliding loss of a mesh at steady load P = mu H_V T_1 omega_1 [W].

    torque_1 [N m] and omega_1 [rad/s] of the pinion; their signs do not matter.
    """
    factor = tooth_loss_factor(path, stiffness)
    transmitted = abs(torque_1 * omega_1)
    sharing = "even over the contact lines" if stiffness is None else "by tooth-pair stiffness"
    return Loss(
        place=place,
        kind="mesh",
        power=transmitted * friction.value * factor,
        details={
            "transmitted_power": transmitted,
            "friction_coefficient": friction.value,
            "friction_law": friction.law,
            "tooth_loss_factor": factor,
            "load_sharing": sharing,
            "source": f"H_V integrated over the path of contact (Wimmer 2006); {friction.source}",
        },
        warnings=friction.warnings,
    )


def steady_mesh_loss(
    place: str, path: ToothPath, torque_1: float, omega_1: float, contact: ToothContact, law: FrictionLaw
) -> Loss:
    """Friction coefficient and sliding loss in one step, rigid load sharing."""
    return mesh_loss(place, path, torque_1, omega_1, friction_coefficient(contact, law))


def squeeze_loss(place: str, mesh: Loss, share: float) -> Loss:
    """Oil squeezed out of the tooth spaces, taken as a share of the mesh loss [W].

    share : 0 to 0.1 [-]; 0 if oil is injected behind the mesh. No formula at this size is trusted: an input.
    """
    if not 0.0 <= share <= 0.1:
        raise LossError(f"{place}: squeeze share = {share}: must lie within 0 to 0.1; correct it")
    return Loss(
        place=place,
        kind="squeeze",
        power=share * mesh.power,
        details={"share_of_mesh_loss": share, "source": "input of the case"},
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
    marks = np.array([path.start, path.end, 0.0])
    marks = np.concatenate([marks, marks + path.width_shift])
    inside = np.mod(marks - path.start, path.base_pitch)
    return np.unique(np.concatenate([[0.0, path.base_pitch], inside]))
