"""How far the dynamic loads behind the checks are from those of infinitely many slices and shaft elements.

The periodic response behind a check is solved again, once with half the slices of every mesh and once with shaft
elements twice as long; each change gives an error of its own, and they are added. Both are of second order (midpoint
rule over the face, lumped inertia), so that a third of the change is left where the rules of `rig.resolution` decide;
slices or elements that the case states may be too few for any order: there the whole change counts. Peaks and least
torques of the time run take the error of the periodic response at the speed and torque at which they occur: the run
itself is not marched again. Source: Roache, Annu. Rev. Fluid Mech. 29 (1997) 123.
"""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace

from dynamics.errors import DynamicsNotConverged
from dynamics.response.speed_sweep import CurvePoint
from rigdesign.checks.dynamics import loaded_stages
from rigdesign.coupling.bearing_films import solve_bearings
from rigdesign.coupling.loads import BracingState, LoadedCircuit, mesh_models, respond
from rigdesign.coupling.loop_system import loop_system
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.records.solved_rig import SolvedRig
from rigdesign.results.result import DiscretisationRow
from rigdesign.rig.model import Rig
from rigdesign.rig.resolution import Coarsening

HALVED = (Coarsening(slices=2), Coarsening(elements=2))
ORDER = 2.0
RPM = math.pi / 30.0
Value = Callable[[CurvePoint, int], float]
Rigs = tuple[Rig, ...]
"""As the result has it, with half the slices, with elements twice as long."""


@dataclass(frozen=True)
class _Loaded:
    """An operating point of the warm rig at which a periodic response is wanted."""

    point: OperatingPoint
    coupling_state: CouplingState = field(repr=False)
    drags: Mapping[str, float]
    setting: BracingState

    def _circuit(self, rig: Rig) -> LoadedCircuit:
        bearings = solve_bearings(rig, self.point, self.coupling_state)
        return LoadedCircuit(
            self.point,
            mesh_models(rig, self.point, self.coupling_state),
            self.drags,
            self.setting,
            loop_system(rig, self.point, self.coupling_state, bearings),
        )

    def responses(self, rigs: Rigs) -> tuple[CurvePoint, ...]:
        """Of each rig; nothing where one of them finds none."""
        try:
            return tuple(respond(rig, self._circuit(rig)) for rig in rigs)
        except DynamicsNotConverged:
            return ()


def load_errors(solved: SolvedRig) -> tuple[DiscretisationRow, ...]:
    """Discretisation errors of the checks on dynamic loads by id; none without loads or where no response is found."""
    if solved.run is None:
        return ()
    rigs = (solved.rig, *(replace(solved.rig, coarsening=halved) for halved in HALVED))
    rows = [*_held(solved, rigs)]
    for mesh in range(len(solved.rig.mesh_names)):
        rows += _run(solved, rigs, mesh)
    return tuple(rows)


def missing_load_errors(solved: SolvedRig) -> tuple[str, ...]:
    """Ids of the checks on dynamic loads whose error is not known: a coarser rig found no periodic response."""
    if solved.run is None:
        return ()
    known = {row.quantity for row in solved.discretisation}
    wanted = [
        f"dynamics.{key}.{solved.label(mesh)}"
        for mesh in range(len(solved.rig.mesh_names))
        for key in (
            "dynamic_factor",
            *(("ramp_peak", "contact_margin") if loaded_stages(solved, mesh) else ()),
        )
    ]
    return tuple(name for name in wanted if name not in known)


def _held(solved: SolvedRig, rigs: Rigs) -> Iterator[DiscretisationRow]:
    """K_V of every mesh at the held stage where it is highest."""
    found: dict[str, tuple[CurvePoint, ...]] = {}
    for mesh in range(len(solved.rig.mesh_names)):
        worst = max(
            (point for point in solved.points if point.last.response is not None),
            key=lambda point: _factor(point.last.response, mesh) if point.last.response else 0.0,
        )
        stage, last = worst.point.stage, worst.last
        assert worst.setting is not None
        if stage not in found:
            loaded = _Loaded(worst.point, last.coupling_state, last.drags, worst.setting)
            found[stage] = loaded.responses(rigs)
        yield from _row(solved, "dynamic_factor", mesh, found[stage], _factor)


def _run(solved: SolvedRig, rigs: Rigs, mesh: int) -> Iterator[DiscretisationRow]:
    """Highest peak and least share of the time run, in the stages that the checks look at."""
    loads = loaded_stages(solved, mesh)
    if not loads:
        return
    peak = max(loads, key=lambda load: load.peak)
    least = min(loads, key=lambda load: load.least_share)
    for key, stage, speed, mean, value in (
        ("ramp_peak", peak.stage, peak.speed, peak.mean, _factor),
        ("contact_margin", least.stage, least.least_share_speed, least.least_share_mean, _least),
    ):
        loaded = _at(solved, mesh, stage, speed, mean)
        yield from _row(solved, key, mesh, loaded.responses(rigs), value)


def _at(solved: SolvedRig, mesh: int, stage: str, speed: float, torque: float) -> _Loaded:
    """The warm rig of the test at another speed [rad/s] and mean torque [N m] of the pinion of a mesh."""
    test, rig = solved.test, solved.rig
    assert test.last.response is not None
    share = torque / float(test.last.response.mean[mesh])
    point = OperatingPoint(
        stage=stage,
        speed=speed / rig.shaft_speed(rig.mesh_gear(mesh, 0).shaft, 1.0),
        torque=share * test.point.torque,
    )
    torques = {name: share * value for name, value in test.last.coupling_state.mesh_torque.items()}
    return _Loaded(
        point,
        replace(test.last.coupling_state, mesh_torque=torques),
        {},
        BracingState(mode="torque_controlled"),
    )


def _row(
    solved: SolvedRig, key: str, mesh: int, responses: tuple[CurvePoint, ...], value: Value
) -> Iterator[DiscretisationRow]:
    """Error of the check ``key`` of a mesh from the responses of the rigs."""
    if not responses:
        return
    numerics = solved.case.numerics
    ruled = (
        numerics.slices_spur is None and numerics.slices_helical is None,
        numerics.shaft_element_length is None,
    )
    fine, *halved = (value(response, mesh) for response in responses)
    shares = [1.0 / (2.0**ORDER - 1.0) if rule else 1.0 for rule in ruled]
    parts = [share * abs(fine - other) for share, other in zip(shares, halved, strict=True)]
    yield DiscretisationRow(
        quantity=f"dynamics.{key}.{solved.label(mesh)}", gearbox="", stage="", value=fine, error=sum(parts),
        unit="-", order=ORDER if all(ruled) else None,
        method=f"periodic response at {responses[0].speed / RPM:.0f} rpm of the first pinion, half the slices "
        f"{halved[0]:.4f}, elements twice as long {halved[1]:.4f}"
        + ("" if all(ruled) else "; whole change where the case states slices or element length"),
    )  # fmt: skip


def _factor(response: CurvePoint, mesh: int) -> float:
    return float(response.dynamic_factor[mesh])


def _least(response: CurvePoint, mesh: int) -> float:
    return float(response.minimum[mesh] / response.mean[mesh])
