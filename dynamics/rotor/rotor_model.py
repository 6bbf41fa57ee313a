"""What the elastic rig needs beyond the drivetrain: where the shafts stand, how housing and axial locations hold them.

x runs along all shafts, y across, z up. The torsional drivetrain stays the one description of shafts, gears, couplings,
bearings and meshes; what of their fields torsion does not read is read here.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.beam import ShearRule, TorsionalInertia
from dynamics.rotor.graph import Drivetrain
from dynamics.rotor.parts import DISTANCE_TOLERANCE, Coupling, GearBody, MeshConnection, speed_ratios
from dynamics.rotor.shaft import DrivetrainError

# What turns with a shaft and shakes it once a turn: unbalance, a bent shaft, flanges out of true.
#
# Angles [rad] count from +y in the sense of rotation of the shaft, at the instant at which its angle is zero.


@dataclass(frozen=True, kw_only=True)
class ShaftUnbalance:
    """Mass times radius [kg m] on a shaft at a position [m] from its left end."""

    shaft: str
    position: float
    moment: float
    angle: float = 0.0

    def __post_init__(self) -> None:
        if not (self.moment >= 0.0 and math.isfinite(self.moment)):
            raise DrivetrainError(
                f"unbalance of shaft {self.shaft!r}: {self.moment} kg m: must be finite and at least 0; turn its angle"
            )


@dataclass(frozen=True, kw_only=True)
class ShaftBow:
    """Shape of the axis of a shaft without load.

    amplitude : largest distance from the line through the supports, or at ``position`` where one is given [m]: a half
        sine between them, straight beyond
    gradient : temperature difference across the diameter times the expansion coefficient [-]: a curvature gradient /
        diameter all along the shaft
    supports : positions of two bearings [m]

    Raises DrivetrainError for supports at one place, or a position at which a half sine has no height.
    """

    shaft: str
    supports: tuple[float, float]
    amplitude: float = 0.0
    position: float | None = None
    angle: float = 0.0
    gradient: float = 0.0
    gradient_angle: float = 0.0

    def __post_init__(self) -> None:
        first, second = self.supports
        if not second > first:
            raise DrivetrainError(
                f"bow of shaft {self.shaft!r}: supports at {first} and {second} m: must ascend; give the positions of "
                "two bearings"
            )
        if self.position is not None and self.amplitude and abs(self.height) < 1e-3:
            raise DrivetrainError(
                f"bow of shaft {self.shaft!r}: position = {self.position} m is at a support, where it has no "
                f"amplitude; give a place between {first} and {second} m or beyond them"
            )

    @property
    def height(self) -> float:
        """Of the shape at ``position``, over its largest."""
        return 1.0 if self.position is None else self.shape(self.position)[0]

    def shape(self, position: float) -> tuple[float, float]:
        """Distance from the line through the supports and slope [1/m] at a position [m], for a largest of 1."""
        first, second = self.supports
        span = second - first
        inside = min(max(position, first), second)
        turn = math.pi * (inside - first) / span
        slope = math.pi / span * math.cos(turn)
        return math.sin(turn) + slope * (position - inside), slope


@dataclass(frozen=True, kw_only=True)
class FlangeRunOut:
    """Flange of the first shaft of a coupling against that of the second, turning with them.

    offset : of its centre from the axis [m]; tilt : of its face from square [rad]
    """

    coupling: str
    offset: float = 0.0
    offset_angle: float = 0.0
    tilt: float = 0.0
    tilt_angle: float = 0.0


RotatingPart = ShaftUnbalance | ShaftBow | FlangeRunOut


@dataclass(frozen=True, kw_only=True)
class AxisMisalignment:
    """Axis of the first shaft of a coupling against that of the second, as they stand: offset [m], slope over x [rad].

    Both (y, z).
    """

    coupling: str
    offset: tuple[float, float] = (0.0, 0.0)
    slope: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True, kw_only=True)
class CrossJoint:
    """Coupling that is a cross joint: slope (y, z) over x of the axis of its first shaft against that of the second."""

    coupling: str
    slope: tuple[float, float]


SpeedPower = Literal[0, 2]


# Residual unbalance of a shaft by its balance quality grade, in its two bearing planes (ISO 21940-11).
#
# The grade G is the speed of the centre of mass, e_per Omega; the permissible unbalance is U_per = m G / Omega with the
# mass m and highest service speed Omega of the rotor. It goes to the bearing planes by the lever rule, with 0.3 to 0.7
# of it in either of them where the centre of mass lies between, and up to 1.3 where it overhangs.

LEAST_SHARE = 0.3
MOST_INSIDE, MOST_BEYOND = 0.7, 1.3
"""Share of the unbalance in one bearing plane: centre of mass between the bearings, and beyond them."""


@dataclass(frozen=True, kw_only=True)
class BalanceGrade:
    """Grade [m/s] (G 2.5 is 2.5e-3), speed for which it holds [rad/s], angles in the two planes [rad].

    Equal angles are a static unbalance, angles that differ by half a turn a couple.
    """

    grade: float
    speed: float
    angles: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        if not (self.grade >= 0.0 and self.speed > 0.0):
            raise DrivetrainError(
                f"balance grade = {self.grade} m/s at {self.speed} rad/s: must not be negative, at a speed above 0; "
                "correct them"
            )

    @property
    def eccentricity(self) -> float:
        """Permissible of the centre of mass, e_per [m]."""
        return self.grade / self.speed


@dataclass(frozen=True, kw_only=True)
class Rotor:
    """Mass [kg] of a shaft with its discs and gears, and its centre from the left end [m]."""

    mass: float
    centre: float


def rotor_of(drivetrain: Drivetrain, shaft: str) -> Rotor:
    """A shaft with discs, gears and a motor rotor that it carries."""
    parts = list(_masses(drivetrain, shaft))
    mass = math.fsum(mass for mass, _ in parts)
    return Rotor(mass=mass, centre=math.fsum(mass * position for mass, position in parts) / mass)


def residual_unbalances(
    drivetrain: Drivetrain, shaft: str, grade: BalanceGrade
) -> tuple[ShaftUnbalance, ...]:
    """What the grade leaves in the planes of the outer two bearings of a shaft; at its centre of mass where it has one
    bearing or none."""
    rotor = rotor_of(drivetrain, shaft)
    whole = rotor.mass * grade.eccentricity
    planes = sorted({bearing.position for bearing in drivetrain.bearings if bearing.shaft == shaft})
    if len(planes) < 2:
        return (ShaftUnbalance(shaft=shaft, position=rotor.centre, moment=whole, angle=grade.angles[0]),)
    first, second = planes[0], planes[-1]
    levers = (second - rotor.centre) / (second - first), (rotor.centre - first) / (second - first)
    most = MOST_INSIDE if first <= rotor.centre <= second else MOST_BEYOND
    return tuple(
        ShaftUnbalance(
            shaft=shaft, position=plane, moment=whole * min(max(abs(lever), LEAST_SHARE), most), angle=angle
        )
        for plane, lever, angle in zip((first, second), levers, grade.angles)
    )


def _masses(drivetrain: Drivetrain, shaft: str) -> Iterator[tuple[float, float]]:
    """(mass [kg], position [m]) of sections, discs, gears and motor of a shaft."""
    part = next(part for part in drivetrain.shafts if part.name == shaft)
    start = 0.0
    for section in part.sections:
        area = 0.25 * math.pi * (section.outer_diameter**2 - section.inner_diameter**2)
        yield part.density * area * section.length, start + 0.5 * section.length
        start += section.length
    yield from ((disc.mass, disc.position) for disc in part.discs)
    for gear in drivetrain.gears:
        if gear.shaft == shaft:
            yield gear.mass, gear.position + gear.offset
    motor = drivetrain.motor
    if motor.shaft == shaft and motor.diametral_inertia is not None:
        yield motor.mass, motor.position


Array = NDArray[np.float64]
Sign = Literal[1, -1]

SEAT_DIRECTIONS = ("u_y", "u_z", "u_x", "theta_y", "theta_z")
"""Order of the motions between journal and seat: a film knows the first two, a rolling bearing all five."""


@dataclass(frozen=True, kw_only=True)
class ShaftPlacement:
    """Where a shaft stands: axis at (y, z), its left end at x = ``start`` [m].

    direction : 1 if it is drawn along +x from there, else -1; sense : 1 if it turns about +x, else -1
    """

    shaft: str
    y: float
    z: float
    sense: Sign
    start: float = 0.0
    direction: Sign = 1


@dataclass(frozen=True, kw_only=True)
class HousingSupport:
    """Seats of bearings that the housing holds: their motion against the foundation.

    bearings : names of k of them. stiffness, mass, damping : (d k, d k) symmetric [N/m], [kg], [N s/m] and likewise for
    rotations, bearing after bearing, each in the first d of `SEAT_DIRECTIONS`, d = 2, 3 or 5; in the others a seat
    stands still. Condensed from a finite-element mesh of the housing (Guyan 1965), or one bearing by
    `isotropic_support`.

    Raises DrivetrainError for a wrong shape, or a stiffness or mass that is not symmetric and positive definite.
    """

    name: str
    bearings: tuple[str, ...]
    stiffness: Array
    mass: Array
    damping: Array | None = None

    def __post_init__(self) -> None:
        sizes = tuple((d * len(self.bearings),) * 2 for d in (2, 3, 5))
        for name, matrix in (("stiffness", self.stiffness), ("mass", self.mass), ("damping", self.damping)):
            if matrix is None:
                continue
            if matrix.shape not in sizes or matrix.shape != self.stiffness.shape:
                raise DrivetrainError(
                    f"housing support {self.name!r}: {name} has shape {matrix.shape}: must be "
                    f"{sizes[0]}, {sizes[1]} or {sizes[2]}, the same for all; give two, three or five directions for "
                    "each bearing"
                )
            if not np.allclose(matrix, matrix.T, rtol=1e-6, atol=1e-9 * float(np.abs(matrix).max())):
                raise DrivetrainError(
                    f"housing support {self.name!r}: {name} is not symmetric; give the condensed matrix"
                )
        for name, matrix in (("stiffness", self.stiffness), ("mass", self.mass)):
            smallest = float(np.linalg.eigvalsh(matrix)[0])
            if not smallest > 0.0:
                raise DrivetrainError(
                    f"housing support {self.name!r}: smallest eigenvalue of the {name} = {smallest:.6g}: must be "
                    "above 0; hold the housing on its foundation and give the mass that moves with each seat"
                )

    @property
    def directions(self) -> int:
        """Motions of a seat: 2, 3 or 5."""
        return int(self.stiffness.shape[0]) // len(self.bearings)


def isotropic_support(bearing: str, stiffness: float, mass: float, damping: float = 0.0) -> HousingSupport:
    """Seat of one bearing that yields alike in all lateral directions [N/m], [kg], [N s/m]."""
    plane = np.eye(2)
    return HousingSupport(
        name=bearing,
        bearings=(bearing,),
        stiffness=stiffness * plane,
        mass=mass * plane,
        damping=damping * plane,
    )


@dataclass(frozen=True, kw_only=True)
class AxialLocation:
    """Bearing that holds its shaft along x with a spring and a damper: [N/m], [N s/m]."""

    bearing: str
    stiffness: float
    damping: float = 0.0

    def __post_init__(self) -> None:
        if not (self.stiffness > 0.0 and self.damping >= 0.0):
            raise DrivetrainError(
                f"axial location at {self.bearing!r}: stiffness = {self.stiffness} N/m, damping = {self.damping} "
                "N s/m: must be above 0 and not negative; correct them or leave the location out"
            )


@dataclass(frozen=True, kw_only=True)
class AxialMeshSpring:
    """Spring between the gears of a double-helical mesh along x, at the pitch point: [N/m], [N s/m].

    Two halves that share the mesh stiffness k with base helix angles +beta_b and -beta_b resist a shift of one gear
    against the other by k tan^2(beta_b) (`double_helical_stiffness`).
    """

    mesh: str
    stiffness: float
    damping: float = 0.0


def double_helical_stiffness(mesh_stiffness: float, base_helix_angle: float) -> float:
    """k tan^2(beta_b) [N/m] of a mesh stiffness k in the transverse line of action [N/m]."""
    return float(mesh_stiffness * math.tan(base_helix_angle) ** 2)


@dataclass(frozen=True, kw_only=True)
class ProbeStation:
    """Any further place of a shaft whose motion is wanted (gauge, seal, probe): it gets a node."""

    name: str
    shaft: str
    position: float


@dataclass(frozen=True, kw_only=True)
class ElasticRig:
    """A drivetrain in six degrees of freedom.

    axially_locating : bearings whose force, outside the matrices, holds a shaft along x (a rolling bearing that comes
    with its axial stiffness). moment_carrying : bearings that resist tilting by themselves.
    reference_shaft : whose speed is the reference of the gyroscopics; that of the motor unless given. rotating : what
    shakes the shafts once a turn; misalignments : of couplings, as they stand; cross_joints : couplings whose torque
    bends their shafts.

    Raises DrivetrainError for placements that are missing or do not fit couplings and meshes.
    """

    drivetrain: Drivetrain
    placements: tuple[ShaftPlacement, ...]
    supports: tuple[HousingSupport, ...] = ()
    axial_locations: tuple[AxialLocation, ...] = ()
    axial_mesh_springs: tuple[AxialMeshSpring, ...] = ()
    axially_locating: tuple[str, ...] = ()
    moment_carrying: tuple[str, ...] = ()
    stations: tuple[ProbeStation, ...] = ()
    rotating: tuple[RotatingPart, ...] = ()
    misalignments: tuple[AxisMisalignment, ...] = ()
    cross_joints: tuple[CrossJoint, ...] = ()
    reference_shaft: str | None = None
    shear: ShearRule = "cowper"
    torsional_inertia: TorsionalInertia = "lumped"

    def __post_init__(self) -> None:
        placed = [placement.shaft for placement in self.placements]
        for shaft in self.drivetrain.shafts:
            if placed.count(shaft.name) != 1:
                raise DrivetrainError(
                    f"shaft {shaft.name!r} has {placed.count(shaft.name)} placements: must have 1; say where it stands"
                )
        for name in placed:
            self.drivetrain.shaft(name)
        for coupling in self.drivetrain.couplings:
            self._check_coupling(coupling)
        for mesh in self.drivetrain.meshes:
            self._check_mesh(mesh)
        for station in self.stations:
            self.drivetrain.shaft(station.shaft).check_position(station.position, f"station {station.name!r}")
        for part in self.rotating:
            self._check_rotating(part)
        for joint in self.cross_joints:
            if joint.coupling not in {coupling.name for coupling in self.drivetrain.couplings}:
                raise DrivetrainError(f"cross joint {joint.coupling!r}: no such coupling; correct the name")
        self._check_names()

    def placement(self, shaft: str) -> ShaftPlacement:
        """Placement of a shaft."""
        return next(placement for placement in self.placements if placement.shaft == shaft)

    def mesh(self, name: str) -> MeshConnection:
        """Mesh by its name; raises DrivetrainError if there is none."""
        for mesh in self.drivetrain.meshes:
            if mesh.name == name:
                return mesh
        raise DrivetrainError(f"mesh {name!r} does not exist: correct the name")

    def x(self, shaft: str, position: float) -> float:
        """Coordinate [m] along x of a position [m] on a shaft."""
        placement = self.placement(shaft)
        return placement.start + placement.direction * position

    def centre(self, gear: GearBody) -> float:
        """Coordinate [m] along x of the centre of a gear."""
        return self.x(gear.shaft, gear.position + gear.offset)

    def spins(self) -> dict[str, float]:
        """Angular speed about +x of every shaft per reference speed, with its sign."""
        ratios = speed_ratios(self.drivetrain)
        reference = ratios[self.reference_shaft or self.drivetrain.motor.shaft]
        return {name: self.placement(name).sense * ratio / reference for name, ratio in ratios.items()}

    def _check_coupling(self, coupling: Coupling) -> None:
        a, b = (self.placement(name) for name in coupling.shafts)
        apart = math.hypot(a.y - b.y, a.z - b.z)
        if apart > DISTANCE_TOLERANCE:
            raise DrivetrainError(
                f"coupling {coupling.name!r}: its shafts {a.shaft!r} and {b.shaft!r} are {apart:.6g} m apart across "
                "x: must be on one axis; correct the placements"
            )
        if a.sense != b.sense:
            raise DrivetrainError(
                f"coupling {coupling.name!r}: senses of rotation {a.sense} and {b.sense}: must be equal; correct one"
            )

    def _check_mesh(self, mesh: MeshConnection) -> None:
        a, b = (self.placement(self.drivetrain.gear(name).shaft) for name in (mesh.pinion, mesh.wheel))
        distance = math.hypot(a.y - b.y, a.z - b.z)
        if abs(distance - mesh.centre_distance) > DISTANCE_TOLERANCE:
            raise DrivetrainError(
                f"mesh {mesh.name!r}: axes placed {distance:.9g} m apart: must be the centre distance "
                f"{mesh.centre_distance:.9g} m; correct the placements"
            )
        if a.sense == b.sense:
            raise DrivetrainError(
                f"mesh {mesh.name!r}: pinion and wheel both turn with sense {a.sense}: must be opposite; correct one"
            )
        pinion, wheel = (self.drivetrain.gear(name) for name in (mesh.pinion, mesh.wheel))
        apart = abs(self.centre(pinion) - self.centre(wheel))
        if pinion.width and wheel.width and apart >= 0.5 * (pinion.width + wheel.width):
            raise DrivetrainError(
                f"mesh {mesh.name!r}: gears stand {apart:.6g} m apart along x: must be less than half the sum of "
                f"their widths, {0.5 * (pinion.width + wheel.width):.6g} m; correct a placement or position"
            )

    def _check_rotating(self, part: RotatingPart) -> None:
        if isinstance(part, FlangeRunOut):
            if part.coupling not in {coupling.name for coupling in self.drivetrain.couplings}:
                raise DrivetrainError(
                    f"flange run-out of coupling {part.coupling!r}: there is none; correct the name"
                )
            return
        shaft = self.drivetrain.shaft(part.shaft)
        if isinstance(part, ShaftUnbalance):
            shaft.check_position(part.position, "unbalance")

    def _check_names(self) -> None:
        bearings = {bearing.name for bearing in self.drivetrain.bearings}
        meshes = {mesh.name for mesh in self.drivetrain.meshes}
        seats = [name for support in self.supports for name in support.bearings]
        drivetrain = self.drivetrain
        taken = ["motor", *(gear.name for gear in drivetrain.gears)]
        taken += [bearing.name for bearing in drivetrain.bearings]
        taken += [place.name for place in drivetrain.drag_places]
        for station in self.stations:
            if station.name in taken:
                raise DrivetrainError(
                    f"station {station.name!r}: the name is taken by another place; rename it"
                )
            taken.append(station.name)
        for kind, names, known in (
            ("housing support", seats, bearings),
            ("axial location", [location.bearing for location in self.axial_locations], bearings),
            ("axial mesh spring", [spring.mesh for spring in self.axial_mesh_springs], meshes),
            ("axially_locating", list(self.axially_locating), bearings),
            ("moment_carrying", list(self.moment_carrying), bearings),
        ):
            for name in names:
                if name not in known or names.count(name) > 1:
                    raise DrivetrainError(
                        f"{kind} {name!r}: is given {names.count(name)} times, known are "
                        f"{', '.join(sorted(known)) or 'none'}; name each once"
                    )
