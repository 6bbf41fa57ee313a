"""Forces on the bearings from teeth and weight: radial by the lever rule, axial to the locating bearing."""

import math
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product
from weakref import ReferenceType, ref

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.bearing import Bearing, BearingOperation, BearingState, OilSupply
from dynamics.rotor.rolling_stiffness import force_on_first, pair_axial_loads
from rigdesign.base.errors import named
from rigdesign.base.part_name import BearingName, MeshName
from rigdesign.case.bearings import BearingInput
from rigdesign.case.gearbox import Gearbox, injected_flow
from rigdesign.case.rolling_bearing import BearingPlace
from rigdesign.case.rotation import has_hands, helix_hands, pinion_hand
from rigdesign.coupling.bearing_seats import HOUSING, SHAFT, bearing_seats, seats_of
from rigdesign.coupling.flank_heat import splash_to_bearing
from rigdesign.coupling.located_loss import given_power
from rigdesign.coupling.misalignment import coupling_forces
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import OilFeed, bearing_feed

# Mean forces on the shafts of a rig: teeth with the hand of their helix, weight of shafts, discs and gears, couplings
# out of line.
#
# In the frame of the rig (`rigdesign.rig.shaft_axes`): x along the shafts, y across, z up.

Array = NDArray[np.float64]

GRAVITY = 9.80665
"""Standard acceleration of fall [m/s2]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class ShaftLoad:
    """A force on a shaft.

    position : along the shaft [m]; None where the case states none
    force : (2,) in the plane (y, z) [N]
    axial : along x [N]; arm : (2,) from the axis to where the axial force acts [m]
    gear : whose teeth press, None for a weight
    sure : False where the case states no hand: ``axial`` is that of a right-hand pinion, its sign is open
    """

    position: float | None
    force: Array
    axial: float
    arm: Array
    gear: str | None = None
    sure: bool = True


def shaft_loads(rig: Rig, name: str, shaft: str, coupling_state: CouplingState) -> list[ShaftLoad]:
    """Loads on a shaft of the gearbox ``name`` under the mean torques of a coupling state."""
    box = rig.case.gearboxes[name]
    teeth = [
        tooth_load(rig, MeshName(name, mesh), gear, coupling_state)
        for mesh, entry in box.meshes.items()
        for gear in (entry.pinion, entry.wheel)
        if box.gears[gear].shaft == shaft
    ]
    couplings = [
        ShaftLoad(position=place, force=force, axial=0.0, arm=np.zeros(2))
        for place, force in coupling_forces(rig, shaft, coupling_state)
    ]
    return [*_weights(rig, name, shaft), *teeth, *couplings]


def tooth_load(rig: Rig, mesh: MeshName, gear: str, coupling_state: CouplingState) -> ShaftLoad:
    """Mean force of the teeth of a mesh on one of its gears, by its own name.

    The pinion of hand h that turns in the sense sigma about x presses its wheel with its front flanks along
    -h sigma tan(beta_b) times the transverse force; with its back flanks the other way.
    """
    box, own = rig.mesh(mesh)
    entry, pair, torque = box.meshes[own], rig.pairs[mesh], coupling_state.mesh_torque[mesh]
    side = 0 if gear == entry.pinion else 1
    line = rig.line_of_action(mesh)
    transverse = abs(torque) / pair.base_radii[0]
    normal = line.normal(pair.working_pressure_angle, math.copysign(1.0, torque))
    onto = (-1.0, 1.0)[side]  # what presses the wheel presses the pinion back
    sense = rig.axes[box.gears[entry.pinion].shaft].sense
    axial = -pinion_hand(box, own) * sense * math.tan(pair.base_helix_angle) * torque / pair.base_radii[0]
    return ShaftLoad(
        position=box.gears[gear].position,
        force=onto * transverse * normal,
        axial=onto * axial,
        arm=-onto * pair.working_radii[side] * line.centres,
        gear=gear,
        sure=not has_hands(entry) or entry.pinion in helix_hands(box),
    )


def _weights(rig: Rig, name: str, shaft: str) -> Iterator[ShaftLoad]:
    """Weight of the shaft, of its discs and of its gears; of the bodies that the dynamics have where it has any."""
    drivetrain = rig.drivetrain
    box = rig.case.gearboxes[name]
    for gear, (mesh, side) in box.first_meshes().items():
        if box.gears[gear].shaft == shaft:
            mass = (
                box.halves(gear) * rig.pairs[MeshName(name, mesh)].masses[side]
                if rig.case.drivetrain is None
                else drivetrain.gear(f"{name}.{gear}").mass
            )
            yield _weight(box.gears[gear].position, mass)
    if shaft not in (one.name for one in drivetrain.shafts):
        return
    part = drivetrain.shaft(shaft)
    start = 0.0
    for section in part.sections:
        area = 0.25 * math.pi * (section.outer_diameter**2 - section.inner_diameter**2)
        yield _weight(start + 0.5 * section.length, part.density * area * section.length)
        start += section.length
    for disc in part.discs:
        yield _weight(disc.position, disc.mass)


def _weight(position: float | None, mass: float) -> ShaftLoad:
    return ShaftLoad(position=position, force=np.array([0.0, -GRAVITY * mass]), axial=0.0, arm=np.zeros(2))


@dataclass(frozen=True, kw_only=True)
class BearingLoad:
    """Radial force and axial force inside the bearing for its rating [N], not negative, and the force as a vector.

    force : of the shaft on the bearing in the plane (y, z) [N]. Its size is ``radial`` unless the case states the
        radial load, or leaves the hand of helical teeth open: then ``radial`` is the largest that either hand makes
        and ``force`` that of a right-hand pinion.
    axial_sense : 1 where the shaft presses the bearing towards +x, else -1
    """

    radial: float
    axial: float = 0.0
    axial_sense: float = 1.0
    force: tuple[float, float] = (0.0, 0.0)


_MET: deque[tuple[ReferenceType[Rig], ReferenceType[CouplingState], dict[str, BearingLoad]]] = deque(maxlen=8)
"""Loads found last: bearings, their stiffness and the places of the gears ask for those of one state in turn."""


def bearing_loads(rig: Rig, coupling_state: CouplingState) -> dict[str, BearingLoad]:
    """As `solved_bearing_loads`; those of a state that was asked for just before are not found again."""
    for of_rig, of_state, known in _MET:
        if of_rig() is rig and of_state() is coupling_state:
            return dict(known)
    found = solved_bearing_loads(rig, coupling_state)
    _MET.append((ref(rig), ref(coupling_state), found))
    return dict(found)


def solved_bearing_loads(rig: Rig, coupling_state: CouplingState) -> dict[str, BearingLoad]:
    """Load of every bearing: tooth forces and weight by the lever rule on its shaft, axial forces to what locates it.

    Forces add as vectors where the axes stand (`rigdesign.rig.shaft_axes`): at an idler between two wheels the
    tangential forces add and the separating ones cancel. Axial forces of a double-helical gear cancel. Those of the
    single-helical gears of a shaft go to its locating bearing, the first where none is; their tilting moment F_a r is
    carried by both bearings of the shaft as a couple over their distance; it is left out where the case does not state
    both positions (`Gearbox.bearing_positions`).

    Where the radial load of a bearing induces an axial force, its partner takes that up as well (`pair_axial_loads`).
    The axial force of the gears presses the one that their hand and the stated arrangement say; where the case leaves
    either open, the locating one, which is on the safe side for it.
    """
    loads: dict[BearingName, BearingLoad] = {}
    for name, box in rig.case.gearboxes.items():
        for shaft in dict.fromkeys(entry.shaft for entry in box.bearings.values()):
            acting = shaft_loads(rig, name, shaft, coupling_state)
            own = {
                BearingName(name, part): _radial_load(rig, box, entry, acting)
                for part, entry in box.bearings.items()
                if entry.shaft == shaft
            }
            loads |= own | _axial_loads(rig, name, own, acting)
    return {name: loads[name] for name, _, _ in rig.bearings()}


def axial_force(acting: Sequence[ShaftLoad]) -> float:
    """Size of the axial force of the gears of a shaft [N]; gears of open hand push the same way as the others."""
    sure = math.fsum(load.axial for load in acting if load.sure)
    either = (abs(math.fsum(load.axial for load in loads)) for loads in _open_hands(acting))
    return abs(sure) + math.fsum(either)


def _radial_load(rig: Rig, box: Gearbox, entry: BearingInput, acting: Sequence[ShaftLoad]) -> BearingLoad:
    """Without the axial force."""
    sure = np.zeros(2)
    for load in acting:
        sure += _lever(box, entry, load.position) * load.force
        if load.sure:
            sure += _couple(rig, box, entry, load)
    either = [
        sum((_couple(rig, box, entry, load) for load in loads), np.zeros(2)) for loads in _open_hands(acting)
    ]
    force = sure + sum(either, np.zeros(2))
    if entry.radial_load is not None:
        return _stated(entry.radial_load, force)
    largest = max(
        float(np.hypot(*(sure + sum(sign * couple for sign, couple in zip(signs, either)))))
        for signs in product((1.0, -1.0), repeat=len(either))
    )
    return BearingLoad(radial=largest, force=(float(force[0]), float(force[1])))


def _stated(radial: float, force: Array) -> BearingLoad:
    """A radial load that the case states, in the direction of the computed force; downwards without one."""
    size = float(np.hypot(*force))
    y, z = force / size if size > 0.0 else (0.0, -1.0)
    return BearingLoad(radial=radial, force=(radial * float(y), radial * float(z)))


def _open_hands(acting: Sequence[ShaftLoad]) -> list[list[ShaftLoad]]:
    """Loads of every gear whose hand is open: they change sign together."""
    found: dict[str, list[ShaftLoad]] = {}
    for load in acting:
        if load.gear is not None and not load.sure:
            found.setdefault(load.gear, []).append(load)
    return list(found.values())


def _axial_loads(
    rig: Rig, name: str, loads: dict[BearingName, BearingLoad], acting: Sequence[ShaftLoad]
) -> dict[BearingName, BearingLoad]:
    """Loads of the bearings of a shaft that carry axial force."""
    box = rig.case.gearboxes[name]
    entries = {full: box.bearings[full.part] for full in loads}
    locating = next((full for full in loads if entries[full].locating), next(iter(loads)))
    induced = {full: entries[full].induced_axial_load(loads[full].radial) for full in loads}
    signed = math.fsum(load.axial for load in acting)
    axial = {locating: axial_force(acting)}
    senses = {full: math.copysign(1.0, signed) for full in loads}
    if len(loads) == 2 and max(induced.values()) > 0.0:
        front, rear = sorted(loads, key=lambda full: _place(rig, entries[full]))
        stated = next((entry.arrangement for entry in entries.values() if entry.arrangement), None)
        senses = dict(zip((front, rear), (1.0, -1.0) if stated == "back_to_back" else (-1.0, 1.0)))
        if stated is not None and all(load.sure for load in acting):
            pair, force = (front, rear), force_on_first(stated, signed)
        else:
            pair, force = (locating, rear if locating == front else front), axial_force(acting)
        axial = dict(zip(pair, pair_axial_loads((induced[pair[0]], induced[pair[1]]), force), strict=True))
    return {
        full: replace(loads[full], axial=force, axial_sense=senses[full])
        for full, force in axial.items()
        if force > 0.0 and not entries[full].has_film  # a thrust face carries it, not the film
    }


def _place(rig: Rig, entry: BearingInput) -> float:
    """x of a bearing; of one without a stated position the end of the housing it sits in."""
    if entry.position is None:
        return 0.0 if entry.side == "front" else 1.0
    return rig.axes[entry.shaft].place(entry.position)


def _couple(rig: Rig, box: Gearbox, entry: BearingInput, load: ShaftLoad) -> Array:
    """(2,) force on one of two bearings by the tilting moment of an axial force; none where positions are missing."""
    stations = box.bearing_positions(entry.shaft)
    if stations is None or entry.position is None:
        return np.zeros(2)
    beyond = rig.axes[entry.shaft].direction * (sum(stations) - 2.0 * entry.position)
    return np.asarray(load.axial / beyond * load.arm)


def _lever(box: Gearbox, entry: BearingInput, position: float | None) -> float:
    """Share of a force at a position that one of the two bearings of a shaft carries; negative beyond the other one."""
    stations = box.bearing_positions(entry.shaft)
    if stations is None or entry.position is None or position is None:
        return 1.0 / sum(bearing.shaft == entry.shaft for bearing in box.bearings.values())
    other = sum(stations) - entry.position
    return (other - position) / (other - entry.position)


# Bearings at one operating point: what they carry and what heats their oil.


def solve_bearing(bearing: Bearing, operation: BearingOperation) -> BearingState:
    """State of one bearing, whatever its kind."""
    return bearing.operating_state(operation)


def solve_bearings(
    rig: Rig,
    point: OperatingPoint,
    coupling_state: CouplingState,
    solve: Callable[[Bearing, BearingOperation], BearingState] = solve_bearing,
) -> dict[str, BearingState]:
    """State of every bearing by ``gearbox.bearing``.

    solve : of one bearing; one with memoisation may take its place

    A loss that the case prescribes heats the oil in place of the friction the bearing would make.

    Raises
    ------
    BearingError
        A hot clearance that is used up.
    BearingNotConvergedError
        No oil temperature balances friction and oil flow.
    """
    states: dict[str, BearingState] = {}
    loads = bearing_loads(rig, coupling_state)
    for name, box, entry in rig.bearings():
        feed = _supply(rig, name.gearbox, point, coupling_state)
        seats = seats_of(name, coupling_state)
        if seats == (None, None) and feed.flow == 0.0:
            seats = None, feed.inlet  # stands in oil that nothing moves: all round it is as warm as that
        with named(f"gearboxes.{name.gearbox}.bearings.{name.part}"):
            bearing = entry.as_it_runs(_surroundings(rig, name, coupling_state.bearing_clearance[name]))
            operation = BearingOperation(
                load=loads[name].radial,
                axial_load=loads[name].axial,
                speed=rig.shaft_speed(entry.shaft, point.speed),
                oil=OilSupply(
                    inlet_temperature=feed.inlet,
                    flow=feed.flow,
                    viscosity=feed.oil.dynamic_viscosity,
                    density=feed.oil.density(feed.inlet),
                    heat_capacity=feed.oil.heat_capacity(feed.inlet),
                ),
                heat_from_bodies=coupling_state.bearing_heat[name] if entry.has_film else 0.0,
                friction_heat=_imposed_heat(rig, name, entry, point),
                friction_factor=box.loss_factors.bearing * entry.friction_factor,
                shaft_temperature=seats[0],
                housing_temperature=seats[1],
            )
            states[name] = solve(bearing, operation)
    return states


def _surroundings(rig: Rig, name: BearingName, clearance: float) -> BearingPlace:
    """What the gearbox makes of the place of a bearing."""
    box = rig.case.gearboxes[name.gearbox]
    factors = {seat: found.factor for seat, found in bearing_seats(rig, name).items()}
    return BearingPlace(
        clearance=clearance,
        lubrication=box.bearing_oil,
        sump_level=None if box.sump is None else box.sump.level,
        seat_factors=(factors.get(SHAFT, 1.0), factors.get(HOUSING, 1.0)),
    )


def _supply(rig: Rig, box_name: str, point: OperatingPoint, coupling_state: CouplingState) -> OilFeed:
    """Oil that passes each bearing of a gearbox: fed, a share of what the gears lift or the jets inject, or none."""
    box, chamber = rig.case.gearboxes[box_name], coupling_state.oil_outlet[f"{box_name}.gear_oil"]
    feed = bearing_feed(rig, box_name, chamber, coupling_state.oil_supply)
    share = box.splash_share
    if share == 0.0:
        return feed
    if box.sump is not None:
        return replace(feed, flow=splash_to_bearing(rig, box_name, box.sump, point, chamber, share))
    return replace(feed, flow=share * injected_flow(box) * len(box.meshes))


def _imposed_heat(rig: Rig, name: BearingName, entry: BearingInput, point: OperatingPoint) -> float | None:
    """Friction heat that the case prescribes for a film [W]; None where the film makes its own."""
    given = given_power(rig.case, point, name.gearbox, "bearing", name.part)
    if given is not None:
        return given
    return 0.0 if rig.case.losses.basis == "input" else constant_drag(rig, name.gearbox, entry, point)


def constant_drag(rig: Rig, box: str, entry: BearingInput, point: OperatingPoint) -> float | None:
    """Power of a bearing whose drag the case states as constant damping [W]; None where the film decides."""
    if rig.case.losses.bearing_drag == "film" or entry.torsional_damping is None:
        return None
    factor = rig.case.gearboxes[box].loss_factors.bearing * entry.friction_factor
    return factor * entry.torsional_damping * rig.shaft_speed(entry.shaft, point.speed) ** 2
