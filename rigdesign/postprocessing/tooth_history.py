"""Stress history of the teeth over a turn of their gear: both fillets, all meshes, with what the root holds at rest.

The stress of every mesh is that of its dynamic tooth forces times its K_A, as the ratings take it.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from dynamics.rating.iso_rating import root_stress
from dynamics.rating.root_stress import (
    GearDisc,
    MeanRootStress,
    PressFit,
    Solid,
    mean_root_stress,
    mean_stress_factor,
)
from dynamics.standards.iso6336_3_2006 import IDLER_RATIO, mean_stress_ratio
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.root_field import (
    Fillet,
    PairForces,
    RootCourse,
    Side,
    ToothPass,
    pitches_apart,
    tooth_turn,
)
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.mesh_models import MeshModel
from rigdesign.postprocessing import root
from rigdesign.postprocessing.gear_loads import application_factor
from rigdesign.properties.materials import Material
from rigdesign.results.teeth import FROM_FACTORS, FROM_INFLUENCE, ToothHistory
from rigdesign.rig.model import Rig

FIRST_MESH = 0.5 * math.pi
"""Rotation at which the tooth passes the pitch point of its first mesh [rad]: the turn begins where it is free."""


@dataclass(frozen=True)
class GearInMesh:
    """A gear in one of its meshes: number of the mesh, side there (0 pinion, 1 wheel)."""

    mesh: int
    index: int


def tooth_histories(rig: Rig, point: PointResult) -> Iterator[ToothHistory]:
    """Of every gear that carries load at a held point."""
    for gear, places in gear_meshes(rig).items():
        found = tooth_history(rig, point, gear, places)
        if found is not None:
            yield found


def gear_meshes(rig: Rig) -> dict[str, list[GearInMesh]]:
    """All meshes of every gear ``gearbox.gear``."""
    found: dict[str, list[GearInMesh]] = {}
    for mesh, name in enumerate(rig.mesh_names):
        for index, gear in enumerate(rig.mesh_gears(name)):
            found.setdefault(gear, []).append(GearInMesh(mesh, index))
    return found


def tooth_history(
    rig: Rig, point: PointResult, gear: str, places: Sequence[GearInMesh]
) -> ToothHistory | None:
    """Of one gear, in its meshes; None without load."""
    response = point.last.response
    if response is None:
        return None
    passes: list[ToothPass] = []
    loaded: list[GearInMesh] = []
    first: float | None = None
    for place in places:
        model = point.last.models[place.mesh]
        (forces,) = root.dynamic_forces(model, [response], place.mesh)
        if not forces.force.any():
            continue
        front = bool(response.flank[place.mesh] > 0)
        passing = _Passing(model, place.index, front)
        start = FIRST_MESH
        if first is None:
            first = passing.start
        else:
            coarse = _angle_between(rig, loaded[0], place)
            start += pitches_apart(coarse, passing.start - first, passing.pitch)
        raised = replace(forces, force=application_factor(rig, place.mesh) * forces.force)
        passes.append(_tooth_pass(rig, passing, raised, start))
        loaded.append(place)
    if not passes:
        return None
    main = loaded[0]
    return ToothHistory(
        gear=gear,
        stage=point.point.stage,
        meshes=tuple(rig.mesh_labels[rig.mesh_names[place.mesh]] for place in loaded),
        turn=tooth_turn(passes),
        mean=mean_stress(rig, main, point.point.speed),
        sensitivity=sensitivity(rig, main),
        source=FROM_INFLUENCE if rig.mesh_stiffness == "influence_numbers" else FROM_FACTORS,
    )


@dataclass(frozen=True)
class _Passing:
    """A gear in a warm mesh, on the flank that carries."""

    model: MeshModel
    index: int
    front: bool

    @property
    def law(self) -> MeshLaw:
        return self.model.law

    @property
    def radius(self) -> float:
        """Base radius [m]."""
        return (self.law.base_radius_1, self.law.base_radius_2)[self.index]

    @property
    def pitch(self) -> float:
        """Angle of a tooth [rad]."""
        return self.law.base_pitch / self.radius

    @property
    def start(self) -> float:
        """Rotation at which a tooth stands at the pitch point, but for whole pitches [rad]."""
        return (-self.law.phase if self.front else self.law.back_phase) / self.radius

    @property
    def leading(self) -> bool:
        """Whether the loaded flank faces the rotation: that of a gear that drives."""
        return (self.index == 0) == self.front


def _tooth_pass(rig: Rig, passing: _Passing, forces: PairForces, start: float) -> ToothPass:
    under, behind = _both_fillets(rig, passing, forces)
    sense = 1.0 if passing.front else -1.0
    angle = start + sense * under.path / passing.radius
    order = slice(None, None, 1 if passing.front else -1)
    leading, trailing = (under, behind) if passing.leading else (behind, under)
    return ToothPass(
        angle=angle[order],
        loaded="leading" if passing.leading else "trailing",
        leading=leading.stress[order],
        trailing=trailing.stress[order],
    )


def _both_fillets(rig: Rig, passing: _Passing, forces: PairForces) -> tuple[RootCourse, RootCourse]:
    """Stress under the loaded flank and under the other, over the path of the loaded flank.

    The factors of ISO 6336-3 know the tension; the compression behind it is then that of its Annex B.
    """
    model, index = passing.model, passing.index
    if rig.mesh_stiffness != "influence_numbers":
        path, stress = root.FactorRoots(model).highest(forces)[index]
        under = RootCourse(path=path, face=np.zeros(1), stress=stress[:, None, None])
        return under, RootCourse(path=path, face=under.face, stress=-IDLER_RATIO * under.stress)

    def of_side(side: Side) -> RootCourse:
        # both gears are on z of the contact, which the back flanks count from the other end of the face
        course = root.field_of(rig, model, 1 if index else 0, side).course(forces)
        return course if passing.front else course.turned()

    return of_side(1), of_side(-1)


def _angle_between(rig: Rig, first: GearInMesh, other: GearInMesh) -> float:
    """Angle at the axis of a gear from one partner to another [rad]: 0 or half a turn, all axes in one plane.

    Without a housing no axis has a place: partners are taken to stand on opposite sides.
    """
    gear = rig.mesh_gears(rig.mesh_names[first.mesh])[first.index]
    box = rig.case.gearboxes[gear.gearbox]
    if box.housing is None:
        return math.pi
    shafts = box.housing.shafts
    here = shafts[box.gears[gear.part].shaft].lateral_position
    sides = [
        shafts[rig.mesh_gear(place.mesh, 1 - place.index).shaft].lateral_position > here
        for place in (first, other)
    ]
    return math.pi if sides[0] != sides[1] else 0.0


def mean_stress(rig: Rig, place: GearInMesh, speed: float) -> MeanRootStress:
    """Tension that the root of a gear holds at a speed of the reference gear [rad/s]."""
    disc, fit = seated_gear(rig, place)
    gear = rig.mesh_gear(place.mesh, place.index)
    return mean_root_stress(disc, rig.shaft_speed(gear.shaft, speed), fit)


def seated_gear(rig: Rig, place: GearInMesh) -> tuple[GearDisc, PressFit | None]:
    """A gear as a turning disc, and its press fit where the case states an interference."""
    pair, gear = rig.pairs[rig.mesh_names[place.mesh]], rig.mesh_gear(place.mesh, place.index)
    disc = GearDisc(
        bore=0.5 * gear.bore_diameter,
        root=pair.root_radii[place.index],
        tip=pair.tip_radii[place.index],
        solid=_solid(rig.materials[gear.material]),
        rim=gear.rim_thickness,
    )
    fit = None
    if gear.shaft_interference > 0.0:
        fit = PressFit(
            interference=gear.shaft_interference,
            shaft=_solid(shaft_material(rig, gear.shaft) or rig.materials[gear.material]),
            shaft_bore=shaft_bore(rig, gear.shaft, gear.seat_position),
        )
    return disc, fit


def sensitivity(rig: Rig, place: GearInMesh) -> float:
    """M of ISO 6336-3, Annex B, of a gear [-]."""
    name = rig.mesh_names[place.mesh]
    pair, gear = rig.pairs[name], rig.mesh_gear(place.mesh, place.index)
    # Y_S does not depend on the torque
    notch = root_stress(pair, 1.0, place.index, grade=gear.quality_grade).Y_S
    return mean_stress_ratio(rig.materials[gear.material].treatment, notch)


def _solid(material: Material) -> Solid:
    return Solid(young=material.elastic_modulus, poisson=material.poisson_ratio, density=material.density)


def shaft_material(rig: Rig, shaft: str) -> Material | None:
    """Of a shaft of the drivetrain; None of one that is not part of it."""
    shafts = rig.case.power_circuit.shafts
    return rig.materials[shafts[shaft].material] if shaft in shafts else None


def shaft_bore(rig: Rig, shaft: str, position: float | None) -> float:
    """Inner radius of a shaft at a position [m]; 0 where the case has no sections or the gear no position."""
    shafts = rig.case.power_circuit.shafts
    if shaft not in shafts or position is None:
        return 0.0
    section = shafts[shaft].section_at(position)
    return 0.0 if section is None else 0.5 * section.inner_diameter


# Bending both ways of a gear that two meshes load on opposite flanks: stress ratio, mean stress, Y_M.
#
# Each mesh is rated at the fillet that it loads: R is the compression by the opposite flank over the tension of this
# mesh. Under the flank that carries less, R falls below the -1.2 at which Annex B of ISO 6336-3 ends; Y_M then keeps
# the stress amplitude of -1.2 (`mean_stress_factor`). It is lower than that of the higher loaded mesh, at a lower
# stress; the fillet that is stressed most governs.


@dataclass(frozen=True, kw_only=True)
class ReversedBending:
    """What reversed bending does to the rating of a root.

    mean : stress that the root holds all the time, added to that of the load [Pa]
    stress_ratio : R with it; strength_factor : Y_M on the strength at R = 0
    """

    mean: float
    stress_ratio: float
    strength_factor: float


def bent_both_ways(rig: Rig, gear: str) -> bool:
    """Whether meshes load both flanks of a gear ``gearbox.gear``."""
    return len({_flank(rig, place) for place in gear_meshes(rig)[gear] if _load(rig, place) > 0.0}) > 1


def of_history(rig: Rig, place: GearInMesh, history: ToothHistory) -> ReversedBending | None:
    """Of a gear in one of its meshes by its stress history; None where it is bent one way."""
    if not _opposite_share(rig, place):
        return None
    root = history.of(_flank(rig, place))
    return ReversedBending(
        mean=history.mean.total,
        stress_ratio=root.ratio,
        strength_factor=mean_stress_factor(root.ratio, history.sensitivity),
    )


def by_standard(rig: Rig, place: GearInMesh, stress: float, speed: float) -> ReversedBending | None:
    """By ISO 6336-3:2006, Annex B: compression 1.2 times the load of the opposite flank; None where bent one way.

    stress : root stress of the load of this mesh [Pa]; speed : of the reference gear [rad/s]
    """
    other = _opposite_share(rig, place)
    if not other:
        return None
    mean = mean_stress(rig, place, speed).total
    ratio = (mean - IDLER_RATIO * other * stress) / (mean + stress)
    return ReversedBending(
        mean=mean, stress_ratio=ratio, strength_factor=mean_stress_factor(ratio, sensitivity(rig, place))
    )


def _opposite_share(rig: Rig, place: GearInMesh) -> float:
    """Load of the flank opposite to that of a mesh, over the load of this mesh [-]; 0 without one of them."""
    own, flank = _load(rig, place), _flank(rig, place)
    if own == 0.0:
        return 0.0
    gear = rig.mesh_gears(rig.mesh_names[place.mesh])[place.index]
    opposite = [_load(rig, other) for other in gear_meshes(rig)[gear] if _flank(rig, other) != flank]
    return max(opposite, default=0.0) / own


def _load(rig: Rig, place: GearInMesh) -> float:
    """Load of a mesh per face width, with K_A, per force in the control mesh [1/m]."""
    name = rig.mesh_names[place.mesh]
    box, own = rig.mesh(name)
    width = box.meshes[own].sharing * rig.pairs[name].face_width
    return application_factor(rig, place.mesh) * abs(rig.mesh_forces[name]) / width


def _flank(rig: Rig, place: GearInMesh) -> Fillet:
    """Flank of the gear that a mesh loads."""
    return (
        "leading" if (place.index == 0) == (rig.mesh_forces[rig.mesh_names[place.mesh]] > 0.0) else "trailing"
    )
