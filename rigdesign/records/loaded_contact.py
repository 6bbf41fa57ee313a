"""Loaded contact of the meshes from influence numbers: quasi-static, warm, at the held points.

All teeth alike, with the modifications of the flanks that carry. The axes are those of the warm housing, of shafts that
bend also by their bending and by where the journals stand in their clearance (`contact_gap.warm_axes`). The load is the
mean torque: a dynamic load on top of it evens out face and pairs. Helix slope deviations of manufacture are not in the
axes, and so not in K_Hbeta.
"""

from dataclasses import dataclass
from functools import cached_property
from math import radians

import numpy as np
from numpy.typing import NDArray

from dynamics.contact.contact_ratio import unloaded_contact_ratio
from dynamics.contact.face import FaceGrid, default_positions
from dynamics.contact.loaded_mesh import LoadedMesh
from dynamics.contact.mesh_cycle import MeshCycle
from dynamics.contact.pitch_deviation import transverse_load_factor
from dynamics.contact.root_course import RootCourse, root_course
from dynamics.gear.pair import GearPair
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.state import LEAST_TORQUE
from rigdesign.records.contact_gap import HeldFlanks, held_flanks
from rigdesign.records.gauge_stress import ElasticGear, gauge_stresses
from rigdesign.results.teeth import LoadedContact
from rigdesign.rig.model import Rig
from rigdesign.rig.tooth_influence import ToothInfluence
from thermal.fe.kept_results import kept

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
