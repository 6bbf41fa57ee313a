"""The solved rig: the case, the solved points and their SI records. Checks and rows of the result read nothing else."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from rigdesign.base.json_text import finite
from rigdesign.case.model import Case
from rigdesign.coupling.loop import PointResult, governing_point
from rigdesign.coupling.temperatures import HousingField
from rigdesign.postprocessing.dynamics import DynamicRun, SolvedLoads
from rigdesign.postprocessing.housing import stage_balance
from rigdesign.postprocessing.nearest_resonance import NearDwell
from rigdesign.postprocessing.press_fits import press_fits, spline_stresses
from rigdesign.postprocessing.run_torques import PartTorque, part_torques
from rigdesign.postprocessing.vibration import LoopVibration
from rigdesign.postprocessing.warm_gearbox import warm_gearbox
from rigdesign.results.check import Role
from rigdesign.results.housing import CoolingBalance, HousingTemperatures, StageBalance
from rigdesign.results.lateral import LateralVibration
from rigdesign.results.loads import DynamicLoads, EventRecord, PressFitCapacity, SplineStress
from rigdesign.results.result import DiscretisationRow, MeshShift
from rigdesign.results.thermal import HistoryExtremes
from rigdesign.results.vibration import HeldTorque
from rigdesign.results.warm_gearbox import WarmGearbox
from rigdesign.rig.model import Rig


@dataclass(frozen=True, kw_only=True)
class LawSpread:
    """What another published law of a loss would change.

    cause : both laws with what they give; changes : of the value of a check in its unit, by its id
    """

    cause: str
    changes: Mapping[str, float]


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


NO_LOADS = "losses are given (losses.basis = input): there are no dynamic loads"
NO_LIMIT = "the case states no limit"
NO_HOUSING = "no gearbox has a housing: there are no temperatures and clearances"


def worst(items: Iterable[tuple[float, str]], *, smallest: bool = False) -> tuple[float, str]:
    """The governing value and where it occurs; the first of equals.

    items : (value, where)

    Raises
    ------
    NonFiniteResultError
        A value is NaN or infinite: it has no place in an order.
    """
    ordered = sorted(items, key=lambda item: finite(item[1], item[0]), reverse=not smallest)
    return ordered[0]
