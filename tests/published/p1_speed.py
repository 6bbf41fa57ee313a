"""What speed does to the root stress at gauge II of P1's rig: the loop at 1500 rpm against the quasi-static one.

The mesh force of the periodic response goes onto the quasi-static curve of the gauge: at every rolling angle its stress
times dynamic over quasi-static root stress of the pinion. The 100 rpm of P1 are taken as quasi-static, as P1 does.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.static_loop import LoopLoad, port_model, solve_static
from rigdesign.base.part_name import MeshName
from rigdesign.coupling.loop import solve_point
from rigdesign.coupling.mesh_models import laws_of
from rigdesign.coupling.preloaded_loop import signed_torque
from rigdesign.coupling.time_run import held_points
from rigdesign.postprocessing import root
from rigdesign.rig.model import Rig, build_rig
from rigdesign.strain_gauge.measuring_point import GaugeCurve

Array = NDArray[np.float64]
START = 0.1
"""Share of the way through the mesh that counts as its start."""
LOADED = 0.3
"""Share of the highest stress from which a ratio means something."""
STIFFNESS, DAMPING = "5e5 N m/rad", "500 N m s/rad"
"""Of a feather key in P1, Figure 8."""


@dataclass(frozen=True)
class SpeedEffect:
    """Root stress at speed against that at rest [-].

    maximum : change of the maximum at the gauge
    start : change of the stress over the first tenth of the way of the tooth through the mesh
    """

    maximum: float
    start: float


def speed_effect(rig: Rig, mesh: MeshName, curve: GaugeCurve) -> SpeedEffect:
    """At the last held stage of a rig, for a gauge of the pinion of a mesh, ``gearbox.mesh``."""
    point = solve_point(rig, held_points(rig)[-1])
    response = point.last.response
    assert response is not None and point.last.system is not None
    number = rig.mesh_names.index(mesh)
    model = point.last.models[number]
    ports = port_model(point.last.system, laws_of(point.last.models))
    state = solve_static(ports, LoopLoad(torque=signed_torque(rig, point.point)))
    roots = root.mesh_roots(rig, model)
    (at_speed,) = root.dynamic_forces(model, [response], number)
    dynamic = roots.highest(at_speed)[0]
    static = roots.highest(root.static_forces(model, state, ports, number))[0]
    ratio = _ratio(dynamic, static, model.pair.base_radii[0] * curve.angle)
    moved = ratio * curve.stress
    first, last = static[0][0], static[0][-1]
    early = (static[0] <= first + START * (last - first)).nonzero()[0]
    at_start = np.interp(static[0][early], *dynamic, left=0.0, right=0.0)
    return SpeedEffect(
        maximum=float(moved.max()) / curve.peak - 1.0,
        start=float(at_start.sum() / static[1][early].sum()) - 1.0,
    )


def _ratio(dynamic: root.Stress, static: root.Stress, path: Array) -> Array:
    """Dynamic over quasi-static stress at path positions (n,); 1 where the tooth is not loaded."""
    moved, still = (np.interp(path, *stress, left=0.0, right=0.0) for stress in (dynamic, static))
    loaded = still > LOADED * float(static[1].max())
    return np.where(loaded, moved / np.where(loaded, still, 1.0), 1.0)


def with_feather_keys(rig: Rig) -> Rig:
    """The same rig with every gear on the feather keys of P1 instead of fixed to its shaft."""
    gears = [f"{box}.gears.{gear}" for box, entry in rig.case.gearboxes.items() for gear in entry.gears]
    values: dict[str, object] = {f"gearboxes.{gear}.spline.torsional_stiffness": STIFFNESS for gear in gears}
    values |= {f"gearboxes.{gear}.spline.torsional_damping": DAMPING for gear in gears}
    return replace(build_rig(rig.case.with_values(values), rig.fidelity), shaft_model=rig.shaft_model)
