"""Linear forces of one running state: speed, bearing coefficients, linear mesh springs.

Bearings and meshes stand outside the matrices of `dynamics.rotor.assembly`, because they change from stage to
stage; `ReducedElasticRig.matrices` adds them.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.assembly import ElasticModel, shaft_stiffness
from dynamics.rotor.freedoms import ElasticJoint
from dynamics.rotor.rotor_model import (
    SEAT_DIRECTIONS,
    AxisMisalignment,
    FlangeRunOut,
    RotatingPart,
    ShaftBow,
    ShaftUnbalance,
    SpeedPower,
)
from dynamics.rotor.shaft import DrivetrainError, Shaft, element_sections

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class BearingCoefficients:
    """Force -K w - C w' on the journal for its motion w against the seat: (d, d) in the first d of `SEAT_DIRECTIONS`.

    d is 2 for a film, 5 for a rolling bearing. [N/m], [N s/m] and likewise for tilts; K of a film is not symmetric.

    Raises DrivetrainError for another shape or a value that is not finite.
    """

    stiffness: Array
    damping: Array

    def __post_init__(self) -> None:
        for name, matrix in (("stiffness", self.stiffness), ("damping", self.damping)):
            if matrix.shape not in ((2, 2), (5, 5)) or not np.isfinite(matrix).all():
                raise DrivetrainError(
                    f"bearing: {name} of shape {matrix.shape}: must be (2, 2) or (5, 5) and finite; correct it"
                )

    def padded(self) -> tuple[Array, Array]:
        """Both with zeros up to (5, 5)."""
        whole = np.zeros((2, len(SEAT_DIRECTIONS), len(SEAT_DIRECTIONS)))
        for i, matrix in enumerate((self.stiffness, self.damping)):
            whole[i, : matrix.shape[0], : matrix.shape[0]] = matrix
        return whole[0], whole[1]


def isotropic_bearing(stiffness: float, damping: float = 0.0) -> BearingCoefficients:
    """Bearing alike in all lateral directions without cross-coupling (P2, Table 1): [N/m], [N s/m]."""
    return BearingCoefficients(stiffness=stiffness * np.eye(2), damping=damping * np.eye(2))


@dataclass(frozen=True, kw_only=True)
class RowSpring:
    """Spring and damper on one relative motion row . q, row (n,): a mesh in its mean position [N/m], [N s/m]."""

    row: Array
    stiffness: float
    damping: float = 0.0


@dataclass(frozen=True, kw_only=True)
class RunningState:
    """Speed of the reference shaft [rad/s], coefficients of the bearings by name, springs on rows of all freedoms.

    torques : by coupling, mean torque that its first shaft passes to the second along their rotation [N m], for the
        cross joints; 0 where none is given
    """

    speed: float = 0.0
    bearings: Mapping[str, BearingCoefficients] = field(default_factory=dict)
    springs: tuple[RowSpring, ...] = ()
    torques: Mapping[str, float] = field(default_factory=dict)

    def check(self, model: ElasticModel) -> None:
        """Raise DrivetrainError for a bearing that is missing, unknown or does not locate a shaft it should."""
        for name in self.bearings.keys() - model.ports.keys():
            raise DrivetrainError(
                f"bearing {name!r} has coefficients but no place on a shaft; correct the name"
            )
        for name in model.ports.keys() - self.bearings.keys():
            raise DrivetrainError(f"bearing {name!r} has no coefficients: give its stiffness and damping")
        axial = SEAT_DIRECTIONS.index("u_x")
        for name, coefficients in self.bearings.items():
            stiffness = coefficients.padded()[0]
            if name in model.rig.axially_locating:
                if not stiffness[axial, axial] > 0.0:
                    raise DrivetrainError(
                        f"bearing {name!r} is to locate its shaft, but its axial stiffness is "
                        f"{stiffness[axial, axial]:.6g} N/m: must be above 0; give five directions or another location"
                    )
            elif np.abs(stiffness[axial]).max() > 0.0:
                raise DrivetrainError(
                    f"bearing {name!r} has an axial stiffness of {stiffness[axial, axial]:.6g} N/m but does not count "
                    "as locating: must be 0; make it the locating bearing of its shaft"
                )


# Loads once a turn from unbalance, bow and flange run-out, and the standing load of axes out of line.
#
# A shaft that turns with the angle theta in its sense s about x carries what is fixed to it along (cos theta, s sin
# theta): a complex amplitude a means u_y = Re(a exp(i theta)), u_z = Re(-i s a exp(i theta)), tilts follow from u_y' =
# theta_z, u_z' = -theta_y. The load of an unbalance is U Omega^2. A bent shaft pulls with K_s q_b, K_s the stiffness of
# its elements alone and q_b its shape without load: rigid motion of the shape loads nothing (J. C. Nicholas, E. J.
# Gunter, P. E. Allaire, J. Eng. Power 98, 1976, 182). A coupling with stiffness K whose flanges stand o apart loads
# both shafts with -K o (M. Xu, R. D. Marangoni, J. Sound Vib. 176, 1994, 663, for the stiffness of the coupling as the
# path).

Complex = NDArray[np.complex128]


@dataclass(frozen=True, kw_only=True)
class RotatingLoad:
    """Re(load exp(i theta)) on all freedoms (n,) [N], [N m] with the angle of a shaft.

    speed_power : 2 where it grows with the square of the speed of that shaft, per [rad2/s2]
    """

    shaft: str
    load: Complex
    speed_power: SpeedPower


def rotating_loads(model: ElasticModel) -> tuple[RotatingLoad, ...]:
    """Load of every rotating part of a rig, in its order; DrivetrainError for a coupling that does not resist."""
    return tuple(_rotating_load(model, part) for part in model.rig.rotating)


def line_loads(model: ElasticModel) -> dict[tuple[str, SpeedPower], Complex]:
    """Loads (n,) by shaft line, under the name of its first loaded shaft, and by power of the speed."""
    lines = model.rig.drivetrain.lines()
    first: dict[int, str] = {}
    loads: dict[tuple[str, SpeedPower], Complex] = {}
    for load in rotating_loads(model):
        name = first.setdefault(lines[load.shaft], load.shaft)
        key = (name, load.speed_power)
        loads[key] = loads.get(key, 0.0) + load.load
    return loads


def misalignment_load(model: ElasticModel, misalignments: tuple[AxisMisalignment, ...]) -> Array:
    """Standing load (n,) of axes out of line on both shafts of their couplings [N], [N m].

    Raises DrivetrainError for a coupling that does not resist the offset or angle.
    """
    total = np.zeros(model.size)
    for part in misalignments:
        joint = model.joint(part.coupling, "coupling")
        y, z, slope_y, slope_z = *part.offset, *part.slope
        total -= _joint_load(joint, {"u_y": y, "u_z": z, "theta_z": slope_y, "theta_y": -slope_z}).real
    return total


def _rotating_load(model: ElasticModel, part: RotatingPart) -> RotatingLoad:
    match part:
        case ShaftUnbalance():
            place = model.freedoms.on_shaft(part.shaft, part.position)
            across, up = place.rows(model.size)[1:3]
            force = part.moment * np.exp(1j * part.angle)
            turning = across - 1j * _sense(model, part.shaft) * up
            return RotatingLoad(shaft=part.shaft, load=force * turning, speed_power=2)
        case ShaftBow():
            load = shaft_stiffness(model, part.shaft) @ _bent(model, part)
            return RotatingLoad(shaft=part.shaft, load=np.asarray(load), speed_power=0)
        case FlangeRunOut():
            joint = model.joint(part.coupling, "coupling")
            coupling = next(c for c in model.rig.drivetrain.couplings if c.name == part.coupling)
            turn = -1j * _sense(model, coupling.shafts[0])
            offset = part.offset * np.exp(1j * part.offset_angle)
            slope = part.tilt * np.exp(1j * part.tilt_angle)
            gap = {"u_y": offset, "u_z": turn * offset, "theta_z": slope, "theta_y": -turn * slope}
            return RotatingLoad(shaft=coupling.shafts[0], load=-_joint_load(joint, gap), speed_power=0)


def _joint_load(joint: ElasticJoint, gap: dict[str, complex]) -> Complex:
    """Sum of loads of built-in offsets by direction; directions without an offset may be free."""
    loads = [value * joint.load(direction) for direction, value in gap.items() if value]
    return np.asarray(sum(loads, np.zeros(joint.rows.shape[1], complex)))


def _sense(model: ElasticModel, shaft: str) -> float:
    return float(np.sign(model.spins[shaft]))


def _bent(model: ElasticModel, bow: ShaftBow) -> Complex:
    """Shape (n,) of a bent shaft on all freedoms, complex amplitudes over its angle."""
    nodes = model.freedoms.nodes[bow.shaft]
    shaft = next(part for part in model.rig.drivetrain.shafts if part.name == bow.shaft)
    residual = bow.amplitude / bow.height * np.array([bow.shape(float(x)) for x in nodes.positions])
    thermal = bow.gradient * np.array(list(_curved(shaft, nodes.positions)))
    shape = residual * np.exp(1j * bow.angle) + thermal * np.exp(1j * bow.gradient_angle)
    ahead = model.rig.placement(bow.shaft).direction
    turn = -1j * _sense(model, bow.shaft)
    bent = np.zeros(model.size, complex)
    base = nodes.first + 6 * np.arange(nodes.positions.size)
    bent[base + 1], bent[base + 2] = shape[:, 0], turn * shape[:, 0]
    bent[base + 5], bent[base + 4] = ahead * shape[:, 1], -ahead * turn * shape[:, 1]
    return bent


def _curved(shaft: Shaft, positions: Array) -> Iterator[tuple[float, float]]:
    """Distance [m] and slope of the axis at positions (n,) from its left end, for a curvature of 1 / diameter."""
    height, slope = 0.0, 0.0
    yield height, slope
    for section, length in zip(element_sections(shaft, positions), np.diff(positions)):
        curvature = 1.0 / section.outer_diameter
        height += slope * length + 0.5 * curvature * length**2
        slope += curvature * length
        yield height, slope
