"""Places on a housing mesh as weights of nodal temperatures: surfaces, bodies, coordinates.

Coordinates are found in the nearest cell by Newton's method on its isoparametric map and read with its shape
functions. A sensor sits on a surface that the mesh follows to a fraction of a millimetre, so a point that far
outside the body is read at the nearest point of the cell.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from dynamics.rotor.linear_system import LinearSystem
from dynamics.vibration.deviation_response import OrderLoads
from rigdesign.base.errors import UsageError
from rigdesign.prediction.model import LATERAL_QUANTITIES, Channel
from rigdesign.rig.model import Rig
from rigdesign.rig.shaft_motion import axis_rows, journal_rows, seat_rows
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import FloatArray

OFF_BODY = 2e-3
"""Distance from the body [m] up to which a sensor is taken to sit on its surface."""
CANDIDATES = 24
"""Cells whose middle is nearest that are searched for a point."""
STEPS = 12
"""Newton steps on the map of a cell; the cells are nearly straight."""

Weights = tuple[np.ndarray[tuple[int], np.dtype[np.intp]], FloatArray]
"""Nodes and the weights of their temperatures, which sum to one."""


def place_weights(rig: Rig, place: str, at: tuple[float, float, float] | None) -> tuple[str, Weights]:
    """Gearbox and weights of a temperature channel.

    place : ``gearbox.surface`` (area mean) or ``gearbox.body`` (volume mean); the gearbox alone with ``at`` [m]

    Raises
    ------
    UsageError
        A gearbox without a housing, a name that is neither surface nor body, a point off the body.
    """
    name, _, part = place.partition(".")
    if name not in rig.models:
        known = ", ".join(rig.models) or "none"
        raise UsageError(
            f"temperature at {place!r}: {name!r} is no gearbox with a housing; with one: {known}"
        )
    elements = rig.conduction[name].elements
    if at is not None:
        return name, _at_point(elements, place, np.array(at, dtype=np.float64))
    if part in elements.mesh.surfaces:
        return name, _normed(elements.surfaces[part].shares)
    if part in elements.mesh.bodies:
        return name, _normed(elements.body_load(part))
    known = ", ".join([*elements.mesh.bodies, *elements.mesh.surfaces])
    raise UsageError(
        f"temperature at {place!r}: {part!r} is no body or surface of the housing; it has {known}"
    )


def _normed(shares: FloatArray) -> Weights:
    nodes = np.flatnonzero(shares)
    return nodes, shares[nodes] / shares.sum()


def _at_point(elements: FiniteElements, place: str, point: FloatArray) -> Weights:
    mesh, shape = elements.mesh, elements.shape
    middles = mesh.points[mesh.cells[:, : shape.n_corners]].mean(axis=1)
    _, near = cKDTree(middles).query(point, k=min(CANDIDATES, len(middles)))
    best: tuple[float, Weights] | None = None
    for cell in np.atleast_1d(near):
        nodes = mesh.cells[cell].astype(np.intp)
        local = _inside(elements, _local(elements, mesh.points[nodes], point))
        weights = shape.values(local[None])[0]
        gap = float(np.linalg.norm(weights @ mesh.points[nodes] - point))
        if best is None or gap < best[0]:
            best = gap, (nodes, weights)
        if gap < 1e-9:
            break
    assert best is not None
    if best[0] > OFF_BODY:
        x, y, z = point
        raise UsageError(
            f"temperature at {place!r}: the point {x:g}, {y:g}, {z:g} m is {1e3 * best[0]:.3g} mm off the body, "
            f"above {1e3 * OFF_BODY:g} mm; nearest surface: {_nearest_surface(mesh.surfaces, mesh.points, point)}"
        )
    return best[1]


def _local(elements: FiniteElements, corners: FloatArray, point: FloatArray) -> FloatArray:
    """Reference coordinates of a point in the cell with these nodes (n_nodes, 3)."""
    shape = elements.shape
    local = shape.corners.mean(axis=0)
    for _ in range(STEPS):
        gap = shape.values(local[None])[0] @ corners - point
        slope = np.einsum("na,nd->ad", corners, shape.gradients(local[None])[0])
        step = np.linalg.lstsq(slope, -gap, rcond=None)[0]
        local = np.clip(local + step, -3.0, 3.0)
        if np.abs(step).max() < 1e-12:
            break
    return np.asarray(local)


def _inside(elements: FiniteElements, local: FloatArray) -> FloatArray:
    """The point of the reference cell nearest to ``local``, in its own coordinates."""
    if elements.shape.n_corners == 8:
        return np.clip(local, 0.0, 1.0)
    shares = np.append(1.0 - local.sum(), local)
    for _ in range(4):
        shares = np.maximum(shares, 0.0)
        shares /= shares.sum()
    return shares[1:]


def _nearest_surface(surfaces: Mapping[str, np.ndarray], points: FloatArray, point: FloatArray) -> str:
    gaps = {
        name: float(np.linalg.norm(points[np.unique(facets)] - point, axis=1).min())
        for name, facets in surfaces.items()
    }
    return min(gaps, key=gaps.__getitem__)


# Where the channels that have orders read the power circuit, and what they read of its loads.
#
# A place is a row over the freedoms of the linear system: of shafts that only twist its stations, of shafts that bend
# the freedoms of the reduced elastic rig (`dynamics.rotor.craig_bampton`). Both measure turns in the running
# direction.

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


# Where accelerometers and proximity probes read shafts that bend.
#
# A proximity probe in a bearing sits in its seat and reads the journal against it; one at a place of a shaft stands on
# the foundation. An accelerometer reads the housing under the bearing where the case gives it a support
# (``support_stiffness`` of the bearing, or ``bearing_seats = "elastic"`` of the housing); where it does not, the model
# has no motion of the housing, and the acceleration is that of the shaft in the bearing: an upper bound of what a stiff
# housing passes on.

STILL = 1e-12
"""Norm of a row below which nothing that the model moves is read."""


@dataclass(frozen=True, kw_only=True)
class LateralMotion:
    """Motion of one place in one direction.

    row : (n,) of it per freedom; accelerates : its second derivative is read
    """

    row: Array
    accelerates: bool

    def mean(self, windup: Array, twist: float) -> float:
        """Zero: a probe is set to zero, an accelerometer has no mean."""
        return 0.0

    def amplitude(self, motion: Complex, omega: float, torques: object = ()) -> complex:
        """Complex displacement [m], or acceleration - omega^2 of it [m/s2], of the motion of all freedoms (n,)."""
        moved = complex(self.row @ motion)
        return -(omega**2) * moved if self.accelerates else moved


def lateral_motion(rig: Rig, channel: Channel) -> LateralMotion:
    """Where an accelerometer or a proximity probe reads.

    Raises
    ------
    UsageError
        Shafts that only twist, no direction, a place that the case does not have, a direction in which it stands
        still.
    """
    require_bending(rig, channel)
    if channel.direction is None:
        raise UsageError(
            f"channel {channel.name!r}: {channel.quantity} has no direction; give a unit vector (x, y, z) in the frame "
            "of the case"
        )
    full = np.asarray(channel.direction) @ _rows(rig, channel)
    if float(np.linalg.norm(full)) < STILL:
        raise UsageError(
            f"channel {channel.name!r}: {channel.place} stands still along {channel.direction} in this model: a "
            "support gives across the shafts only; read it along y or z"
        )
    row = rig.elastic.seen.on_freedoms(full)
    return LateralMotion(row=row, accelerates=channel.quantity == "acceleration")


def require_bending(rig: Rig, channel: Channel) -> None:
    """Refuse a lateral channel of shafts that only twist (UsageError)."""
    if rig.shaft_model == "torsional":
        raise UsageError(
            f"channel {channel.name!r}: {channel.quantity} needs shafts that bend, and this prediction has shafts that "
            'only twist; ask for PredictionModel(shafts="elastic"), for a measurement set shaft_model = "elastic" '
            "under drivetrain in its case, or leave the channel out (torque, angle and torsional natural frequencies "
            "need no bending)"
        )


def _rows(rig: Rig, channel: Channel) -> Array:
    """(3, n_full) motion along x, y and z that the channel reads a component of."""
    bearings = [name for name, _, _ in rig.bearings()]
    if channel.place in bearings:
        journal, seat = journal_rows(rig, channel.place), seat_rows(rig, channel.place)
        if channel.quantity == "acceleration":
            return journal if seat is None else seat
        return journal if seat is None else journal - seat
    if channel.quantity == "acceleration":
        raise UsageError(
            f"channel {channel.name!r}: {channel.place!r} is no bearing; there are {', '.join(bearings)}"
        )
    shafts = list(rig.elastic.model.freedoms.nodes)
    if channel.place not in shafts:
        raise UsageError(
            f"channel {channel.name!r}: {channel.place!r} is neither a bearing ({', '.join(bearings)}) nor a shaft "
            f"({', '.join(shafts)})"
        )
    length = float(rig.elastic.model.freedoms.nodes[channel.place].positions[-1])
    if channel.position is None or not 0.0 <= channel.position <= length:
        said = "no position" if channel.position is None else f"position = {1e3 * channel.position:.6g} mm"
        raise UsageError(
            f"channel {channel.name!r}: {said} on shaft {channel.place!r}; give one from 0 to {1e3 * length:.6g} mm "
            "from its start"
        )
    return axis_rows(rig, channel.place, channel.position)


@dataclass(frozen=True, kw_only=True)
class OscillatingTorque:
    """Load that oscillates with a shaft: Re(amplitude load exp(i order phi)) on all freedoms.

    Torque of a motor or coupling; of shafts that bend, unbalance, bow, run-out and cross joints as well.

    name : of its part; order : per turn of the pinion of the first mesh; load : (n,) per unit
    """

    name: str
    order: float
    amplitude: complex
    load: Array


@dataclass(frozen=True, kw_only=True)
class InCoupling:
    """Torque that a coupling transmits, positive where its first shaft is ahead.

    row : (n,) its twist per freedom; stiffness [N m/rad], damping [N m s/rad]; twisted : it makes the bracing twist
    """

    name: str
    row: Array
    stiffness: float
    damping: float
    twisted: bool

    def mean(self, windup: Array, twist: float) -> float:
        """Mean torque [N m] from the windup of all freedoms and the bracing twist [rad]."""
        turned = float(self.row @ windup)
        return self.stiffness * (turned - (twist if self.twisted else 0.0))

    def amplitude(self, motion: Complex, omega: float, torques: Sequence[OscillatingTorque]) -> complex:
        """Complex torque [N m] from the motion of all freedoms (n,) at a frequency [rad/s].

        What the coupling itself adds between its ends is transmitted too.
        """
        sprung = (self.stiffness + 1j * omega * self.damping) * (self.row @ motion)
        return complex(sprung - sum(torque.amplitude for torque in torques if torque.name == self.name))


@dataclass(frozen=True, kw_only=True)
class OfShaft:
    """Angle of a place of a shaft beyond its uniform rotation; row : (n,) its turn per freedom."""

    row: Array

    def mean(self, windup: Array, twist: float) -> float:
        """Zero: an encoder counts from where it stands."""
        return 0.0

    def amplitude(self, motion: Complex, omega: float, torques: Sequence[OscillatingTorque]) -> complex:
        """Complex angle [rad]."""
        return complex(self.row @ motion)


def motions(system: LinearSystem, loads: Sequence[OrderLoads]) -> Complex:
    """One-sided amplitudes of all freedoms under the loads of orders above 0 (n_orders, n) [rad]."""
    acting = np.zeros((len(system.inertia), len(loads)), complex)
    for column, one in zip(acting.T, loads):
        column += one.torque
    form = system.form
    s = 1j * np.array([one.omega for one in loads])
    moved = form.velocity_shapes @ ((form.loads @ acting) / (s - form.poles[:, None]))
    return np.asarray((moved / s).T)


def place_of(rig: Rig, channel: Channel) -> InCoupling | OfShaft | LateralMotion:
    """Where a channel with orders reads; UsageError for a place that the drivetrain does not have."""
    if channel.quantity in LATERAL_QUANTITIES:
        return lateral_motion(rig, channel)
    return _coupling(rig, channel) if channel.quantity == "torque" else _shaft_end(rig, channel)


def _coupling(rig: Rig, channel: Channel) -> InCoupling:
    drivetrain = rig.drivetrain
    for coupling in drivetrain.couplings:
        if coupling.name == channel.place:
            return InCoupling(
                name=coupling.name,
                row=_twist_row(rig, coupling.name),
                stiffness=coupling.stiffness,
                damping=coupling.damping,
                twisted=drivetrain.bracing_coupling == coupling.name,
            )
    known = ", ".join(coupling.name for coupling in drivetrain.couplings) or "none"
    raise UsageError(f"channel {channel.name!r}: {channel.place!r} is no coupling; there are {known}")


def _shaft_end(rig: Rig, channel: Channel) -> OfShaft:
    """The end that no coupling takes; the start, if both or none are free."""
    drivetrain, system = rig.drivetrain, rig.system
    stations = [
        name for name in system.dofs if name.rpartition("/")[0] == channel.place and name.endswith(" mm")
    ]
    if not stations:
        known = ", ".join(shaft.name for shaft in drivetrain.shafts)
        raise UsageError(f"channel {channel.name!r}: {channel.place!r} is no shaft; there are {known}")
    taken = {
        end
        for coupling in drivetrain.couplings
        for shaft, end in zip(coupling.shafts, coupling.ends)
        if shaft == channel.place
    }
    return OfShaft(row=_turn_row(rig, stations[-1] if taken == {"left"} else stations[0]))


def _twist_row(rig: Rig, coupling: str) -> Array:
    """(n,) twist of a coupling, its first shaft ahead."""
    if rig.shaft_model == "elastic":
        seen = rig.elastic.seen
        return seen.on_freedoms(seen.reduced.model.joint(coupling, "coupling").row("turn"))
    row = np.zeros(len(rig.system.dofs))
    for joint in rig.joints:
        if joint.kind == "coupling" and joint.name == coupling:
            row[joint.dof_a], row[joint.dof_b] = 1.0, -1.0
    return row


def _turn_row(rig: Rig, station: str) -> Array:
    """(n,) turn of a station; shafts that bend are divided at the same ones."""
    if rig.shaft_model == "elastic":
        seen = rig.elastic.seen
        names = np.array(seen.reduced.model.names)
        return seen.on_freedoms(np.asarray(names == f"{station} turn", float))
    return np.asarray(np.array(rig.system.dofs) == station, float)
