"""What one rig may take over from another: cached parts that the difference between their cases leaves as they are."""

from rigdesign.case.gearbox import Gearbox
from rigdesign.rig.model import Rig

HOUSINGS = ("models", "conduction", "chamber_views")
"""Cached parts of a rig that depend on geometry and materials of its housings alone, as ``expansion`` does."""


def take_over(rig: Rig, source: Rig, parts: tuple[str, ...]) -> Rig:
    """Let ``rig`` use what ``source`` computes; computed now, so that no two rigs compute it twice.

    ``models`` bring the expansion set-up with them where every housing has one.
    """
    for name in parts:
        rig.__dict__[name] = getattr(source, name)
    if "models" in parts and not any(model.no_expansion for model in source.models.values()):
        rig.__dict__["expansion"] = source.expansion
    return rig


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
