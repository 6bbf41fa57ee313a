"""The dynamic section of the result: K_V(n) with that of ISO 6336, gear data, crossings, time run, torque balance."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.static_loop import LoopLoad, port_model, solve_static
from dynamics.rotor.torsional_modes import DampingRecord, sampling_audit
from dynamics.tooth.root_field import PairForces
from dynamics.vibration.response_curve import CurvePoint
from rigdesign.base.part_name import MeshName
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.mesh_models import laws_of
from rigdesign.coupling.preloaded_loop import signed_torque
from rigdesign.postprocessing import root
from rigdesign.postprocessing.curves import factor_points, iso_factor
from rigdesign.postprocessing.dwell_speeds import dwell_record
from rigdesign.postprocessing.dynamic_root import dynamic_root
from rigdesign.postprocessing.dynamics import DynamicRun, numbered, ramp_history
from rigdesign.postprocessing.gear_loads import flank_ratings
from rigdesign.postprocessing.loaded_contact import loaded_contact
from rigdesign.postprocessing.run_torques import (
    mesh_swing,
    run_torques,
)
from rigdesign.postprocessing.solved_rig import SolvedRig
from rigdesign.postprocessing.spectra import held_spectra, waterfalls
from rigdesign.postprocessing.tooth_history import bent_both_ways
from rigdesign.results.dynamics import DynamicsResult, GearboxDynamics
from rigdesign.results.loads import (
    HeldBracing,
    JointDamping,
    ListedMode,
    MeshLoads,
    StageBracing,
    TorqueBalance,
)
from rigdesign.results.quantity import Records
from rigdesign.results.serialisation import dynamics as rows
from rigdesign.results.serialisation.teeth import (
    dynamic_root_rows,
    flank_rating_row,
    loaded_contact_row,
    tooth_history_row,
)
from rigdesign.results.serialisation.vibration import (
    campbell_row,
    dwell_row,
    section_torque_rows,
)
from rigdesign.results.teeth import PairShare
from rigdesign.results.vibration import (
    HeldTorque,
    RunTorque,
    SectionTorqueRecord,
    TorqueOverSpeed,
    TorquePlace,
)
from rigdesign.rig.model import Rig


def dynamics_section(solved: SolvedRig) -> DynamicsResult:
    """All of it as rows of the result, of a rig with loads."""
    rig, run, loads = solved.rig, solved.run, solved.loads
    assert run is not None and loads is not None
    sampling = sampling_audit(
        rig.drivetrain, rig.drive_speed(run.test.point.speed), rig.case.numerics.sample_rate
    )[0]
    vibration = solved.vibration
    torques = section_torque_record(solved, *vibration.torques)
    return DynamicsResult(
        gearboxes={
            rig.mesh_labels[name]: _mesh_section(solved, run, mesh, loads.meshes[rig.mesh_labels[name]])
            for mesh, name in enumerate(rig.mesh_names)
        },
        natural_frequencies=Records(
            ListedMode(
                mode=number,
                frequency=mode.frequency,
                damping_ratio=mode.damping_ratio,
                shape=mode.name,
                largest_at=mode.largest,
            )
            for number, mode in numbered(loads.modes)
        ),
        damping_audit=Records(_joint_damping(record) for record in loads.damping),
        sampling={
            "sample_rate_Hz": rig.case.numerics.sample_rate,
            "mesh_frequency_Hz": sampling.mesh_frequency,
            "samples_per_mesh": sampling.samples_per_mesh,
            "internal_steps_per_mesh": sampling.samples_per_mesh * rig.case.numerics.internal_steps,
        },
        bracing=Records(_held_bracing(bracing) for bracing in loads.bracing),
        ramp=ramp_history(rig, run.ramp),
        torque_balance=Records(torque_balance(rig, point) for point in run.points),
        tooth_histories=[
            tooth_history_row(history, rated=bent_both_ways(rig, gear))
            for gear, history in loads.teeth.items()
        ],
        loop_crossings=Records(loads.loop_crossings),
        campbell=campbell_row(vibration.campbell),
        section_torques=section_torque_rows(torques),
        dwell=dwell_row(dwell_record(solved, torques)),
        press_fits=Records(solved.press_fits),
        splines=Records(solved.splines),
        pair_shares=Records(pair_shares(rig, run)),
        waterfalls=Records(waterfalls(rig, run)),
        spectra=Records(held_spectra(rig, run)),
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
        stage_loads=Records(loads.stage_loads),
        dynamic_torque_peak_Nm=loads.torque_peak,
        iso_factors=_flat(asdict(iso)),
        lift_off=Records(loads.contact_losses),
        resonances=Records(loads.resonances),
        unsolved=Records(loads.unsolved),
        root_stress=[rows.root_stress_row(path) for path in loads.root_stress],
        root_stress_factor=Records(loads.root_stress_ratios),
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


def _joint_damping(record: DampingRecord) -> JointDamping:
    """A joint without damping has no corner frequency."""
    corner = record.corner_frequency
    return JointDamping(
        joint=record.name,
        kind=record.kind,
        damping_ratio=record.damping_ratio,
        corner_frequency=corner if math.isfinite(corner) else None,
        own_frequency=record.own_frequency,
        warning=record.warning,
    )


def _held_bracing(bracing: StageBracing) -> HeldBracing:
    warm, as_set = bracing.drift.warm, bracing.drift.initial
    return HeldBracing(
        stage=bracing.stage,
        mode=warm.mode,
        torque=float(warm.torque[0]),
        twist=warm.twist,
        axial_shift=warm.shift,
        half_gear_rotation=warm.rotation,
        actuator_force=warm.actuator_force,
        spline_friction=warm.friction_force,
        loop_stiffness=warm.loop_stiffness,
        torque_as_drawn=float(as_set.torque[0]),
        axial_shift_as_drawn=as_set.shift,
    )


def torque_balance(rig: Rig, point: PointResult) -> TorqueBalance:
    """Motor power against the losses of one held point."""
    response = point.last.response
    assert response is not None
    return TorqueBalance(
        stage=point.point.stage,
        drive_torque=response.drive_torque,
        drive_power=response.drive_torque * rig.drive_speed(point.point.speed),
        losses=math.fsum(placed.loss.power for placed in point.last.losses),
    )


# Load of the tooth pairs in motion: how they share the force of the mesh, and how it lies over the face.

Array = NDArray[np.float64]
POINTS = 161
"""Points of a share over the rolling angle."""


def pair_shares(rig: Rig, run: DynamicRun) -> Iterator[PairShare]:
    """Of every mesh that carries at every held stage."""
    for point in run.points:
        last = point.last
        assert last.system is not None and last.response is not None
        ports = port_model(last.system, laws_of(last.models))
        still = solve_static(ports, LoopLoad(torque=signed_torque(rig, point.point)))
        for mesh, name in enumerate(rig.mesh_names):
            model = last.models[mesh]
            (moving,) = root.dynamic_forces(model, [last.response], mesh)
            resting = root.static_forces(model, still, ports, mesh)
            if moving.force.any() and resting.force.any():
                yield _pair_share(rig, point, (mesh, name), moving, resting)


def _pair_share(
    rig: Rig, point: PointResult, place: tuple[int, MeshName], moving: PairForces, resting: PairForces
) -> PairShare:
    mesh, name = place
    radius = point.last.models[mesh].pair.base_radii[0]
    path, share, force = _over_path(moving)
    rest_path, rest_share, _ = _over_path(resting)
    carrying = path[force > 0.0]
    most, line_load, rest_load = _most_loaded(moving, resting)
    face, width = _slices(point, mesh)
    back = bool(point.last.response is not None and point.last.response.flank[mesh] < 0.0)
    grid = np.linspace(float(carrying.min()), float(carrying.max()), POINTS)
    return PairShare(
        mesh=rig.mesh_labels[name],
        stage=point.point.stage,
        angle=tuple((grid / radius).tolist()),
        share=tuple(np.interp(grid, path, share).tolist()),
        static_share=tuple(np.interp(grid, rest_path, rest_share, left=0.0, right=0.0).tolist()),
        force=tuple(np.interp(grid, path, force).tolist()),
        most_loaded=most / radius,
        face=tuple(face.tolist()),
        line_load=tuple(_over_face(line_load, width, back=back)),
        static_line_load=tuple(_over_face(rest_load, width, back=back)),
    )


def _most_loaded(moving: PairForces, resting: PairForces) -> tuple[float, Array, Array]:
    """Path at mid-face of the pair with the highest force of all states [m], and the forces of its slices then: in
    motion, and in the quasi-static state nearest on the path (n_slices,) [N]."""
    of_pair = moving.force.sum(axis=2)
    state, pair = np.unravel_index(int(np.argmax(of_pair)), of_pair.shape)
    path = float(moving.path[state, pair])
    near = np.unravel_index(int(np.argmin(np.abs(resting.path - path))), resting.path.shape)
    return path, np.asarray(moving.force[state, pair]), np.asarray(resting.force[near])


def _slices(point: PointResult, mesh: int) -> tuple[Array, float]:
    """Face positions of the slices from mid-face, rising [m], and the width of one [m]; none of a mesh of one slice."""
    face = point.last.models[mesh].law.slice_face
    if face is None or face.size < 2:
        return np.zeros(0), 1.0
    return np.sort(face), float(np.ptp(face)) / (face.size - 1)


def _over_face(force: Array, width: float, *, back: bool) -> list[float]:
    """Force per face width of the slices (n_slices,) [N/m]; those of the back flank come in reverse."""
    if force.size < 2:
        return []
    found: list[float] = ((force[::-1] if back else force) / width).tolist()
    return found


def _over_path(forces: PairForces) -> tuple[Array, Array, Array]:
    """Path of a pair, rising [m], its share of the force at that moment and its force over the mean of all."""
    of_pair = forces.force.sum(axis=2)
    total = of_pair.sum(axis=1, keepdims=True)
    share = np.divide(of_pair, total, out=np.zeros_like(of_pair), where=total > 0.0)
    order = np.argsort(forces.path, axis=None, kind="stable")
    relative = of_pair / max(float(total.mean()), 1e-300)
    return forces.path.ravel()[order], share.ravel()[order], relative.ravel()[order]


# Dynamic torque in every section of the shafts, every joint and mesh: held stages, over speed, in the time run.
#
# Held stages and curves over speed are periodic responses, the time run is read at every sample.


def section_torque_record(
    solved: SolvedRig, points: Sequence[CurvePoint], curves: tuple[TorqueOverSpeed, ...]
) -> SectionTorqueRecord:
    """Torques of the held points, of the governing curve, and of the time run of a rig with loads.

    points, curves : of `torques_over_speed`
    """
    assert solved.run is not None
    in_run = run_torques(solved.rig, solved.run.ramp)
    return SectionTorqueRecord(
        held=tuple(_held(solved, in_run)),
        torque=next(iter(solved.run.curves.named)),
        speeds=tuple(point.speed for point in points),
        curves=curves,
        run=in_run,
    )


def _held(solved: SolvedRig, run: Sequence[RunTorque]) -> Iterator[HeldTorque]:
    """Sections, joints and meshes of every held point with their peaks in the time run."""
    peaks = {(torque.place, torque.stage): torque.peak for torque in run}
    for point in solved.points:
        stage = point.point.stage
        for torque in solved.held_torques:
            if torque.stage == stage:
                yield replace(torque, run_peak=peaks.get((torque.place, stage)))
        yield from _held_meshes(solved, point)


def _held_meshes(solved: SolvedRig, point: PointResult) -> Iterator[HeldTorque]:
    rig, loads, response = solved.rig, solved.loads, point.last.response
    assert loads is not None and response is not None
    for mesh, name in enumerate(rig.mesh_names):
        label = rig.mesh_labels[name]
        stages = {load.stage: load.peak for load in loads.meshes[label].stage_loads}
        yield HeldTorque(
            place=TorquePlace(kind="mesh", part=label),
            stage=point.point.stage,
            speed=rig.pinion_speed(point.point.speed),
            swing=mesh_swing(response, mesh),
            run_peak=stages.get(point.point.stage),
            shear_stress=None,
        )
