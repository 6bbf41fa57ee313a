"""Made-up dynamic loads of a mesh."""

from typing import Any

import numpy as np

from rigdesign.results.loads import MeshLoads, RootStressPath


def mesh_loads(**changes: Any) -> MeshLoads:
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
    return MeshLoads(**(given | changes))
