"""The power circuit of a case as a drivetrain of the dynamics package."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dynamics.gear.cylindrical_gear import CylindricalGear
from dynamics.gear.pair import GearPair
from dynamics.rotor.graph import Drivetrain
from dynamics.rotor.parts import (
    BearingPlace,
    Coupling,
    DragPlace,
    End,
    GearBody,
    JointStiffness,
    LoadOrder,
    MeshConnection,
    Motor,
)
from dynamics.rotor.shaft import Disc, DrivetrainError, Section, Shaft
from rigdesign.base.errors import CaseError, Fault
from rigdesign.base.part_name import GearName, MeshName
from rigdesign.base.units import show
from rigdesign.case.bearings import BearingInput
from rigdesign.case.drivetrain import CouplingInput, HarmonicTorqueInput
from rigdesign.case.elastic_shafts import disc_mass
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.gears import Gear, Spline
from rigdesign.case.model import Case
from rigdesign.case.rotation import pinion_hand
from rigdesign.properties.materials import Material

ENDS: dict[str, End] = {"start": "left", "end": "right"}
RIGID_SEAT = 1e8
"""Torsional stiffness [N m/rad] of a gear that is rigid with its shaft: far above any spline."""


def build_drivetrain(
    case: Case, pairs: Mapping[MeshName, GearPair], materials: Mapping[str, Material]
) -> Drivetrain:
    """Shafts, gears, couplings, bearings and meshes of the loop; the shafts divided as `resolution.with_elements` says.

    pairs : ``gearbox.mesh`` -> gear pair. Gears are called ``gearbox.gear``, bearings ``gearbox.bearing``,
    seals ``gearbox.seals.name``.

    Raises
    ------
    DrivetrainError
        A part that does not fit its shaft, or a loop that cannot close.
    """
    power = case.power_circuit
    return Drivetrain(
        shafts=tuple(_shaft(name, case, materials) for name in power.shafts),
        gears=tuple(_gear_bodies(case, pairs, materials)),
        meshes=tuple(_meshes(case, pairs)),
        motor=_motor(case),
        couplings=tuple(
            Coupling(
                name=name,
                shafts=coupling.shafts,
                ends=(ENDS[coupling.ends[0]], ENDS[coupling.ends[1]]),
                stiffness=coupling.torsional_stiffness,
                damping=coupling.torsional_damping,
                excitation=(*_load_orders(coupling.excitation), *_cross_joint(coupling)),
                flexibility=_flexibility(coupling),
            )
            for name, coupling in power.couplings.items()
        ),
        bearings=tuple(_bearings(case)),
        drag_places=tuple(_seals(case)),
        bracing_coupling=power.bracing.coupling or next(iter(power.couplings), None),
    )


def _shaft(name: str, case: Case, materials: Mapping[str, Material]) -> Shaft:
    shaft = case.power_circuit.shafts[name]
    material = materials[shaft.material]
    return Shaft(
        name=name,
        sections=tuple(
            Section(
                length=section.length,
                outer_diameter=section.outer_diameter,
                inner_diameter=section.inner_diameter,
            )
            for section in shaft.sections
        ),
        discs=tuple(
            Disc(
                name=disc,
                position=entry.position,
                inertia=entry.inertia,
                mass=entry.mass or disc_mass(entry.inertia),
                diametral_inertia=entry.diametral_inertia,
            )
            for disc, entry in shaft.discs.items()
        ),
        shear_modulus=material.elastic_modulus / (2.0 * (1.0 + material.poisson_ratio)),
        density=material.density,
        poisson_ratio=material.poisson_ratio,
        damping_time=shaft.material_damping / mesh_frequency(case) if shaft.material_damping else 0.0,
    )


def mesh_frequency(case: Case) -> float:
    """Angular frequency [rad/s] at which the teeth of the reference gear mesh at test speed."""
    gear = case.power_circuit.counting_gear
    return case.gearboxes[gear.gearbox].gears[gear.part].teeth * case.schedule.test_speed


def _gear_bodies(
    case: Case, pairs: Mapping[MeshName, GearPair], materials: Mapping[str, Material]
) -> list[GearBody]:
    bodies = []
    for box_name, box in case.gearboxes.items():
        for name, gear in box.gears.items():
            assert gear.seat_position is not None
            bodies.append(
                GearBody(
                    name=f"{box_name}.{name}",
                    shaft=gear.shaft,
                    position=gear.seat_position,
                    offset=gear.seat_offset,
                    inertia=gear_inertia(case, box_name, name, pairs, materials),
                    mass=gear_mass(case, box_name, name, pairs, materials),
                    width=box.carrying_halves(name) * gear.face_width,
                    stiffness=RIGID_SEAT if gear.spline is None else gear.spline.torsional_stiffness,
                    damping=0.0 if gear.spline is None else gear.spline.torsional_damping,
                    loss_factor=0.0 if gear.spline is None else gear.spline.loss_factor,
                    seat=None if gear.spline is None else _seat(gear.spline),
                )
            )
    return bodies


def _seat(spline: Spline) -> JointStiffness | None:
    """What a seat resists besides torsion; None for a gear that only twists against its shaft."""
    if spline.radial_stiffness is None:
        return None
    return _joint(
        (spline.axial_stiffness, spline.radial_stiffness, spline.angular_stiffness),
        spline.lateral_damping_time,
    )


def gear_inertia(
    case: Case, box: str, gear: str, pairs: Mapping[MeshName, GearPair], materials: Mapping[str, Material]
) -> float:
    """Polar inertia of a gear body [kg m2]: as the case states it, else that of bored disc, or rim and web; times its
    factor. Of a gear without a bore that round its section of the shaft, which has its own."""
    gearbox = case.gearboxes[box]
    part = gearbox.gears[gear]
    inertia, bore = part.inertia, _bore(case, part)
    if inertia is None:
        toothing, density = _toothing(gear, box, case, pairs), materials[part.material].density
        halves = gearbox.carrying_halves(gear)
        outer, width = 2.0 * toothing.reference_radius, halves * part.face_width
        inner = bore
        if part.rim_thickness is not None and part.web_thickness is not None:
            inner = max(2.0 * (toothing.root_radius - part.rim_thickness), inner)
        inertia = disc_inertia(outer, inner, width, density)
        if inner > bore:
            web = (part.web_thickness or 0.0) * halves
            inertia += disc_inertia(inner, bore, web, density)
    return part.inertia_factor * inertia


def gear_mass(
    case: Case, box: str, gear: str, pairs: Mapping[MeshName, GearPair], materials: Mapping[str, Material]
) -> float:
    """Mass of a gear body [kg] that goes with its inertia: at the radius of gyration of its bored disc, or rim and
    web."""
    mesh, side = case.gearboxes[box].first_meshes()[gear]
    pair, bore = pairs[MeshName(box, mesh)], _bore(case, case.gearboxes[box].gears[gear])
    per_inertia = pair.masses[side] / pair.inertias[side]
    if bore > pair.bore_diameters[side]:
        per_inertia = 2.0 / (pair.gears[side].reference_radius ** 2 + 0.25 * bore**2)
    return gear_inertia(case, box, gear, pairs, materials) * per_inertia


def _bore(case: Case, part: Gear) -> float:
    """Bore of a gear body [m]; of one cut into its shaft the diameter of the shaft there, where that is stated."""
    shafts = case.power_circuit.shafts
    if part.bore_diameter or part.seat_position is None or not shafts:
        return part.bore_diameter
    section = shafts[part.shaft].section_at(part.seat_position)
    return 0.0 if section is None else section.outer_diameter


def _flexibility(coupling: CouplingInput) -> JointStiffness:
    """What a coupling resists besides torsion."""
    stiffness = coupling.axial_stiffness, coupling.radial_stiffness, coupling.angular_stiffness
    return _joint(stiffness, coupling.lateral_damping_time)


def _joint(stiffness: tuple[float | None, float | None, float | None], time: float) -> JointStiffness:
    """Axial, radial and angular stiffness, with dampers that have a time over them [s]."""
    axial, lateral, angular = (value or 0.0 for value in stiffness)
    return JointStiffness(
        axial=axial, lateral=lateral, angular=angular,
        axial_damping=time * axial, lateral_damping=time * lateral, angular_damping=time * angular,
    )  # fmt: skip


def disc_inertia(outer_diameter: float, bore_diameter: float, width: float, density: float) -> float:
    """Polar inertia of a bored disc, pi rho b (D^4 - d^4) / 32 [kg m2]."""
    return math.pi * density * width * (outer_diameter**4 - bore_diameter**4) / 32.0


def _toothing(gear: str, box: str, case: Case, pairs: Mapping[MeshName, GearPair]) -> CylindricalGear:
    for mesh_name, mesh in case.gearboxes[box].meshes.items():
        for member, name in enumerate((mesh.pinion, mesh.wheel)):
            if name == gear:
                return pairs[MeshName(box, mesh_name)].gears[member]
    raise DrivetrainError(f"gear {box}.{gear} is in no mesh; state its inertia or remove it")


def _meshes(case: Case, pairs: Mapping[MeshName, GearPair]) -> list[MeshConnection]:
    meshes = []
    for name, pair in pairs.items():
        box = case.gearboxes[name.gearbox]
        mesh = box.meshes[name.part]
        meshes.append(
            MeshConnection(
                name=name,
                pinion=GearName(name.gearbox, mesh.pinion),
                wheel=GearName(name.gearbox, mesh.wheel),
                base_radii=pair.base_radii,
                teeth=pair.teeth,
                centre_distance=pair.centre_distance,
                base_helix_angle=pinion_hand(box, name.part) * pair.base_helix_angle,
            )
        )
    return meshes


def _motor(case: Case) -> Motor:
    motor = case.power_circuit.motor
    length = math.fsum(section.length for section in case.power_circuit.shafts[motor.shaft].sections)
    return Motor(
        shaft=motor.shaft,
        position=0.0 if motor.end == "start" else length,
        inertia=motor.inertia,
        ripple=_load_orders(motor.ripple),
    )


def _cross_joint(coupling: CouplingInput) -> Iterator[LoadOrder]:
    """Torque of a cross joint under an angle b between its axes: tan(turn_2) = tan(turn_1) cos(b) holds the second
    shaft back by b^2/4 sin(2 turn_1), to the second power of b, against the torsional stiffness.

    Source: H. C. Seherr-Thoss, F. Schmelz, E. Aucktor, Universal Joints and Driveshafts, 2nd ed. 2006, chapter 1; as an
    excitation by misalignment: M. Xu, R. D. Marangoni, J. Sound Vib. 176, 1994, 663.
    """
    squared = coupling.cold_angle_lateral**2 + coupling.cold_angle_vertical**2
    if coupling.alternates and squared:
        yield LoadOrder(
            order=2.0, amplitude=0.25 * squared * coupling.torsional_stiffness, phase=0.5 * math.pi
        )


def _load_orders(torques: Sequence[HarmonicTorqueInput]) -> tuple[LoadOrder, ...]:
    return tuple(
        LoadOrder(order=torque.order, amplitude=torque.torque, phase=torque.phase) for torque in torques
    )


def _bearings(case: Case) -> list[BearingPlace]:
    """Constant drag enters the damping matrix; the drag of a computed film acts as a load."""
    constant = case.losses.bearing_drag == "constant"
    bearings = []
    for box_name, box in case.gearboxes.items():
        for name, bearing in box.bearings.items():
            assert bearing.position is not None
            bearings.append(
                BearingPlace(
                    name=f"{box_name}.{name}",
                    shaft=bearing.shaft,
                    position=bearing.position,
                    linear_drag=_constant_drag(box, bearing) if constant else 0.0,
                )
            )
    return bearings


def _constant_drag(box: Gearbox, bearing: BearingInput) -> float:
    """Drag torque over speed [N m s] that the case states, times its factors."""
    return box.loss_factors.bearing * bearing.friction_factor * (bearing.torsional_damping or 0.0)


def _seals(case: Case) -> list[DragPlace]:
    """All seals of a shaft brake halfway between its bearings."""
    places = []
    for box_name, box in case.gearboxes.items():
        for name, seals in box.seals.items():
            stations = [b.position for b in box.bearings.values() if b.shaft == seals.shaft]
            middle = math.fsum(position or 0.0 for position in stations) / len(stations)
            places.append(DragPlace(name=f"{box_name}.seals.{name}", shaft=seals.shaft, position=middle))
    return places


# Tooth force of every mesh per tooth force of the mesh whose torque the case states, without losses.

Array = NDArray[np.float64]


def loop_forces(case: Case, pairs: Mapping[MeshName, GearPair], lines: Mapping[str, int]) -> dict[str, float]:
    """Signed force of each mesh ``gearbox.mesh`` of the closed loop for the force 1 in the first one.

    Positive where the pinion drives its wheel. Every shaft line is in balance: what one mesh gives it, the others
    take. Round one loop all forces are equal; an idler is driven by one neighbour and drives the other. Several
    loops side by side share the load as equal meshes would (least sum of squares).

    lines : shaft -> line of the drivetrain

    Raises
    ------
    CaseError
        The first mesh is in no loop: nothing can be locked into it.
    """
    forces = _forces(_balance(case, pairs, lines))
    if forces is None:
        joined = (
            "; ".join(
                f"{name}: {', '.join(one.shafts)}" for name, one in case.power_circuit.couplings.items()
            )
            if case.drivetrain
            else "none"
        )
        fault = Fault(
            "drivetrain.couplings", joined,
            f"leaves mesh {next(iter(pairs))}, where drivetrain.torque_at counts, in no closed loop: nothing holds a "
            "torque in it",
            "close the loop through a second gearbox or let torque_at name a gear of the loop",
        )  # fmt: skip
        raise CaseError([fault], f"case {case.name}")
    return dict(zip(pairs, map(float, forces)))


def gearbox_forces(case: Case, pairs: Mapping[MeshName, GearPair]) -> dict[str, float]:
    """The same for gearboxes without a drivetrain: force 1 in the first mesh of each, its idlers in balance."""
    found: dict[str, float] = {}
    for box in case.gearboxes:
        own = {name: pair for name, pair in pairs.items() if name.gearbox == box}
        shafts = {gear.shaft: i for i, gear in enumerate(case.gearboxes[box].gears.values())}
        rows = _balance(case, own, shafts)
        forces = _forces(rows[np.count_nonzero(rows, axis=1) > 1])
        found |= dict(zip(own, [1.0] * len(own) if forces is None else map(float, forces)))
    return {name: found[name] for name in pairs}


def _balance(case: Case, pairs: Mapping[MeshName, GearPair], lines: Mapping[str, int]) -> Array:
    """(n_lines, n_meshes) torque on each line per force in each mesh [m]."""
    rows = np.zeros((max(lines.values()) + 1, len(pairs)))
    for index, (name, pair) in enumerate(pairs.items()):
        box = case.gearboxes[name.gearbox]
        mesh = box.meshes[name.part]
        rows[lines[box.gears[mesh.pinion].shaft], index] += pair.base_radii[0]
        rows[lines[box.gears[mesh.wheel].shaft], index] -= pair.base_radii[1]
    return rows


def _forces(rows: Array) -> Array | None:
    """Forces of least squares with ``rows @ forces = 0`` and 1 in the first mesh; None if that one must be 0."""
    free = np.eye(rows.shape[1]) - np.linalg.pinv(rows) @ rows
    return None if free[0, 0] < 1e-9 else np.asarray(free[:, 0] / free[0, 0])


# Torsion of the shafts under the torques a case asks for: where the elastic model of them ends.
#
# Round a loop every mesh carries the same tooth force, so a shaft line carries force times base radius between its
# gears, and what the motor gives between the motor and the first gear. Static torques; vibration comes on top.

LARGEST_STRAIN = 0.015
"""Shear strain at the surface beyond which no steel stays elastic (1200 MPa)."""
DOUBTFUL_STRAIN = 0.005
"""Shear strain at which heat-treated shaft steel begins to yield (400 MPa)."""


@dataclass(frozen=True, kw_only=True)
class SectionTorsion:
    """Static torsion of one section of a shaft: torque [N m] and shear strain at its surface [-]."""

    path: str
    """Case path of its outer diameter."""
    outer_diameter: float
    torque: float
    strain: float

    @property
    def finding(self) -> str:
        """What there is to say of a doubtful section; empty for a sound one."""
        if self.strain <= DOUBTFUL_STRAIN:
            return ""
        return (
            f"{self.path} = {show(self.outer_diameter, 'length')}: shear strain {100.0 * self.strain:.2g} % under "
            f"{self.torque:.3g} N m, limit {100.0 * DOUBTFUL_STRAIN:g} %, where shaft steel begins to yield; "
            "enlarge the section or lower the torque"
        )


def section_torsions(
    drivetrain: Drivetrain, tooth_force: float, motor_torque: float
) -> tuple[SectionTorsion, ...]:
    """Torsion of every section that carries torque.

    tooth_force : force along the transverse line of action in every mesh [N]
    motor_torque : largest torque of the motor [N m]
    """
    found: list[SectionTorsion] = []
    for shaft in drivetrain.shafts:
        spans = [
            (_loop_span(drivetrain, shaft), tooth_force * _largest_radius(drivetrain, shaft.name)),
            (_motor_span(drivetrain, shaft), motor_torque),
        ]
        start = 0.0
        for index, section in enumerate(shaft.sections):
            end = start + section.length
            torque = max((t for (low, high), t in spans if start < high and low < end), default=0.0)
            radius = 0.5 * section.outer_diameter
            if torque > 0.0:
                found.append(
                    SectionTorsion(
                        path=f"drivetrain.shafts.{shaft.name}.sections.{index}.outer_diameter",
                        outer_diameter=section.outer_diameter,
                        torque=torque,
                        strain=torque * radius / (shaft.shear_modulus * section.polar_moment),
                    )
                )
            start = end
    return tuple(found)


def refuse_broken_shafts(torsions: tuple[SectionTorsion, ...], source: str) -> None:
    """Raise CaseError for every section that no steel would carry."""
    faults = [
        Fault(
            torsion.path,
            show(torsion.outer_diameter, "length"),
            f"its shear strain is {100.0 * torsion.strain:.2g} % under {torsion.torque:.3g} N m, limit "
            f"{100.0 * LARGEST_STRAIN:g} %: no steel stays elastic there",
            "enlarge the section, or lower test torque or motor torque",
        )
        for torsion in torsions
        if torsion.strain > LARGEST_STRAIN
    ]
    if faults:
        raise CaseError(faults, source)


def _loop_span(drivetrain: Drivetrain, shaft: Shaft) -> tuple[float, float]:
    """Part of a shaft between the gears of its line [m]: torque goes on through couplings with gears beyond."""
    points = [gear.position for gear in drivetrain.gears if gear.shaft == shaft.name]
    points += _coupled_ends(drivetrain, shaft, with_gears=True)
    return (min(points), max(points)) if points else (0.0, 0.0)


def _motor_span(drivetrain: Drivetrain, shaft: Shaft) -> tuple[float, float]:
    """Part of the motor's shaft between the motor and what it drives [m]."""
    motor = drivetrain.motor
    points = [gear.position for gear in drivetrain.gears if gear.shaft == shaft.name]
    points += _coupled_ends(drivetrain, shaft, with_gears=False)
    if motor.shaft != shaft.name or not points:
        return 0.0, 0.0
    driven = min(points, key=lambda point: abs(point - motor.position))
    return min(driven, motor.position), max(driven, motor.position)


def _coupled_ends(drivetrain: Drivetrain, shaft: Shaft, *, with_gears: bool) -> Iterator[float]:
    """Ends of a shaft that a coupling joins to others; only those with a gear beyond, if asked."""
    for coupling in drivetrain.couplings:
        for here, end, there in zip(coupling.shafts, coupling.ends, coupling.shafts[::-1]):
            if here == shaft.name and not (with_gears and not _gear_beyond(drivetrain, there, {here})):
                yield 0.0 if end == "left" else shaft.length


def _gear_beyond(drivetrain: Drivetrain, shaft: str, seen: set[str]) -> bool:
    """Whether a gear sits on a shaft or on those joined to it, the seen ones left out."""
    if any(gear.shaft == shaft for gear in drivetrain.gears):
        return True
    others = {name for c in drivetrain.couplings if shaft in c.shafts for name in c.shafts} - seen - {shaft}
    return any(_gear_beyond(drivetrain, other, seen | {shaft}) for other in sorted(others))


def _largest_radius(drivetrain: Drivetrain, shaft: str) -> float:
    """Largest base radius of the gears on the line of a shaft [m]."""
    lines = drivetrain.lines()
    radii = (
        radius
        for mesh in drivetrain.meshes
        for gear, radius in zip((mesh.pinion, mesh.wheel), mesh.base_radii)
        if lines[drivetrain.gear(gear).shaft] == lines[shaft]
    )
    return max(radii, default=0.0)
