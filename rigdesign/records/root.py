"""Root stress of the teeth over the path of contact, dynamic and quasi-static."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.static_loop import PortModel, StaticState
from dynamics.mesh.force import ToothForces, tooth_forces
from dynamics.rating.root_stress import root_influence, root_stress_over_face
from dynamics.response.speed_sweep import CurvePoint
from rigdesign.coupling.loads import MeshModel
from rigdesign.results.loads import RootStressPath

Array = NDArray[np.float64]
Stress = tuple[Array, Array]
"""Path positions (n,) [m], rising, and root stress (n,) [Pa] of one tooth through its contact."""
Pair = tuple[Stress, Stress]
"""Of pinion and wheel."""
GEARS = ("pinion", "wheel")
PATH_POINTS = 161
"""Points of a stress history over the path of contact."""


def dynamic_stress(model: MeshModel, point: CurvePoint, mesh: int) -> Pair:
    """Root stress of one tooth of pinion and wheel at a periodic point.

    One mesh period holds every tooth at another place: put together by path they are one tooth's whole contact.
    """
    return dynamic_stresses(model, [point], mesh)[0]


def dynamic_stresses(model: MeshModel, points: Sequence[CurvePoint], mesh: int) -> list[Pair]:
    """The same at many periodic points; all of them together, as the tables of the law are made once."""
    states = np.concatenate(
        [
            (p.wave.angle[mesh], p.wave.approach[mesh], p.wave.omega_1[mesh], p.wave.omega_2[mesh])
            for p in points
        ],
        axis=1,
    )
    forces = tooth_forces(model.law, *states)
    ends = np.cumsum([0, *(point.wave.angle[mesh].size for point in points)])
    return [
        _stress(model, forces, slice(a, b), bool(point.flank[mesh] > 0))
        for point, a, b in zip(points, ends[:-1], ends[1:])
    ]


def static_stress(model: MeshModel, state: StaticState, ports: PortModel, mesh: int) -> Pair:
    """The same for the quasi-static state of the loop."""
    pinion = ports.pinions[mesh]
    angle = ports.ratios[pinion] * state.angles + state.ports[:, pinion]
    forces = tooth_forces(model.law, angle, state.approach[:, mesh])
    return _stress(model, forces, slice(None), bool(state.mean_torque[mesh] > 0.0))


def _stress(model: MeshModel, forces: ToothForces, states: slice, front: bool) -> Pair:
    path = (forces.path if front else forces.back_path)[states].ravel()
    slices = (forces.front if front else forces.back)[states].reshape(path.size, -1)
    touching = slices.sum(axis=1) > 0.0
    path, slices = path[touching], slices[touching]
    order = np.argsort(path, kind="stable")
    path, slices = path[order], slices[order]
    pinion, wheel = (
        root_stress_over_face(
            root_influence(model.pair, gear), slices, path, model.law.slice_shift, model.pair.face_width
        ).max(axis=1)
        for gear in (0, 1)
    )
    return (path, pinion), (path, wheel)


def peak(stress: Stress) -> float:
    """Largest root stress [Pa]; 0 without contact."""
    return float(stress[1].max(initial=0.0))


def over_path(gear: str, stage: str, base_radius: float, dynamic: Stress, static: Stress) -> RootStressPath:
    """Both curves on one grid of the rolling angle of the gear, zero at the pitch point.

    base_radius : of the gear [m]
    """
    low = min(dynamic[0].min(), static[0].min())
    high = max(dynamic[0].max(), static[0].max())
    path = np.linspace(low, high, PATH_POINTS)

    def on_grid(stress: Stress) -> tuple[float, ...]:
        return tuple(map(float, np.interp(path, *stress, left=0.0, right=0.0)))

    return RootStressPath(
        gear=gear,
        stage=stage,
        rolling_angle=tuple(float(s) / base_radius for s in path),
        dynamic=on_grid(dynamic),
        quasi_static=on_grid(static),
    )
