"""What one rig may take over from another: cached parts that the difference between their cases leaves as they are."""

from dataclasses import fields

import numpy as np

from dynamics.rotor.rotor_model import ElasticRig, HousingSupport
from rigdesign.case.gearbox import Gearbox
from rigdesign.rig.model import Rig

HOUSINGS = ("models", "conduction", "chamber_views")
"""Cached parts of a rig that depend on geometry and materials of its housings alone, as ``expansion`` does."""
TWISTING = ("drivetrain", "twisting", "system", "joints")
"""Cached parts that depend on the parts of the power circuit alone."""
LOADS = ("rotating", "misalignments")
"""Fields of an elastic rig that load its shafts and leave its modes as they are."""


def take_over(rig: Rig, source: Rig, parts: tuple[str, ...]) -> Rig:
    """Let ``rig`` use what ``source`` computes; computed now, so that no two rigs compute it twice.

    ``models`` bring the expansion set-up with them where every housing has one. Of a power circuit nothing is taken
    over where there is none.
    """
    for name in parts:
        if name in TWISTING and source.drivetrain is None:
            continue
        rig.__dict__[name] = getattr(source, name)
    if "models" in parts and not any(model.no_expansion for model in source.models.values()):
        rig.__dict__["expansion"] = source.expansion
    return rig


def share_elastic(rig: Rig, source: Rig) -> None:
    """Let ``rig`` use what ``source`` knows of shafts that bend, as far as their parts are the same."""
    if _seated(rig) == _seated(source) and same_housings(rig, source):
        take_over(rig, source, ("_seats",))
    own, other = rig.elastic, source.elastic
    if (own.faces, own.cutoff, own.pressed) != (other.faces, other.cutoff, other.pressed):
        return
    if _same_parts(own.rig, other.rig):
        rig.__dict__["elastic"] = other
    elif _same_parts(own.rig, other.rig, LOADS):
        own.take_basis(other)


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
    boxes, others = rig.case.gearboxes, stated.case.gearboxes
    return all(_made_of(boxes[name]) == _made_of(others[name]) for name in stated.geometries)


def _made_of(box: Gearbox) -> tuple[object, ...]:
    """What a housing is meshed from in addition to its geometry, and its materials with those of shafts and gears."""
    housing = box.housing
    assert housing is not None
    shafts = [shaft.material for shaft in housing.shafts.values()]
    gears = [gear.material for gear in box.gears.values()]
    contact = housing.foot_contact is None
    file = housing.part_file, housing.faces
    return (file, housing.mesh, housing.material, housing.field.material, contact, shafts, gears)
