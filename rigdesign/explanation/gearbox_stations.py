"""Where the keys of gearboxes, oils, materials and losses enter the flow."""

from collections.abc import Mapping

from rigdesign.explanation.station import Station, stations_at

_OIL_FLOW = "heat capacity flow of the oil stream: its outlet temperature"
_SHEET = "properties of the oil at every temperature, from its data sheet"
_WARM = "flank of the loaded contact: load distribution, transmission error, mesh stiffness"
_SUPPORT = "housing under the bearing: mass on a spring and damper in series with it"
_LIMIT = "limit that a result is held against"

GEARBOX_STATIONS: Mapping[str, tuple[Station, ...]] = {
    "oils.*": stations_at(
        rig__model=_SHEET, properties__oil="viscosity by Ubbelohde-Walther, density, heat data"
    ),
    "oils.*.pressure_viscosity": stations_at(
        records__flank_rating="film between the flanks",
        coupling__mesh_friction="friction coefficient after Doleschel",
    ),
    "oils.*.scuffing_load_stage": stations_at(records__flank_rating="scuffing temperature of the oil"),
    "materials.*": stations_at(
        rig__model="material of gears, shafts and housing",
        coupling__expansion="thermal expansion",
        coupling__boundary="heat conduction of the bodies",
    ),
    "materials.*.elastic_modulus": stations_at(
        rig__gears="stiffness of the teeth",
        rig__drivetrain="shear modulus of the shafts",
        coupling__expansion="centrifugal expansion of journals",
    ),
    "materials.*.poisson_ratio": stations_at(
        rig__gears="stiffness of the teeth", rig__drivetrain="shear modulus of the shafts"
    ),
    "materials.*.density": stations_at(
        rig__drivetrain="inertia of shafts and gears", coupling__boundary="heat stored in bodies"
    ),
    "materials.*.root_strength": stations_at(checks__strength="strength of the tooth root"),
    "materials.*.flank_strength": stations_at(
        records__flank_rating="pitting strength of the flanks",
        records__curves="running-in allowance in K_V of ISO 6336-1",
    ),
    "materials.*.treatment": stations_at(
        records__flank_rating="life factor of the flanks",
        records__curves="running-in allowance in K_V of ISO 6336-1",
    ),
    "materials.*.scuffing_factor": stations_at(records__flank_rating="scuffing temperature of the flanks"),
    "materials.*.tempering_temperature": stations_at(
        checks__temperatures="temperature that gears keep a distance from"
    ),
    "gearboxes.*": stations_at(rig__model="one gearbox of the rig"),
    "gearboxes.*.role": stations_at(
        checks__strength="target window for specimens, safety for gears of the rig"
    ),
    "gearboxes.*.gears.*": stations_at(
        rig__gears="tooth geometry: stiffness, root stress, backlash",
        rig__drivetrain="inertia and place on the shaft",
    ),
    "gearboxes.*.gears.*.quality_grade": stations_at(
        records__curves="K_V of ISO 6336-1",
        records__gear_loads="base pitch deviation of K_Falpha and K_Halpha",
        coupling__alignment="tolerances of the axes",
    ),
    "gearboxes.*.gears.*.flank_roughness": stations_at(
        coupling__mesh_friction="friction coefficient of the teeth",
        records__flank_rating="pitting strength, flash temperature and film thickness ratio",
    ),
    "gearboxes.*.gears.*.rim_thickness": stations_at(
        rig__gears="mass of the body, rim factor of the root stress",
        rig__drivetrain="inertia of the gear body",
        rig__tooth_influence="body under the teeth in their influence numbers",
        records__tooth_history="centrifugal stress of the rim in the root",
    ),
    "gearboxes.*.gears.*.web_thickness": stations_at(
        rig__gears="mass of the body, gear blank factor of ISO 6336-1",
        rig__drivetrain="inertia of the gear body",
        rig__tooth_influence="body under the teeth in their influence numbers",
    ),
    "gearboxes.*.gears.*.tip_edge": stations_at(
        rig__gears="end of the active flank: path of contact, tip corner",
        rig__tooth_influence="outline of the tooth in its influence numbers",
    ),
    "gearboxes.*.gears.*.shaft_interference": stations_at(
        records__tooth_history="tension of the press fit in the root of an idler, at speed, without temperature",
        records__press_fits="pressure and slip torque of the seat, hot and at speed",
    ),
    "gearboxes.*.gears.*.shaft_interference_minimum": stations_at(
        records__press_fits="pressure and slip torque of the seat, hot and at speed"
    ),
    "gearboxes.*.gears.*.helix_hand": stations_at(
        case__rotation="end of the face that comes into mesh last: sign of the misalignment over the face"
    ),
    "gearboxes.*.rotation": stations_at(
        case__rotation="flanks and end of the face that a misalignment of the axes loads"
    ),
    "gearboxes.*.gears.*.inertia": stations_at(rig__drivetrain="inertia of the gear body"),
    "gearboxes.*.gears.*.inertia_factor": stations_at(rig__drivetrain="inertia of the gear body"),
    "gearboxes.*.gears.*.flank": stations_at(coupling__microgeometry=_WARM),
    "gearboxes.*.gears.*.flank.topography": stations_at(
        rig__flank_topography="grid of the measured flanks, held against form circle, tip circle and face width",
        coupling__microgeometry=_WARM,
    ),
    "gearboxes.*.gears.*.flank.back_topography": stations_at(
        rig__flank_topography="grid of the measured back flanks, read and held against the gear",
        records__contact_gap="gap of a mesh that runs on its back flanks",
    ),
    "gearboxes.*.gears.*.flank.topography_interpolation": stations_at(
        rig__flank_topography="deviations between the places of the grid"
    ),
    "gearboxes.*.gears.*.flank.pitch_waves.*": stations_at(
        coupling__microgeometry="pitch deviations of the teeth: orders of the shaft"
    ),
    "gearboxes.*.gears.*.flank.weak_tooth": stations_at(
        coupling__microgeometry="stiffness of the pairs of one tooth: orders of the shaft"
    ),
    "gearboxes.*.gears.*.strain_gauges.*": stations_at(
        rig__strain_gauges="place in the tooth root, held against face width and fillet",
        records__gauge_stress="root stress there from influence numbers",
    ),
    "gearboxes.*.gears.*.strain_gauges.*.gauge_factor": stations_at(
        strain_gauge__gauge="strain to change of resistance"
    ),
    "gearboxes.*.gears.*.strain_gauges.*.resistance": stations_at(
        strain_gauge__bridge="strain to bridge voltage"
    ),
    "gearboxes.*.gears.*.strain_gauges.*.transverse_sensitivity": stations_at(
        strain_gauge__gauge="strain that the gauge indicates"
    ),
    "gearboxes.*.gears.*.strain_gauges.*.stress_state": stations_at(
        rig__strain_gauges="strain to stress by Hooke's law"
    ),
    "gearboxes.*.gears.*.strain_gauges.*.response_time": stations_at(
        prediction__root_strain="low-pass of the measuring chain, in predictions that data are held against"
    ),
    "gearboxes.*.gears.*.strain_gauges.*.bridge": stations_at(
        strain_gauge__bridge="strain to bridge voltage"
    ),
    "gearboxes.*.gears.*.spline.toothing": stations_at(
        records__spline_capacity="stresses of teeth, shaft and hub at the largest torque of the seat"
    ),
    "gearboxes.*.gears.*.spline.loss_factor": stations_at(
        rig__drivetrain="friction between gear and shaft",
        coupling__loop_over_speed="its damper, by the mesh frequency of every speed",
    ),
    "gearboxes.*.gears.*.spline": stations_at(rig__drivetrain="spring and damper between gear and shaft"),
    **{
        f"gearboxes.*.gears.*.spline.{key}": stations_at(
            rig__drivetrain="seat of a gear with all its freedoms on a shaft that bends"
        )
        for key in ("radial_stiffness", "axial_stiffness", "angular_stiffness", "lateral_damping_time")
    },
    "gearboxes.*.gears.*.seat_offset": stations_at(
        rig__drivetrain="place of the seat, and lever of the gear on a shaft that bends"
    ),
    "gearboxes.*.meshes.*": stations_at(
        rig__gears="geometry of the gear pair",
        coupling__mesh_models="mesh law: stiffness over the path of contact",
    ),
    "gearboxes.*.meshes.*.carrying_halves": stations_at(
        coupling__mesh_models="springs and dampers of the mesh in the loop, and the torque on each of its halves",
        rig__drivetrain="mass of the gear bodies, where no inertia is stated",
    ),
    "gearboxes.*.meshes.*.damping": stations_at(coupling__mesh_damping="damper of the mesh in the response"),
    "gearboxes.*.meshes.*.damping_ratio": stations_at(
        coupling__mesh_damping="damper of the mesh in the response"
    ),
    "gearboxes.*.meshes.*.damping_acts_on": stations_at(
        coupling__mesh_models="damper of the mesh in the response", coupling__losses="work of the damper"
    ),
    "gearboxes.*.meshes.*.stiffness_factor": stations_at(
        coupling__tooth_springs="stiffness of the tooth pairs"
    ),
    "gearboxes.*.meshes.*.friction_factor": stations_at(
        coupling__mesh_friction="friction coefficient: drag in the loop and heat of the mesh"
    ),
    "gearboxes.*.meshes.*.tooth_offset": stations_at(coupling__mesh_models="which teeth meet"),
    "gearboxes.*.meshes.*.phase": stations_at(
        coupling__mesh_models="phase of the mesh against the others of the loop"
    ),
    **{
        f"gearboxes.*.meshes.*.{key}": stations_at(
            coupling__alignment="deviation of the axes, with that of the warm housing",
            coupling__mesh_models="gap over the face in the mesh law, as made",
            records__contact_gap="gap over the face in the loaded contact",
        )
        for key in ("axis_inclination", "axis_skew")
    },
    "gearboxes.*.meshes.*.application_factor": stations_at(
        records__gear_loads="K_A of the ratings of root and flank and of the root stress over the path",
        records__curves="load of K_V by ISO 6336-1",
    ),
    "gearboxes.*.meshes.*.face_load_factor": stations_at(
        records__gear_loads="K_Fbeta of the root stress, K_Hbeta of the flanks, where no loaded contact is computed"
    ),
    "gearboxes.*.meshes.*.low_load_factor": stations_at(
        coupling__mesh_models="mean mesh stiffness of ISO 6336-1", records__curves="K_V of ISO 6336-1"
    ),
    "gearboxes.*.meshes.*.rack": stations_at(
        rig__gears="outline of the tooth with its fillet: stiffness and root stress"
    ),
    "gearboxes.*.meshes.*.rack.protuberance": stations_at(
        rig__gears="start of the active flank, root section of ISO 6336-3",
        rig__tooth_influence="outline of the fillet in the influence numbers",
    ),
    "gearboxes.*.meshes.*.rack.protuberance_angle": stations_at(
        rig__gears="outline of the fillet, of which the active flank begins at its end",
        rig__tooth_influence="outline of the fillet in the influence numbers",
    ),
    "gearboxes.*.oil": stations_at(rig__oil_supply="oil that is fed", coupling__oil=_OIL_FLOW),
    "gearboxes.*.oil.oil": stations_at(
        rig__oil_supply="oil data",
        coupling__losses="windage and jets",
        coupling__mesh_friction="viscosity in the friction of the teeth",
    ),
    "gearboxes.*.oil.inlet_temperature": stations_at(
        rig__oil_supply="temperature of the oil that is fed",
        coupling__mesh_friction="viscosity in the friction of the teeth, locked torque by bracing.temperature_drift",
        coupling__boundary="fluid of the films of wetted walls",
        coupling__oil="start of the heat balance of the stream",
    ),
    "gearboxes.*.oil.flow": stations_at(
        rig__oil_supply="oil that is fed",
        coupling__losses="power that brings the jets up to speed",
        coupling__flank_heat="film of the jets on the flanks",
        coupling__oil=_OIL_FLOW,
    ),
    "gearboxes.*.oil.jet_direction": stations_at(
        case__jets="power that brings the jets up to speed",
        coupling__flank_heat="film of the jets on the flanks",
    ),
    "gearboxes.*.oil.jet_velocity": stations_at(
        case__jets="velocity with which the oil arrives: power of the jets, film on the flanks"
    ),
    "gearboxes.*.oil.blocked_jets": stations_at(
        case__jets="velocity of the open jets", rig__oil_supply="wetted face width"
    ),
    "gearboxes.*.oil.lubrication": stations_at(
        case__lubrication="injection at the meshes, or a sump into which gears dip"
    ),
    "gearboxes.*.oil.level": stations_at(
        coupling__dip="depth to which the gears dip: churning, oil that they lift"
    ),
    "gearboxes.*.oil.volume": stations_at(
        coupling__dip="oil bath of the churning laws", transient__oil="heat that the sump stores"
    ),
    "gearboxes.*.oil.sump_temperature": stations_at(
        coupling__temperatures="temperature at which the sump is held",
        coupling__boundary="fluid of the films of wetted walls",
        coupling__dip="viscosity of the oil that is churned",
    ),
    "gearboxes.*.oil.scuffing_load_stage": stations_at(
        records__flank_rating="scuffing temperature of the oil"
    ),
    "gearboxes.*.oil.scuffing_temperature": stations_at(
        records__flank_rating="scuffing temperature of the oil"
    ),
    "gearboxes.*.oil.churning": stations_at(coupling__dip="law of the churning loss"),
    "gearboxes.*.oil.plan_length": stations_at(coupling__dip="hydraulic length of ISO/TR 14179-2"),
    "gearboxes.*.oil.plan_width": stations_at(coupling__dip="hydraulic length of ISO/TR 14179-2"),
    "gearboxes.*.bearing_oil.lubrication": stations_at(
        case__lubrication="oil that is fed, splash of the gears, or grease"
    ),
    "gearboxes.*.bearing_oil": stations_at(rig__oil_supply="oil that is fed", coupling__oil=_OIL_FLOW),
    "gearboxes.*.bearing_oil.inlet_temperature": stations_at(
        rig__oil_supply="temperature of the oil that is fed",
        coupling__bearing_films="viscosity of the film, its heat balance",
    ),
    "gearboxes.*.bearings.*": stations_at(
        coupling__bearing_films="film, drag torque and heat of the bearing",
        case__geometry="journal and bore in the housing",
    ),
    "gearboxes.*.bearings.*.catalogue": stations_at(
        case__rolling_bearing="numbers of a bearing that no table has"
    ),
    "gearboxes.*.bearings.*.diametral_clearance": stations_at(
        case__bearings="clearance that thermal expansion changes, film of the bearing"
    ),
    "gearboxes.*.bearings.*.feed": stations_at(case__bearings="arcs of the film, its load and stiffness"),
    "gearboxes.*.bearings.*.arrangement": stations_at(
        coupling__bearing_loads="which of two bearings the axial force presses"
    ),
    "gearboxes.*.bearings.*.locating": stations_at(
        case__geometry="point from which the shaft expands axially"
    ),
    "gearboxes.*.bearings.*.axial_play": stations_at(
        records__warm_gearbox="axial play that thermal expansion uses up"
    ),
    "gearboxes.*.bearings.*.shell_conductance": stations_at(rig__joints="joint between shell and housing"),
    "gearboxes.*.bearings.*.friction_factor": stations_at(
        coupling__bearing_films="friction heat and drag torque of one bearing"
    ),
    "gearboxes.*.bearings.*.torsional_damping": stations_at(
        coupling__bearing_films="drag torque where losses.bearing_drag is constant"
    ),
    "gearboxes.*.bearings.*.radial_stiffness": stations_at(
        coupling__loop_system="spring under the shaft, where drivetrain.bearing_coefficients is stated"
    ),
    "gearboxes.*.bearings.*.radial_damping": stations_at(
        coupling__loop_system="damper under the shaft, where drivetrain.bearing_coefficients is stated"
    ),
    "gearboxes.*.bearings.*.axial_stiffness": stations_at(
        rig__elastic_rig="axial spring of a locating bearing between shaft and housing"
    ),
    "gearboxes.*.bearings.*.support_stiffness": stations_at(rig__elastic_rig=_SUPPORT),
    "gearboxes.*.bearings.*.support_damping": stations_at(rig__elastic_rig=_SUPPORT),
    "gearboxes.*.bearings.*.support_mass": stations_at(rig__elastic_rig=_SUPPORT),
    "gearboxes.*.seals.*": stations_at(
        coupling__losses="loss of the seals",
        case__geometry="gap between shaft and wall",
        checks__clearances="warm gap and travel",
    ),
    "gearboxes.*.seals.*.rubbing_torque": stations_at(
        coupling__losses="friction heat of the seals and drag of the shaft"
    ),
    "gearboxes.*.seals.*.axial_travel": stations_at(checks__clearances=_LIMIT),
    "gearboxes.*.heat_split": stations_at(
        coupling__losses="share of a loss that heats bodies",
        coupling__boundary="heat sources on surfaces of the field",
    ),
    "gearboxes.*.heat_split.mesh_pinion_share": stations_at(
        coupling__flank_heat="friction heat between pinion and wheel"
    ),
    "gearboxes.*.heat_split.mesh": stations_at(
        case__heat_split="by which rule the friction heat divides",
        coupling__flank_heat="friction heat between gears and oil",
    ),
    "gearboxes.*.heat_split.mesh_into_gears": stations_at(
        coupling__flank_heat="friction heat between gears and oil"
    ),
    "gearboxes.*.loss_factors": stations_at(
        coupling__losses="losses of the gearbox: heat and drag torque",
        coupling__mesh_friction="friction of the teeth in the loop",
    ),
    "gearboxes.*.oil_paths": stations_at(
        coupling__oil="ways of the gear oil: which heat which part of it takes up"
    ),
    "gearboxes.*.oil_paths.leak_front_share": stations_at(
        coupling__leak_by_side="temperature of the oil in the cold chamber of each side"
    ),
    "gearboxes.*.oil_paths.bypass": stations_at(
        case__jets="flow that reaches the jets", coupling__oil="part of the oil that takes up no heat"
    ),
    "gearboxes.*.oil_state": stations_at(
        rig__oil_supply="properties of the oil as it runs: viscosity, heat capacity, conductivity"
    ),
    "losses": stations_at(coupling__losses="which losses are computed"),
    "losses.chamber_density": stations_at(
        coupling__losses="windage and seal losses", coupling__boundary="films in oil mist"
    ),
    "losses.mesh_damping_heats_oil": stations_at(
        coupling__losses="whether work of the mesh dampers heats the oil"
    ),
    "losses.bearing_drag": stations_at(coupling__bearing_films="drag torque of the bearings"),
    "losses.given.*": stations_at(coupling__point_losses="loss in place of a computed one"),
    "losses.friction": stations_at(
        coupling__mesh_friction="friction coefficient of the teeth: drag in the loop and heat of the mesh"
    ),
    "losses.friction.doleschel": stations_at(
        coupling__mesh_friction="friction coefficient of the teeth: constants of the oil"
    ),
}
"""By path, ``*`` for a name."""
