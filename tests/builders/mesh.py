"""Synthetic mesh laws and the smallest drivetrains for the tests of mesh forces and time response."""

import numpy as np

from dynamics.rotor.linear_system import LinearSystem, line_shapes
from dynamics.tooth.law import MeshLaw

BASE_RADIUS_1 = 46.5e-3
TEETH = (99, 102)
BASE_PITCH = 2.0 * np.pi * BASE_RADIUS_1 / TEETH[0]
BASE_RADIUS_2 = BASE_RADIUS_1 * TEETH[1] / TEETH[0]


def mesh_law(
    path: np.ndarray,
    stiffness: np.ndarray,
    gap: np.ndarray,
    slice_shift: np.ndarray | None = None,
    **changes: object,
) -> MeshLaw:
    """A law of the size of P2's test gear from tables over the path (n_slices, n_path)."""
    n_slices, n_path = stiffness.shape
    none = np.zeros((1, n_path))
    law = MeshLaw(
        base_radius_1=BASE_RADIUS_1, base_radius_2=BASE_RADIUS_2, base_pitch=BASE_PITCH, teeth_1=TEETH[0],
        teeth_2=TEETH[1], tooth_offset_2=0, path_start=float(path[0]), path_step=float(path[1] - path[0]),
        stiffness=stiffness, gap=gap, slice_shift=np.zeros(n_slices) if slice_shift is None else slice_shift,
        deviation_1=none, deviation_2=none, scale_1=np.ones(1), scale_2=np.ones(1), backlash=100e-6, offset=0.0,
        phase=0.0, back_phase=0.3 * BASE_PITCH, damping=0.0, mean_stiffness=1.1e8, friction=0.0,
        rolling_radius_1=15e-3, rolling_radius_2=16e-3, friction_reversal_speed=0.05,
    )  # fmt: skip
    return law._replace(**changes)  # type: ignore[arg-type]


def spur_law(n_slices: int = 5, contact_ratio: float = 1.26, span: float = 0.0, **changes: object) -> MeshLaw:
    """Relieved teeth that enter smoothly; ``span`` is the lag over the face width of a helical gear [m]."""
    active = contact_ratio * BASE_PITCH
    path = np.linspace(-0.6 * active - 0.2 * BASE_PITCH, 0.6 * active + 0.2 * BASE_PITCH, 401)
    q = path / (0.5 * active)
    outside = np.clip(np.abs(q) - 1.0, 0.0, None) * 0.5 * active
    shape = np.clip(1.0 - 0.35 * q**2, 0.3, None)
    mean = np.sum(np.where(np.abs(q) <= 1.0, shape, 0.0)) * (path[1] - path[0]) / BASE_PITCH
    gap = 7e-6 * np.minimum(q**2, 1.0) + 40.0 * outside**2
    law = mesh_law(
        path,
        np.tile(shape * 1.1e8 / mean / n_slices, (n_slices, 1)),
        np.tile(gap, (n_slices, 1)),
        np.linspace(-0.5 * span, 0.5 * span, n_slices) if n_slices > 1 else None,
    )
    return law._replace(**changes)  # type: ignore[arg-type]


def ramped_law(contact_ratio: float = 1.26, ramp: float = 0.4, **changes: object) -> MeshLaw:
    """One stiffness over the path without gaps, rising and falling over ``ramp`` base pitches."""
    length = (contact_ratio + ramp) * BASE_PITCH
    path = np.linspace(-0.5 * length, 0.5 * length, 401)
    inward = np.clip((0.5 * length - np.abs(path)) / (ramp * BASE_PITCH), 0.0, 1.0)
    stiffness = (0.5 - 0.5 * np.cos(np.pi * inward))[None] * 1.1e8 / contact_ratio
    return mesh_law(path, stiffness, np.zeros_like(stiffness), **changes)


def wavy_law(depth: float = 0.25, points: int = 201, **changes: object) -> MeshLaw:
    """One contact for ever, its stiffness a cosine over the base pitch: k(phi)."""
    path = np.linspace(0.0, BASE_PITCH, points)
    stiffness = (1.1e8 * (1.0 + depth * np.cos(2.0 * np.pi * path / BASE_PITCH)))[None]
    return mesh_law(path, stiffness, np.zeros_like(stiffness), **changes)


def two_bodies(
    inertia: tuple[float, float] = (5.1e-4, 1.1e-3), damping: tuple[float, float] = (0.0, 0.0)
) -> LinearSystem:
    """Two free discs in mesh; the twist is a brake on the wheel: load torque per radian of twist 1 N m."""
    return LinearSystem(
        inertia=np.diag(inertia),
        damping=np.diag(damping),
        stiffness=np.zeros((2, 2)),
        dofs=("pinion", "wheel"),
        mesh_ports=np.array([[0, 1]]),
        rigid=line_shapes(np.array([0, 1])),
        drive_dof=0,
        twist_load=np.array([0.0, -1.0]),
        drag_loads={"pinion bearing": np.array([-1.0, 0.0])},
    )


def chain(
    n: int = 6, *, joint: tuple[float, float] = (1e6, 1e3), bearing: float = 0.0, inertia: float = 1e-3
) -> LinearSystem:
    """Two lines of ``n`` discs in mesh at their far ends; the first joint of each is a spline (k, c)."""
    stiffness, damping = np.zeros((2 * n, 2 * n)), np.zeros((2 * n, 2 * n))
    for line in range(2):
        for station in range(n - 1):
            a, b = line * n + station, line * n + station + 1
            k, c = joint if station == 0 else (2e5, 0.0)
            for matrix, value in ((stiffness, k), (damping, c)):
                matrix[a, a] += value
                matrix[b, b] += value
                matrix[a, b] -= value
                matrix[b, a] -= value
        damping[line * n + 1, line * n + 1] += bearing
    load = np.zeros(2 * n)
    load[n + 1] = -1.0
    return LinearSystem(
        inertia=np.diag(np.full(2 * n, inertia)),
        damping=damping,
        stiffness=stiffness,
        dofs=tuple(f"line {i // n}/{i % n}" for i in range(2 * n)),
        mesh_ports=np.array([[n - 1, 2 * n - 1]]),
        rigid=line_shapes(np.repeat([0, 1], n)),
        drive_dof=0,
        twist_load=load,
        drag_loads={},
    )
