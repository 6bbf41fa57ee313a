"""The power circuit of a case in six degrees of freedom: shafts that bend, bearings on their supports, axial locations.

The reduced rig is made once: one basis for all speeds, stages and iterations, whatever the bearings do.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.gear.pair import GearPair
from dynamics.rating.iso_rating import RatingOptions, mesh_stiffness
from dynamics.rotor.assembly import ElasticModel, assemble_rig
from dynamics.rotor.bearing_state import BearingCoefficients, isotropic_bearing
from dynamics.rotor.craig_bampton import SeenRig, mesh_ports
from dynamics.rotor.graph import Drivetrain
from dynamics.rotor.parts import speed_ratios
from dynamics.rotor.reduction import ReducedElasticRig, port_rows_of, reduce_rig
from dynamics.rotor.rotor_model import (
    AxialLocation,
    AxialMeshSpring,
    AxisMisalignment,
    BalanceGrade,
    CrossJoint,
    ElasticRig,
    FlangeRunOut,
    HousingSupport,
    RotatingPart,
    ShaftBow,
    ShaftPlacement,
    ShaftUnbalance,
    Sign,
    double_helical_stiffness,
    isotropic_support,
    residual_unbalances,
)
from rigdesign.base.part_name import MeshName
from rigdesign.case.drivetrain import BowInput, ShaftInput
from rigdesign.case.elastic_shafts import AXIAL_STIFFNESS, BALANCE_GRADE
from rigdesign.case.model import Case
from rigdesign.case.rolling_bearing import ROLLING_DAMPING_TIME
from rigdesign.properties.materials import Material
from rigdesign.rig.shaft_axes import ShaftAxis

Array = NDArray[np.float64]
Face = Literal["front", "back"]

REFERENCE_STIFFNESS = 1e8
"""Of every bearing in the state whose modes span the reduced rig [N/m]; any other stiffness is exact at rest."""
SLOW = 8e3
"""Highest mode of the rig that is reduced for lateral vibration [Hz]: with static shapes of all ports the prototype's
modes up to 1 kHz and orbits are those of the rig with modes up to 50 kHz within 1e-4."""
NOMINAL_TORQUE = 100.0
"""Torque at which the axial spring of a double-helical mesh takes its stiffness [N m]."""


@dataclass(frozen=True)
class ElasticDrivetrain:
    """The elastic rig of a case and what of it is seen from outside.

    faces : flank of the pinion that carries in each mesh; cutoff : highest mode that is kept [Hz]
    pressed : bearings, ``gearbox.bearing``, whose rolling elements locate their shaft (`pressed_bearings`)
    basis : this rig in the modes of one that differs in loads of its shafts alone; None: in its own modes
    """

    rig: ElasticRig
    faces: Mapping[str, Face]
    cutoff: float
    pressed: frozenset[str] = frozenset()
    basis: ReducedElasticRig | None = None

    @cached_property
    def model(self) -> ElasticModel:
        """All freedoms, without bearings and meshes."""
        return assemble_rig(self.rig) if self.basis is None else self.basis.model

    @cached_property
    def reduced(self) -> ReducedElasticRig:
        """Modes up to the cutoff with static shapes of all ports."""
        return self.basis or self._reduced(self.cutoff)

    @cached_property
    def slow(self) -> ReducedElasticRig:
        """The same with modes up to `SLOW` only: for what happens at the speed of the shafts."""
        return self.reduced if self.cutoff <= SLOW else self._reduced(SLOW)

    def with_basis_of(self, other: "ElasticDrivetrain") -> "ElasticDrivetrain":
        """This rig in the modes of one that differs in what turns with its shafts and in how its axes stand, no more;
        in its own where that gives the shafts other nodes."""
        if self.model.names != other.model.names:
            return self
        return replace(self, basis=replace(other.reduced, model=self.model))

    def _reduced(self, cutoff: float) -> ReducedElasticRig:
        reference = {
            bearing.name: _reference(bearing.name in self.pressed) for bearing in self.rig.drivetrain.bearings
        }
        rows = np.vstack([port_rows_of(self.model), *self.port_rows.values()])
        return reduce_rig(self.model, reference, cutoff, rows)

    @cached_property
    def seen(self) -> SeenRig:
        """The reduced rig as the meshes, the drive and the couplings see it."""
        return SeenRig(reduced=self.reduced, ports=self.port_rows)

    @cached_property
    def weight(self) -> Array:
        """(n,) gravity on the coordinates of the reduced rig [N, N m]."""
        return self.reduced.rows(self.model.weight())

    @cached_property
    def lateral_rows(self) -> dict[str, Array]:
        """(4, n) y, z and their slopes over x of every gear, by ``gearbox.gear``, on the same coordinates."""
        signs = np.array([[1.0], [1.0], [1.0], [-1.0]])
        return {
            gear.name: self.reduced.rows(self.model.rows(gear.name)[[1, 2, 5, 4]]) * signs
            for gear in self.rig.drivetrain.gears
        }

    @cached_property
    def turn_rows(self) -> dict[str, Array]:
        """(2, n) `port_rows` on the same coordinates."""
        return {mesh: self.reduced.rows(rows) for mesh, rows in self.port_rows.items()}

    @cached_property
    def port_rows(self) -> dict[str, Array]:
        """(2, n) turns of pinion and wheel as each mesh sees them on the flanks that carry, by mesh."""
        return {
            mesh.name: mesh_ports(self.model, mesh.name, self.faces[mesh.name])
            for mesh in self.rig.drivetrain.meshes
        }


def elastic_rig(
    case: Case,
    drivetrain: Drivetrain,
    axes: Mapping[str, ShaftAxis],
    pairs: Mapping[MeshName, GearPair],
    materials: Mapping[str, Material],
    housings: Sequence[HousingSupport] = (),
) -> ElasticRig:
    """Shafts at their axes, bearings on their supports, what locates them axially and what shakes them.

    housings : condensed to the seats of their bearings, of the gearboxes whose case says so

    Raises DrivetrainError for parts that contradict each other.
    """
    return ElasticRig(
        drivetrain=drivetrain,
        placements=tuple(_placement(shaft.name, axes[shaft.name]) for shaft in drivetrain.shafts),
        supports=(*_supports(case), *housings),
        axial_locations=tuple(_locations(case)),
        axial_mesh_springs=tuple(_double_helical(case, pairs)),
        axially_locating=tuple(pressed_bearings(case)),
        rotating=tuple(rotating_parts(case, drivetrain, materials)),
        misalignments=tuple(misalignments(case)),
        cross_joints=tuple(cross_joints(case)),
    )


def pressed_bearings(case: Case) -> Iterator[str]:
    """Bearings on shafts that contact angles hold: pressed against each other, they have an axial stiffness."""
    if case.power_circuit.bearing_coefficients == "stated":
        return
    for box_name, box in case.gearboxes.items():
        angled = {entry.shaft for entry in box.bearings.values() if entry.induced_axial_load(1.0) > 0.0}
        yield from (f"{box_name}.{name}" for name, entry in box.bearings.items() if entry.shaft in angled)


def _reference(pressed: bool) -> BearingCoefficients:
    """Bearing of the state whose modes span the reduced rig."""
    if not pressed:
        return isotropic_bearing(REFERENCE_STIFFNESS)
    axially = np.diag([REFERENCE_STIFFNESS] * 3 + [0.0, 0.0])
    return BearingCoefficients(stiffness=axially, damping=np.zeros((5, 5)))


def _placement(name: str, axis: ShaftAxis) -> ShaftPlacement:
    return ShaftPlacement(
        shaft=name,
        y=axis.lateral,
        z=axis.vertical,
        sense=_sign(axis.sense),
        start=axis.start,
        direction=_sign(axis.direction),
    )


def _sign(value: float) -> Sign:
    return 1 if value > 0.0 else -1


def _supports(case: Case) -> Iterator[HousingSupport]:
    for box_name, box in case.gearboxes.items():
        for name, bearing in box.bearings.items():
            if bearing.support_stiffness is not None:
                yield isotropic_support(
                    f"{box_name}.{name}",
                    bearing.support_stiffness,
                    bearing.support_mass,
                    bearing.support_damping,
                )


def _locations(case: Case) -> Iterator[AxialLocation]:
    pressed = set(pressed_bearings(case))
    for box_name, box in case.gearboxes.items():
        for name, bearing in box.bearings.items():
            if bearing.locating and f"{box_name}.{name}" not in pressed:
                stiffness = bearing.axial_stiffness or AXIAL_STIFFNESS
                yield AxialLocation(
                    bearing=f"{box_name}.{name}",
                    stiffness=stiffness,
                    damping=ROLLING_DAMPING_TIME * stiffness,
                )


def _double_helical(case: Case, pairs: Mapping[MeshName, GearPair]) -> Iterator[AxialMeshSpring]:
    for name, pair in pairs.items():
        mesh = case.gearboxes[name.gearbox].meshes[name.part]
        if mesh.double_helical and pair.helix_angle:
            half = mesh_stiffness(pair, NOMINAL_TORQUE / mesh.sharing, RatingOptions())
            stiffness = mesh.sharing * pair.face_width * half
            yield AxialMeshSpring(
                mesh=name, stiffness=double_helical_stiffness(stiffness, pair.base_helix_angle)
            )


# What shakes the shafts of a case once a turn, and couplings out of line, as parts of the elastic rig.

MM_PER_S = 1e-3
"""Unit of a balance grade [m/s]."""


def rotating_parts(
    case: Case, drivetrain: Drivetrain, materials: Mapping[str, Material]
) -> Iterator[RotatingPart]:
    """Unbalances as stated or by grade, bows, run-out of flanges.

    Raises DrivetrainError for parts that do not fit the drivetrain.
    """
    power = case.power_circuit
    highest = highest_speeds(case, drivetrain)
    for name, shaft in power.shafts.items():
        for own in shaft.unbalances.values():
            yield ShaftUnbalance(shaft=name, position=own.position, moment=own.unbalance, angle=own.angle)
        grade = grade_of(case, shaft)
        speed = shaft.balance_speed or highest[name]
        if grade and speed:
            yield from residual_unbalances(
                drivetrain,
                name,
                BalanceGrade(grade=MM_PER_S * grade, speed=speed, angles=shaft.balance_angles),
            )
        if shaft.bow is not None:
            yield _bow(name, shaft.bow, drivetrain, materials[shaft.material])
    for name, coupling in power.couplings.items():
        if coupling.flange_run_out or coupling.flange_tilt:
            yield FlangeRunOut(
                coupling=name,
                offset=coupling.flange_run_out,
                offset_angle=coupling.flange_run_out_angle,
                tilt=coupling.flange_tilt,
                tilt_angle=coupling.flange_tilt_angle,
            )


def without_residual_unbalance(case: Case) -> Case:
    """The case with the unbalances that it states alone: what a balance grade leaves turns at angles nobody knows."""
    power = case.power_circuit
    shafts = {name: shaft.model_copy(update={"balance_grade": None}) for name, shaft in power.shafts.items()}
    return case.model_copy(
        update={"drivetrain": power.model_copy(update={"balance_grade": 0.0, "shafts": shafts})}
    )


def misalignments(case: Case) -> Iterator[AxisMisalignment]:
    """Couplings that resist the offset or angle in which their axes were set up."""
    for name, coupling in case.power_circuit.couplings.items():
        offset = coupling.cold_offset_lateral, coupling.cold_offset_vertical
        slope = coupling.cold_angle_lateral, coupling.cold_angle_vertical
        found = AxisMisalignment(
            coupling=name,
            offset=offset if coupling.radial_stiffness else (0.0, 0.0),
            slope=slope if coupling.angular_stiffness else (0.0, 0.0),
        )
        if any((*found.offset, *found.slope)):
            yield found


def cross_joints(case: Case) -> Iterator[CrossJoint]:
    """Couplings that are cross joints under an angle."""
    for name, coupling in case.power_circuit.couplings.items():
        slope = coupling.cold_angle_lateral, coupling.cold_angle_vertical
        if coupling.alternates and any(slope):
            yield CrossJoint(coupling=name, slope=slope)


def grade_of(case: Case, shaft: ShaftInput) -> float:
    """Balance quality grade of a shaft [mm/s], 0 where its unbalances are stated in its place."""
    if shaft.balance_grade is not None:
        return shaft.balance_grade
    if shaft.unbalances:
        return 0.0
    common = case.power_circuit.balance_grade
    return BALANCE_GRADE if common is None else common


def highest_speeds(case: Case, drivetrain: Drivetrain) -> dict[str, float]:
    """Highest speed of every shaft in the schedule [rad/s]."""
    gear = case.power_circuit.counting_gear
    ratios = speed_ratios(drivetrain)
    reference = ratios[case.gearboxes[gear.gearbox].gears[gear.part].shaft]
    top = max(max(stage.speed_start, stage.speed_end) for stage in case.schedule.resolved())
    return {name: abs(ratio / reference) * top for name, ratio in ratios.items()}


def _bow(name: str, bow: BowInput, drivetrain: Drivetrain, material: Material) -> ShaftBow:
    places = sorted(bearing.position for bearing in drivetrain.bearings if bearing.shaft == name)
    difference = bow.temperature_difference or 0.0
    return ShaftBow(
        shaft=name,
        supports=(places[0], places[-1]),
        amplitude=bow.amplitude,
        position=bow.position,
        angle=bow.angle,
        # the hot side is the outer one of the bend: away from the centre of curvature
        gradient=-material.expansion_coefficient * difference,
        gradient_angle=bow.hot_side,
    )
