"""Loss in the damping between the flanks: two gears as one mass on the line of action, marched to the periodic state.

Every pair in contact is a spring and a dashpot side by side, which see how fast its own flanks are pressed together:
by the vibration of the gears, and by crowning, relief and tip corners that pass while the teeth are pressed. At high
speed the mass stands still and the teeth run through it.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

import numpy as np
from numba import njit

from tests.virtual_rig.loop_changes import LoopConstants
from tests.virtual_rig.teeth import Teeth, path_gaps, read_teeth, stiffness_course

REACH = 1.2
"""Tables beyond the path of contact [base pitches]: loaded teeth touch at their corners before and after it."""
GROWTH = 1e-6
"""Depth over which the damping of a contact sets in [m]."""
LEAST_STEPS, STEPS_PER_SWING = 256, 24
MOST_PERIODS, AVERAGED = 400, 64
"""Mesh periods marched, and averaged where the motion does not come back after one."""


@dataclass(frozen=True, kw_only=True)
class VibratingMesh:
    """A mesh as one mass with its pairs; two of the same key have the same numbers."""

    key: tuple[float, ...]
    mass: float = field(compare=False)
    """Of pinion and wheel at their base circles, turning against each other [kg]."""
    pitch: float = field(compare=False)
    start: float = field(compare=False)
    step: float = field(compare=False)
    stiffness: np.ndarray = field(compare=False)
    """(n_path,) of one pair [N/m]."""
    gaps: np.ndarray = field(compare=False)
    """(n_slices, n_path) [m]"""
    mean_stiffness: float = field(compare=False)
    """Of the mesh, over the active path [N/m]."""

    @property
    def frequency(self) -> float:
        """Natural frequency [Hz]."""
        return math.sqrt(self.mean_stiffness / self.mass) / (2.0 * math.pi)


def vibrating_mesh(tree: Mapping[str, Any], box: str, mesh: str) -> VibratingMesh:
    """Mesh of a case: reduced mass of the two gears, stiffness and gaps of its teeth."""
    teeth: Teeth = read_teeth(tree, box, mesh)
    entry = tree["gearboxes"][box]
    gears = (entry["gears"][entry["meshes"][mesh][side]] for side in ("pinion", "wheel"))
    inertias = [gear.get("inertia", own) for gear, own in zip(gears, teeth.inertias, strict=True)]
    curvature = LoopConstants.curvature
    grid = teeth.grid(REACH)
    stiffness = teeth.peak_stiffness * stiffness_course(teeth, curvature, REACH)
    gaps = path_gaps(teeth, margin=REACH)
    mass = 1.0 / sum(r * r / j for r, j in zip(teeth.base_radii, inertias, strict=True))
    return VibratingMesh(
        key=(mass, teeth.base_pitch, grid[0], teeth.peak_stiffness, float(gaps.sum())), mass=mass,
        pitch=teeth.base_pitch, start=float(grid[0]), step=float(grid[1] - grid[0]), stiffness=stiffness, gaps=gaps,
        mean_stiffness=teeth.peak_stiffness * teeth.contact_ratio * (1.0 - curvature / 3.0),
    )  # fmt: skip


@lru_cache(maxsize=4096)
def vibration_power(mesh: VibratingMesh, force: float, speed: float, damping: float) -> float:
    """Mean power [W] that the damping between the flanks takes.

    force : mean normal force [N]; speed : of the base circles [m/s]
    damping : of the whole mesh at its mean stiffness [N s/m]; a pair has its share by stiffness
    """
    if speed <= 0.0:
        return 0.0
    swings = mesh.frequency * mesh.pitch / speed
    steps = max(LEAST_STEPS, math.ceil(STEPS_PER_SWING * swings))
    slopes = np.gradient(mesh.gaps, mesh.step, axis=1)
    powers, count = _march(
        mesh.mass, force, speed, mesh.pitch, mesh.start, mesh.step, mesh.stiffness, mesh.gaps, slopes,
        damping / mesh.mean_stiffness, steps, MOST_PERIODS, 2.0 * math.pi * mesh.frequency,
    )  # fmt: skip
    return float(powers[count - 1] if count < MOST_PERIODS else powers[-AVERAGED:].mean())


@njit(cache=True)
def _march(mass, force, speed, pitch, start, step, stiffness, gaps, slopes, lag, steps, periods, omega):  # type: ignore[no-untyped-def]
    """Mean power of each mesh period (periods,), and how many ran until the state came back after one.

    lag : dashpot over spring of a pair [s]; omega : natural frequency, by which velocities count [rad/s]
    """
    n_slices, n_path = gaps.shape
    dt = pitch / speed / steps
    x, v = force / stiffness.max(), 0.0
    powers = np.zeros(periods)
    for period in range(periods):
        x_before, v_before = x, v
        for i in range(steps):
            total = 0.0
            at = (i + 0.5) / steps * pitch / step
            while at < n_path - 1:
                cell = int(at)
                f = at - cell
                k = ((1.0 - f) * stiffness[cell] + f * stiffness[cell + 1]) / n_slices
                for j in range(n_slices):
                    depth = x - (1.0 - f) * gaps[j, cell] - f * gaps[j, cell + 1]
                    if depth > 0.0:
                        rate = v - speed * ((1.0 - f) * slopes[j, cell] + f * slopes[j, cell + 1])
                        damped = lag * k * rate * depth / (depth + GROWTH)
                        damped = max(damped, -k * depth)  # flanks do not pull
                        total += k * depth + damped
                        powers[period] += damped * rate / steps
                at += pitch / step
            v += dt * (force - total) / mass
            x += dt * v
        change = abs(x - x_before) + abs(v - v_before) / omega
        if change < 1e-5 * (abs(x) + force / stiffness.max()):
            return powers, period + 1
    return powers, periods
