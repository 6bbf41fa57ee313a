"""What the checks look at: the case, the solved points, the assembled results."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from rigdesign.base.finite import finite
from rigdesign.case.model import Case
from rigdesign.coupling.loop import PointResult, governing_point
from rigdesign.records.dynamics import DynamicRun
from rigdesign.results.result import (
    DiscretisationRow,
    DynamicsResult,
    ExpansionResult,
    MeshShift,
    Role,
    ThermalResult,
)
from rigdesign.rig.model import Rig


@dataclass(frozen=True, kw_only=True)
class SolvedRig:
    """A solved rig."""

    rig: Rig
    points: Sequence[PointResult]
    run: DynamicRun | None
    """None when the losses are given: no drivetrain, no loads."""
    dynamics: DynamicsResult | None
    thermal: Sequence[ThermalResult]
    expansion: Sequence[ExpansionResult]
    cooler: Sequence[Mapping[str, float | str]]
    """Where the heat goes, one row for each held stage (`records.heat.cooler`)."""
    discretisation: Sequence[DiscretisationRow] = ()
    mesh_shifts: Sequence[MeshShift] = ()

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


NO_LOADS = "losses are given (losses.basis = input): there are no dynamic loads"
NO_LIMIT = "the case states no limit"
NO_HOUSING = "no gearbox has a housing: there are no temperatures and clearances"


def worst(items: Iterable[tuple[float, str]], *, smallest: bool = False) -> tuple[float, str]:
    """The governing value and where it occurs; the first of equals.

    Raises NonFiniteResultError for a value that is NaN or infinite: it has no place in an order.
    """
    ordered = sorted(items, key=lambda item: finite(item[1], item[0]), reverse=not smallest)
    return ordered[0]
