"""Joints of a housing that pass heat from metal to metal: the foot on its field, bearing shells in their bores."""

from collections.abc import Sequence
from dataclasses import replace

from rigdesign.case.gearbox import Gearbox
from rigdesign.rig.model import Rig
from thermal.conditions.boundary import Film
from thermal.conditions.contact import Contact
from thermal.conduction.setup import Condition
from thermal.films import convection
from thermal.films.law import FilmCoefficient, FilmLaw
from thermal.films.still import air
from thermal.housing.housing_surfaces import FOOT, SEAT

FOOT_CONTACT = "foot_contact"
"""Kind of the rows of the foot joint in the heat balance."""

JOINT = "shell_conductance"
"""Among the inputs of a film behind a shell: the conductance of the joint [W/(m2 K)]."""


def foot_joint(rig: Rig, name: str) -> list[Contact]:
    """The contact of foot and field of gearbox ``name``; none where they share their nodes."""
    housing = rig.case.gearboxes[name].housing
    if housing is None or housing.foot_contact is None:
        return []
    entry = housing.foot_contact
    if entry.conductance is not None:
        path = f"gearboxes.{name}.housing.foot_contact.conductance"
        law = convection.constant(entry.conductance, rig.case.provenance(path))
    else:
        assert entry.joint is not None
        foot, field = (
            rig.materials[each].conductivity for each in (housing.material, housing.field.material)
        )
        law = entry.joint.law((foot, field), air(rig.case.ambient.temperature).conductivity)
    return [Contact(surface_a=FOOT, surface_b=SEAT, kind=FOOT_CONTACT, law=law)]


def behind_shell(rig: Rig, name: str, surface: str, law: FilmLaw) -> FilmLaw:
    """Film of a surface; on a bearing bore in series with the joint of its shell."""
    part = bearing_of_bore(rig.case.gearboxes[name], surface)
    if part is None:
        return law
    conductance = rig.case.gearboxes[name].bearings[part].shell_conductance
    if conductance is None:
        return law
    path = f"gearboxes.{name}.bearings.{part}.shell_conductance"
    whole = convection.series(law, convection.constant(conductance, rig.case.provenance(path)))

    def behind(wall: float, fluid: float) -> FilmCoefficient:
        film = whole(wall, fluid)
        return replace(film, inputs=film.inputs | {JOINT: conductance})

    return behind


def shell_temperature(surface: str, wall: float, conditions: Sequence[Condition]) -> float:
    """What a sensor in a bearing shell reads [K], from the mean temperature of its bore in the housing.

    conditions : of the housing as solved. The heat that crosses the joint into the ``wall`` drops by q / conductance
    there; where the case joins shell and housing without a resistance both are one.
    """
    for condition in conditions:
        if isinstance(condition, Film) and condition.surface == surface:
            film = condition.law(wall, condition.fluid_temperature)
            if film.inputs.get(JOINT):
                return wall + film.value / film.inputs[JOINT] * (condition.fluid_temperature - wall)
    return wall


def bearing_of_bore(box: Gearbox, surface: str) -> str | None:
    """The bearing whose bore in the housing a surface is; None for another surface."""
    bores = {f"bearing_bore_{b.shaft}_{b.side}": name for name, b in box.bearings.items()}
    return bores.get(surface)
