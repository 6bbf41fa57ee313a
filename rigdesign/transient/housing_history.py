"""Temperatures of one housing over one branch of the thermal history, marched with given supply temperatures."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from rigdesign.coupling.housing_context import BEARING_FILM, BEARING_OIL, GEAR_OIL
from rigdesign.rig.model import Rig
from rigdesign.transient.bearing_nodes import seated_bearings
from rigdesign.transient.heating import Heating
from rigdesign.transient.oil_power import OilHistory
from rigdesign.transient.oil_supply import SupplyHistory
from rigdesign.transient.phases import Phase
from thermal.transient.history import InitialState, Observed, StepControl, TransientSolution, solve_transient
from thermal.transient.probes import Probe

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


# Places of a housing whose temperatures are kept over time.


def probes_of(rig: Rig, name: str) -> list[Probe]:
    """Every body by its mean, the hottest place of the housing, oil outlets, bearing films, and those of the case."""
    box = rig.case.gearboxes[name]
    fed = box.fed_bearings is not None
    films = list(box.bearings) if fed else seated_bearings(rig, name)
    own = [
        *(Probe(name=body, place=body) for body in rig.models[name].mesh.bodies),
        Probe(name="housing_max", place="housing", quantity="max"),
        Probe(name="gear_oil_outlet", place=GEAR_OIL),
        Probe(name="bearing_oil_outlet", place=BEARING_OIL if fed else GEAR_OIL),
        *(Probe(name=f"film_outlet_{part}", place=f"{BEARING_FILM}:{part}") for part in films),
    ]
    taken = {probe.name for probe in own}
    return own + [
        Probe(name=f"probe_{key}" if key in taken else key, place=entry.place, quantity=entry.quantity)
        for key, entry in rig.case.transient.probes.items()
        if entry.gearbox == name
    ]
