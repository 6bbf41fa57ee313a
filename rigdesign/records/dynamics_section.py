"""The dynamic section of the result: K_V(n) with that of ISO 6336, gear data, crossings, time run, torque balance."""

import math
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from dynamics.drivetrain.modes import sampling_audit
from rigdesign.coupling.loop import PointResult
from rigdesign.records.contact_in_motion import pair_shares
from rigdesign.records.curves import factor_points, iso_factor
from rigdesign.records.dwell_speeds import dwell_record
from rigdesign.records.dynamic_root import dynamic_root
from rigdesign.records.dynamics import DynamicRun, numbered
from rigdesign.records.flank_rating import flank_ratings
from rigdesign.records.loaded_contact import loaded_contact
from rigdesign.records.reversed_bending import bent_both_ways
from rigdesign.records.section_torques import section_torque_record
from rigdesign.records.solved_rig import SolvedRig
from rigdesign.records.spectra import held_spectra, waterfalls
from rigdesign.records.time_run import ramp_history
from rigdesign.results.dynamics import DynamicsResult, GearboxDynamics
from rigdesign.results.loads import MeshLoads
from rigdesign.results.rows import dynamics as rows
from rigdesign.results.rows.seats import press_fit_row, spline_stress_row
from rigdesign.results.rows.teeth import (
    dynamic_root_rows,
    flank_rating_row,
    loaded_contact_row,
    pair_share_row,
    tooth_history_row,
)
from rigdesign.results.rows.vibration import (
    campbell_row,
    dwell_row,
    section_torque_rows,
    spectrum_row,
    waterfall_row,
)
from rigdesign.rig.model import Rig


def dynamics_section(solved: SolvedRig) -> DynamicsResult:
    """All of it as rows of the result, of a rig with loads."""
    rig, run, loads = solved.rig, solved.run, solved.loads
    drivetrain = rig.drivetrain
    assert drivetrain is not None and run is not None and loads is not None
    sampling = sampling_audit(
        drivetrain, rig.drive_speed(run.test.point.speed), rig.case.numerics.sample_rate
    )[0]
    vibration = solved.vibration
    torques = section_torque_record(solved, *vibration.torques)
    return DynamicsResult(
        gearboxes={
            rig.mesh_labels[name]: _mesh_section(solved, run, mesh, loads.meshes[rig.mesh_labels[name]])
            for mesh, name in enumerate(rig.mesh_names)
        },
        natural_frequencies=[rows.mode_row(number, mode) for number, mode in numbered(loads.modes)],
        damping_audit=[rows.damping_row(record) for record in loads.damping],
        sampling={
            "sample_rate_Hz": rig.case.numerics.sample_rate,
            "mesh_frequency_Hz": sampling.mesh_frequency,
            "samples_per_mesh": sampling.samples_per_mesh,
            "internal_steps_per_mesh": sampling.samples_per_mesh * rig.case.numerics.internal_steps,
        },
        bracing=[rows.bracing_row(bracing) for bracing in loads.bracing],
        ramp=ramp_history(rig, run.ramp),
        torque_balance=[torque_balance(rig, point) for point in run.points],
        tooth_histories=[
            tooth_history_row(history, rated=bent_both_ways(rig, gear))
            for gear, history in loads.teeth.items()
        ],
        loop_crossings=[rows.mode_crossing_row(crossing) for crossing in loads.loop_crossings],
        campbell=campbell_row(vibration.campbell),
        section_torques=section_torque_rows(torques),
        dwell=dwell_row(dwell_record(solved, torques)),
        press_fits=[press_fit_row(found) for found in solved.press_fits],
        splines=[spline_stress_row(found) for found in solved.splines],
        pair_shares=[pair_share_row(found) for found in pair_shares(rig, run)],
        waterfalls=[waterfall_row(found) for found in waterfalls(rig, run)],
        spectra=[spectrum_row(found) for found in held_spectra(rig, run)],
        dynamic_root=dynamic_root_rows(dynamic_root(rig, run)),
    )


def _mesh_section(solved: SolvedRig, run: DynamicRun, mesh: int, loads: MeshLoads) -> GearboxDynamics:
    """Section of one mesh; what depends on temperatures is that of the final mesh of the housing."""
    rig = solved.rig
    name = rig.mesh_names[mesh]
    response = run.test.last.response
    assert response is not None
    speed = rig.shaft_speed(rig.mesh_gear(mesh, 0).shaft, run.test.point.speed)
    iso = iso_factor(rig, name, float(response.mean[mesh]), speed)
    main = next(iter(run.curves.named))
    contact = loaded_contact(rig, solved.test, mesh)
    return GearboxDynamics(
        role=loads.role,
        torque=main,
        dynamic_factor=factor_points(rig, mesh, run.curves.response),
        dynamic_factor_at={
            other: factor_points(rig, mesh, curve)
            for other, (_, curve) in run.curves.named.items()
            if other != main
        },
        stage_loads=[rows.stage_load_row(load) for load in loads.stage_loads],
        dynamic_torque_peak_Nm=loads.torque_peak,
        iso_factors=_flat(asdict(iso)),
        lift_off=[rows.contact_loss_row(loss) for loss in loads.contact_losses],
        resonances=[rows.resonance_row(resonance) for resonance in loads.resonances],
        unsolved=[rows.unsolved_row(speed) for speed in loads.unsolved],
        root_stress=[rows.root_stress_row(path) for path in loads.root_stress],
        root_stress_factor=[rows.root_ratio_row(ratio) for ratio in loads.root_stress_ratios],
        geometry=rows.geometry_row(rig.pairs[name], solved.test.last.models[mesh]),
        flank_ratings=[flank_rating_row(rating) for rating in flank_ratings(rig, solved.points, mesh)],
        loaded_contact=None if contact is None else loaded_contact_row(contact),
    )


def _flat(record: Mapping[str, Any]) -> dict[str, float | str]:
    """Every factor by its printed symbol; nested stiffness factors side by side."""
    flat: dict[str, float | str] = {}
    for key, value in record.items():
        if isinstance(value, Mapping):
            flat |= _flat(value)
        elif isinstance(value, int | float | str):
            flat[key] = value
    return flat


def torque_balance(rig: Rig, point: PointResult) -> dict[str, Any]:
    """Motor power against the losses of one held point [W]."""
    response = point.last.response
    assert response is not None
    drive = response.drive_torque * rig.drive_speed(point.point.speed)
    losses = math.fsum(placed.loss.power for placed in point.last.losses)
    return {
        "stage": point.point.stage,
        "drive_torque_Nm": response.drive_torque,
        "drive_power_W": drive,
        "losses_W": losses,
        "joints_W": drive - losses,
    }
