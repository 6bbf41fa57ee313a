"""Mesh law of a warm mesh: tooth pairs as the analytic model or as influence numbers have them."""

from dataclasses import dataclass

import numpy as np

from dynamics.contact.influence_law import ContactLines, ElasticPair, contact_lines, influence_law
from dynamics.flank.microgeometry import Microgeometry
from dynamics.gear.pair import GearPair
from dynamics.mesh.flank import ContactDiscretisation, MeshDissipation, MeshPosition, mesh_law
from dynamics.mesh.law import MeshLaw
from dynamics.mesh.stiffness import PairStiffness, pair_stiffness
from dynamics.rating.iso_rating import RatingOptions, mesh_stiffness
from rigdesign.case.drivetrain import MeshStiffness
from rigdesign.rig.model import Rig
from rigdesign.rig.tooth_influence import ToothInfluence
from thermal.fe.kept_results import kept


@dataclass(frozen=True, kw_only=True)
class WarmMesh:
    """A warm gear pair, how it stands and what it is asked with.

    torque : on the pinion [N m], above 0
    micro, cold_micro : modifications and deviations of the flanks of the warm and of the cold pair
    """

    name: str
    pair: GearPair
    torque: float
    micro: tuple[Microgeometry, Microgeometry]
    cold_micro: tuple[Microgeometry, Microgeometry]
    position: MeshPosition
    dissipation: MeshDissipation
    discretisation: ContactDiscretisation


def springs_of(rig: Rig, mesh: WarmMesh, kind: MeshStiffness) -> tuple[PairStiffness, MeshLaw]:
    """Stiffness of one tooth pair over the path, and the mesh law, not yet damped."""
    box, name = rig.mesh(mesh.name)
    factor = box.meshes[name].stiffness_factor
    if kind == "influence_numbers":
        return _from_influence(rig, mesh, factor)
    shape = _analytic(rig, mesh, kind)
    shape = shape if factor == 1.0 else shape.scaled(factor)
    law = mesh_law(
        mesh.pair,
        shape,
        micro=mesh.micro,
        position=mesh.position,
        dissipation=mesh.dissipation,
        discretisation=mesh.discretisation,
    )
    return shape, law


def _analytic(rig: Rig, mesh: WarmMesh, kind: MeshStiffness) -> PairStiffness:
    pair = mesh.pair
    shape = pair_stiffness(pair, mesh.torque / pair.base_radii[0] / pair.face_width)
    if kind != "iso_6336_scaled":
        return shape.scaled(0.8)
    box, name = rig.mesh(mesh.name)
    entry = box.meshes[name]
    options = RatingOptions(
        application_factor=entry.application_factor, low_load_factor=entry.low_load_factor
    )
    return shape.scaled_to(mesh_stiffness(rig.pairs[mesh.name], mesh.torque, options))


def _from_influence(rig: Rig, mesh: WarmMesh, factor: float) -> tuple[PairStiffness, MeshLaw]:
    """Teeth as drawn and cold; thermal expansion is in their gaps and centre distance."""
    pair = mesh.pair
    cold = rig.pairs[mesh.name]
    law = influence_law(
        ElasticPair(
            pair=pair, gears=rig.tooth_influence.compliances(cold), force=mesh.torque / pair.base_radii[0]
        ),
        mesh.micro,
        position=mesh.position,
        dissipation=mesh.dissipation,
        discretisation=mesh.discretisation,
        lines=_lines(rig.tooth_influence, cold, mesh.cold_micro, mesh.discretisation),
    )
    law = law._replace(
        stiffness=factor * law.stiffness,
        body_compliance=law.body_compliance / factor,
        mean_stiffness=factor * law.mean_stiffness,
    )
    places = law.path_start + law.path_step * np.arange(law.stiffness.shape[1], dtype=np.float64)
    on_path = (places >= pair.path.start) & (places <= pair.path.end)
    # in series with the whole body: what a pair on its own gives
    alone = 1.0 / (1.0 / law.stiffness.sum(axis=0) + law.body_compliance)
    shape = PairStiffness(
        path=places[on_path], value=alone[on_path] / pair.face_width, base_pitch=pair.base_pitch
    )
    return shape, law


@kept
def _lines(
    influence: ToothInfluence,
    pair: GearPair,
    micro: tuple[Microgeometry, Microgeometry],
    discretisation: ContactDiscretisation,
) -> ContactLines:
    """Contact lines of a cold pair: the displacements of its slices, the same at every temperature."""
    return contact_lines(pair, influence.compliances(pair), micro, discretisation=discretisation)
