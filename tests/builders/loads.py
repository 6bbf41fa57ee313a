"""Made-up dynamic loads."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from dynamics.rotor.torsional_modes import DampingRecord, LoopMode
from rigdesign.results.check import Role
from rigdesign.results.loads import (
    ContactLoss,
    MeshResonance,
    ModeCrossing,
    RootStressPath,
    RootStressRatio,
    StageBracing,
    StageLoad,
    UnsolvedSpeed,
)
from rigdesign.results.teeth import ToothHistory


@dataclass(frozen=True, kw_only=True)
class StatedMeshLoads:
    """Loads of one mesh, nothing but what is given."""

    role: Role = "rig"
    torque_peak: float = 0.0
    stage_loads: tuple[StageLoad, ...] = ()
    contact_losses: tuple[ContactLoss, ...] = ()
    resonances: tuple[MeshResonance, ...] = ()
    unsolved: tuple[UnsolvedSpeed, ...] = ()
    root_stress: tuple[RootStressPath, ...] = ()
    root_stress_ratios: tuple[RootStressRatio, ...] = ()


@dataclass(frozen=True, kw_only=True)
class StatedLoads:
    """Loads of a rig, nothing but what is given."""

    meshes: Mapping[str, StatedMeshLoads]
    modes: tuple[LoopMode, ...] = ()
    loop_crossings: tuple[ModeCrossing, ...] = ()
    damping: tuple[DampingRecord, ...] = ()
    bracing: tuple[StageBracing, ...] = ()
    teeth: Mapping[str, ToothHistory] = field(default_factory=dict)


def mesh_loads(**changes: Any) -> StatedMeshLoads:
    """Loads of one mesh: root stress of both gears over 9.2 degrees, nothing else but what ``changes`` say."""
    angle = np.linspace(0.0, 9.2, 240)
    static = 1800e6 * np.clip(np.sin(np.pi * angle / 9.2), 0.0, None) ** 0.7
    dynamic = static * (1.0 + 0.16 * np.sin(11.0 * angle))
    paths = tuple(
        RootStressPath(
            gear=gear,
            stage="dwell",
            rolling_angle=tuple(np.radians(angle).tolist()),
            dynamic=tuple(dynamic.tolist()),
            quasi_static=tuple(static.tolist()),
        )
        for gear in ("pinion", "wheel")
    )
    given: dict[str, Any] = {"role": "rig", "torque_peak": 212.0, "root_stress": paths}
    return StatedMeshLoads(**(given | changes))
