"""Contact of the teeth in motion: how the pairs share the force, and where on speed and torque contact is lost."""

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from dynamics.contact.root_field import PairForces
from dynamics.drivetrain.loop_load import LoopLoad
from dynamics.drivetrain.speed_bands import DrivetrainOverSpeed, SpeedBands
from dynamics.drivetrain.static_loop import port_model, solve_static
from dynamics.response.speed_sweep import CurvePoint, SweepSettings, periodic_response
from rigdesign.coupling.braced_loop import signed_torque
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.mesh_models import laws_of
from rigdesign.coupling.tooth_deviations import periodic_laws
from rigdesign.records import root
from rigdesign.records.curves import own_ratio, resolved
from rigdesign.records.dynamics import DynamicRun
from rigdesign.records.loop_states import LoopState
from rigdesign.results.contact_in_motion import ContactLossMap, PairShare
from rigdesign.rig.model import Rig

Array = NDArray[np.float64]
POINTS = 161
"""Points of a share over the rolling angle."""
SHARES = (0.05, 0.1, 0.2, 0.4, 1.0)
"""Torques of the map over the test torque."""
SPEEDS = 28
"""Speeds of the map, evenly over the range of the curves."""


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
    rig: Rig, point: PointResult, place: tuple[int, str], moving: PairForces, resting: PairForces
) -> PairShare:
    mesh, name = place
    radius = point.last.models[mesh].pair.base_radii[0]
    path, share, force = _over_path(moving)
    rest_path, rest_share, _ = _over_path(resting)
    carrying = path[force > 0.0]
    grid = np.linspace(float(carrying.min()), float(carrying.max()), POINTS)
    return PairShare(
        mesh=rig.mesh_labels[name],
        stage=point.point.stage,
        angle=tuple((grid / radius).tolist()),
        share=tuple(np.interp(grid, path, share).tolist()),
        static_share=tuple(np.interp(grid, rest_path, rest_share, left=0.0, right=0.0).tolist()),
        force=tuple(np.interp(grid, path, force).tolist()),
    )


def _over_path(forces: PairForces) -> tuple[Array, Array, Array]:
    """Path of a pair, rising [m], its share of the force at that moment and its force over the mean of all."""
    of_pair = forces.force.sum(axis=2)
    total = of_pair.sum(axis=1, keepdims=True)
    share = np.divide(of_pair, total, out=np.zeros_like(of_pair), where=total > 0.0)
    order = np.argsort(forces.path, axis=None, kind="stable")
    relative = of_pair / max(float(total.mean()), 1e-300)
    return forces.path.ravel()[order], share.ravel()[order], relative.ravel()[order]


def contact_loss_maps(rig: Rig, run: DynamicRun, states: Sequence[LoopState]) -> tuple[ContactLossMap, ...]:
    """Of every mesh, by harmonic balance under the warm teeth of the governing held point; bearings as they run there.

    None at quick fidelity and where the response repeats after a revolution or more: its points cost too much.
    """
    if not resolved(rig):
        return ()
    low, high = float(run.curves.response.speeds[0]), float(run.curves.response.speeds[-1])
    speeds = np.linspace(low, high, SPEEDS)
    torques = [share * rig.case.schedule.test_torque for share in SHARES]
    rows = [_row(rig, run, _bands(rig, states), share, speeds) for share in SHARES]
    found = []
    for mesh, name in enumerate(rig.mesh_names):
        found.append(
            ContactLossMap(
                mesh=rig.mesh_labels[name],
                speed=tuple((own_ratio(rig, mesh) * speeds).tolist()),
                torque=tuple(torques),
                least_share=tuple(
                    tuple(None if p is None else float(p.minimum[mesh] / p.mean[mesh]) for p in row)
                    for row in rows
                ),
                lift_off=tuple(
                    tuple(None if p is None else float(p.lift_off_share[mesh]) for p in row) for row in rows
                ),
            )
        )
    return tuple(found)


def _row(
    rig: Rig, run: DynamicRun, drivetrain: DrivetrainOverSpeed, share: float, speeds: Array
) -> list[CurvePoint | None]:
    """Response at every speed under a share of the test torque."""
    warm = run.test.last
    held = signed_torque(rig, warm.point)
    torque = math.copysign(share * rig.case.schedule.test_torque * abs(held / warm.point.torque), held)
    curve = periodic_response(
        drivetrain,
        periodic_laws(rig, laws_of(warm.models)),
        speeds,
        LoopLoad(torque=torque),
        drag_torques=warm.drags,
        settings=SweepSettings(
            period=rig.case.numerics.response_period,
            cutoff=rig.highest_mode,
            methods=("harmonic_balance",),
            branches=False,
        ),
    )
    found = {point.speed: point for point in curve.points}
    return [found.get(float(speed)) for speed in speeds]


def _bands(rig: Rig, states: Sequence[LoopState]) -> DrivetrainOverSpeed:
    """The nearest state at every speed."""
    speeds = [rig.pinion_speed(state.speed) for state in states]
    if len({id(state.system) for state in states}) == 1:
        return states[0].system
    limits = tuple(math.sqrt(a * b) for a, b in pairwise(speeds))
    return SpeedBands(limits=limits, systems=tuple(state.system for state in states))
