"""The rig: a case turned into the inputs of the solvers, as drawn, SI. Nothing here changes during a run."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

from dynamics.gear.pair import GearPair
from dynamics.rotor.graph import NO_DRIVETRAIN, Drivetrain, TorsionalJoint, assemble, at_speed, joints
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.rotor_model import HousingSupport
from dynamics.tooth.elastic_segment import FACE_POSITIONS
from dynamics.vibration.modal_model import DEFAULT_CUTOFF
from rigdesign.base.fidelity import Fidelity
from rigdesign.base.part_name import BearingName, GearName, MeshName
from rigdesign.case.bearings import BearingInput
from rigdesign.case.circuit_parts import HeatParts, heat_parts, oil_circuits
from rigdesign.case.drivetrain import MeshStiffness, ShaftModel
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.gears import Gear
from rigdesign.case.geometry import housing_geometry
from rigdesign.case.model import Case
from rigdesign.oil_circuit.circuit import Circuit
from rigdesign.properties.materials import MATERIALS, Material
from rigdesign.properties.oil import OILS, Oil
from rigdesign.rig.chamber_views import ChamberViews
from rigdesign.rig.drivetrain import (
    SectionTorsion,
    build_drivetrain,
    gearbox_forces,
    loop_forces,
    refuse_broken_shafts,
    section_torsions,
)
from rigdesign.rig.elastic_rig import (
    ElasticDrivetrain,
    elastic_rig,
    pressed_bearings,
    without_residual_unbalance,
)
from rigdesign.rig.gears import NOT_MEASURED, FlankTopographies, build_pairs, flank_topographies
from rigdesign.rig.housing_seats import housing_supports
from rigdesign.rig.resolution import (
    AS_RULED,
    Coarsening,
    counted_frequency,
    highest_bending_mode,
    highest_mode,
    refuse_uncovered_speeds,
    speed_ratios,
    with_elements,
)
from rigdesign.rig.shaft_axes import LineOfAction, ShaftAxis, line_of_action, shaft_axes
from rigdesign.rig.strain_gauges import RootGauge, root_gauges
from rigdesign.rig.tooth_influence import QUICK_POSITIONS, Count, Progress, ToothInfluence
from rigdesign.rig.user_mesh import user_model
from thermal.conduction.steady import ConductionSetup
from thermal.expansion.expansion import ExpansionSetup
from thermal.housing.gearbox import build_gearbox, mesh_sizes
from thermal.housing.geometry import HousingGeometry
from thermal.housing.housing_surfaces import surface_names
from thermal.housing.stations import GearboxModel

# The power circuit with shafts that only twist, at every speed: friction of splines follows the mesh frequency.


@dataclass(frozen=True, eq=False)
class TwistingLoop:
    """Matrices by stated speed; drive_ratio : speed of the motor per stated speed."""

    drivetrain: Drivetrain
    drive_ratio: float
    _systems: dict[float, LinearSystem] = field(default_factory=dict, repr=False)

    @property
    def follows_speed(self) -> bool:
        """Whether a spline has a loss factor; all others are the same at every speed."""
        return any(gear.loss_factor for gear in self.drivetrain.gears)

    def parts(self, speed: float) -> Drivetrain:
        """Parts with the dampers of splines at a stated speed [rad/s]."""
        return at_speed(self.drivetrain, self.drive_ratio * speed)

    def at(self, speed: float) -> LinearSystem:
        """Matrices without the meshes at a stated speed [rad/s]."""
        key = speed if self.follows_speed else 0.0
        if key not in self._systems:
            self._systems[key] = assemble(self.parts(key))
        return self._systems[key]


@dataclass(frozen=True)
class RigParts:
    """Derived parts of a rig that another one has computed and that hold for it too; None: computed when asked for."""

    models: Mapping[str, GearboxModel] | None = None
    conduction: Mapping[str, ConductionSetup] | None = None
    chamber_views: ChamberViews | None = None
    expansion: Mapping[str, ExpansionSetup] | None = None
    geometries: Mapping[str, HousingGeometry] | None = None
    drivetrain: Drivetrain | None = None
    twisting: TwistingLoop | None = None
    joints: tuple[TorsionalJoint, ...] | None = None
    speed_ratios: Mapping[str, float] | None = None
    mesh_forces: Mapping[str, float] | None = None
    axes: Mapping[str, ShaftAxis] | None = None
    topographies: Mapping[str, FlankTopographies] | None = None
    seats: tuple[HousingSupport, ...] | None = None
    elastic: ElasticDrivetrain | None = None


@dataclass(frozen=True)
class Rig:
    """Everything that stays the same over operating points and iterations.

    pairs : gear pair as drawn, by ``gearbox.mesh``; oils, materials : by the name the case uses
    mesh_stiffness : tooth model of the meshes; shaft_model : of the power circuit; those of the case
    tooth_influence : influence numbers of the cold gears, from the store or computed when they are asked for
    coarsening : of the loop, for estimates of its discretisation error
    residual_unbalance : whether shafts that bend have what their balance grade leaves, at the worst angles
    parts : computed elsewhere (`rigdesign.rig.reuse`); to be given anew with a field on which they depend
    """

    case: Case
    fidelity: Fidelity
    oils: Mapping[str, Oil]
    materials: Mapping[str, Material]
    pairs: Mapping[MeshName, GearPair]
    mesh_stiffness: MeshStiffness = "iso_6336_scaled"
    shaft_model: ShaftModel = "torsional"
    tooth_influence: ToothInfluence = field(default_factory=ToothInfluence)
    coarsening: Coarsening = AS_RULED
    residual_unbalance: bool = True
    parts: RigParts = field(default=RigParts(), repr=False, compare=False)

    @cached_property
    def speed_ratios(self) -> Mapping[str, float]:
        """Speed of each shaft per speed of the reference gear."""
        return self.parts.speed_ratios or speed_ratios(self.case, self.drivetrain)

    @cached_property
    def drivetrain(self) -> Drivetrain:
        """The power circuit; without any part when the losses are given."""
        if self.case.drivetrain is None:
            return NO_DRIVETRAIN
        if self.parts.drivetrain is not None:
            return self.parts.drivetrain
        whole = build_drivetrain(self.case, self.pairs, self.materials)
        return with_elements(self.case, whole, self.coarsening.elements)

    @cached_property
    def highest_mode(self) -> float:
        """Frequency [Hz] up to which modes of the loop are followed in its periodic response."""
        return (
            DEFAULT_CUTOFF
            if self.case.drivetrain is None
            else highest_mode(counted_frequency(self.case, self.drivetrain))
        )

    @cached_property
    def mesh_forces(self) -> Mapping[str, float]:
        """Signed tooth force of each mesh per force in the control mesh, positive where the pinion drives."""
        if self.parts.mesh_forces is not None:
            return self.parts.mesh_forces
        if self.case.drivetrain is None:
            return gearbox_forces(self.case, self.pairs)
        return loop_forces(self.case, self.pairs, self.drivetrain.lines())

    @cached_property
    def axes(self) -> Mapping[str, ShaftAxis]:
        """Axis of every shaft."""
        return self.parts.axes or shaft_axes(self.case, self.pairs)

    def line_of_action(self, mesh: MeshName) -> LineOfAction:
        """Directions of the mesh ``gearbox.mesh``."""
        box, own = self.mesh(mesh)
        pinion, wheel = (box.gears[gear].shaft for gear in (box.meshes[own].pinion, box.meshes[own].wheel))
        return line_of_action(self.axes[pinion], self.axes[wheel])

    @cached_property
    def system(self) -> LinearSystem:
        """Matrices of the power circuit that only twists, without its meshes; splines as at test speed; of a rig with
        a drivetrain only."""
        return self.twisting.at(self.case.schedule.test_speed)

    @cached_property
    def twisting(self) -> TwistingLoop:
        """The same at every stated speed; of a rig with a drivetrain only."""
        return self.parts.twisting or TwistingLoop(self.drivetrain, self.drive_speed(1.0))

    @cached_property
    def joints(self) -> tuple[TorsionalJoint, ...]:
        """Springs and dampers of the power circuit between its freedoms, splines as at test speed."""
        return self.parts.joints or joints(self.twisting.parts(self.case.schedule.test_speed))

    @cached_property
    def shaft_torsions(self) -> tuple[SectionTorsion, ...]:
        """Static torsion of the shafts at the largest torque of the schedule; empty without a drivetrain."""
        if self.case.drivetrain is None:
            return ()
        torque = self.torque_ratio * max(abs(stage.torque_end) for stage in self.case.schedule.resolved())
        force = torque / self.pairs[self.control_mesh].base_radii[0]
        return section_torsions(self.drivetrain, force, self.case.power_circuit.motor.torque_limit)

    @cached_property
    def oil_circuits(self) -> Mapping[str, Circuit]:
        """Oil circuits by name; empty where every inlet temperature is stated."""
        return oil_circuits(self.case, self.oils)

    @cached_property
    def heat_parts(self) -> HeatParts:
        """Machines, couplings and room: heat of the rig outside of its gearboxes."""
        return heat_parts(self.case)

    @cached_property
    def geometries(self) -> Mapping[str, HousingGeometry]:
        """Parametric housing of every gearbox that has one."""
        return self.parts.geometries or {
            name: housing_geometry(self.case.gearboxes[name], self._gear_diameters(name))
            for name in self.case.housings
        }

    @cached_property
    def models(self) -> Mapping[str, GearboxModel]:
        """Meshed housing of every gearbox that has one."""
        return self.parts.models or self.meshed(self.fidelity)

    def surface_names(self, name: str) -> tuple[str, ...]:
        """Surfaces of a housing that want a boundary condition: of the box, or all of a file."""
        if self.case.housings[name].part_file is not None:
            return tuple(self.models[name].mesh.surfaces)
        return tuple(surface_names(self.geometries[name]))

    def meshed(self, fidelity: Fidelity, coarser: float = 1.0) -> dict[str, GearboxModel]:
        """The housings meshed at one fidelity, or so many times coarser; the case may give sizes for its zones."""
        models = {}
        for name, geometry in self.geometries.items():
            housing = self.case.housings[name]
            sizes = mesh_sizes(geometry, fidelity, housing.mesh.sizes()).times(coarser)
            if housing.part_file is not None:
                models[name] = user_model(self.case, name, housing.part_file, geometry, sizes)
                continue
            models[name] = build_gearbox(geometry, sizes)
        return models

    def with_models(self, models: Mapping[str, GearboxModel]) -> "Rig":
        """This rig with housings that were meshed elsewhere."""
        return replace(self, parts=RigParts(models=models))

    def coarsened(self, coarsening: Coarsening) -> "Rig":
        """This rig with its loop divided otherwise; what the division leaves as it is, is not computed again."""
        bends, divided = self.shaft_model == "elastic", coarsening.elements == self.coarsening.elements
        parts = RigParts(
            models=self.models,
            topographies=self.topographies,
            axes=self.axes,
            seats=self.seats if bends else None,
            drivetrain=self.drivetrain if divided else None,
            elastic=self.elastic if bends and divided and coarsening.modes == self.coarsening.modes else None,
        )
        return replace(self, coarsening=coarsening, parts=parts)

    @cached_property
    def conduction(self) -> Mapping[str, ConductionSetup]:
        """Conduction matrices of every housing, assembled once."""
        return self.parts.conduction or {
            name: ConductionSetup(
                model.mesh, {b: m.conductivity for b, m in self.body_materials(name).items()}
            )
            for name, model in self.models.items()
        }

    @cached_property
    def chamber_views(self) -> ChamberViews:
        """View factors between the surfaces of the chambers that radiate at each other."""
        return self.parts.chamber_views or ChamberViews(self.conduction)

    @cached_property
    def expansion(self) -> Mapping[str, ExpansionSetup]:
        """Stiffness and supports of every housing, assembled once."""
        return self.parts.expansion or {
            name: ExpansionSetup(
                model,
                {
                    b: (m.elastic_modulus, m.poisson_ratio, m.expansion_coefficient)
                    for b, m in self.body_materials(name).items()
                },
                self.conduction[name].elements,
            )
            for name, model in self.models.items()
        }

    def body_materials(self, name: str, model: GearboxModel | None = None) -> dict[str, Material]:
        """Material of every body of a housing, or of another model of it."""
        box, housing = self.case.gearboxes[name], self.case.housings[name]
        named = {"housing": housing.material, "field": housing.field.material}
        named |= {f"shaft_{shaft}": entry.material for shaft, entry in housing.shafts.items()}
        named |= {f"gear_{gear.shaft}": gear.material for gear in box.gears.values()}
        return {body: self.materials[named[body]] for body in (model or self.models[name]).mesh.bodies}

    @cached_property
    def topographies(self) -> Mapping[str, FlankTopographies]:
        """Measured front and back flanks by ``gearbox.gear`` of the gears that have any."""
        return self.parts.topographies or flank_topographies(self.case, self.pairs)

    def topography(self, gear: str) -> FlankTopographies:
        """Measured front and back flanks of the gear ``gearbox.gear``."""
        return self.topographies.get(gear, NOT_MEASURED)

    @cached_property
    def strain_gauges(self) -> Mapping[str, RootGauge]:
        """Strain gauges in tooth roots by ``gearbox.gear.gauge``."""
        return root_gauges(self.case, self.pairs, self.materials)

    @cached_property
    def elastic(self) -> ElasticDrivetrain:
        """The power circuit in six degrees of freedom; of a rig with a drivetrain only."""
        if self.parts.elastic is not None:
            return self.parts.elastic
        case = self.case if self.residual_unbalance else without_residual_unbalance(self.case)
        return ElasticDrivetrain(
            rig=elastic_rig(case, self.drivetrain, self.axes, self.pairs, self.materials, self.seats),
            faces={name: "back" if force < 0.0 else "front" for name, force in self.mesh_forces.items()},
            cutoff=highest_bending_mode(counted_frequency(self.case, self.drivetrain))
            / self.coarsening.modes,
            pressed=frozenset(pressed_bearings(self.case)),
        )

    @cached_property
    def seats(self) -> tuple[HousingSupport, ...]:
        """Housings condensed to their seats; their quick meshes are 1 % stiffer than the others."""
        return self.parts.seats or housing_supports(
            self.case.gearboxes, self.axes, lambda: self.meshed("quick"), self.body_materials
        )

    @property
    def mesh_names(self) -> tuple[MeshName, ...]:
        """``gearbox.mesh`` in the order of the drivetrain, the one that counts first."""
        return tuple(self.pairs)

    @property
    def mesh_labels(self) -> Mapping[MeshName, str]:
        """Name of each mesh in results and checks: its gearbox, or ``gearbox.mesh`` where that has several."""
        boxes = [name.gearbox for name in self.mesh_names]
        return {name: name if boxes.count(name.gearbox) > 1 else name.gearbox for name in self.mesh_names}

    @property
    def control_mesh(self) -> MeshName:
        """The mesh whose torque the case states: the first of all."""
        return next(iter(self.pairs))

    @property
    def torque_ratio(self) -> float:
        """Pinion torque of the control mesh per stated torque: 1, or z1/z2 if the case counts at a wheel."""
        if self.case.drivetrain is None:
            return 1.0
        gear = self.case.drivetrain.counting_gear.part
        box, mesh = self.mesh(self.control_mesh)
        pair = self.pairs[self.control_mesh]
        return 1.0 if box.meshes[mesh].pinion == gear else pair.teeth[0] / pair.teeth[1]

    def mesh(self, name: MeshName) -> tuple[Gearbox, str]:
        """Gearbox and own name of a mesh."""
        return self.case.gearboxes[name.gearbox], name.part

    def mesh_gear_name(self, mesh: int, index: int) -> str:
        """Own name of pinion (0) or wheel (1) of a mesh by its number."""
        return self.mesh_gears(self.mesh_names[mesh])[index].part

    def mesh_gear(self, mesh: int, index: int) -> Gear:
        """Pinion (0) or wheel (1) of a mesh by its number."""
        return self.mesh(self.mesh_names[mesh])[0].gears[self.mesh_gear_name(mesh, index)]

    def mesh_gears(self, name: MeshName) -> tuple[GearName, GearName]:
        """Pinion and wheel of a mesh."""
        entry = self.case.gearboxes[name.gearbox].meshes[name.part]
        return GearName(name.gearbox, entry.pinion), GearName(name.gearbox, entry.wheel)

    def shaft_speed(self, shaft: str, speed: float) -> float:
        """Speed of a shaft [rad/s] at the stated speed [rad/s]."""
        return self.speed_ratios[shaft] * speed

    def pinion_speed(self, speed: float) -> float:
        """Speed of the pinion of the first mesh [rad/s] at the stated speed [rad/s]."""
        box, mesh = self.mesh(self.control_mesh)
        return self.shaft_speed(box.gears[box.meshes[mesh].pinion].shaft, speed)

    def drive_speed(self, speed: float) -> float:
        """Speed of the motor [rad/s] at the stated speed [rad/s]."""
        return self.shaft_speed(self.case.power_circuit.motor.shaft, speed)

    def prepare_teeth(self, say: Progress, count: Count | None = None) -> None:
        """Read or compute the influence numbers of all gears; ``count`` as of `ToothInfluence.prepare`."""
        self.tooth_influence.prepare(self.pairs.values(), say, count)

    def driven_speed(self, speed: float) -> float:
        """Speed of the shaft that is driven [rad/s] at the stated speed; without a drivetrain of the first pinion."""
        return abs(self.pinion_speed(speed) if self.case.drivetrain is None else self.drive_speed(speed))

    def bearings(self) -> list[tuple[BearingName, Gearbox, BearingInput]]:
        """(name, gearbox, bearing) of the whole rig."""
        return [
            (BearingName(box_name, name), box, bearing)
            for box_name, box in self.case.gearboxes.items()
            for name, bearing in box.bearings.items()
        ]

    def bearing(self, name: str) -> BearingInput:
        """A bearing of the case by its name."""
        return self._bearing_inputs[name]

    @cached_property
    def _bearing_inputs(self) -> dict[str, BearingInput]:
        """All of them by their names."""
        return {name: entry for name, _, entry in self.bearings()}

    def _gear_diameters(self, name: str) -> dict[str, float]:
        """Mean tooth diameter (d_a + d_f)/2 of each gear of a gearbox [m]."""
        diameters = {}
        for mesh_name, mesh in self.case.gearboxes[name].meshes.items():
            pair = self.pairs[MeshName(name, mesh_name)]
            for gear, member in zip((mesh.pinion, mesh.wheel), pair.gears):
                diameters[gear] = 2.0 * member.mean_radius
        return diameters


def build_rig(case: Case, fidelity: Fidelity = "standard") -> Rig:
    """Turn a case into a rig.

    Raises
    ------
    CaseError
        A shaft that would twist off, a machine whose loss map does not hold its speed, a topography that does not fit
        its flanks, a strain gauge that does not fit its root.
    ValueError
        Of the solvers: gears that cannot mesh, a loop that cannot close, a housing that cannot be built.
    """
    oils = dict(OILS) | {name: entry.properties(name) for name, entry in case.oils.items()}
    materials = dict(MATERIALS) | {name: _custom_material(case, name) for name in case.materials}
    pairs = build_pairs(case, materials)
    control = _control_mesh(case)
    pairs = {control: pairs[control]} | pairs
    rig = Rig(
        case=case,
        fidelity=fidelity,
        oils=oils,
        materials=materials,
        pairs=pairs,
        mesh_stiffness=case.power_circuit.mesh_stiffness,
        shaft_model=case.power_circuit.shaft_model,
        tooth_influence=ToothInfluence(positions=QUICK_POSITIONS if fidelity == "quick" else FACE_POSITIONS),
    )
    refuse_broken_shafts(rig.shaft_torsions, str(case.path))
    if rig.heat_parts.machines:
        speeds = {stage.name: rig.driven_speed(stage.speed_end) for stage in case.schedule.held()}
        refuse_uncovered_speeds(rig.heat_parts.machines, speeds, str(case.path))
    _ = rig.topographies, rig.strain_gauges  # now: what does not fit the teeth is a fault of the case
    return rig


def _control_mesh(case: Case) -> MeshName:
    """The first mesh of the gear at which torque and speed count; of all, without a drivetrain."""
    wanted = None if case.drivetrain is None else case.drivetrain.counting_gear
    for box_name, box in case.gearboxes.items():
        for name, mesh in box.meshes.items():
            if wanted is None or (wanted.gearbox == box_name and wanted.part in (mesh.pinion, mesh.wheel)):
                return MeshName(box_name, name)
    raise ValueError(f"drivetrain.torque_at = {wanted}: this gear is in no mesh; name one that is")


def _custom_material(case: Case, name: str) -> Material:
    entry = case.materials[name]
    return Material(
        title=entry.title,
        conductivity=entry.conductivity,
        expansion_coefficient=entry.expansion_coefficient,
        elastic_modulus=entry.elastic_modulus,
        poisson_ratio=entry.poisson_ratio,
        density=entry.density,
        root_strength=entry.root_strength,
        flank_strength=entry.flank_strength,
        scuffing_factor=entry.scuffing_factor,
        treatment=entry.treatment,
        tempering_temperature=entry.tempering_temperature,
    )
