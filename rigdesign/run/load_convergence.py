"""How far the dynamic loads behind the checks are from those of infinitely many slices, shaft elements and modes.

The periodic response behind a check is solved again, once with half the slices of every mesh, once with shaft elements
twice as long, and of shafts that bend once with modes up to half the frequency; each change gives an error of its own,
and they are added. Slices and elements are of second order (midpoint rule over the face, lumped inertia), modes fall at
least as fast, for static shapes stand for those left out: a third of the change is left where the rules of
`rig.resolution` decide; slices or elements that the case states may be too few for any order: there the whole change
counts. Peaks and least torques of the time run take the error of the periodic response at the speed and torque at which
they occur: the run itself is not marched again. What the contact tables of bending shafts leave out is added
(`TABLES_LEAVE_OUT`).
Source: Roache, Annu. Rev. Fluid Mech. 29 (1997) 123.
"""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial

from dynamics.errors import DynamicsNotConverged
from dynamics.rotor.linear_system import LinearSystem
from dynamics.vibration.response_curve import CurvePoint
from rigdesign.base.parallel import BackgroundTasks
from rigdesign.checks.dynamics import loaded_stages
from rigdesign.coupling.bearing_films import solve_bearings
from rigdesign.coupling.loop_system import loop_system
from rigdesign.coupling.mesh_models import mesh_models
from rigdesign.coupling.preloaded_loop import BracingState, LoadedCircuit, respond
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.postprocessing.solved_rig import SolvedRig
from rigdesign.results.result import DiscretisationRow
from rigdesign.rig.model import Rig
from rigdesign.rig.resolution import Coarsening

HALVED = (Coarsening(slices=2), Coarsening(elements=2))
FEWER_MODES = Coarsening(modes=2)
ORDER = 2.0
TABLES_LEAVE_OUT = (0.02, 0.2)
"""Error of a dynamic factor or least share by the contact tables, in all and per dynamic part, against contacts solved
from influence numbers in every step of a time integration (`tests/contact_in_loop`): held stages and peaks of K_V of
the shipped rigs are within it where no contact is lost, the main rig with 0.11 of 0.50; tables are mostly higher."""
RPM = math.pi / 30.0
Value = Callable[[CurvePoint, int], float]
Place = tuple[str, float, float, str]
Rigs = tuple[Rig, ...]
"""As the result has it, with half the slices, with elements twice as long, and with fewer modes where shafts bend."""


@dataclass(frozen=True)
class _Loaded:
    """An operating point of the warm rig at which a periodic response is wanted."""

    point: OperatingPoint
    coupling_state: CouplingState = field(repr=False)
    drags: Mapping[str, float]
    setting: BracingState
    in_run: bool = False
    """Passed by the time run, whose motion is that of a time integration where it is not plain."""

    @property
    def place(self) -> Place:
        """What tells it from other points of the rig: stage, speed [rad/s], torque [N m] and kind of bracing."""
        return self.point.stage, self.point.speed, self.point.torque, self.setting.mode

    def responses(self, rigs: Rigs) -> tuple[CurvePoint, ...]:
        """Of each rig; nothing where one of them finds none."""
        systems: dict[tuple[int, int], LinearSystem] = {}
        try:
            return tuple(respond(rig, self._circuit(rig, systems), traced=not self.in_run) for rig in rigs)
        except DynamicsNotConverged:
            return ()

    def _circuit(self, rig: Rig, systems: dict[tuple[int, int], LinearSystem]) -> LoadedCircuit:
        """Rigs with the same shaft elements and modes share their matrices."""
        elements = rig.coarsening.elements, rig.coarsening.modes
        if elements not in systems:
            bearings = solve_bearings(rig, self.point, self.coupling_state)
            systems[elements] = loop_system(rig, self.point, self.coupling_state, bearings)
        models = mesh_models(rig, self.point, self.coupling_state)
        return LoadedCircuit(self.point, models, self.drags, self.setting, systems[elements])


@dataclass(frozen=True)
class _Wanted:
    """The error of one check: its key, its mesh, where the response behind it is, and what it takes from it."""

    key: str
    mesh: int
    loaded: _Loaded
    value: Value


def load_errors(solved: SolvedRig) -> tuple[DiscretisationRow, ...]:
    """Discretisation errors of the checks on dynamic loads by id; none without loads or where no response is found.

    Checks that look at the same place share its responses; the places are solved on all cores.
    """
    if solved.run is None:
        return ()
    coarser = HALVED if solved.rig.shaft_model == "torsional" else (*HALVED, FEWER_MODES)
    rigs = (solved.rig, *(solved.rig.coarsened(one) for one in coarser))
    wanted = [*_held(solved), *_in_the_run(solved)]
    places = {one.loaded.place: one.loaded for one in wanted}
    with BackgroundTasks([partial(loaded.responses, rigs) for loaded in places.values()]) as tasks:
        found = dict(zip(places, tasks.results(), strict=True))
    return tuple(_row(solved, one, found[one.loaded.place]) for one in wanted if found[one.loaded.place])


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


def _held(solved: SolvedRig) -> Iterator[_Wanted]:
    """K_V of every mesh at the held stage where it is highest."""
    for mesh in range(len(solved.rig.mesh_names)):
        worst = max(
            (point for point in solved.points if point.last.response is not None),
            key=lambda point: _factor(point.last.response, mesh) if point.last.response else 0.0,
        )
        assert worst.setting is not None
        loaded = _Loaded(worst.point, worst.last.coupling_state, worst.last.drags, worst.setting)
        yield _Wanted("dynamic_factor", mesh, loaded, _factor)


def _in_the_run(solved: SolvedRig) -> Iterator[_Wanted]:
    """Highest peak and least share of every mesh in the time run, in the stages that the checks look at."""
    for mesh in range(len(solved.rig.mesh_names)):
        loads = loaded_stages(solved, mesh)
        if loads:
            peak = max(loads, key=lambda load: load.peak)
            least = min(loads, key=lambda load: load.least_share)
            at_peak = _at(solved, mesh, peak.stage, peak.speed, peak.mean)
            at_least = _at(solved, mesh, least.stage, least.least_share_speed, least.least_share_mean)
            yield _Wanted("ramp_peak", mesh, at_peak, _factor)
            yield _Wanted("contact_margin", mesh, at_least, _least)


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
    state = test.last.coupling_state.with_torque_share(share)
    return _Loaded(point, state, {}, BracingState(mode="torque_controlled"), in_run=True)


def _row(solved: SolvedRig, wanted: _Wanted, responses: tuple[CurvePoint, ...]) -> DiscretisationRow:
    """Error of a check from the responses of the rigs."""
    numerics = solved.case.numerics
    ruled = (
        numerics.slices_spur is None and numerics.slices_helical is None,
        numerics.shaft_element_length is None,
    )
    bends = solved.rig.shaft_model != "torsional"
    by_influence = solved.rig.mesh_stiffness == "influence_numbers"
    fine, *halved = (wanted.value(response, wanted.mesh) for response in responses)
    shares = [1.0 / (2.0**ORDER - 1.0) if rule else 1.0 for rule in (*ruled, *(True,) * bends)]
    parts = [share * abs(fine - other) for share, other in zip(shares, halved, strict=True)]
    solid, per_dynamic = TABLES_LEAVE_OUT
    tables = solid + per_dynamic * abs(fine - 1.0) if bends and by_influence else 0.0
    return DiscretisationRow(
        quantity=f"dynamics.{wanted.key}.{solved.label(wanted.mesh)}", gearbox="", stage="", value=fine,
        error=sum(parts) + tables, unit="-", order=ORDER if all(ruled) else None,
        method=f"periodic response at {responses[0].speed / RPM:.0f} rpm of the first pinion, half the slices "
        f"{halved[0]:.4f}, elements twice as long {halved[1]:.4f}"
        + (f", modes up to half the frequency {halved[2]:.4f}" if bends else "")
        + ("" if all(ruled) else "; full change where the case states slices or element length")
        + (f"; {tables:.4f} that the contact tables leave out" if tables else ""),
    )  # fmt: skip


def _factor(response: CurvePoint, mesh: int) -> float:
    return float(response.dynamic_factor[mesh])


def _least(response: CurvePoint, mesh: int) -> float:
    return float(response.minimum[mesh] / response.mean[mesh])
