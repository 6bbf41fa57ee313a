"""Root stress in motion over the rolling angle at strain gauges and at the most stressed point, and its strain rate.

The periodic response gives the force on every tooth at each phase, the influence numbers turn its distribution into
stress: held stages, and the speeds the case asks for (``numerics.root_stress_speeds``).
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.gear.root_arc import normal_arc
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.static_loop import LoopLoad, port_model, solve_static
from dynamics.tooth.root_field import PairForces, RootField, Side, root_field
from dynamics.vibration.response_curve import CurvePoint
from dynamics.vibration.speed_continuation import MOST_HARMONICS, mesh_cells
from dynamics.vibration.speed_sweep import SweepSettings, periodic_response
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.mesh_models import MeshModel, laws_of
from rigdesign.coupling.preloaded_loop import periodic_laws, signed_torque
from rigdesign.coupling.time_run import drags_at
from rigdesign.postprocessing import root
from rigdesign.postprocessing.curves import state_at
from rigdesign.postprocessing.dynamics import DynamicRun
from rigdesign.postprocessing.loaded_contact import ROOT
from rigdesign.results.teeth import (
    FROM_INFLUENCE,
    DynamicRootCurve,
    DynamicRootRecord,
    MissingRootSpeed,
    StressSource,
)
from rigdesign.rig.model import Rig
from rigdesign.rig.strain_gauges import RootGauge
from rigdesign.strain_gauge.measuring_point import grid_weights

# Periodic response of the warm rig at a speed that no stage holds, under the torque of the governing held point.

REACH = 1.5
"""Harmonics go up to this times the highest mode that counts (`dynamics.vibration.speed_sweep`)."""
BELOW = 0.98
"""Share of the frequency that the harmonics reach up to which modes count."""


@dataclass(frozen=True)
class SpeedResponse:
    """A periodic state with the loop it was sought in; stage : empty where none holds the speed.

    speed : stated [rad/s]; torque : with its sign, at the control mesh [N m]
    response : None where none was found, with the reason
    """

    stage: str
    speed: float
    torque: float
    models: tuple[MeshModel, ...]
    system: LinearSystem
    response: CurvePoint | None
    reason: str = ""


def held_response(rig: Rig, point: PointResult) -> SpeedResponse:
    """That of a held point."""
    last = point.last
    assert last.system is not None and last.response is not None
    torque = signed_torque(rig, point.point)
    return SpeedResponse(
        point.point.stage, point.point.speed, torque, last.models, last.system, last.response
    )


def response_at(rig: Rig, held: PointResult, speed: float) -> SpeedResponse:
    """At a stated speed [rad/s], gears as warm as at the held point, bearings as they run at the speed.

    By harmonic balance; far below the curves of the case its harmonics end below the highest modes, which then answer
    as springs.
    """
    last = held.last
    system = state_at(rig, held, speed).system
    laws = periodic_laws(rig, laws_of(last.models))
    period = rig.case.numerics.response_period
    _, cell_angle = mesh_cells(port_model(system, laws), period, 0)
    reached = MOST_HARMONICS / REACH * rig.drive_speed(speed) / cell_angle
    torque = signed_torque(rig, held.point)
    curve = periodic_response(
        system,
        laws,
        [rig.pinion_speed(speed)],
        LoopLoad(torque=torque),
        drag_torques=drags_at(rig, last, last.coupling_state, speed),
        settings=SweepSettings(
            period=period,
            cutoff=min(rig.highest_mode, BELOW * reached),
            methods=("harmonic_balance",),
        ),
    )
    if curve.failed:
        return SpeedResponse("", speed, torque, last.models, system, None, curve.failed[0][1])
    return SpeedResponse("", speed, torque, last.models, system, curve.points[0])


Array = NDArray[np.float64]
Gear = Literal[0, 1]
Stress = tuple[Array, Array]
"""Rolling angle [rad] and stress [Pa], (n,) each."""
Strain = Callable[[Array], Array]
"""Strain of stresses."""
GEARS: tuple[tuple[Gear, str], ...] = ((0, "pinion"), (1, "wheel"))
POINTS = 241
"""Points of a curve over the rolling angle."""
STRAINED = 0.02
"""Share of the highest stress below which a tooth counts as unloaded: the curve ends there, with a margin."""
MARGIN = 0.1
COARSE = 8
"""Every so many of the states tell which point is stressed most."""
SAME = 1e-6
"""Relative difference below which two speeds are one."""


class _Fields:
    """Stress numbers of the fillets, each made once."""

    def __init__(self) -> None:
        self._made: dict[tuple[int, Gear, Side], RootField] = {}

    def of(self, rig: Rig, model: MeshModel, gear: Gear, side: Side) -> RootField:
        """At all points of a fillet, under the loaded flank (1) or the other (-1)."""
        key = id(model), gear, side
        if key not in self._made:
            drawn = rig.pairs[model.name]
            numbers = rig.tooth_influence.of_pair(drawn)[gear]
            compliance = rig.tooth_influence.compliances(drawn)[gear]
            self._made[key] = root_field(model.law, model.pair, numbers, compliance, gear, side)
        return self._made[key]


def dynamic_root(rig: Rig, run: DynamicRun) -> DynamicRootRecord:
    """Curves of all meshes at all speeds."""
    found: list[SpeedResponse] = [held_response(rig, point) for point in run.points]
    missing = []
    for speed in rig.case.numerics.root_stress_speeds:
        if any(abs(own.speed - speed) <= SAME * speed for own in found):
            continue
        found.append(response_at(rig, run.test, speed))
        if found[-1].response is None:
            missing.append(MissingRootSpeed(speed=speed, reason=found[-1].reason))
    fields = _Fields()
    curves = [
        curve
        for state in sorted(found, key=lambda state: state.speed)
        for curve in _curves(rig, state, fields)
    ]
    return DynamicRootRecord(curves=tuple(curves), missing=tuple(missing))


def _curves(rig: Rig, state: SpeedResponse, fields: _Fields) -> Iterator[DynamicRootCurve]:
    ports = port_model(state.system, laws_of(state.models))
    still = solve_static(ports, LoopLoad(torque=state.torque))
    for mesh in range(len(rig.mesh_names)):
        model = state.models[mesh]
        resting = root.static_forces(model, still, ports, mesh)
        moving = resting
        if state.response is not None:
            (moving,) = root.dynamic_forces(model, [state.response], mesh)
        if moving.force.any() and resting.force.any():
            front = bool(still.mean_torque[mesh] > 0.0)
            yield from _MeshCurves(rig, state, mesh, moving, resting, fields, front).all()


@dataclass(frozen=True, eq=False)
class _MeshCurves:
    """Curves of one mesh from the forces on its teeth in motion and at rest."""

    rig: Rig
    state: SpeedResponse
    mesh: int
    moving: PairForces
    resting: PairForces
    fields: _Fields
    front: bool

    def all(self) -> Iterator[DynamicRootCurve]:
        """The most stressed point of pinion and wheel, and their gauges."""
        for gear, _ in GEARS:
            young = self.rig.materials[self.rig.mesh_gear(self.mesh, gear).material].elastic_modulus
            stresses, source = self._most_stressed(gear)
            yield self._curve(gear, "", stresses, partial(_uniaxial, young), source)
            if self.rig.mesh_stiffness == "influence_numbers":
                yield from self._gauges(gear)

    def _most_stressed(self, gear: Gear) -> tuple[tuple[Stress, Stress], StressSource]:
        """Dynamic and quasi-static stress over the angle at the point of the root that the motion stresses most.

        The factors of ISO 6336-3 know no points: theirs is the highest stress over the face.
        """
        model = self.state.models[self.mesh]
        if self.rig.mesh_stiffness != "influence_numbers":
            roots = root.FactorRoots(model)
            per_path = _sense(gear) / model.pair.base_radii[gear]
            moving, resting = (roots.highest(forces)[gear] for forces in (self.moving, self.resting))
            curves = (
                _rising(per_path * moving[0], moving[1]),
                _rising(per_path * resting[0], resting[1]),
            )
            return curves, roots.source
        field = self.fields.of(self.rig, model, gear, 1)
        numbers = self.rig.tooth_influence.of_pair(self.rig.pairs[model.name])[gear]
        inside = numbers.fillet.tangent >= ROOT
        few = PairForces(self.moving.path[::COARSE], self.moving.force[::COARSE])
        _, point, face = field.within(inside).course(few).highest_at
        weights = np.zeros((len(inside), len(field.face)))
        weights[np.flatnonzero(inside)[point], face] = 1.0
        return self._weighted(field, weights, gear), FROM_INFLUENCE

    def _gauges(self, gear: Gear) -> Iterator[DynamicRootCurve]:
        mesh = self.rig.mesh_names[self.mesh]
        box, own = self.rig.mesh(mesh)
        for gauge in self.rig.strain_gauges.values():
            first, _ = box.first_meshes().get(gauge.gear.part, ("", 0))
            if gauge.gear == self.rig.mesh_gears(mesh)[gear] and first == own:
                stresses = self._at_gauge(gauge, gear)
                strain = gauge.point.surface.strain
                yield self._curve(gear, gauge.name, stresses, strain, FROM_INFLUENCE)

    def _at_gauge(self, gauge: RootGauge, gear: Gear) -> tuple[Stress, Stress]:
        """Mean over the grid of a gauge, as `gauge_stress.stress_at` takes it."""
        model = self.state.models[self.mesh]
        drawn = self.rig.pairs[model.name]
        front = self.front
        field = self.fields.of(self.rig, model, gear, 1 if gauge.front == front else -1)
        fillet = self.rig.tooth_influence.of_pair(drawn)[gear].fillet
        places = normal_arc(drawn.gears[gear], fillet.point, fillet.arc)
        face = field.face if front else -field.face[::-1]
        weights = grid_weights(places, face, gauge.point.bridge.gauge, gauge.point.placement)
        return self._weighted(field, weights if front else weights[:, ::-1], gear)

    def _weighted(self, field: RootField, weights: Array, gear: Gear) -> tuple[Stress, Stress]:
        """Dynamic and quasi-static sum of the stresses of a fillet times weights (n_r, n_f), over the rolling angle."""
        one = replace(
            field,
            table={k: (block @ weights.ravel())[:, :, None] for k, block in field.table.items()},
            face=np.zeros(1),
        )
        per_path = _sense(gear) / self.state.models[self.mesh].pair.base_radii[gear]
        moving, resting = (one.course(forces) for forces in (self.moving, self.resting))
        return (
            _rising(per_path * moving.path, moving.stress[:, 0, 0]),
            _rising(per_path * resting.path, resting.stress[:, 0, 0]),
        )

    def _curve(
        self,
        gear: Gear,
        gauge: str,
        stresses: tuple[Stress, Stress],
        strain: Strain,
        source: StressSource,
    ) -> DynamicRootCurve:
        dynamic, static = stresses
        angle = _range(dynamic)
        own, quasi = (np.interp(angle, *stress, left=0.0, right=0.0) for stress in (dynamic, static))
        strained = strain(own)
        speed = self.rig.shaft_speed(self.rig.mesh_gear(self.mesh, gear).shaft, self.state.speed)
        pinion = self.rig.shaft_speed(self.rig.mesh_gear(self.mesh, 0).shaft, self.state.speed)
        # contact runs to the tip of the gear that drives, to the root of the driven one
        turned = _sense(gear) * (1.0 if self.front else -1.0)
        return DynamicRootCurve(
            mesh=self.rig.mesh_labels[self.rig.mesh_names[self.mesh]],
            gear=dict(GEARS)[gear],
            gauge=gauge,
            stage=self.state.stage,
            in_motion=self.state.response is not None,
            speed=speed,
            pinion_speed=pinion,
            angle=tuple(angle.tolist()),
            dynamic=tuple(own.tolist()),
            quasi_static=tuple(quasi.tolist()),
            strain=tuple(strained.tolist()),
            strain_rate=tuple((turned * speed * np.gradient(strained, angle)).tolist()),
            source=source,
        )


def _uniaxial(young: float, stress: Array) -> Array:
    """Strain of a stress along one direction."""
    return stress / young


def _sense(gear: Gear) -> float:
    """Of the rolling angle over the path."""
    return -1.0 if gear else 1.0


def _rising(angle: Array, stress: Array) -> Stress:
    order = np.argsort(angle, kind="stable")
    return angle[order], stress[order]


def _range(stress: Stress) -> Array:
    """Rolling angles of the curve: where the tooth is strained, and a margin."""
    angle, values = stress
    strained = angle[np.abs(values) > STRAINED * np.abs(values).max()]
    first, last = float(strained.min()), float(strained.max())
    margin = MARGIN * (last - first)
    return np.linspace(first - margin, last + margin, POINTS)
