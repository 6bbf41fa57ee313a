"""Load of the tooth pairs in motion: how they share the force of the mesh, and how it lies over the face."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from dynamics.contact.root_field import PairForces
from dynamics.drivetrain.loop_load import LoopLoad
from dynamics.drivetrain.static_loop import port_model, solve_static
from rigdesign.coupling.braced_loop import signed_torque
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.mesh_models import laws_of
from rigdesign.records import root
from rigdesign.records.dynamics import DynamicRun
from rigdesign.results.teeth import PairShare
from rigdesign.rig.model import Rig

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
    rig: Rig, point: PointResult, place: tuple[int, str], moving: PairForces, resting: PairForces
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
