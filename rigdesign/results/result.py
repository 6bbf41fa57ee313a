"""What a run returns: immutable records, named as they stand in results.json."""

from dataclasses import dataclass, field
from functools import cached_property
from html import escape
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray

from rigdesign.case.assumptions import AssumptionRecord
from rigdesign.case.provenance import InputRow, MeasuredInput
from rigdesign.results.check import STATUSES, Checks, Finding, HandCalculation, Status
from rigdesign.results.curves import Columns, curves_of, event_curves, lateral_curves
from rigdesign.results.dynamics import DynamicsResult
from rigdesign.results.housing import CircuitBalance, CoolingBalance, HousingTemperatures, RigHeat
from rigdesign.results.lateral import LateralVibration, RollingBearingRecord
from rigdesign.results.loads import EventRecord
from rigdesign.results.quantity import Quantity, Records, to_dataframe
from rigdesign.results.ranges import RangesResult
from rigdesign.results.thermal import (
    ExpansionResult,
    LossRow,
    OilRow,
    TemperatureField,
    TransientResult,
)

if TYPE_CHECKING:
    import pandas

# Inputs that would turn failing checks: immutable records, named as they stand in results.json.


@dataclass(frozen=True, kw_only=True)
class Flip:
    """One input at the value at which a check changes between held and broken, all others as stated.

    path : of the input; empty for the limit of the check itself; ``*`` where several move together
    stated, needed : as the case would write them; ``needed`` is empty where no value is known
    check : the check; ``holds`` says whether it holds at the stated value
    turns : whether the verdict turns with it: no other check fails then
    effect : what follows, in words
    """

    path: str
    title: str
    stated: str
    needed: str
    check: str
    holds: bool
    turns: bool
    effect: str


@dataclass(frozen=True, kw_only=True)
class FlipSearch:
    """What was looked at for `Flip` rows.

    inputs : titles of the inputs that were moved, each alone
    checks : ids of the checks that they were to turn; ``not_searched`` the other failing
        ones, which would take the run again
    """

    inputs: tuple[str, ...] = ()
    checks: tuple[str, ...] = ()
    not_searched: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class DiscretisationRow:
    """How far a number is from that of an infinitely fine mesh."""

    quantity: str
    """A number of one gearbox at the governing stage, or the id of a check."""
    gearbox: str
    """Empty for a check, which takes the worst place of all."""
    stage: str
    """Empty for a check."""
    value: float
    error: float
    """Estimated size of the error in the unit of the value."""
    unit: str
    method: str
    order: float | None
    """Order of convergence behind the estimate; None where none was used."""


@dataclass(frozen=True, kw_only=True)
class MeshShift:
    """What the fine mesh changes in the value of one check."""

    id: str
    standard: float
    reference: float
    shift: float
    unit: str


@dataclass(frozen=True, kw_only=True)
class IterationResidual:
    """Largest changes in one iteration of the coupling loop."""

    temperature: Annotated[float, Quantity("K")]
    expansion: Annotated[float, Quantity("um")]
    torque_relative: float


@dataclass(frozen=True, kw_only=True)
class CouplingHistory:
    """Residuals of every iteration of the coupling loop of one stage."""

    stage: str
    residuals: tuple[IterationResidual, ...]

    @property
    def iterations(self) -> Annotated[int, Quantity()]:
        """How many it took."""
        return len(self.residuals)


@dataclass(frozen=True, kw_only=True, repr=False)
class RunResult:
    """Result of `rigdesign.run_case`; all of it but ``fields`` goes into results.json."""

    case: dict[str, str]
    """{name, path, hash, title}"""
    fidelity: str
    verdict: Literal["pass", "open", "fail"]
    checks: Checks
    dynamics: DynamicsResult | None
    losses: Records[LossRow]
    oil: Records[OilRow]
    events: Records[EventRecord] = field(default_factory=Records)
    rolling_bearings: Records[RollingBearingRecord] = field(default_factory=Records)
    """Of every held stage."""
    cooler: Records[CoolingBalance]
    """Of every held stage."""
    lateral: LateralVibration | None = None
    """None for shafts that only twist."""
    rig_heat: Records[RigHeat] = field(default_factory=Records)
    """Of every held stage, of a case that states `rig_heat`."""
    oil_circuits: Records[CircuitBalance] = field(default_factory=Records)
    """Of every held stage."""
    thermal: Records[HousingTemperatures]
    """Of every housing at every held stage."""
    expansion: list[ExpansionResult]
    coupling: Records[CouplingHistory]
    discretisation: list[DiscretisationRow] = field(default_factory=list)
    reference_shift: list[MeshShift] = field(default_factory=list)
    """At reference: every check that depends on a housing mesh, on the standard mesh and on the fine one."""
    hand_checks: Records[HandCalculation]
    """A number an engineer can redo for each key result."""
    inputs: list[InputRow] = field(default_factory=list)
    """Every value the case states."""
    assumptions: list[AssumptionRecord]
    overrides: Records[MeasuredInput]
    not_modelled: list[str]
    warnings: list[Finding]
    timings_s: dict[str, float]
    transient: TransientResult | None = None
    """With ``--transient``."""
    ranges: RangesResult | None = None
    """With `--ranges`: verdicts and margins over the ranges of the assumed inputs."""
    flips: list[Flip] = field(default_factory=list)
    """Inputs that would turn failing checks, or the one nearest to its limit."""
    flip_search: FlipSearch | None = None
    """What was looked at for ``flips``; None where nothing was asked."""
    fields: list[TemperatureField] = field(repr=False)

    def __repr__(self) -> str:
        counts = ", ".join(f"{number} {verdict}" for verdict, number in self.counts.items() if number)
        return f"RunResult({self.case['name']}, {self.fidelity}: {self.verdict}; {len(self.checks)} checks: {counts})"

    def _repr_html_(self) -> str:
        """Verdict and checks as a table, for notebooks."""
        rows = "".join(
            f"<tr><td>{escape(check.id)}</td><td>{_shown(check.value)}</td><td>{_shown(check.limit)}</td>"
            f"<td>{escape(check.unit)}</td><td>{_shown(check.distance)}</td><td>{check.status}</td></tr>"
            for check in self.checks
        )
        head = "".join(
            f"<th>{name}</th>" for name in ("check", "value", "limit", "unit", "distance", "verdict")
        )
        return (
            f"<p>{escape(repr(self))}</p><table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>"
        )

    @property
    def counts(self) -> dict[Status, int]:
        """How many checks end with each verdict, missed advisory limits apart."""
        return {status: sum(check.status == status for check in self.checks) for status in STATUSES}

    @cached_property
    def columns(self) -> dict[str, Columns]:
        """Every curve of the run by name as lists by ``quantity [unit]``: what curves/*.csv holds."""
        return (
            curves_of(self.expansion, self.dynamics, self.transient)
            | event_curves(self.events)
            | lateral_curves(self.lateral)
        )

    @property
    def curves(self) -> dict[str, dict[str, NDArray[Any]]]:
        """Every curve of the run by name as arrays by ``quantity [unit]``: ``curves["ramp"]["time [s]"]``."""
        return {
            name: {header: np.asarray(values) for header, values in columns.items()}
            for name, columns in self.columns.items()
        }

    def to_dataframe(self) -> "pandas.DataFrame":
        """The checks as a table, one row each, indexed by id.

        Raises
        ------
        MissingLibraryError
            pandas is not installed.
        """
        return to_dataframe(self.checks).set_index("id")


def _shown(value: float | None) -> str:
    return "" if value is None else f"{value:.4g}"
