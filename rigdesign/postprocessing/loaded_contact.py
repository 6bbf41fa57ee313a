"""Loaded contact of the meshes from influence numbers: quasi-static, warm, at the held points.

All teeth alike, with the modifications of the flanks that carry. The axes are those of the warm housing, of shafts that
bend also by their bending and by where the journals stand in their clearance (`contact_gap.warm_axes`). The load is the
mean torque: a dynamic load on top of it evens out face and pairs. Helix slope deviations of manufacture are not in the
axes, and so not in K_Hbeta.
"""

from dataclasses import dataclass
from functools import cached_property
from math import radians
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dynamics.gear.flank import AxisMisalignment, Flank
from dynamics.gear.microgeometry import Microgeometry
from dynamics.gear.pair import GearPair
from dynamics.gear.root_arc import normal_arc
from dynamics.tooth.compliance import InterpolatedCompliance
from dynamics.tooth.influence_numbers import InfluenceNumbers
from dynamics.tooth.loaded_mesh import LoadedMesh, transverse_load_factor
from dynamics.tooth.mesh_cycle import MeshCycle, unloaded_contact_ratio
from dynamics.tooth.pair_gap import PairGap
from dynamics.tooth.points import FaceGrid, FlankGap, default_positions, face_sense, modified_gap
from dynamics.tooth.root_field import RootCourse, root_course
from rigdesign.base.part_name import MeshName
from rigdesign.coupling.alignment import axes_in_mesh
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.mesh_models import mesh_microgeometry
from rigdesign.coupling.state import LEAST_TORQUE
from rigdesign.results.teeth import EdgeContact, GaugeStress, LoadedContact
from rigdesign.rig.model import Rig
from rigdesign.rig.strain_gauges import RootGauge
from rigdesign.rig.tooth_influence import ToothInfluence
from rigdesign.strain_gauge.measuring_point import GaugeCurve, gauge_curve
from thermal.fe.kept_results import kept

# Root stress at the strain gauges of a mesh, from its loaded contact and the influence numbers of its gears.
#
# A gauge is reported in the first mesh of its gear. What a second mesh of the same gear does to it, at another rolling
# angle, is not in the curve.

GEARS = ("pinion", "wheel")


class ElasticGear(NamedTuple):
    """Influence numbers of a gear and the compliance made of them, on the face positions of the contact."""

    numbers: InfluenceNumbers
    compliance: InterpolatedCompliance


def gauge_stresses(
    rig: Rig,
    mesh: MeshName,
    cycle: MeshCycle,
    gears: tuple[ElasticGear, ElasticGear],
    flank: Flank = "front",
) -> tuple[GaugeStress, ...]:
    """Stress at the gauges of pinion and wheel of a mesh under the torque of a cycle.

    flank : that carries
    """
    box, own = rig.mesh(mesh)
    found = []
    for gauge in rig.strain_gauges.values():
        first, side = box.first_meshes().get(gauge.gear.part, ("", 0))
        if gauge.gear == rig.mesh_gears(mesh)[side] and first == own:
            found.append(
                GaugeStress(
                    name=gauge.name,
                    gear=GEARS[side],
                    tooth=gauge.tooth,
                    front=gauge.front,
                    point=gauge.point,
                    curve=stress_at(gauge, cycle, gears[side], rig.pairs[mesh], 1 if side else 0, flank),
                )
            )
    return tuple(found)


def stress_at(
    gauge: RootGauge,
    cycle: MeshCycle,
    gear: ElasticGear,
    pair: GearPair,
    index: Literal[0, 1],
    flank: Flank = "front",
) -> GaugeCurve:
    """Curve of one gauge on the pinion (0) or wheel (1) of a pair, which is the cold one; ``flank`` carries."""
    under_load = gauge.front == (flank == "front")
    course = root_course(cycle, gear.numbers, gear.compliance, index, 1 if under_load else -1)
    if face_sense(flank) < 0.0:
        course = course.turned()
    fillet = gear.numbers.fillet
    places = normal_arc(pair.gears[index], fillet.point, fillet.arc)
    sense = -1.0 if index else 1.0
    return gauge_curve(course, places, gauge.point, sense / pair.base_radii[index])


# Flanks and axes of a mesh at a held point, as its loaded contact sees them: the flanks that carry, and what the
# expansion of the warm housing makes of the axes over the face.
#
# The axes stand as made (``axis_inclination``, ``axis_skew``), are moved by the bores of the warm housing and, where
# shafts bend, tilted by them and by the journals in their clearance. Signs: `rigdesign.coupling.alignment`.


@dataclass(frozen=True, kw_only=True)
class HeldFlanks:
    """Flanks of a warm mesh that carry at a held point, and its axes.

    micro : modifications and deviations of pinion and wheel; axes : over z
    """

    pair: GearPair
    micro: tuple[Microgeometry, Microgeometry]
    axes: AxisMisalignment
    flank: Flank

    @property
    def gap(self) -> FlankGap:
        """Gap of the loaded flanks, all teeth alike with their modifications, at the face positions of the contact.

        Raises DynamicsInputError for a micro-geometry that does not fit.
        """
        return modified_gap(PairGap.of_pair(self.pair, self.micro, self.axes), self.flank)

    @property
    def face_sense(self) -> float:
        """Face position z per face position of the contact, 1 or -1."""
        return face_sense(self.flank)


def held_flanks(rig: Rig, point: PointResult, mesh: int) -> HeldFlanks:
    """Flanks of a mesh, by its number, that its mean torque loads at a held point."""
    name, model = rig.mesh_names[mesh], point.last.models[mesh]
    response = point.last.response
    assert response is not None
    return HeldFlanks(
        pair=model.pair,
        micro=mesh_microgeometry(rig, name, model.pair),
        axes=warm_axes(rig, point, mesh),
        flank="front" if response.flank[mesh] > 0.0 else "back",
    )


def warm_axes(rig: Rig, point: PointResult, mesh: int) -> AxisMisalignment:
    """Misalignment of a mesh as made, by its shafts and by the expansion of its housing, where these are computed."""
    name = rig.mesh_names[mesh]
    expansion = point.last.expansion.get(name.gearbox)
    shape = None if expansion is None else expansion.deformed
    return axes_in_mesh(rig, name, point.last.coupling_state, shape)


Array = NDArray[np.float64]
ROOT = radians(15.0)
"""Least angle between fillet and tooth axis of the root: nearer to the flank the stress is that of the contact."""
TANGENT = radians(30.0)
"""Angle between fillet and tooth axis at the critical section of ISO 6336-3."""
POSITIONS = 64
"""Positions of a mesh cycle."""
FINE = 256
"""Positions of a mesh cycle for the contact ratio without load."""


@dataclass(frozen=True, kw_only=True)
class HeldContact:
    """A mesh under its mean load at a held point, and what follows from it, each computed when it is asked for.

    cold : the pair as drawn, of whose teeth the influence numbers are; force : transverse mesh force [N]
    positions : of the cycle, over one base pitch
    """

    cold: GearPair
    flanks: HeldFlanks
    force: float
    influence: ToothInfluence
    positions: int = POSITIONS

    @cached_property
    def gears(self) -> tuple[ElasticGear, ElasticGear]:
        """Influence numbers of pinion and wheel with their compliance."""
        pinion, wheel = zip(
            self.influence.of_pair(self.cold), self.influence.compliances(self.cold), strict=True
        )
        return ElasticGear(*pinion), ElasticGear(*wheel)

    @cached_property
    def mesh(self) -> LoadedMesh:
        """The warm pair on its compliant flanks."""
        pair = self.flanks.pair
        return LoadedMesh(
            pair=pair,
            gears=(self.gears[0].compliance, self.gears[1].compliance),
            grid=FaceGrid.over(pair.face_width, default_positions(pair, gap_varies=True)),
            gap=self.flanks.gap,
            n_positions=self.positions,
        )

    @cached_property
    def cycle(self) -> MeshCycle:
        """Contact over one mesh cycle."""
        return self.mesh.cycle(self.force)

    @property
    def edges(self) -> EdgeContact:
        """Contact at the tip edges and at the ends of the face."""
        return EdgeContact.of(self.cycle, self.flanks.flank)

    @cached_property
    def unloaded_contact_ratio(self) -> float:
        """In the limit of no load, modifications included [-]."""
        return unloaded_contact_ratio(self.mesh.points(self.cycle.points.reach, FINE))

    @cached_property
    def _fillets(self) -> tuple[RootCourse, RootCourse]:
        """Stress at all points of the fillets under the loaded flanks of pinion and wheel."""
        pinion, wheel = self.gears
        return root_course(self.cycle, *pinion, 0), root_course(self.cycle, *wheel, 1)

    @cached_property
    def roots(self) -> tuple[RootCourse, RootCourse]:
        """Root stress under the loaded flanks of pinion and wheel."""
        pinion, wheel = (
            course.within(gear.numbers.fillet.tangent >= ROOT)
            for course, gear in zip(self._fillets, self.gears, strict=True)
        )
        return pinion, wheel

    @cached_property
    def at_tangent(self) -> tuple[Array, Array]:
        """Highest stress at the 30 deg tangent over the face of pinion and wheel, (n_f,) each [Pa]."""
        pinion, wheel = (
            np.tensordot(gear.numbers.fillet.weights_at_tangent(TANGENT), course.stress, (0, 1)).max(axis=0)
            for course, gear in zip(self._fillets, self.gears, strict=True)
        )
        return pinion, wheel

    def transverse_load_factor(self, deviation: float) -> float:
        """K_Halpha with a base pitch deviation [m]."""
        return _transverse_load_factor(self, deviation)


def held_contact(rig: Rig, point: PointResult, mesh: int) -> HeldContact | None:
    """Contact of one mesh, by its number, at a held point; None without load and where the teeth are analytic."""
    response = point.last.response
    if rig.mesh_stiffness != "influence_numbers" or response is None:
        return None
    torque = abs(float(response.mean[mesh]))
    if torque < LEAST_TORQUE:
        return None
    flanks = held_flanks(rig, point, mesh)
    return kept_contact(
        HeldContact(
            cold=rig.pairs[rig.mesh_names[mesh]],
            flanks=flanks,
            force=torque / point.last.models[mesh].halves / flanks.pair.base_radii[0],
            influence=rig.tooth_influence,
        )
    )


@kept
def kept_contact(contact: HeldContact) -> HeldContact:
    """The first contact that was equal: what is computed of it serves ratings, checks and report alike."""
    return contact


@kept
def _transverse_load_factor(contact: HeldContact, deviation: float) -> float:
    return transverse_load_factor(contact.mesh, contact.cycle, deviation)


def loaded_contact(rig: Rig, point: PointResult, mesh: int) -> LoadedContact | None:
    """Record of the contact of one mesh, by its number, at a held point; None where there is none."""
    contact = held_contact(rig, point, mesh)
    if contact is None:
        return None
    response = point.last.response
    assert response is not None
    return LoadedContact(
        stage=point.point.stage,
        torque=abs(float(response.mean[mesh])),
        flank=contact.flanks.flank,
        axes=contact.flanks.axes,
        cycle=contact.cycle,
        unloaded_contact_ratio=contact.unloaded_contact_ratio,
        roots=contact.roots,
        at_tangent=contact.at_tangent,
        gauges=gauge_stresses(rig, rig.mesh_names[mesh], contact.cycle, contact.gears, contact.flanks.flank),
    )
