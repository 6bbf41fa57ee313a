"""Is every shaft held, and which rigid motions are left: turning of the shaft lines, axial float.

Lateral motion must be held by bearings, and by couplings that join a shaft to a held one; axial motion by an axial
location, a bearing that the caller names or helical meshes that can (`helical_hold`). What is left free is known from
the connections alone, so the rigid shapes are exact: one for every freedom that takes part, zero elsewhere.
"""

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.freedoms import ElasticJoint, Freedoms, port_rows
from dynamics.rotor.parts import MeshConnection
from dynamics.rotor.rotor_model import SEAT_DIRECTIONS, ElasticRig
from dynamics.rotor.shaft import DrivetrainError

FREE = 1e-9
"""Sum of squared row values below which a lateral motion of rigid shafts counts as free, rows scaled to 1."""


# Axial restraint of floating shafts by helical meshes.
#
# A single-helical mesh alone gives none: it ties axial motion to rotation, so that under load a floating shaft moves
# axially as it turns until the flanks lose contact. A restraint must resist the shift while the torque of the loop is
# given, that is with the bracing coupling free to turn. Then shafts joined by two meshes of different lead (a pair of
# opposite hands side by side) are held; a helical and a spur gear at the two ends of a shaft are not: position and
# twist go together, and no force along x balances that of the helical teeth.


class HelicalTie(NamedTuple):
    """A mesh as a tie of two rigid bodies: approach radius_1 turn_1 - radius_2 turn_2 - thrust (u_1 - u_2).

    pinion, wheel : what turns and shifts with them; radii [m], turns in the running direction
    thrust : tan(base helix angle) over base radii, or tan(helix angle) over reference radii, positive for a right-hand
        pinion that turns about +x; 0 for a spur or double-helical mesh
    """

    pinion: str
    wheel: str
    radii: tuple[float, float]
    thrust: float


def turning_together(bodies: Collection[str], joints: Sequence[tuple[str, str]]) -> dict[str, int]:
    """Number of the group of each body that joints make turn as one; leave out the coupling that is twisted."""
    group = {body: i for i, body in enumerate(bodies)}
    for first, second in joints:
        keep, drop = group[first], group[second]
        group = {body: keep if i == drop else i for body, i in group.items()}
    return group


def not_held(
    turning: Mapping[str, int], floating: Sequence[Sequence[str]], ties: Sequence[HelicalTie]
) -> Iterator[Sequence[str]]:
    """Those of the floating groups that shift in a motion which no mesh resists.

    turning : group of each body that turns as one, the loop open where it is braced; floating : bodies that shift
    along x together and that neither bearing, coupling nor double-helical mesh locates
    """
    lines = {number: column for column, number in enumerate(dict.fromkeys(turning.values()))}
    sliding = {body: len(lines) + i for i, group in enumerate(floating) for body in group}
    radius = float(np.mean([tie.radii for tie in ties])) if ties else 1.0
    table = np.zeros((len(ties) + 1, len(lines) + len(floating)))
    for row, tie in zip(table, ties):
        for sign, body, arm in zip((1.0, -1.0), (tie.pinion, tie.wheel), tie.radii, strict=True):
            row[lines[turning[body]]] += sign * arm / radius
            if body in sliding:
                row[sliding[body]] -= sign * tie.thrust
    size = np.linalg.norm(table, axis=1, keepdims=True)
    table = np.divide(table, size, where=size > FREE, out=np.zeros_like(table))
    values, vectors = np.linalg.eigh(table.T @ table)
    shares = (vectors[len(lines) :, values <= FREE] ** 2).sum(axis=1)
    for group, share in zip(floating, shares, strict=True):
        if share > FREE:
            yield group


Array = NDArray[np.float64]

GROUND = "foundation"


@dataclass(frozen=True)
class RigidMotion:
    """A rigid motion without any elastic force: ``turn`` or ``axial`` of the bodies named; shape (n,) of ones."""

    kind: str
    bodies: tuple[str, ...]
    shape: Array


def rigid_motions(rig: ElasticRig, freedoms: Freedoms) -> tuple[RigidMotion, ...]:
    """Turning of every shaft line, then the axial float of whatever no spring of the matrices holds along x."""
    lines = rig.drivetrain.lines()
    names = np.array(freedoms.names)
    turning = np.char.endswith(names, " turn")
    sliding = np.char.endswith(names, " u_x")
    shaft_of = np.array(freedoms.shaft_of)
    motions = []
    for line in sorted(set(lines.values())):
        shafts = tuple(shaft for shaft in lines if lines[shaft] == line)
        member = np.isin(shaft_of, [_index(rig, shaft) for shaft in shafts])
        motions.append(RigidMotion("turn", shafts, (turning & member).astype(float)))
    for bodies in _floating(rig):
        shape = np.zeros(freedoms.size)
        for body in bodies:
            if body in freedoms.nodes:
                on_shaft = (shaft_of == _index(rig, body)) & ~_separate(rig, freedoms, body)
                shape[on_shaft & sliding] = 1.0
            else:
                shape[freedoms.place(body).base] = 1.0
        motions.append(RigidMotion("axial", bodies, shape))
    return tuple(motions)


def unresisted(forces: Array, scale: float = 0.0) -> Array:
    """(r, k) orthonormal combinations of r motions that no force resists: forces (n, r) per unit of each.

    A mesh spring between two shaft lines leaves one combination of their turns free. ``scale`` [force per unit] is that
    of the numbers whose rounding the forces may hold.
    """
    if forces.shape[1] == 0:
        return np.zeros((0, 0))
    values, vectors = np.linalg.eigh(forces.T @ forces)
    size = np.sqrt(np.maximum(values, 0.0))
    return np.asarray(vectors[:, size <= 1e-7 * size[-1] + 1e-12 * scale])


def check_location(rig: ElasticRig, freedoms: Freedoms, joints: Sequence[ElasticJoint]) -> None:
    """Raise DrivetrainError, naming shaft and remedy, if a shaft can float along x or move sideways without force."""
    for bodies in not_held(_turning(rig), _floating(rig), list(_ties(rig))):
        helical = [mesh.name for mesh in rig.drivetrain.meshes if _thrust(rig, mesh)]
        screws = (
            f" (single-helical mesh {', '.join(map(repr, helical))} gives no axial restraint: the shaft can move "
            "axially as it turns)"
            if helical
            else ""
        )
        raise DrivetrainError(
            f"shaft or gear {bodies[0]!r} has no axial location: 0 of its bearings hold it along x, must be 1 for "
            f"{', '.join(bodies)}{screws}; give an axial location, name the bearing that locates it, or couple it "
            "axially to a located shaft"
        )
    _check_lateral(rig, freedoms, joints)


def _floating(rig: ElasticRig) -> list[tuple[str, ...]]:
    """Groups of shafts and gears that move along x together and that no spring or bearing holds."""
    groups = _Groups([GROUND, *(shaft.name for shaft in rig.drivetrain.shafts)])
    for gear in rig.drivetrain.gears:
        if gear.seat is not None:
            groups.add(gear.name)
            if gear.seat.axial > 0.0:
                groups.tie(gear.name, gear.shaft)
    for a, b in _axial_ties(rig):
        groups.tie(a, b)
    return groups.without(GROUND)


def _axial_ties(rig: ElasticRig) -> Iterator[tuple[str, str]]:
    bodies = _bodies(rig)
    shaft_of = {bearing.name: bearing.shaft for bearing in rig.drivetrain.bearings}
    for coupling in rig.drivetrain.couplings:
        if coupling.flexibility.axial > 0.0:
            yield coupling.shafts
    for bearing in (*(location.bearing for location in rig.axial_locations), *rig.axially_locating):
        yield shaft_of[bearing], GROUND
    springs = [spring.mesh for spring in rig.axial_mesh_springs]
    for mesh in rig.drivetrain.meshes:
        if mesh.name in springs:
            yield bodies[mesh.pinion], bodies[mesh.wheel]


def _bodies(rig: ElasticRig) -> dict[str, str]:
    """Body that shifts with each gear: its shaft, or itself on a seat that gives."""
    return {gear.name: gear.name if gear.seat is not None else gear.shaft for gear in rig.drivetrain.gears}


def _turning(rig: ElasticRig) -> dict[str, int]:
    """What turns as one while the torque of the loop is given: lines, open at the coupling that is twisted."""
    drivetrain = rig.drivetrain
    joints = [c.shafts for c in drivetrain.couplings if c.name != drivetrain.bracing_coupling]
    seats = [(gear.name, gear.shaft) for gear in drivetrain.gears if gear.seat is not None]
    return turning_together(
        [*(shaft.name for shaft in drivetrain.shafts), *(a for a, _ in seats)], joints + seats
    )


def _ties(rig: ElasticRig) -> Iterator[HelicalTie]:
    bodies = _bodies(rig)
    for mesh in rig.drivetrain.meshes:
        yield HelicalTie(bodies[mesh.pinion], bodies[mesh.wheel], mesh.base_radii, _thrust(rig, mesh))


def _thrust(rig: ElasticRig, mesh: MeshConnection) -> float:
    """Force along x for one along the transverse line of action; none of a double-helical mesh."""
    if mesh.name in [spring.mesh for spring in rig.axial_mesh_springs]:
        return 0.0
    sense = rig.placement(rig.drivetrain.gear(mesh.pinion).shaft).sense
    return sense * math.tan(mesh.base_helix_angle)


def _separate(rig: ElasticRig, freedoms: Freedoms, shaft: str) -> NDArray[np.bool_]:
    """Freedoms of gears on this shaft that have all six of their own."""
    mask = np.zeros(freedoms.size, bool)
    for gear in rig.drivetrain.gears:
        if gear.shaft == shaft and gear.seat is not None:
            mask[freedoms.place(gear.name).freedoms] = True
    return mask


def _check_lateral(rig: ElasticRig, freedoms: Freedoms, joints: Sequence[ElasticJoint]) -> None:
    """Null space of bearing and joint rows over the lateral rigid motions of all shafts, bearings taken as locked."""
    shafts = [shaft.name for shaft in rig.drivetrain.shafts]
    motions = np.hstack([_lateral_motions(rig, freedoms, shaft) for shaft in shafts])
    rows = [
        joint.rows[np.diag(joint.stiffness) > 0.0] for joint in joints if joint.kind in ("coupling", "spline")
    ]
    for bearing in rig.drivetrain.bearings:
        directions = [0, 1]
        if bearing.name in rig.moment_carrying:
            directions += [SEAT_DIRECTIONS.index("theta_y"), SEAT_DIRECTIONS.index("theta_z")]
        rows.append(port_rows(bearing.name, freedoms)[directions])
    table = np.vstack([*rows, np.zeros((1, freedoms.size))]) @ motions
    size = np.linalg.norm(table, axis=1, keepdims=True)
    table = np.divide(table, size, where=size > FREE, out=np.zeros_like(table))
    values, vectors = np.linalg.eigh(table.T @ table)
    if values[0] > FREE:
        return
    share = (vectors[:, 0] ** 2).reshape(len(shafts), 4)
    shaft = shafts[int(np.argmax(share.sum(axis=1)))]
    places = [bearing.position for bearing in rig.drivetrain.bearings if bearing.shaft == shaft]
    count = f"{len(places)} bearing{'' if len(places) == 1 else 's'}"
    if len(places) > 1:
        count += f" {max(places) - min(places):.6g} m apart, must be above 0 m"
    raise DrivetrainError(
        f"shaft {shaft!r} with {count}: a lateral rigid motion is not held; it needs two bearings at different "
        "positions, one that carries moments, or one and a coupling with lateral stiffness to a held shaft; add or "
        "move a bearing, or add the lateral stiffness of the coupling"
    )


def _lateral_motions(rig: ElasticRig, freedoms: Freedoms, shaft: str) -> Array:
    """(n, 4) shift along y and z, tilt about z and y of a rigid shaft with its gears, tilt 1 at half its length."""
    names = np.array(freedoms.names)
    on_shaft = np.array(freedoms.shaft_of) == _index(rig, shaft)
    x = np.zeros(freedoms.size)
    nodes = freedoms.nodes[shaft]
    for i, position in enumerate(nodes.x):
        x[nodes.first + 6 * i : nodes.first + 6 * i + 6] = position
    for gear in rig.drivetrain.gears:
        if gear.shaft == shaft and gear.seat is not None:
            place = freedoms.place(gear.name)
            x[place.freedoms] = place.x
    half = 0.5 * float(np.ptp(nodes.x))
    along = (x - 0.5 * float(nodes.x.min() + nodes.x.max())) / half
    picked = {d: (on_shaft & np.char.endswith(names, f" {d}")).astype(float) for d in SEAT_DIRECTIONS}
    return np.column_stack(
        [
            picked["u_y"],
            picked["u_z"],
            picked["u_y"] * along + picked["theta_z"] / half,
            -picked["u_z"] * along + picked["theta_y"] / half,
        ]
    )


def _index(rig: ElasticRig, shaft: str) -> int:
    return [part.name for part in rig.drivetrain.shafts].index(shaft)


class _Groups:
    """Disjoint groups of names."""

    def __init__(self, names: Sequence[str]) -> None:
        self.group = {name: i for i, name in enumerate(names)}

    def add(self, name: str) -> None:
        self.group[name] = len(self.group)

    def tie(self, a: str, b: str) -> None:
        keep, drop = self.group[a], self.group[b]
        self.group = {name: keep if i == drop else i for name, i in self.group.items()}

    def without(self, name: str) -> list[tuple[str, ...]]:
        """Groups that do not hold a name."""
        groups: dict[int, list[str]] = {}
        for member, i in self.group.items():
            if i != self.group[name]:
                groups.setdefault(i, []).append(member)
        return [tuple(members) for members in groups.values()]
