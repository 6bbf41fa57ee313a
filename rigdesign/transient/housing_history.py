"""Temperatures of one housing over one branch of the thermal history, marched with given supply temperatures."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from rigdesign.coupling.housing_context import BEARING_OIL, GEAR_OIL
from rigdesign.rig.model import Rig
from rigdesign.transient.heating import Heating
from rigdesign.transient.oil_power import OilHistory
from rigdesign.transient.oil_supply import SupplyHistory
from rigdesign.transient.phases import Phase
from rigdesign.transient.places import probes_of
from thermal.transient.history import InitialState, Observed, StepControl, TransientSolution, solve_transient

FloatArray = NDArray[np.float64]
FIRST_STEP = 0.5
"""First time step of a phase [s]."""
UNBOUND = 1e12
"""No limit of the time step [s] but its error."""


@dataclass(frozen=True)
class WarmStart:
    """State of one housing from which a history goes on."""

    field: FloatArray
    """(n_nodes,) [K]"""
    volumes: Mapping[str, float] | None = None
    """Oil volume -> temperature [K]; None where they follow from the field."""


@dataclass(frozen=True, kw_only=True)
class BranchPlan:
    """What the rig goes through in one branch of the thermal history."""

    name: str
    """``schedule`` or the event."""
    phases: tuple[Phase, ...]
    start: float = 0.0
    """Since the start of the schedule [s]."""
    housings: Mapping[str, WarmStart] = field(default_factory=dict)
    """Gearbox -> its state at the start; at the temperature of the room when left out."""


@dataclass(frozen=True, kw_only=True)
class Marching:
    """How exact the time steps are, and how the oil is fed.

    tolerance : local error of a time step [K]
    supply : what the oil circuits do; None without circuits
    """

    tolerance: float
    supply: SupplyHistory | None = None


@dataclass(frozen=True, kw_only=True)
class ThermalHistory:
    """Temperatures of a branch before its clearances are read."""

    gearbox: str
    plan: BranchPlan
    solution: TransientSolution
    fields: list[NDArray[np.float32]]
    """(n_nodes,) at every time [K]."""
    ends: dict[int, WarmStart]
    """Number of a phase -> its state at its end."""

    @property
    def oil(self) -> OilHistory:
        """The outlets of its oil."""
        solution, plan = self.solution, self.plan
        return OilHistory(
            gearbox=self.gearbox,
            name=plan.name,
            phases=plan.phases,
            start=plan.start,
            times=solution.times + plan.start,
            phase=solution.stages,
            outlets={kind: solution.probes[f"{kind}_outlet"] for kind in (GEAR_OIL, BEARING_OIL)},
            from_rest=plan.start == 0.0,
        )


def march(rig: Rig, heating: Heating, name: str, plan: BranchPlan, how: Marching) -> ThermalHistory:
    """Temperatures of the housing of gearbox ``name`` over a branch.

    Raises
    ------
    ConditionError
        Conditions that cannot be computed.
    NotConverged
        A time step does not converge.
    """
    setup = rig.conduction[name]
    materials = rig.body_materials(name)
    fields: list[NDArray[np.float32]] = []
    ends: dict[int, WarmStart] = {}
    limits = np.cumsum([phase.duration for phase in plan.phases])
    start = plan.housings.get(name)

    def keep(time: float, field: FloatArray, fluids: Mapping[str, float]) -> None:
        fields.append(field.astype(np.float32))
        for number in np.flatnonzero(np.isclose(limits, time, rtol=1e-12, atol=1e-9)).tolist():
            ends[number] = WarmStart(field, dict(fluids))

    solution = solve_transient(
        setup,
        {body: material.density * material.heat_capacity for body, material in materials.items()},
        [
            heating.stage(name, phase, float(end) - phase.duration, how.supply)
            for phase, end in zip(plan.phases, plan.start + limits)
        ],
        InitialState(
            temperature=rig.case.ambient.temperature if start is None else start.field,
            volumes=None if start is None else start.volumes,
        ),
        observed=Observed(probes=probes_of(rig, name), at=None, observer=keep),
        steps=StepControl(tolerance=how.tolerance, first=FIRST_STEP, largest=UNBOUND),
    )
    return ThermalHistory(gearbox=name, plan=plan, solution=solution, fields=fields, ends=ends)
