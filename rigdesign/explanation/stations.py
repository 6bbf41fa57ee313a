"""Where every key of the case enters the flow: module by module, with the physics it takes part in.

The nearest entry counts: of the key itself, else of its table. Every table has an entry, so that a new one has to say
where it enters. ``*`` stands for a name.
"""

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Station:
    """One place of the flow where a key enters."""

    module: str
    """Folder and module of the tool."""
    role: str
    """What the key does there."""


def _at(**roles: str) -> tuple[Station, ...]:
    return tuple(Station(module.replace("__", "/"), role) for module, role in roles.items())


def entering(path: str) -> tuple[Station, ...]:
    """Stations of a key, by its path with ``*`` for names; KeyError where no entry holds it or its table."""
    table = path.rpartition(".")[0]
    return STATIONS[path] if path in STATIONS else STATIONS[table]


_OIL_FLOW = "heat capacity flow of the oil stream: its outlet temperature"
_BOUNDARY = "film law of the surfaces of the condition, in the temperature field"
_GREY = "emission and reflection of the surfaces of a chamber"
_SHEET = "properties of the oil at every temperature, from its data sheet"
_BOX = "geometry of the housing that is meshed"
_WARM = "flank of the loaded contact: load distribution, transmission error, mesh stiffness"
_SUPPORT = "housing under the bearing: mass on a spring and damper in series with it"
_BENDING = "spring and damper between the ends of two shafts that bend"
_UNBALANCE = "force once a turn on a shaft that bends, with the square of its speed"
_LIMIT = "limit that a result is held against"

STATIONS: Mapping[str, tuple[Station, ...]] = {
    "": _at(run__main="names the case in results and report"),
    "schema_version": _at(case__model="tells the reader which keys to expect"),
    "drivetrain": _at(
        rig__drivetrain="shafts, couplings and motor of the power circuit; without it no loads are computed"
    ),
    "drivetrain.shaft_model": _at(
        rig__model="shafts that bend or only twist, at the fidelity of the run",
        coupling__loop_system="matrices of the loop: elastic with bearings, or torsional",
    ),
    "drivetrain.balance_grade": _at(rig__rotating_parts=_UNBALANCE),
    "drivetrain.shafts.*.balance_grade": _at(rig__rotating_parts=_UNBALANCE),
    "drivetrain.shafts.*.balance_speed": _at(rig__rotating_parts=_UNBALANCE),
    "drivetrain.shafts.*.balance_angles": _at(rig__rotating_parts=_UNBALANCE),
    "drivetrain.shafts.*.unbalances.*": _at(rig__rotating_parts=_UNBALANCE),
    "drivetrain.shafts.*.bow": _at(rig__rotating_parts="shape of a shaft without load, turning with it"),
    **{
        f"drivetrain.couplings.*.{key}": _at(
            rig__rotating_parts="flange out of true: load once a turn on two shafts"
        )
        for key in ("flange_run_out", "flange_run_out_angle", "flange_tilt", "flange_tilt_angle")
    },
    **{
        f"drivetrain.couplings.*.cold_angle_{key}": _at(
            rig__rotating_parts="moment on two shafts by axes that stand at an angle",
            rig__drivetrain="torque twice a turn of a cross joint",
            coupling__misalignment="moment of a cross joint on the bearings of its shafts",
        )
        for key in ("lateral", "vertical")
    },
    "drivetrain.couplings.*.joint": _at(
        rig__drivetrain="torque twice a turn of a cross joint",
        rig__rotating_parts="moment of a cross joint on both of its shafts, all the time and twice a turn",
    ),
    "drivetrain.bearing_coefficients": _at(
        coupling__loop_system="stiffness and damping under the shafts: of each operating point, or as stated"
    ),
    "ambient": _at(coupling__boundary="fluid of the films to room air"),
    "ambient.surroundings_temperature": _at(coupling__boundary="walls that surfaces radiate to"),
    "ambient.reference_temperature": _at(
        coupling__expansion="temperature without thermal expansion",
        coupling__mesh_models="cold geometry of the teeth",
    ),
    "ambient.warming_time": _at(
        coupling__boundary="heat stored in bodies that still warm up, as one implicit step"
    ),
    "oils.*": _at(rig__model=_SHEET, properties__oil="viscosity by Ubbelohde-Walther, density, heat data"),
    "oils.*.pressure_viscosity": _at(
        records__flank_rating="film between the flanks",
        coupling__mesh_friction="friction coefficient after Doleschel",
    ),
    "oils.*.scuffing_load_stage": _at(records__flank_rating="scuffing temperature of the oil"),
    "materials.*": _at(
        rig__model="material of gears, shafts and housing",
        coupling__expansion="thermal expansion",
        coupling__boundary="heat conduction of the bodies",
    ),
    "materials.*.elastic_modulus": _at(
        rig__gears="stiffness of the teeth",
        rig__drivetrain="shear modulus of the shafts",
        coupling__expansion="centrifugal expansion of journals",
    ),
    "materials.*.poisson_ratio": _at(
        rig__gears="stiffness of the teeth", rig__drivetrain="shear modulus of the shafts"
    ),
    "materials.*.density": _at(
        rig__drivetrain="inertia of shafts and gears", coupling__boundary="heat stored in bodies"
    ),
    "materials.*.root_strength": _at(checks__strength="strength of the tooth root"),
    "materials.*.flank_strength": _at(
        records__flank_rating="pitting strength of the flanks",
        records__curves="running-in allowance in K_V of ISO 6336-1",
    ),
    "materials.*.treatment": _at(
        records__flank_rating="life factor of the flanks",
        records__curves="running-in allowance in K_V of ISO 6336-1",
    ),
    "materials.*.scuffing_factor": _at(records__flank_rating="scuffing temperature of the flanks"),
    "materials.*.tempering_temperature": _at(
        checks__temperatures="temperature that gears keep a distance from"
    ),
    "gearboxes.*": _at(rig__model="one gearbox of the rig"),
    "gearboxes.*.role": _at(checks__strength="target window for specimens, safety for gears of the rig"),
    "gearboxes.*.gears.*": _at(
        rig__gears="tooth geometry: stiffness, root stress, backlash",
        rig__drivetrain="inertia and place on the shaft",
    ),
    "gearboxes.*.gears.*.quality_grade": _at(
        records__curves="K_V of ISO 6336-1",
        records__gear_loads="base pitch deviation of K_Falpha and K_Halpha",
        coupling__alignment="tolerances of the axes",
    ),
    "gearboxes.*.gears.*.flank_roughness": _at(
        coupling__mesh_friction="friction coefficient of the teeth",
        records__flank_rating="pitting strength, flash temperature and film thickness ratio",
    ),
    "gearboxes.*.gears.*.rim_thickness": _at(
        rig__gears="mass of the body, rim factor of the root stress",
        rig__drivetrain="inertia of the gear body",
        rig__tooth_influence="body under the teeth in their influence numbers",
        records__tooth_history="centrifugal stress of the rim in the root",
    ),
    "gearboxes.*.gears.*.web_thickness": _at(
        rig__gears="mass of the body, gear blank factor of ISO 6336-1",
        rig__drivetrain="inertia of the gear body",
        rig__tooth_influence="body under the teeth in their influence numbers",
    ),
    "gearboxes.*.gears.*.tip_edge": _at(
        rig__gears="end of the active flank: path of contact, tip corner",
        rig__tooth_influence="outline of the tooth in its influence numbers",
    ),
    "gearboxes.*.gears.*.shaft_interference": _at(
        records__tooth_history="tension of the press fit in the root of an idler, at speed, without temperature",
        records__press_fits="pressure and slip torque of the seat, hot and at speed",
    ),
    "gearboxes.*.gears.*.shaft_interference_minimum": _at(
        records__press_fits="pressure and slip torque of the seat, hot and at speed"
    ),
    "gearboxes.*.gears.*.helix_hand": _at(
        case__rotation="end of the face that comes into mesh last: sign of the misalignment over the face"
    ),
    "gearboxes.*.rotation": _at(
        case__rotation="flanks and end of the face that a misalignment of the axes loads"
    ),
    "gearboxes.*.gears.*.inertia": _at(rig__drivetrain="inertia of the gear body"),
    "gearboxes.*.gears.*.inertia_factor": _at(rig__drivetrain="inertia of the gear body"),
    "gearboxes.*.gears.*.flank": _at(coupling__microgeometry=_WARM),
    "gearboxes.*.gears.*.flank.topography": _at(
        rig__flank_topography="grid of the measured flanks, held against form circle, tip circle and face width",
        coupling__microgeometry=_WARM,
    ),
    "gearboxes.*.gears.*.flank.back_topography": _at(
        rig__flank_topography="grid of the measured back flanks, read and held against the gear",
        records__contact_gap="gap of a mesh that runs on its back flanks",
    ),
    "gearboxes.*.gears.*.flank.topography_interpolation": _at(
        rig__flank_topography="deviations between the places of the grid"
    ),
    "gearboxes.*.gears.*.flank.pitch_waves.*": _at(
        coupling__microgeometry="pitch deviations of the teeth: orders of the shaft"
    ),
    "gearboxes.*.gears.*.flank.weak_tooth": _at(
        coupling__microgeometry="stiffness of the pairs of one tooth: orders of the shaft"
    ),
    "gearboxes.*.gears.*.strain_gauges.*": _at(
        rig__strain_gauges="place in the tooth root, held against face width and fillet",
        records__gauge_stress="root stress there from influence numbers",
    ),
    "gearboxes.*.gears.*.strain_gauges.*.gauge_factor": _at(strain_gauge__bridge="strain to bridge voltage"),
    "gearboxes.*.gears.*.strain_gauges.*.resistance": _at(strain_gauge__bridge="strain to bridge voltage"),
    "gearboxes.*.gears.*.strain_gauges.*.transverse_sensitivity": _at(
        strain_gauge__gauge="strain that the gauge indicates"
    ),
    "gearboxes.*.gears.*.strain_gauges.*.stress_state": _at(
        rig__strain_gauges="strain to stress by Hooke's law"
    ),
    "gearboxes.*.gears.*.strain_gauges.*.bridge": _at(strain_gauge__bridge="strain to bridge voltage"),
    "gearboxes.*.gears.*.spline.toothing": _at(
        records__spline_capacity="stresses of teeth, shaft and hub at the largest torque of the seat"
    ),
    "gearboxes.*.gears.*.spline.loss_factor": _at(
        rig__drivetrain="friction between gear and shaft",
        coupling__loop_over_speed="its damper, by the mesh frequency of every speed",
    ),
    "gearboxes.*.gears.*.spline": _at(rig__drivetrain="spring and damper between gear and shaft"),
    "gearboxes.*.meshes.*": _at(
        rig__gears="geometry of the gear pair",
        coupling__mesh_models="mesh law: stiffness over the path of contact",
    ),
    "gearboxes.*.meshes.*.damping": _at(coupling__mesh_damping="damper of the mesh in the response"),
    "gearboxes.*.meshes.*.damping_ratio": _at(coupling__mesh_damping="damper of the mesh in the response"),
    "gearboxes.*.meshes.*.damping_acts_on": _at(
        coupling__mesh_models="damper of the mesh in the response", coupling__losses="work of the damper"
    ),
    "gearboxes.*.meshes.*.stiffness_factor": _at(coupling__tooth_springs="stiffness of the tooth pairs"),
    "gearboxes.*.meshes.*.friction_factor": _at(
        coupling__mesh_friction="friction coefficient: drag in the loop and heat of the mesh"
    ),
    "gearboxes.*.meshes.*.tooth_offset": _at(coupling__mesh_models="which teeth meet"),
    "gearboxes.*.meshes.*.phase": _at(
        coupling__mesh_models="phase of the mesh against the others of the loop"
    ),
    **{
        f"gearboxes.*.meshes.*.{key}": _at(
            coupling__alignment="deviation of the axes, with that of the warm housing",
            coupling__mesh_models="gap over the face in the mesh law, as made",
            records__contact_gap="gap over the face in the loaded contact",
        )
        for key in ("axis_inclination", "axis_skew")
    },
    "gearboxes.*.meshes.*.application_factor": _at(
        records__gear_loads="K_A of the ratings of root and flank and of the root stress over the path",
        records__curves="load of K_V by ISO 6336-1",
    ),
    "gearboxes.*.meshes.*.face_load_factor": _at(
        records__gear_loads="K_Fbeta of the root stress, K_Hbeta of the flanks, where no loaded contact is computed"
    ),
    "gearboxes.*.meshes.*.low_load_factor": _at(
        coupling__mesh_models="mean mesh stiffness of ISO 6336-1", records__curves="K_V of ISO 6336-1"
    ),
    "gearboxes.*.meshes.*.rack": _at(
        rig__gears="outline of the tooth with its fillet: stiffness and root stress"
    ),
    "gearboxes.*.meshes.*.rack.protuberance": _at(
        rig__gears="start of the active flank, root section of ISO 6336-3",
        rig__tooth_influence="outline of the fillet in the influence numbers",
    ),
    "gearboxes.*.meshes.*.rack.protuberance_angle": _at(
        rig__gears="outline of the fillet, of which the active flank begins at its end",
        rig__tooth_influence="outline of the fillet in the influence numbers",
    ),
    "gearboxes.*.oil": _at(rig__oil_supply="oil that is fed", coupling__oil=_OIL_FLOW),
    "gearboxes.*.oil.oil": _at(
        rig__oil_supply="oil data",
        coupling__losses="windage and jets",
        coupling__mesh_friction="viscosity in the friction of the teeth",
    ),
    "gearboxes.*.oil.inlet_temperature": _at(
        rig__oil_supply="temperature of the oil that is fed",
        coupling__mesh_friction="viscosity in the friction of the teeth, locked torque by bracing.temperature_drift",
        coupling__boundary="fluid of the films of wetted walls",
        coupling__oil="start of the heat balance of the stream",
    ),
    "gearboxes.*.oil.flow": _at(
        rig__oil_supply="oil that is fed",
        coupling__losses="power that brings the jets up to speed",
        coupling__flank_heat="film of the jets on the flanks",
        coupling__oil=_OIL_FLOW,
    ),
    "gearboxes.*.oil.jet_direction": _at(
        case__jets="power that brings the jets up to speed",
        coupling__flank_heat="film of the jets on the flanks",
    ),
    "gearboxes.*.oil.jet_velocity": _at(
        case__jets="velocity with which the oil arrives: power of the jets, film on the flanks"
    ),
    "gearboxes.*.oil.blocked_jets": _at(
        case__jets="velocity of the open jets", rig__oil_supply="wetted face width"
    ),
    "gearboxes.*.oil.lubrication": _at(
        case__lubrication="injection at the meshes, or a sump into which gears dip"
    ),
    "gearboxes.*.oil.level": _at(coupling__dip="depth to which the gears dip: churning, oil that they lift"),
    "gearboxes.*.oil.volume": _at(
        coupling__dip="oil bath of the churning laws", transient__oil="heat that the sump stores"
    ),
    "gearboxes.*.oil.sump_temperature": _at(
        coupling__temperatures="temperature at which the sump is held",
        coupling__boundary="fluid of the films of wetted walls",
        coupling__dip="viscosity of the oil that is churned",
    ),
    "gearboxes.*.oil.scuffing_load_stage": _at(records__flank_rating="scuffing temperature of the oil"),
    "gearboxes.*.oil.scuffing_temperature": _at(records__flank_rating="scuffing temperature of the oil"),
    "gearboxes.*.oil.churning": _at(coupling__dip="law of the churning loss"),
    "gearboxes.*.oil.plan_length": _at(coupling__dip="hydraulic length of ISO/TR 14179-2"),
    "gearboxes.*.oil.plan_width": _at(coupling__dip="hydraulic length of ISO/TR 14179-2"),
    "gearboxes.*.bearing_oil.lubrication": _at(
        case__lubrication="oil that is fed, splash of the gears, or grease"
    ),
    "gearboxes.*.bearing_oil": _at(rig__oil_supply="oil that is fed", coupling__oil=_OIL_FLOW),
    "gearboxes.*.bearing_oil.inlet_temperature": _at(
        rig__oil_supply="temperature of the oil that is fed",
        coupling__bearing_films="viscosity of the film, its heat balance",
    ),
    "gearboxes.*.bearings.*": _at(
        coupling__bearing_films="film, drag torque and heat of the bearing",
        case__geometry="journal and bore in the housing",
    ),
    "gearboxes.*.bearings.*.catalogue": _at(case__rolling_bearing="numbers of a bearing that no table has"),
    "gearboxes.*.bearings.*.diametral_clearance": _at(
        case__bearings="clearance that thermal expansion changes, film of the bearing"
    ),
    "gearboxes.*.bearings.*.feed": _at(case__bearings="arcs of the film, its load and stiffness"),
    "gearboxes.*.bearings.*.arrangement": _at(
        coupling__bearing_loads="which of two bearings the axial force presses"
    ),
    "gearboxes.*.bearings.*.locating": _at(case__geometry="point from which the shaft expands axially"),
    "gearboxes.*.bearings.*.axial_play": _at(
        records__warm_gearbox="axial play that thermal expansion uses up"
    ),
    "gearboxes.*.bearings.*.shell_conductance": _at(rig__joints="joint between shell and housing"),
    "gearboxes.*.bearings.*.torsional_damping": _at(
        coupling__bearing_films="drag torque where losses.bearing_drag is constant"
    ),
    "gearboxes.*.bearings.*.radial_stiffness": _at(
        coupling__loop_system="spring under the shaft, where drivetrain.bearing_coefficients is stated"
    ),
    "gearboxes.*.bearings.*.radial_damping": _at(
        coupling__loop_system="damper under the shaft, where drivetrain.bearing_coefficients is stated"
    ),
    "gearboxes.*.bearings.*.axial_stiffness": _at(
        rig__elastic_rig="axial spring of a locating bearing between shaft and housing"
    ),
    "gearboxes.*.bearings.*.support_stiffness": _at(rig__elastic_rig=_SUPPORT),
    "gearboxes.*.housing.bearing_seats": _at(rig__housing_seats=_SUPPORT),
    "gearboxes.*.bearings.*.support_damping": _at(rig__elastic_rig=_SUPPORT),
    "gearboxes.*.bearings.*.support_mass": _at(rig__elastic_rig=_SUPPORT),
    **{
        f"oil_circuits.*{table}": _at(
            case__oil_circuits="part of the circuit that feeds its consumers",
            coupling__oil_circuits="temperature at which oil is fed, heat of heater and cooler",
        )
        for table in (
            "",
            ".tank",
            ".pump",
            ".heater",
            ".tank_cooler",
            ".tank_cooler.coolant",
            ".tank_cooler.rated",
            ".lines.*",
            ".lines.*.cooler",
            ".lines.*.cooler.coolant",
            ".lines.*.cooler.rated",
            ".lines.*.supply_pipe",
            ".lines.*.return_pipe",
        )
    },
    "rig_heat": _at(coupling__rig_heat="heat of the rig outside of its gearboxes"),
    "rig_heat.machines.*": _at(
        case__rig_heat="machine between the rig and the mains",
        coupling__rig_heat="loss at what the rig takes: power from the mains, heat of coolant and room",
    ),
    "rig_heat.machines.*.loss_map.*": _at(
        case__rig_heat="loss of the machine over speed and torque of its output"
    ),
    "rig_heat.machines.*.coolant_share": _at(
        case__rig_heat_parts="split of its heat",
        coupling__oil_circuits="heat into the tank of the oil circuit that cools it",
        records__rig_heat="heat by where it goes",
    ),
    "rig_heat.couplings.*": _at(
        case__rig_heat_parts="rim and faces that stir air",
        coupling__rig_heat="windage of the coupling: load of the drive, heat of the room",
    ),
    "rig_heat.room": _at(records__rig_heat="balance of the room: its temperature and the air flow it needs"),
    "rig_heat.room.temperature_maximum": _at(checks__rig_heat=_LIMIT),
    "gearboxes.*.seals.*": _at(
        coupling__losses="loss of the seals",
        case__geometry="gap between shaft and wall",
        checks__clearances="warm gap and travel",
    ),
    "gearboxes.*.seals.*.rubbing_torque": _at(
        coupling__losses="friction heat of the seals and drag of the shaft"
    ),
    "gearboxes.*.seals.*.axial_travel": _at(checks__clearances=_LIMIT),
    "gearboxes.*.heat_split": _at(
        coupling__losses="share of a loss that heats bodies",
        coupling__boundary="heat sources on surfaces of the field",
    ),
    "gearboxes.*.heat_split.mesh_pinion_share": _at(
        coupling__flank_heat="friction heat between pinion and wheel"
    ),
    "gearboxes.*.heat_split.mesh": _at(
        case__heat_split="by which rule the friction heat divides",
        coupling__flank_heat="friction heat between gears and oil",
    ),
    "gearboxes.*.heat_split.mesh_into_gears": _at(coupling__flank_heat="friction heat between gears and oil"),
    "gearboxes.*.loss_factors": _at(
        coupling__losses="losses of the gearbox: heat and drag torque",
        coupling__mesh_friction="friction of the teeth in the loop",
    ),
    "gearboxes.*.oil_paths": _at(coupling__oil="ways of the gear oil: which heat which part of it takes up"),
    "gearboxes.*.oil_paths.bypass": _at(
        case__jets="flow that reaches the jets", coupling__oil="part of the oil that takes up no heat"
    ),
    "gearboxes.*.oil_state": _at(
        rig__oil_supply="properties of the oil as it runs: viscosity, heat capacity, conductivity"
    ),
    "gearboxes.*.housing": _at(case__geometry=_BOX),
    "gearboxes.*.housing.material": _at(rig__model="heat conduction and thermal expansion of the housing"),
    "gearboxes.*.housing.mesh_file": _at(rig__user_mesh="mesh in place of the parametric box"),
    "gearboxes.*.housing.step_file": _at(rig__user_mesh="CAD part in place of the parametric box"),
    "gearboxes.*.housing.faces": _at(rig__user_mesh="names of the faces of a STEP file"),
    "gearboxes.*.housing.ambient_film_factor": _at(coupling__boundary="films to room air"),
    "gearboxes.*.housing.bearing_film_factor": _at(
        coupling__boundary="conductance between bearing films and walls"
    ),
    "gearboxes.*.housing.radiation_included": _at(
        coupling__boundary="whether radiation is added to films to room air"
    ),
    "gearboxes.*.housing.foot_contact": _at(rig__joints="thermal contact between foot and clamping field"),
    "gearboxes.*.housing.foot_contact.joint": _at(
        rig__joints="conductance of two rough faces under pressure"
    ),
    "gearboxes.*.housing.field": _at(
        case__geometry="plate the gearbox stands on: heat path and hold of the foot"
    ),
    "gearboxes.*.housing.mesh": _at(
        case__mesh="element sizes of the temperature field: discretisation error"
    ),
    "gearboxes.*.housing.shafts.*": _at(
        case__geometry="shaft in the temperature field, diameters of its seals"
    ),
    "gearboxes.*.housing.enclosures.*": _at(
        coupling__enclosures="radiation between the surfaces of a chamber, in the temperature field",
        rig__chamber_views="view factors between them, by rays on the mesh",
    ),
    "gearboxes.*.housing.enclosures.*.emissivity": _at(case__enclosures=_GREY),
    "gearboxes.*.housing.enclosures.*.parts.*": _at(case__enclosures=_GREY),
    "gearboxes.*.housing.enclosures.*.opening_temperature": _at(
        coupling__enclosures="surroundings behind an opening of the chamber"
    ),
    "gearboxes.*.housing.volumes.*": _at(
        coupling__housing_fluids="volume of one temperature, found with the temperature field"
    ),
    "gearboxes.*.housing.streams.*": _at(
        coupling__housing_fluids="plug flow along surfaces: outlet temperature, heat carried off"
    ),
    "gearboxes.*.housing.links.*": _at(
        coupling__housing_fluids="conductance between a volume and another place"
    ),
    "gearboxes.*.housing.boundary.*": _at(coupling__boundary=_BOUNDARY),
    "gearboxes.*.housing.boundary.*.ribs": _at(case__ribs="fin array as a factor on the film"),
    "gearboxes.*.housing.boundary.*.taken_from": _at(
        coupling__boundary="doubt of a printed coefficient: warns where the field differs from what was assumed"
    ),
    "drivetrain.shafts.*": _at(rig__drivetrain="shaft of the power circuit"),
    "drivetrain.shafts.*.material_damping": _at(rig__drivetrain="dampers of the shaft elements"),
    "drivetrain.shafts.*.sections.*": _at(
        rig__drivetrain="stiffness and inertia of the shaft in torsion and bending",
        rig__shaft_torsion="torsional stress of the shaft",
    ),
    "drivetrain.shafts.*.discs.*": _at(rig__drivetrain="inertia on the shaft"),
    "drivetrain.shafts.*.discs.*.mass": _at(rig__drivetrain="mass on a shaft that bends"),
    "drivetrain.shafts.*.discs.*.diametral_inertia": _at(
        rig__drivetrain="inertia against the tilt of a shaft that bends"
    ),
    "drivetrain.couplings.*": _at(rig__drivetrain="spring and damper between two shafts"),
    **{
        f"drivetrain.couplings.*.{key}": _at(rig__drivetrain=_BENDING)
        for key in ("radial_stiffness", "axial_stiffness", "angular_stiffness", "lateral_damping_time")
    },
    "drivetrain.couplings.*.excitation.*": _at(rig__drivetrain="alternating torque between two shafts"),
    "drivetrain.couplings.*.radial_offset_maximum": _at(checks__alignment=_LIMIT),
    "drivetrain.couplings.*.angle_maximum": _at(checks__alignment=_LIMIT),
    "drivetrain.couplings.*.cold_offset_lateral": _at(
        coupling__alignment="place of the shafts before they warm up"
    ),
    "drivetrain.couplings.*.cold_offset_vertical": _at(
        coupling__alignment="place of the shafts before they warm up"
    ),
    "drivetrain.motor": _at(rig__drivetrain="inertia and place of the drive"),
    "drivetrain.motor.torque_limit": _at(
        coupling__time_run="most torque of the speed control over the schedule"
    ),
    "drivetrain.motor.ripple.*": _at(rig__drivetrain="alternating torque of the drive"),
    "drivetrain.bracing": _at(
        coupling__braced_loop="how the torque is locked in: what is held while parts expand"
    ),
    "drivetrain.torque_at": _at(rig__model="gear at which torque and speed of the schedule count"),
    "drivetrain.mesh_stiffness": _at(
        rig__model="tooth model at the fidelity of the run", coupling__tooth_springs="mesh law from it"
    ),
    "losses": _at(coupling__losses="which losses are computed"),
    "losses.chamber_density": _at(
        coupling__losses="windage and seal losses", coupling__boundary="films in oil mist"
    ),
    "losses.mesh_damping_heats_oil": _at(coupling__losses="whether work of the mesh dampers heats the oil"),
    "losses.bearing_drag": _at(coupling__bearing_films="drag torque of the bearings"),
    "losses.given.*": _at(coupling__given_losses="loss in place of a computed one"),
    "losses.friction": _at(
        coupling__mesh_friction="friction coefficient of the teeth: drag in the loop and heat of the mesh"
    ),
    "losses.friction.doleschel": _at(
        coupling__mesh_friction="friction coefficient of the teeth: constants of the oil"
    ),
    "schedule": _at(coupling__time_run="speed and torque over time"),
    "schedule.simulation_only": _at(run__main="doubt in the report that the rig cannot run so"),
    "schedule.stages.*": _at(
        case__schedule="speed and torque over time", coupling__time_run="time run over the schedule"
    ),
    "schedule.stages.*.held": _at(
        coupling__time_run="points at which temperatures are coupled with loads and losses"
    ),
    "schedule.stages.*.drive_torque": _at(
        coupling__time_run="run-up at constant torque instead of speed control"
    ),
    "test_plan": _at(records__gear_loads="load cycles of the teeth", transient__phases="length of the dwell"),
    "limits.standard_set": _at(case__limits="whether the standard set stands for limits that are left out"),
    "limits.clearances": _at(checks__clearances=_LIMIT, transient__limits="limit over the thermal history"),
    "limits.alignment": _at(checks__alignment=_LIMIT),
    "limits.temperatures": _at(checks__temperatures=_LIMIT),
    "limits.oil": _at(checks__oil=_LIMIT),
    "limits.bearing": _at(
        checks__films=_LIMIT,
        checks__rolling_bearings=_LIMIT,
        checks__ramp="torque below the transition speed",
    ),
    "limits.dynamics": _at(checks__dynamics=_LIMIT),
    **{
        f"limits.dynamics.{key}": _at(checks__lateral=_LIMIT)
        for key in (
            "orbit_share_maximum",
            "logarithmic_decrement_minimum",
            "lateral_separation_minimum",
            "torsional_separation_minimum",
        )
    },
    "limits.dynamics.dangerous_amplification": _at(records__resonances="which resonances are dangerous"),
    "limits.dynamics.dangerous_force_share": _at(records__resonances="which resonances are dangerous"),
    "limits.strength": _at(checks__strength=_LIMIT),
    "limits.flanks": _at(checks__flanks=_LIMIT),
    "limits.specimen": _at(checks__strength=_LIMIT),
    "limits.ramp": _at(checks__ramp=_LIMIT),
    "limits.bought_parts.*": _at(checks__component_limits=_LIMIT),
    "numerics": _at(coupling__convergence="end of the coupling loop"),
    "numerics.sample_rate": _at(coupling__time_run="samples of the time run"),
    "numerics.internal_steps": _at(coupling__time_run="integration steps of the time run"),
    "numerics.slices_spur": _at(coupling__mesh_models="slices over the face of spur gears"),
    "numerics.slices_helical": _at(coupling__mesh_models="slices over the face of helical gears"),
    "numerics.shaft_element_length": _at(rig__resolution="elements of the torsional model"),
    "numerics.curve_speed_start": _at(records__curves="first speed of the response over speed"),
    "numerics.curve_speed_end": _at(records__curves="last speed of the response over speed"),
    "numerics.curve_speeds": _at(records__curves="density of the response over speed"),
    "numerics.root_stress_speeds": _at(
        records__dynamic_root="speeds at which root stress and strain rate are shown over the rolling angle"
    ),
    "numerics.response_period": _at(
        coupling__tooth_deviations="which tooth deviations the periodic response holds"
    ),
    "events.*": _at(records__events="march from the steady state at speed and torque of the event"),
    "transient": _at(transient__phases="phases of the thermal history"),
    "transient.events": _at(transient__thermal_history="what is followed in addition to the schedule"),
    "transient.still_film": _at(transient__oil="least film of surfaces in still air"),
    "transient.settled_share": _at(run__transient="time until a quantity is steady"),
    "transient.tolerance": _at(transient__thermal_history="time steps of the thermal history"),
    "transient.probes.*": _at(transient__places="places whose temperature is kept"),
    "document": _at(report__issue="printed on the first page of the report; no result depends on it"),
}
"""Path of a key or of its table -> where it enters."""
