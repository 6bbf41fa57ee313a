"""What one rig may take over from another: derived parts that the difference between their cases leaves as they are."""

from dataclasses import fields, replace

import numpy as np

from dynamics.rotor.rotor_model import ElasticRig, HousingSupport
from rigdesign.case.model import Case
from rigdesign.rig.model import Rig

LOADS = ("rotating", "misalignments")
"""Fields of an elastic rig that load its shafts and leave its modes as they are."""


def with_housings_of(rig: Rig, source: Rig) -> Rig:
    """The rig with what ``source`` computes of geometry and materials of its housings alone; computed now, so that no
    two rigs compute it twice.

    The expansion set-up comes along where every housing has one.
    """
    expands = not any(model.no_expansion for model in source.models.values())
    parts = replace(
        rig.parts,
        models=source.models,
        conduction=source.conduction,
        chamber_views=source.chamber_views,
        expansion=source.expansion if expands else None,
    )
    return replace(rig, parts=parts)


def with_circuit_of(rig: Rig, source: Rig) -> Rig:
    """The rig with what ``source`` computes of the parts of the power circuit alone; of none where there is none."""
    if source.case.drivetrain is None:
        return rig
    parts = replace(rig.parts, drivetrain=source.drivetrain, twisting=source.twisting, joints=source.joints)
    return replace(rig, parts=parts)


def with_all_of(rig: Rig, source: Rig) -> Rig:
    """The rig with what ``source`` computes and no setting of an operating point touches."""
    rig = with_circuit_of(with_housings_of(rig, source), source)
    bends = source.shaft_model == "elastic"
    parts = replace(
        rig.parts,
        geometries=source.geometries,
        speed_ratios=source.speed_ratios,
        mesh_forces=source.mesh_forces,
        axes=source.axes if bends else None,
        elastic=source.elastic if bends else None,
    )
    return replace(rig, parts=parts)


def with_elastic_of(rig: Rig, source: Rig) -> Rig:
    """The rig with what ``source`` knows of shafts that bend, as far as their parts are the same."""
    if _seated(rig) == _seated(source) and same_housings(rig, source):
        rig = replace(rig, parts=replace(rig.parts, seats=source.seats))
    elastic, other = rig.elastic, source.elastic
    if (elastic.faces, elastic.cutoff, elastic.pressed) == (other.faces, other.cutoff, other.pressed):
        if _same_parts(elastic.rig, other.rig):
            elastic = other
        elif _same_parts(elastic.rig, other.rig, LOADS):
            elastic = elastic.with_basis_of(other)
    parts = replace(rig.parts, elastic=elastic, axes=rig.axes, drivetrain=rig.drivetrain)
    return replace(rig, parts=parts)


def _seated(rig: Rig) -> tuple[object, ...]:
    """Where the bearings stand in their housings, and which of these yield."""
    boxes = rig.case.gearboxes.values()
    yielding = [box.housing is not None and box.housing.bearing_seats == "elastic" for box in boxes]
    if not any(yielding):
        return ()
    places = [(one.shaft, one.side) for box in boxes for one in box.bearings.values()]
    return (yielding, places, dict(rig.axes))


def _same_parts(one: ElasticRig, other: ElasticRig, without: tuple[str, ...] = ()) -> bool:
    """Whether two rigs have the same parts, some fields left out."""
    for entry in fields(one):
        if entry.name not in ("supports", *without) and getattr(one, entry.name) != getattr(
            other, entry.name
        ):
            return False
    return len(one.supports) == len(other.supports) and all(map(_same_support, one.supports, other.supports))


def _same_support(one: HousingSupport, other: HousingSupport) -> bool:
    if one is other:
        return True
    if (one.name, one.bearings) != (other.name, other.bearings):
        return False
    pairs = (one.stiffness, other.stiffness), (one.mass, other.mass), (one.damping, other.damping)
    return all(np.array_equal(np.asarray(a), np.asarray(b)) for a, b in pairs)


def same_housings(rig: Rig, stated: Rig) -> bool:
    """Whether meshes, conductivities and stiffnesses of the housings are the same."""
    if dict(rig.geometries) != dict(stated.geometries) or dict(rig.materials) != dict(stated.materials):
        return False
    return all(_made_of(rig.case, name) == _made_of(stated.case, name) for name in stated.geometries)


def _made_of(case: Case, name: str) -> tuple[object, ...]:
    """What a housing is meshed from in addition to its geometry, and its materials with those of shafts and gears."""
    box, housing = case.gearboxes[name], case.housings[name]
    shafts = [shaft.material for shaft in housing.shafts.values()]
    gears = [gear.material for gear in box.gears.values()]
    contact = housing.foot_contact is None
    file = housing.part_file, housing.faces
    return (file, housing.mesh, housing.material, housing.field.material, contact, shafts, gears)
