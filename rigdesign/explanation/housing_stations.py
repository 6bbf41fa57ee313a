"""Where the keys of housings, room and heat of the rig enter the flow."""

from collections.abc import Mapping

from rigdesign.explanation.station import Station, stations_at

_BOUNDARY = "film law of the surfaces of the condition, in the temperature field"
_GREY = "emission and reflection of the surfaces of a chamber"
_BOX = "geometry of the housing that is meshed"
_SUPPORT = "housing under the bearing: mass on a spring and damper in series with it"
_LIMIT = "limit that a result is held against"

HOUSING_STATIONS: Mapping[str, tuple[Station, ...]] = {
    "ambient": stations_at(coupling__boundary="fluid of the films to room air"),
    "ambient.surroundings_temperature": stations_at(coupling__boundary="walls that surfaces radiate to"),
    "ambient.reference_temperature": stations_at(
        coupling__expansion="temperature without thermal expansion",
        coupling__mesh_models="cold geometry of the teeth",
    ),
    "ambient.warming_time": stations_at(
        coupling__warm_up="heat stored in bodies that still warm up, marched from room temperature"
    ),
    "gearboxes.*.housing.bearing_seats": stations_at(rig__housing_seats=_SUPPORT),
    "rig_heat": stations_at(coupling__rig_heat="heat of the rig outside of its gearboxes"),
    "rig_heat.machines.*": stations_at(
        case__rig_heat="machine between the rig and the mains",
        coupling__rig_heat="loss at what the rig takes: power from the mains, heat of coolant and room",
    ),
    "rig_heat.machines.*.loss_map.*": stations_at(
        case__rig_heat="loss of the machine over speed and torque of its output"
    ),
    "rig_heat.machines.*.coolant_share": stations_at(
        case__rig_heat_parts="split of its heat",
        coupling__oil_circuits="heat into the tank of the oil circuit that cools it",
        records__rig_heat="heat by where it goes",
    ),
    "rig_heat.couplings.*": stations_at(
        case__rig_heat_parts="rim and faces that stir air",
        coupling__rig_heat="windage of the coupling: load of the drive, heat of the room",
    ),
    "rig_heat.room": stations_at(
        records__rig_heat="balance of the room: its temperature and the air flow it needs"
    ),
    "rig_heat.room.temperature_maximum": stations_at(checks__rig_heat=_LIMIT),
    "gearboxes.*.housing": stations_at(case__geometry=_BOX),
    "gearboxes.*.housing.material": stations_at(
        rig__model="heat conduction and thermal expansion of the housing"
    ),
    "gearboxes.*.housing.mesh_file": stations_at(rig__user_mesh="mesh in place of the parametric box"),
    "gearboxes.*.housing.step_file": stations_at(rig__user_mesh="CAD part in place of the parametric box"),
    "gearboxes.*.housing.faces": stations_at(rig__user_mesh="names of the faces of a STEP file"),
    "gearboxes.*.housing.ambient_film_factor": stations_at(coupling__boundary="films to room air"),
    "gearboxes.*.housing.surface_film_factors": stations_at(
        coupling__boundary="film of one wall to room air"
    ),
    "gearboxes.*.housing.bearing_film_factor": stations_at(
        coupling__boundary="conductance between bearing films and walls"
    ),
    "gearboxes.*.housing.radiation_included": stations_at(
        coupling__boundary="whether radiation is added to films to room air"
    ),
    "gearboxes.*.housing.foot_contact": stations_at(
        rig__joints="thermal contact between foot and clamping field"
    ),
    "gearboxes.*.housing.foot_contact.joint": stations_at(
        rig__joints="conductance of two rough faces under pressure"
    ),
    "gearboxes.*.housing.field": stations_at(
        case__geometry="plate the gearbox stands on: heat path and hold of the foot"
    ),
    "gearboxes.*.housing.mesh": stations_at(
        rig__model="element sizes of the temperature field: discretisation error"
    ),
    "gearboxes.*.housing.shafts.*": stations_at(
        case__geometry="shaft in the temperature field, diameters of its seals"
    ),
    "gearboxes.*.housing.enclosures.*": stations_at(
        coupling__enclosures="radiation between the surfaces of a chamber, in the temperature field",
        rig__chamber_views="view factors between them, by rays on the mesh",
    ),
    "gearboxes.*.housing.enclosures.*.emissivity": stations_at(case__enclosures=_GREY),
    "gearboxes.*.housing.enclosures.*.parts.*": stations_at(case__enclosures=_GREY),
    "gearboxes.*.housing.enclosures.*.opening_temperature": stations_at(
        coupling__enclosures="surroundings behind an opening of the chamber"
    ),
    "gearboxes.*.housing.volumes.*": stations_at(
        coupling__housing_fluids="volume of one temperature, found with the temperature field"
    ),
    "gearboxes.*.housing.streams.*": stations_at(
        coupling__housing_fluids="plug flow along surfaces: outlet temperature, heat carried off"
    ),
    "gearboxes.*.housing.links.*": stations_at(
        coupling__housing_fluids="conductance between a volume and another place"
    ),
    "gearboxes.*.housing.boundary.*": stations_at(coupling__boundary=_BOUNDARY),
    "gearboxes.*.housing.boundary.*.ribs": stations_at(case__ribs="fin array as a factor on the film"),
    "gearboxes.*.housing.boundary.*.taken_from": stations_at(
        coupling__boundary="doubt of a printed coefficient: warns where the field differs from what was assumed"
    ),
}
"""By path, ``*`` for a name."""
