"""Root stress of the teeth over the path of contact, dynamic and quasi-static."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dynamics.linear_system import LinearSystem
from dynamics.mesh_force import tooth_forces
from dynamics.response_curve import CurvePoint
from dynamics.root_stress import root_influence, root_stress_over_face
from dynamics.static_loop import StaticState, port_model, solve_static
from rigdesign.loads import MeshModel, laws_of
from rigdesign.results import RootStressHistory

Array = NDArray[np.float64]
GEARS = ("pinion", "wheel")
PATH_POINTS = 161
"""Points of a stress history over the path of contact."""


def static_state(system: LinearSystem, models: tuple[MeshModel, ...], torque: float) -> StaticState:
    """Quasi-static loop over one mesh at the torque [N m] of the first mesh, without friction."""
    model = port_model(system, laws_of(models))
    return solve_static(model, torque=torque)


def dynamic_stress(model: MeshModel, point: CurvePoint, mesh: int, gear: int) -> tuple[Array, Array]:
    """Path positions (n,) [m] and root stress (n,) [Pa] of one tooth at a periodic point.

    One mesh period holds every tooth at another place: put together by path they are one tooth's whole contact.
    """
    wave = point.wave
    return _stress(
        model, gear, point.flank[mesh] > 0, wave.angle[mesh], wave.approach[mesh], wave.omega_1[mesh], wave.omega_2[mesh]
    )


def static_stress(
    model: MeshModel, state: StaticState, system: LinearSystem, models: tuple[MeshModel, ...], mesh: int, gear: int
) -> tuple[Array, Array]:
    """The same for the quasi-static state."""
    ports = port_model(system, laws_of(models))
    angle = ports.ratios[2 * mesh] * state.angles + state.ports[:, 2 * mesh]
    front = float(state.mean_torque[mesh]) > 0.0
    return _stress(model, gear, front, angle, state.approach[:, mesh], 0.0, 0.0)


def _stress(
    model: MeshModel,
    gear: int,
    front: bool,
    angle: ArrayLike,
    approach: ArrayLike,
    omega_1: ArrayLike,
    omega_2: ArrayLike,
) -> tuple[Array, Array]:
    forces = tooth_forces(model.law, angle, approach, omega_1, omega_2)
    path = (forces.path if front else forces.back_path).ravel()
    slices = (forces.front if front else forces.back).reshape(path.size, -1)
    touching = slices.sum(axis=1) > 0.0
    path, slices = path[touching], slices[touching]
    order = np.argsort(path, kind="stable")
    influence = root_influence(model.pair, gear)
    stress = root_stress_over_face(
        influence, slices[order], path[order], model.law.slice_shift, model.pair.face_width
    )
    return path[order], stress.max(axis=1)


def peak(stress: tuple[Array, Array]) -> float:
    """Largest root stress [Pa]; 0 without contact."""
    return float(stress[1].max(initial=0.0))


def history(gear: str, base_radius: float, dynamic: tuple[Array, Array], static: tuple[Array, Array]) -> RootStressHistory:
    """Both curves on one grid of the rolling angle of the gear, zero at the pitch point."""
    low = min(dynamic[0].min(), static[0].min())
    high = max(dynamic[0].max(), static[0].max())
    path = np.linspace(low, high, PATH_POINTS)

    def on_grid(stress: tuple[Array, Array]) -> list[float]:
        values = np.interp(path, *stress, left=0.0, right=0.0)
        return [float(value) * 1e-6 for value in values]

    return RootStressHistory(
        gear=gear,
        rolling_angle_deg=[math.degrees(float(s) / base_radius) for s in path],
        dynamic_MPa=on_grid(dynamic),
        quasi_static_MPa=on_grid(static),
    )
