"""Friction coefficient of the tooth contact: one function for the torque in the loop and the heat in the box.

`friction_coefficient(contact, law)` returns the mean coefficient over the path of contact. The laws are
Schlenk (ISO/TR 14179-2, default), Michaelis, Doleschel and a given value.
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
from dynamics.standards import iso_tr_14179_2_2001 as tr14179


class FrictionError(DynamicsInputError):
    """Impossible input of a friction law; the message names value, limit and remedy."""


@dataclass(frozen=True, kw_only=True)
class ToothContact:
    """What a friction law needs to know of a running mesh.

    line_load : transverse tooth force per face width F_bt / b [N/m]
    pitch_line_speed : v_t at the working pitch circle [m/s]
    working_pressure_angle : alpha_wt [rad]
    reduced_radius : relative radius of curvature at the pitch point, normal section [m]
    pinion_diameter : reference diameter d_1 [m]
    roughness : arithmetic mean roughness Ra, mean of both flanks [m]
    viscosity : dynamic viscosity at the oil temperature of the mesh [Pa s]
    """

    line_load: float
    pitch_line_speed: float
    working_pressure_angle: float
    reduced_radius: float
    pinion_diameter: float
    roughness: float
    viscosity: float

    def __post_init__(self) -> None:
        for name in ("working_pressure_angle", "reduced_radius", "pinion_diameter", "roughness", "viscosity"):
            value = getattr(self, name)
            if not value > 0.0:
                raise FrictionError(f"tooth contact: {name} = {value:.6g}: must be above 0; correct it")
        for name in ("line_load", "pitch_line_speed"):
            value = getattr(self, name)
            if not value >= 0.0:
                raise FrictionError(
                    f"tooth contact: {name} = {value:.6g}: must not be negative; give its magnitude"
                )

    @property
    def sum_speed(self) -> float:
        """Sum of both surface speeds at the pitch point 2 v_t sin(alpha_wt) [m/s]."""
        return 2.0 * self.pitch_line_speed * math.sin(self.working_pressure_angle)


@dataclass(frozen=True, kw_only=True)
class Schlenk:
    """ISO/TR 14179-2 (Schlenk); lubricant_factor X_L 1 for mineral oil, about 0.8 for esters and PAO."""

    lubricant_factor: float = 1.0


@dataclass(frozen=True, kw_only=True)
class Michaelis:
    """Michaelis with the roughness factor of Niemann/Winter II."""

    lubricant_factor: float = 1.0


@dataclass(frozen=True, kw_only=True)
class Doleschel:
    """Doleschel (TU Munich 2003): solid and fluid friction shared by the relative film thickness.

    mu = xi mu_EHD + (1 - xi) mu_F ,  xi = 1 - (1 - lambda/2)^2 below lambda 2, else 1
    mu_F = solid (p_H/1000)^a (v_Sigma/0.2)^b ,  mu_EHD = fluid (p_H/1000)^a (v_Sigma/8.3)^b (eta/20)^c

    p_H [N/mm2], v_Sigma [m/s], eta [mPa s]. The eight constants belong to one oil and come from its FZG
    efficiency test; there is no default. Confidence of the form: medium.
    """

    solid: float
    solid_pressure_exponent: float
    solid_speed_exponent: float
    fluid: float
    fluid_pressure_exponent: float
    fluid_speed_exponent: float
    fluid_viscosity_exponent: float
    pressure_viscosity: float
    """Pressure-viscosity coefficient at the oil temperature [1/Pa], for the film thickness."""
    reduced_modulus: float = 226.4e9
    """E' = 2 / ((1 - nu1^2)/E1 + (1 - nu2^2)/E2) [Pa]; steel on steel."""


@dataclass(frozen=True, kw_only=True)
class GivenFriction:
    """A measured or prescribed coefficient."""

    value: float


FrictionLaw = Schlenk | Michaelis | Doleschel | GivenFriction


@dataclass(frozen=True, kw_only=True)
class FrictionCoefficient:
    """Mean friction coefficient with its provenance."""

    value: float
    law: str
    inputs: dict[str, float]
    """Every number that entered after floors and caps, SI."""
    source: str
    warnings: tuple[str, ...] = ()


def friction_coefficient(contact: ToothContact, law: FrictionLaw) -> FrictionCoefficient:
    """Mean friction coefficient of a mesh.

    Parameters
    ----------
    contact : load, speed, curvature and oil of the mesh
    law : Schlenk, Michaelis, Doleschel or GivenFriction

    Returns
    -------
    FrictionCoefficient; floors (150 N/mm, 1 m/s) and the cap (50 m/s) that were used stand in its warnings
    """
    if isinstance(law, GivenFriction):
        if not 0.0 <= law.value < 1.0:
            raise FrictionError(
                f"given friction coefficient = {law.value}: must lie within 0 to 1; correct it"
            )
        return FrictionCoefficient(
            value=law.value, law="given", inputs={"value": law.value}, source="input of the case"
        )
    if isinstance(law, Doleschel):
        return _doleschel(contact, law)
    line_load, speed, warnings = _inside_range(contact)
    sum_speed = 2.0 * speed * math.sin(contact.working_pressure_angle)
    radius = contact.reduced_radius * 1e3
    viscosity = contact.viscosity * 1e3
    roughness = contact.roughness * 1e6
    factor = law.lubricant_factor
    pitch_point = tr14179.PitchPointContact(line_load * 1e-3, sum_speed, radius, viscosity, roughness)
    if isinstance(law, Schlenk):
        name, source = "schlenk", "ISO/TR 14179-2:2001 (Schlenk)"
        value = tr14179.mu_mz(pitch_point, factor)
    else:
        name, source = "michaelis", "Michaelis; Niemann/Winter, Maschinenelemente II"
        diameter = contact.pinion_diameter * 1e3
        value = tr14179.mu_mz_michaelis(pitch_point, diameter, factor)
    inputs = _inputs(contact) | {"line_load": line_load, "sum_speed": sum_speed, "lubricant_factor": factor}
    return FrictionCoefficient(value=value, law=name, inputs=inputs, source=source, warnings=warnings)


def hertzian_pressure(contact: ToothContact, reduced_modulus: float) -> float:
    """Pressure of the line contact at the pitch point p_H = sqrt(w E' / (2 pi rho)) [Pa] (Hertz)."""
    return math.sqrt(contact.line_load * reduced_modulus / (2.0 * math.pi * contact.reduced_radius))


def relative_film_thickness(
    contact: ToothContact, pressure_viscosity: float, reduced_modulus: float
) -> float:
    """Minimum film at the pitch point over Ra, lambda [-].

    h_min / rho = 2.65 U^0.7 G^0.54 W^-0.13, U = eta v_Sigma / (2 E' rho), G = alpha E', W = w / (E' rho)

    Source: D. Dowson, Proc. IMechE 182 (1967-68) 3A, line contact, isothermal.
    """
    modulus_length = reduced_modulus * contact.reduced_radius
    speed = contact.viscosity * contact.sum_speed / (2.0 * modulus_length)
    load = max(contact.line_load, 1.0) / modulus_length
    film: float = 2.65 * speed**0.7 * (pressure_viscosity * reduced_modulus) ** 0.54 * load**-0.13
    return film * contact.reduced_radius / contact.roughness


def _doleschel(contact: ToothContact, law: Doleschel) -> FrictionCoefficient:
    pressure = hertzian_pressure(contact, law.reduced_modulus)
    film = relative_film_thickness(contact, law.pressure_viscosity, law.reduced_modulus)
    sum_speed = max(contact.sum_speed, 2.0 * tr14179.SPEED_MINIMUM * math.sin(contact.working_pressure_angle))
    share = 1.0 - (1.0 - 0.5 * film) ** 2 if film < 2.0 else 1.0
    relative_pressure = pressure * 1e-9
    solid: float = (
        law.solid
        * relative_pressure**law.solid_pressure_exponent
        * (sum_speed / 0.2) ** law.solid_speed_exponent
    )
    fluid: float = (
        law.fluid
        * relative_pressure**law.fluid_pressure_exponent
        * (sum_speed / 8.3) ** law.fluid_speed_exponent
        * (contact.viscosity * 1e3 / 20.0) ** law.fluid_viscosity_exponent
    )
    return FrictionCoefficient(
        value=share * fluid + (1.0 - share) * solid,
        law="doleschel",
        inputs=_inputs(contact) | {"hertzian_pressure": pressure, "film_ratio": film, "fluid_share": share},
        source="Doleschel, TU Munich 2003; film after Dowson 1968",
    )


def _inputs(contact: ToothContact) -> dict[str, float]:
    return {
        "line_load": contact.line_load,
        "sum_speed": contact.sum_speed,
        "reduced_radius": contact.reduced_radius,
        "roughness": contact.roughness,
        "viscosity": contact.viscosity,
    }


def _inside_range(contact: ToothContact) -> tuple[float, float, tuple[str, ...]]:
    """Line load and speed held inside the tested range, with a sentence for each step taken."""
    warnings = []
    line_load, speed = contact.line_load, contact.pitch_line_speed
    floor = tr14179.LINE_LOAD_MINIMUM * 1e3
    if line_load < floor:
        warnings.append(
            f"line load F_bt/b = {line_load * 1e-3:.0f} N/mm: below {tr14179.LINE_LOAD_MINIMUM:.0f} N/mm, "
            "the value at the limit is used; give a measured friction coefficient for low load"
        )
        line_load = floor
    if speed > tr14179.SPEED_MAXIMUM:
        warnings.append(
            f"pitch line speed = {speed:.1f} m/s: above {tr14179.SPEED_MAXIMUM:.0f} m/s, the value "
            "at the limit is used; give a measured friction coefficient for high speed"
        )
        speed = tr14179.SPEED_MAXIMUM
    if speed < tr14179.SPEED_MINIMUM:
        warnings.append(
            f"pitch line speed = {speed:.2f} m/s: below {tr14179.SPEED_MINIMUM:.0f} m/s, the value "
            "at the limit is used; boundary friction is not described, give a measured coefficient"
        )
        speed = tr14179.SPEED_MINIMUM
    return line_load, speed, tuple(warnings)


# Sliding on the path of contact of a gear mesh, and the tooth-loss factor H_V that follows from it.
#
# Path positions count from the pitch point, growing to the pinion tip; the pitch point may lie outside the path
# of contact, where Ohlendorf's closed formula is wrong and only the integral holds.

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
