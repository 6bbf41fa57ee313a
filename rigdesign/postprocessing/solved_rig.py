"""The solved rig: the case, the solved points and their SI records. Checks and rows of the result read nothing else."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from dynamics.rating.iso_rating import permissible_factors, root_stress
from dynamics.rotor.rolling_state import RollingState
from dynamics.standards.iso6336_3_2006 import RootStress
from dynamics.vibration.schedule import Schedule
from rigdesign.case.model import Case
from rigdesign.case.schedule import StageValues
from rigdesign.coupling.loop import PointResult, governing_point
from rigdesign.coupling.mesh_models import laws_of
from rigdesign.coupling.preloaded_loop import averaged_gears, lines_left_out, loads_left_out, signed_torque
from rigdesign.coupling.temperatures import HousingField
from rigdesign.coupling.time_run import schedule_of
from rigdesign.postprocessing.curves import dwell_stages, resolved, speed_ranges, torque_key
from rigdesign.postprocessing.dynamics import DynamicRun, SolvedLoads
from rigdesign.postprocessing.gear_loads import (
    RatedLoad,
    application_factor,
    flank_ratings,
    load_cycles,
    rated_cycles,
    rated_loads,
)
from rigdesign.postprocessing.housing import stage_balance
from rigdesign.postprocessing.loaded_contact import HeldContact, held_contact
from rigdesign.postprocessing.nearest_resonance import (
    NearDwell,
    at_torque,
    bounds_of,
    mesh_resonances,
    root_shares,
)
from rigdesign.postprocessing.press_fits import press_fits, spline_stresses
from rigdesign.postprocessing.run_torques import PartTorque, part_torques
from rigdesign.postprocessing.tooth_history import (
    GearInMesh,
    ReversedBending,
    by_standard,
    gear_meshes,
    of_history,
)
from rigdesign.postprocessing.vibration import LoopVibration
from rigdesign.postprocessing.warm_gearbox import rolling_states, warm_gearbox
from rigdesign.results.check import NO_HOUSING, Role
from rigdesign.results.housing import CoolingBalance, HousingTemperatures, StageBalance
from rigdesign.results.lateral import LateralVibration
from rigdesign.results.loads import DynamicLoads, EventRecord, PressFitCapacity, SplineStress
from rigdesign.results.result import DiscretisationRow, MeshShift
from rigdesign.results.teeth import FlankRating
from rigdesign.results.thermal import HistoryExtremes
from rigdesign.results.vibration import AvoidedResonance, HeldTorque
from rigdesign.results.warm_gearbox import WarmGearbox
from rigdesign.rig.model import Rig


@dataclass(frozen=True, kw_only=True)
class LawSpread:
    """What another published law of a loss would change.

    cause : both laws with what they give; changes : of the value of a check in its unit, by its id
    """

    cause: str
    changes: Mapping[str, float]


class SearchedSpeeds(NamedTuple):
    """A curve over speed; torque : in words; speeds : stated ones between which it is wanted [rad/s]."""

    torque: str
    speeds: tuple[float, float]

    def place(self, label: str) -> str:
        """Of the resonances of a mesh on it."""
        return at_torque(label, self.torque)


class BeyondPeriod(NamedTuple):
    """What the period of the response cannot hold.

    gears : whose teeth differ and are taken with their mean; loads : part and order of oscillating torques
    lines : shaft lines, by their first loaded shaft, of which unbalance, bow and run-out are left out
    """

    gears: tuple[str, ...]
    loads: tuple[str, ...]
    lines: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class SolvedRig:
    """A solved rig in SI units; sequences of records run over the held stages, and over the gearboxes in each."""

    rig: Rig
    points: Sequence[PointResult]
    """One for each held stage."""
    run: DynamicRun | None = None
    """None when the losses are given: no drivetrain, no loads."""
    loads: DynamicLoads | None = None
    """Of ``run``."""
    temperatures: Sequence[HousingTemperatures] = ()
    """Of every gearbox with a housing."""
    warm: Sequence[WarmGearbox] = ()
    """Clearances and alignment of every gearbox whose housing is expanded."""
    balances: Sequence[StageBalance] = ()
    """Heat of the whole rig at every held stage."""
    history: HistoryExtremes | None = None
    """None where no thermal history was asked for."""
    events: Sequence[EventRecord] = ()
    """Of a rig with a drivetrain."""
    loop: LoopVibration | None = None
    """What is known of ``vibration``, of the same points and run."""
    discretisation: Sequence[DiscretisationRow] = ()
    mesh_shifts: Sequence[MeshShift] = ()
    law_spreads: Sequence[LawSpread] = ()

    @cached_property
    def vibration(self) -> LoopVibration:
        """What the warm loop does at its held stages and over speed."""
        own = LoopVibration(self.rig, tuple(self.points), self.run, self.loads)
        return self.loop if self.loop is not None and self.loop.is_of(own) else own

    @property
    def cooling(self) -> list[CoolingBalance]:
        """What shafts, pump and heaters put in and cooler and room take out at every held stage."""
        return [balance.cooling for balance in self.balances]

    @property
    def lateral(self) -> LateralVibration | None:
        """Lateral vibration; None for shafts that only twist."""
        return self.vibration.lateral

    @property
    def seal_amplitudes(self) -> Mapping[tuple[str, str], float]:
        """Motion once a turn of the shaft in every seal without contact by stage and seal [m]; empty for shafts that
        only twist."""
        return self.vibration.seal_amplitudes

    @property
    def held_torques(self) -> tuple[HeldTorque, ...]:
        """Torque of every section and joint in the periodic responses of the held stages."""
        return self.vibration.held_torques

    @property
    def near_dwells(self) -> Mapping[float, NearDwell]:
        """What lies near every dwell whose response is computed, by the speed of the first pinion [rad/s]; empty
        without a dynamic run."""
        return self.vibration.near_dwells

    @cached_property
    def part_torques(self) -> tuple[PartTorque, ...]:
        """Largest torque of every section and joint in the held stages, the stages of the time run and the events;
        empty without loads."""
        if self.run is None:
            return ()
        return part_torques(self.rig, self.points, self.held_torques, self.run.ramp, self.events)

    @cached_property
    def seat_torques(self) -> tuple[PartTorque, ...]:
        """Those of the seats of the gears."""
        return tuple(torque for torque in self.part_torques if torque.kind == "spline")

    @cached_property
    def press_fits(self) -> tuple[PressFitCapacity, ...]:
        """Of every gear whose interference the case states, at every torque of its seat."""
        return tuple(press_fits(self.rig, self.seat_torques))

    @cached_property
    def splines(self) -> tuple[SplineStress, ...]:
        """Of every gear whose spline states allowable stresses, at every torque of its seat."""
        return tuple(spline_stresses(self.rig, self.seat_torques))

    @property
    def mesh_errors(self) -> Mapping[str, float]:
        """Discretisation error of the value of a check, by its id."""
        return {row.quantity: row.error for row in self.discretisation if not row.gearbox}

    @cached_property
    def schedule(self) -> Schedule:
        """Stages of the time run."""
        return schedule_of(self.rig)

    @property
    def dwell_stages(self) -> tuple[StageValues, ...]:
        """Stages with a speed at which the rig dwells."""
        return dwell_stages(self.rig)

    @property
    def resolved(self) -> bool:
        """Whether the curves over speed show every resonance."""
        return resolved(self.rig)

    @property
    def resonance_margin(self) -> float:
        """Share of its speed that a resonance keeps away from a held one."""
        return bounds_of(self.rig).margin

    @cached_property
    def dangerous_resonances(self) -> tuple[AvoidedResonance, ...]:
        """Of every mesh and root at every torque of the curves; empty without a dynamic run."""
        if self.run is None or self.loads is None:
            return ()
        roots = bounds_of(self.rig).resonances(root_shares(self.rig, self.loads))
        return (*mesh_resonances(self.rig, self.run, self.loads), *roots)

    def searched(self, point: PointResult) -> SearchedSpeeds:
        """The curve over speed under the torque of a held point of a dynamic run."""
        assert self.run is not None
        torque = torque_key(signed_torque(self.rig, point.point))
        named = {torque_key(of): name for name, (of, _) in self.run.curves.named.items()}
        return SearchedSpeeds(named[torque], speed_ranges(self.rig)[torque])

    @cached_property
    def beyond_period(self) -> BeyondPeriod:
        """What does not fit into the period of the response of the last held point."""
        last = self.points[-1].last
        laws = laws_of(last.models)
        return BeyondPeriod(
            gears=tuple(averaged_gears(self.rig, laws)),
            loads=tuple(loads_left_out(self.rig, laws, last.system)),
            lines=tuple(lines_left_out(self.rig, laws, last.system)),
        )

    def rolling_states(self) -> Iterator[tuple[str, RollingState]]:
        """(place and stage, state) of every rolling bearing at every held stage."""
        for point, name, state in rolling_states(self.points):
            yield f"{name}, stage {point.point.stage}", state

    def held_contact(self, point: PointResult, mesh: int) -> HeldContact | None:
        """Loaded contact of one mesh, by its number, at a held point; None without load and of analytic teeth."""
        return held_contact(self.rig, point, mesh)

    def application_factor(self, mesh: int) -> float:
        """K_A of a mesh, by its number."""
        return application_factor(self.rig, mesh)

    def flank_ratings(self, mesh: int) -> tuple[FlankRating, ...]:
        """Ratings of a mesh, by its number, at every held stage that turns under load."""
        return tuple(flank_ratings(self.rig, self.points, mesh))

    def standard_root_stresses(self, mesh: int, index: int) -> Iterator[tuple[RatedLoad, RootStress]]:
        """sigma_F of ISO 6336-3 of one gear of a mesh at every held stage, with the simulated K_V in K_Falpha too."""
        pair, gear = self.rig.pairs[self.rig.mesh_names[mesh]], self.rig.mesh_gear(mesh, index)
        for load in rated_loads(self.rig, self.points, mesh):
            yield load, root_stress(pair, load.torque, index, load.root, grade=gear.quality_grade)

    def strength_factors(self, mesh: int, index: int) -> tuple[float, Mapping[str, float]]:
        """Load cycles that a gear has to endure, and the factors on sigma_FE by symbol."""
        cycles = rated_cycles(self.rig, mesh, index)
        return cycles, permissible_factors(self.rig.pairs[self.rig.mesh_names[mesh]], index, cycles)

    def load_cycles(self, shaft: str) -> float:
        """Turns of a shaft in the planned time at test speed."""
        return load_cycles(self.rig, shaft)

    def reversed_bending(
        self, mesh: int, index: int, stress: float, *, over_path: bool
    ) -> ReversedBending | None:
        """Of an idler whose two flanks carry: by its stress history where that is computed, else by ISO 6336-3.

        stress : root stress of the load of this mesh [Pa], computed ``over_path`` or by the standard
        """
        gear, place = self.rig.mesh_gears(self.rig.mesh_names[mesh])[index], GearInMesh(mesh, index)
        if over_path and self.loads is not None and len(gear_meshes(self.rig)[gear]) > 1:
            history = self.loads.teeth.get(gear)
            if history is not None and self.label(mesh) in history.meshes:
                return of_history(self.rig, place, history)
        return by_standard(self.rig, place, stress, self.test.point.speed)

    @property
    def case(self) -> Case:
        """The case."""
        return self.rig.case

    @property
    def test(self) -> PointResult:
        """The held point that speaks for the rig."""
        return governing_point(self.points)

    @property
    def unexpanded(self) -> tuple[str, ...]:
        """Gearboxes whose housing is not expanded: they have none, or no clearances can be read from its mesh."""
        models = self.rig.models
        return tuple(name for name in self.case.gearboxes if name not in models or models[name].no_expansion)

    def why_unexpanded(self, name: str) -> str:
        """Why the housing of a gearbox is not expanded."""
        model = self.rig.models.get(name)
        return (
            "its housing is not expanded" if model is None or not model.no_expansion else model.no_expansion
        )

    @property
    def no_clearances(self) -> str:
        """Why there are no hot clearances, where there are none."""
        reasons = {
            f"gearbox {name}: {model.no_expansion}"
            for name, model in self.rig.models.items()
            if model.no_expansion
        }
        return "; ".join(sorted(reasons)) or NO_HOUSING

    def label(self, mesh: int) -> str:
        """Name of a mesh in ids and results."""
        return self.rig.mesh_labels[self.rig.mesh_names[mesh]]

    def role(self, mesh: int) -> Role:
        """Role of the gearbox of a mesh."""
        return self.rig.mesh(self.rig.mesh_names[mesh])[0].role


def solved_rig(
    rig: Rig,
    points: Sequence[PointResult],
    temperatures: Sequence[HousingTemperatures],
    *,
    run: DynamicRun | None = None,
    loads: DynamicLoads | None = None,
) -> SolvedRig:
    """The records of solved points; loads are those of the run where they are not given.

    temperatures : of every housing at every point (`housing_fields`), with or without what is solved to compare
    run : of the dynamic solvers; None where losses are given
    """
    loads = SolvedLoads(rig, run) if loads is None and run is not None else loads
    return SolvedRig(
        rig=rig,
        points=points,
        run=run,
        loads=loads,
        loop=LoopVibration(rig, tuple(points), run, loads),
        temperatures=temperatures,
        warm=[warm_gearbox(rig, point, name) for point in points for name in point.last.expansion],
        balances=[stage_balance(rig, point.last) for point in points],
    )


def housing_fields(points: Iterable[PointResult]) -> list[tuple[PointResult, HousingField]]:
    """Every field of every held point, with that point."""
    return [(point, field) for point in points for field in point.last.fields.values()]
