"""Where the keys of schedule, events, limits, numerics and transient enter the flow, and those of the case itself."""

from collections.abc import Mapping

from rigdesign.explanation.station import Station, stations_at

_LIMIT = "limit that a result is held against"

RUN_STATIONS: Mapping[str, tuple[Station, ...]] = {
    "": stations_at(run__main="names the case in results and report"),
    "schema_version": stations_at(case__model="selects the keys that are expected"),
    **{
        f"oil_circuits.*{table}": stations_at(
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
    "schedule": stations_at(coupling__time_run="speed and torque over time"),
    "schedule.simulation_only": stations_at(run__main="doubt in the report that the rig cannot run so"),
    "schedule.stages.*": stations_at(
        case__schedule="speed and torque over time", coupling__time_run="time run over the schedule"
    ),
    "schedule.stages.*.held": stations_at(
        coupling__time_run="points at which temperatures are coupled with loads and losses"
    ),
    "schedule.stages.*.drive_torque": stations_at(
        coupling__time_run="run-up at constant torque instead of speed control"
    ),
    "test_plan": stations_at(
        records__gear_loads="load cycles of the teeth", transient__phases="length of the dwell"
    ),
    "limits.standard_set": stations_at(
        case__limits="whether the standard set stands for limits that are left out"
    ),
    "limits.clearances": stations_at(
        checks__clearances=_LIMIT, transient__branch="limit over the thermal history"
    ),
    "limits.alignment": stations_at(checks__alignment=_LIMIT),
    "limits.temperatures": stations_at(checks__temperatures=_LIMIT),
    "limits.oil": stations_at(checks__oil=_LIMIT),
    "limits.bearing": stations_at(
        checks__films=_LIMIT,
        checks__rolling_bearings=_LIMIT,
        checks__ramp="torque below the transition speed",
    ),
    "limits.dynamics": stations_at(checks__dynamics=_LIMIT),
    **{
        f"limits.dynamics.{key}": stations_at(checks__lateral=_LIMIT)
        for key in (
            "orbit_share_maximum",
            "logarithmic_decrement_minimum",
            "lateral_separation_minimum",
            "torsional_separation_minimum",
        )
    },
    "limits.dynamics.dangerous_amplification": stations_at(
        records__resonances="which resonances are dangerous"
    ),
    "limits.dynamics.dangerous_force_share": stations_at(
        records__resonances="which resonances are dangerous"
    ),
    "limits.geometry": stations_at(checks__geometry=_LIMIT),
    "limits.strength": stations_at(checks__strength=_LIMIT),
    "limits.flanks": stations_at(checks__flanks=_LIMIT),
    "limits.specimen": stations_at(checks__strength=_LIMIT),
    "limits.ramp": stations_at(checks__ramp=_LIMIT),
    "limits.bought_parts.*": stations_at(checks__component_limits=_LIMIT),
    "numerics": stations_at(coupling__convergence="end of the coupling loop"),
    "numerics.sample_rate": stations_at(coupling__time_run="samples of the time run"),
    "numerics.internal_steps": stations_at(coupling__time_run="integration steps of the time run"),
    "numerics.slices_spur": stations_at(coupling__mesh_models="slices over the face of spur gears"),
    "numerics.slices_helical": stations_at(coupling__mesh_models="slices over the face of helical gears"),
    "numerics.shaft_element_length": stations_at(rig__resolution="elements of the torsional model"),
    "numerics.curve_speed_start": stations_at(records__curves="first speed of the response over speed"),
    "numerics.curve_speed_end": stations_at(records__curves="last speed of the response over speed"),
    "numerics.curve_speeds": stations_at(records__curves="density of the response over speed"),
    "numerics.root_stress_speeds": stations_at(
        records__dynamic_root="speeds at which root stress and strain rate are shown over the rolling angle"
    ),
    "numerics.response_period": stations_at(
        coupling__tooth_deviations="which tooth deviations the periodic response holds"
    ),
    "events.*": stations_at(records__events="march from the steady state at speed and torque of the event"),
    "transient": stations_at(transient__phases="phases of the thermal history"),
    "transient.events": stations_at(
        transient__thermal_history="what is followed in addition to the schedule"
    ),
    "transient.still_film": stations_at(transient__oil="least film of surfaces in still air"),
    "transient.settled_share": stations_at(run__transient="time until a quantity is steady"),
    "transient.tolerance": stations_at(transient__thermal_history="time steps of the thermal history"),
    "transient.probes.*": stations_at(transient__places="places whose temperature is kept"),
    "document": stations_at(report__issue="printed on the first page of the report; no result depends on it"),
}
"""By path, ``*`` for a name."""
