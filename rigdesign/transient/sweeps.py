"""One branch of the thermal history: housings and oil circuits in turn, until their supply temperatures agree."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from rigdesign.base.errors import NotConvergedError
from rigdesign.oil_circuit.state import CircuitState
from rigdesign.rig.model import Rig
from rigdesign.transient.heating import Heating
from rigdesign.transient.housing_history import BranchPlan, Marching, ThermalHistory, march
from rigdesign.transient.oil_power import OilPower, oil_power, stream_heats
from rigdesign.transient.oil_supply import (
    MOST_SWEEPS,
    SWEEP_TOLERANCE,
    Secants,
    SupplyHistory,
    circuits_over,
    first_guess,
)

FIRST_CHANGE = 20.0
"""Size by which supply temperatures may move in the first sweep [K]."""
STEP_SHARE = 0.2
"""Error of a time step as a share of what the supply temperatures moved by in the sweep before."""


@dataclass(frozen=True, kw_only=True)
class BranchHistories:
    """One branch of all housings and oil circuits."""

    plan: BranchPlan
    housings: Mapping[str, ThermalHistory]
    """By gearbox."""
    supply: SupplyHistory | None
    """Of the oil circuits; None without any."""
    power: OilPower


def branch_histories(
    rig: Rig,
    heating: Heating,
    plan: BranchPlan,
    circuits: Mapping[str, CircuitState],
    say: Callable[[str], None] = lambda message: None,
) -> BranchHistories:
    """March every housing, and with them the oil circuits, over one branch.

    circuits : at its start

    Raises
    ------
    ConditionError
        Conditions that cannot be computed.
    NotConvergedError
        A time step does not converge, or housings and circuits do not come to agree.
    """
    case = rig.case
    if not circuits:
        housings = _housings(rig, heating, plan, Marching(tolerance=case.transient.tolerance), say)
        heats = stream_heats(rig, heating, [each.oil for each in housings.values()])
        power = oil_power(case, plan.name, heats)
        return BranchHistories(plan=plan, housings=housings, supply=None, power=power)
    fed, secants, change = first_guess(rig, circuits), Secants(), FIRST_CHANGE
    for sweep in range(1, MOST_SWEEPS + 1):
        # while the supplies still move a lot, steps need not be more exact than that
        tolerance = max(case.transient.tolerance, STEP_SHARE * change)
        housings = _housings(rig, heating, plan, Marching(tolerance=tolerance, supply=fed), say)
        heats = stream_heats(rig, heating, [each.oil for each in housings.values()], fed)
        found = circuits_over(circuits, heats, heating.answers)
        change = found.change(fed)
        say(f"oil circuits, sweep {sweep}: supply temperatures move by {change:.2g} K")
        if change <= SWEEP_TOLERANCE and tolerance == case.transient.tolerance:
            power = oil_power(case, plan.name, heats, found)
            return BranchHistories(plan=plan, housings=housings, supply=found, power=power)
        fed = secants.following(fed, found)
    raise NotConvergedError(
        f"oil circuits over {plan.name}: supply temperatures still move by {change:.3g} K after {MOST_SWEEPS} sweeps, "
        f"limit {SWEEP_TOLERANCE:g} K; give the tanks more oil or the consumers less flow"
    )


def _housings(
    rig: Rig, heating: Heating, plan: BranchPlan, how: Marching, say: Callable[[str], None]
) -> dict[str, ThermalHistory]:
    found = {}
    for name in rig.models:
        say(f"{name} over {plan.name.replace('_', ' ')}: {', '.join(phase.name for phase in plan.phases)}")
        found[name] = march(rig, heating, name, plan, how)
    return found
