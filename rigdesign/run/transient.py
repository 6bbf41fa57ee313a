"""The thermal history as a section of the result: curves, worst moments, settling times, soak."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from rigdesign.case.model import Case
from rigdesign.checks import all_checks
from rigdesign.coupling.alignment import ALIGNMENT, CouplingEnd, CouplingPlace, coupling_places
from rigdesign.postprocessing.solved_rig import SolvedRig
from rigdesign.results.check import Check, Checks, Finding, overall
from rigdesign.results.result import RunResult
from rigdesign.results.serialisation.events import EXTREME_UNITS, worst_moment_row
from rigdesign.results.thermal import (
    Extreme,
    HistoryExtremes,
    OilPowerCurve,
    Settling,
    SupplyHeld,
    TransientCurve,
    TransientResult,
)
from rigdesign.results.units import MM, RPM, ZERO
from rigdesign.rig.model import Rig
from rigdesign.run.warnings import oil_at_room_temperature
from rigdesign.transient.oil_power import OilPower
from rigdesign.transient.phases import SCHEDULE
from rigdesign.transient.soak import QUANTITIES, Branch, Quantity, clearance_limits, hours, limited, smallest
from rigdesign.transient.thermal_history import TransientRun, run_transient
from thermal.transient.history import settling_time

# Alignment over the thermal history: bearings, bores, axes and couplings at every time, and their worst moments.

FloatArray = NDArray[np.float64]
Misalignment = Literal[
    "bearing_tilt", "bore_out_of_round", "axis_inclination", "axis_skew", "coupling_offset", "coupling_angle"
]
MISALIGNMENTS: tuple[Misalignment, ...] = get_args(Misalignment)


@dataclass(frozen=True)
class Peak:
    """The largest value of a misalignment and when it is there."""

    value: float
    place: str
    branch: Branch
    at: int


def misalignments(
    rig: Rig, branch: Branch, branches: Sequence[Branch]
) -> dict[Misalignment, dict[str, FloatArray]]:
    """Quantity -> place -> (n,) values of a branch: angles [rad], offsets and deviations [m], shares [-].

    branches : of all gearboxes; one of the same name holds the other shaft of a coupling
    """
    found: dict[Misalignment, dict[str, FloatArray]] = {
        quantity: {
            place: np.array([entry[quantity][place] for entry in branch.alignment])
            for place in branch.alignment[0][quantity]
        }
        for quantity in ALIGNMENT
    }
    places = [place for place in coupling_places(rig) if place.gearbox == branch.gearbox]
    motions = {place.name: _coupling(place, branch, branches) for place in places}
    found["coupling_offset"] = {name: np.hypot(m[:, 0], m[:, 1]) for name, m in motions.items()}
    found["coupling_angle"] = {name: np.hypot(m[:, 2], m[:, 3]) for name, m in motions.items()}
    return found


def _coupling(place: CouplingPlace, branch: Branch, branches: Sequence[Branch]) -> FloatArray:
    """(n, 4) offset in y and z [m] and angle in y and z [rad] at the times of a branch."""
    motion = _end(place.first, branch, branches) - _end(place.second, branch, branches)
    motion[:, :2] += place.offset
    return motion


def _end(end: CouplingEnd, branch: Branch, branches: Sequence[Branch]) -> FloatArray:
    """(n, 4) shift and slope of a shaft end; of another gearbox between the times of its own branch."""
    own = next((b for b in branches if (b.gearbox, b.name) == (end.gearbox, branch.name)), None)
    if own is None:
        return np.zeros((len(branch.times), 4))
    axes = [entry[end.shaft] for entry in own.axes]
    motion = np.array([(*axis.shift(end.x), *axis.slope) for axis in axes])
    if own is branch:
        return motion
    return np.column_stack([np.interp(branch.times, own.times, column) for column in motion.T])


def worst_misalignments(
    solved: SolvedRig, branches: Sequence[Branch], every: Sequence[Branch], planned: bool
) -> Iterator[Extreme]:
    """Largest misalignment of every kind over some branches; of couplings one for each.

    branches : of which the largest is wanted; every : of all gearboxes, for the other shafts of the couplings
    planned : whether the case plans these branches
    """
    rig = solved.rig
    found = [(branch, misalignments(rig, branch, every)) for branch in branches]
    for quantity in MISALIGNMENTS:
        peaks = [
            Peak(float(values.max()), place, branch, int(values.argmax()))
            for branch, entries in found
            for place, values in entries[quantity].items()
        ]
        coupled = quantity.startswith("coupling_")
        groups = (
            dict.fromkeys(peak.place for peak in peaks) if coupled else dict.fromkeys([""] if peaks else [])
        )
        for group in groups:
            peak = max((p for p in peaks if not coupled or p.place == group), key=lambda p: p.value)
            yield Extreme(
                quantity=quantity,
                value=peak.value,
                place=peak.place,
                steady=_steady(solved, quantity, group),
                limit=limit_of(solved.case, quantity, peak.place),
                planned=planned,
                time=float(peak.branch.times[peak.at]),
                branch=peak.branch.name,
                phase=peak.branch.phases[peak.branch.phase[peak.at]].name,
            )


def limit_of(case: Case, quantity: Misalignment, place: str) -> float | None:
    """Limit of a misalignment [SI]; that of a coupling is its own."""
    if quantity in ("coupling_offset", "coupling_angle"):
        coupling = case.power_circuit.couplings[place]
        return coupling.radial_offset_maximum if quantity == "coupling_offset" else coupling.angle_maximum
    found: float | None = getattr(case.limits.alignment, f"{quantity}_maximum")
    return found


def _steady(solved: SolvedRig, quantity: Misalignment, coupling: str) -> float | None:
    """Largest steady value of the held stages, of one coupling where it is one's."""
    if quantity in ("coupling_offset", "coupling_angle"):
        states = [one.warm for warm in solved.warm for one in warm.couplings if one.coupling == coupling]
        found = [state.radial_offset if quantity == "coupling_offset" else state.angle for state in states]
    elif quantity in ("bearing_tilt", "bore_out_of_round"):
        bores = [bore for warm in solved.warm for bore in warm.bores]
        found = [bore.tilt if quantity == "bearing_tilt" else bore.out_of_round_share for bore in bores]
    else:
        meshes = [axes for warm in solved.warm for axes in warm.axes]
        found = [abs(axes.inclination if quantity == "axis_inclination" else axes.skew) for axes in meshes]
    return max(found, default=None)


SETTLING: tuple[Quantity, ...] = ("seal_gap", "bearing_clearance", "backlash")

STEADY = "temperature over time: "
"""Begin of the sentence on what a steady run does not model."""


def with_transient(
    solved: SolvedRig, result: RunResult, say: Callable[[str], None] = lambda message: None
) -> RunResult:
    """The result of a steady run with the thermal history, its checks and its warnings added.

    A rig without a housing has no temperatures to follow; the result then says so.

    Raises
    ------
    ConditionError, NotConverged
        Of the heat model.
    """
    if not solved.rig.models:
        text = "no gearbox has a housing: there are no temperatures over time"
        return replace(result, warnings=[*result.warnings, Finding(id="transient", text=text)])
    run = run_transient(solved.rig, solved.points, say)
    history = history_extremes(solved, run)
    checks: list[Check] = all_checks(replace(solved, history=history), result.hand_checks)
    return replace(
        result,
        transient=transient_result(solved, run, history),
        checks=Checks(checks),
        verdict=overall(checks),
        assumptions=[
            replace(entry, decides=tuple(c.id for c in checks if entry.path in c.assumptions))
            for entry in result.assumptions
        ],
        not_modelled=[
            *(text for text in result.not_modelled if not text.startswith(STEADY)),
            *simplifications(solved.rig),
        ],
        warnings=[*result.warnings, *_oil_at_start(solved), *_warnings(run)],
    )


def history_extremes(solved: SolvedRig, run: TransientRun) -> HistoryExtremes:
    """The worst moments of the planned branches, then those of the cold start, and the soak."""
    extremes = [
        extreme
        for planned in (True, False)
        for branches in ([b for b in run.branches if (b.name != "cold_start") is planned],)
        if branches
        for extreme in (
            *_least(solved, branches, planned),
            *_hottest(solved, branches, planned),
            *worst_misalignments(solved, branches, run.branches, planned),
            *worst_powers(solved, [p for p in run.power if (p.name != "cold_start") is planned], planned),
        )
    ]
    planned_power = next(power for power in run.power if power.name == SCHEDULE)
    supplies = tuple(supplies_held(solved.case, planned_power))
    return HistoryExtremes(extremes=tuple(extremes), soak=run.soak, supplies=supplies)


def transient_result(solved: SolvedRig, run: TransientRun, history: HistoryExtremes) -> TransientResult:
    """All branches as rows of the result."""
    plan = solved.case.transient
    return TransientResult(
        curves=[curve(solved.rig, branch, run.branches) for branch in run.branches],
        worst=[worst_moment_row(extreme) for extreme in history.extremes],
        settling=[row for branch in run.branches if branch.name == SCHEDULE for row in _settling(solved, branch)],
        soak=list(run.soak),
        inputs={
            "warm_up": hours(plan.warm_up),
            "dwell": hours(plan.dwell or solved.case.test_plan.time),
            "oil_run_on": hours(plan.oil_run_on),
            "soak_back": hours(plan.soak_back),
            "stop_time": hours(plan.stop_time),
            "oil_loss_time": hours(plan.oil_loss_time),
            "still_film": f"{plan.still_film:g} W/(m2 K)",
            "tolerance": f"{plan.tolerance:g} K",
        },
        energy_closure=max(branch.energy_closure for branch in run.branches),
        missed_temperature_K=max(run.missed.values()),
        oil_power=[oil_power_curve(power) for power in run.power],
    )  # fmt: skip


def curve(rig: Rig, branch: Branch, branches: Sequence[Branch]) -> TransientCurve:
    """One branch in the units of the result; ``branches`` are those of all gearboxes."""
    begins = np.concatenate([[0.0], np.cumsum([phase.duration for phase in branch.phases])])
    speeds = [
        branch.phases[number].speed(float(time - branch.start - begins[number]))
        for time, number in zip(branch.times, branch.phase, strict=True)
    ]
    return TransientCurve(
        gearbox=branch.gearbox,
        branch=branch.name,
        time_s=branch.times.tolist(),
        phase=[branch.phases[number].name for number in branch.phase],
        speed_rpm=[RPM * speed for speed in speeds],
        temperatures_degC={place: (values - ZERO).tolist() for place, values in branch.temperatures.items()},
        clearances_mm={
            quantity: {
                place: [MM * found[quantity][place] for found in branch.clearances]
                for place in branch.clearances[0][quantity]
            }
            for quantity in QUANTITIES
        },
        alignment={
            _with_unit(quantity): {
                place: (EXTREME_UNITS[quantity].per_si * values).tolist() for place, values in places.items()
            }
            for quantity, places in misalignments(rig, branch, branches).items()
        },
    )


def _with_unit(quantity: str) -> str:
    """Name of a curve of alignment."""
    unit = EXTREME_UNITS[quantity].name
    return quantity if unit == "-" else f"{quantity}_{unit}"


def _least(solved: SolvedRig, branches: Sequence[Branch], planned: bool) -> Iterator[Extreme]:
    """Smallest clearance of every kind over some branches."""
    limits = clearance_limits(solved.case)
    steady = _steady_clearances(solved)
    for quantity in QUANTITIES:
        value, place, branch, at = min(
            (
                (*smallest(found, quantity), branch, at)
                for branch in branches
                for at, clearances in enumerate(branch.clearances)
                for found in (limited(solved.case, clearances),)
                if found[quantity]
            ),
            key=lambda entry: entry[0],
        )
        yield Extreme(
            quantity=quantity,
            value=value,
            place=place,
            steady=min(steady[quantity], default=None),
            limit=limits.get(quantity),
            planned=planned,
            time=float(branch.times[at]),
            branch=branch.name,
            phase=branch.phases[branch.phase[at]].name,
        )


def _steady_clearances(solved: SolvedRig) -> Mapping[Quantity, Sequence[float]]:
    """Clearances of the held stages in their steady state [m]."""
    return {
        "seal_gap": [seal.minimum for warm in solved.warm for seal in warm.seals],
        "axial_play": [shaft.play for warm in solved.warm for shaft in warm.shafts],
        "bearing_clearance": [
            bearing.clearance
            for warm in solved.warm
            for bearing in warm.bearings
            if solved.rig.bearing(bearing.name).has_film
            or not any(e.has_film for _, _, e in solved.rig.bearings())
        ],
        "backlash": [mesh.backlash for warm in solved.warm for mesh in warm.meshes],
        "tip_clearance": [mesh.tip_clearance for warm in solved.warm for mesh in warm.meshes],
    }


def _hottest(solved: SolvedRig, branches: Sequence[Branch], planned: bool) -> Iterator[Extreme]:
    """Highest temperature of housings and of gear bodies over some branches."""
    maximum = solved.case.limits.temperatures.housing_maximum
    gears = [
        body for model in solved.rig.models.values() for body in model.mesh.bodies if body.startswith("gear_")
    ]
    for quantity, places, limit in (
        ("housing_temperature", ["housing_max"], maximum),
        ("gear_temperature", gears, None),
    ):
        if not places:
            continue
        value, place, branch, at = max(
            (
                (float(values.max()), place, branch, int(values.argmax()))
                for branch in branches
                for place, values in branch.temperatures.items()
                if place in places
            ),
            key=lambda entry: entry[0],
        )
        yield Extreme(
            quantity=quantity,
            value=value,
            place=f"{branch.gearbox}.{place}",
            steady=_steady_temperature(solved, quantity),
            limit=limit,
            planned=planned,
            time=float(branch.times[at]),
            branch=branch.name,
            phase=branch.phases[branch.phase[at]].name,
        )


def _steady_temperature(solved: SolvedRig, quantity: str) -> float:
    """Highest steady temperature of the housings, or of the means of the gear bodies [K]."""
    if quantity == "housing_temperature":
        return max(found.bodies["housing"].max for found in solved.temperatures)
    return max(
        temperature.mean
        for found in solved.temperatures
        for body, temperature in found.bodies.items()
        if body.startswith("gear_")
    )


@dataclass(frozen=True)
class DwellHistory:
    """A quantity of one housing over one dwell, in the unit of the result."""

    quantity: str
    times: FloatArray
    """(n,) [s]"""
    values: FloatArray
    """(n,)"""
    unit: str

    def settling(self, branch: Branch, stage: str, share: float) -> Settling:
        """After which time it stays near its end value.

        share : of its largest distance from that value, within which it is near
        """
        end = float(self.values[-1])
        band = share * float(np.abs(self.values - end).max())
        start = float(self.times[0])
        found = settling_time(self.times, self.values, end, band) if band > 0.0 else start
        return Settling(
            gearbox=branch.gearbox,
            stage=stage,
            quantity=self.quantity,
            settled_after_s=None if found is None else found - start,
            start=float(self.values[0]),
            end=end,
            unit=self.unit,
        )


def _settling(solved: SolvedRig, branch: Branch) -> Iterator[Settling]:
    """Field, housing, bearings, seals and backlash: when each stays near its end value in every dwell."""
    for number, phase in enumerate(branch.phases):
        if not phase.held:
            continue
        inside = np.flatnonzero(branch.phase == number)
        at = np.arange(inside[0] - 1, inside[-1] + 1) if inside[0] else inside
        for history in _dwell_histories(branch, at):
            yield history.settling(branch, phase.name, solved.case.transient.settled_share)


def _dwell_histories(branch: Branch, at: NDArray[np.intp]) -> Iterator[DwellHistory]:
    """Quantities whose settling is reported at the numbers ``at`` of the times of a branch."""
    times = branch.times[at]
    for body in ("field", "housing"):
        if body in branch.temperatures:
            yield DwellHistory(body, times, branch.temperatures[body][at] - ZERO, "degC")
    for quantity in SETTLING:
        least = [MM * smallest(branch.clearances[i], quantity)[0] for i in at]
        yield DwellHistory(quantity, times, np.array(least), "mm")


def _oil_at_start(solved: SolvedRig) -> Iterator[Finding]:
    """Oil that is too thick to be pumped at the temperature of the room."""
    yield from (Finding(id="oil", text=text) for text in oil_at_room_temperature(solved.rig))


def _warnings(run: TransientRun) -> Iterator[Finding]:
    """What the film laws say of their range, one sentence a law: the numbers change from step to step."""
    said: dict[str, str] = {}
    for branch in run.branches:
        for text in branch.warnings:
            said.setdefault("".join(c for c in text if not c.isdigit() and c not in ".e+-"), text)
    for text in said.values():
        yield Finding(id="transient", text=f"over time, at first: {text}")
    for soak in run.soak:
        if soak.soak_time_s is None:
            yield Finding(
                id="transient", text=f"{soak.gearbox}: no warm-up is known to be enough: {soak.reason}"
            )


def simplifications(rig: Rig) -> Sequence[str]:
    """What the thermal history leaves out."""
    return (
        "over time: losses and films are those of the coupled steady run, interpolated over speed and torque; "
        "thicker oil and tighter bearings of a rig that still warms up are not fed back into them",
        *_feeds(rig),
        "over time: at standstill gears stand still; jets do not reach them, still air and the shafts warm them",
        "over time: oil has no mass, a bearing without feed keeps its film, tooth friction without oil is that "
        "with oil",
    )


def _feeds(rig: Rig) -> Iterator[str]:
    """How oils are fed over time: by oil circuits with limits, or as the case states."""
    streams = {f"{name}.{kind}" for name, box in rig.case.gearboxes.items() for kind in box.feeds}
    fed = {consumer.name for circuit in rig.oil_circuits.values() for consumer in circuit.consumers}
    if streams - fed:
        which = "every oil" if not fed else ", ".join(sorted(streams - fed))
        yield (
            f"over time: {which} is fed at its inlet temperature from the first moment on, whatever heaters and cooler "
            "must give or take for it; the heat content of tanks and pipes is left out"
        )
    if fed:
        yield (
            "over time: losses do not feel that the supply temperature of an oil circuit is still below its setpoint; "
            "a warm-up that is tried shorter than planned has the supply temperatures of the planned one"
        )


# Heaters and cooler over time as records: curves, and the moment at which each must give or take most.


def oil_power_curve(power: OilPower) -> OilPowerCurve:
    """One branch in the units of the result."""
    circuits = {} if power.supply is None else power.supply.circuits
    supplies = {} if power.supply is None else power.supply.supplies
    return OilPowerCurve(
        branch=power.name,
        time_s=power.times.tolist(),
        phase=[power.phases[number].name for number in power.phase],
        heater_W=power.heater.tolist(),
        cooler_W=power.cooler.tolist(),
        streams_W={name: heat.tolist() for name, heat in power.streams.items()},
        tanks_degC={name: (found.tank - ZERO).tolist() for name, found in circuits.items()},
        supplies_degC={name: (values - ZERO).tolist() for name, values in supplies.items()},
    )


def supplies_held(case: Case, power: OilPower) -> Iterator[SupplyHeld]:
    """When every line of an oil circuit holds its setpoint over the schedule; a branch with a dwell."""
    if power.supply is None:
        return
    last = max(i for i, phase in enumerate(power.phases) if phase.held)
    until = power.phase <= last
    times = power.times[until]
    for name, circuit in case.oil_circuits.items():
        for key, line in circuit.lines.items():
            if line.setpoint is None:
                continue
            values = power.supply.supplies[line.consumers[0]][until]
            outside = np.flatnonzero(np.abs(values - line.setpoint) > line.tolerance)
            held = not len(outside) or outside[-1] < len(values) - 1
            first = 0 if not len(outside) else int(outside[-1]) + 1
            warm = float(np.interp(case.transient.warm_up, times, values))
            yield SupplyHeld(
                place=f"{name}.lines.{key}",
                time=float(times[first]) if held else None,
                reached=(warm if held else float(values[-1])) - ZERO,
                end=float(times[-1]),
            )


def largest_stream(power: OilPower, quantity: str, at: int) -> str:
    """The stream that asks most of heaters or cooler at a time."""
    sign = -1.0 if quantity == "heater_power" else 1.0
    return max(power.streams, key=lambda name: sign * float(power.streams[name][at]))


def worst_powers(solved: SolvedRig, powers: Sequence[OilPower], planned: bool) -> Iterator[Extreme]:
    """Largest power of heaters and of the cooler over some branches [W]."""
    limits = solved.case.limits.oil
    for quantity, steady, limit in (
        ("heater_power", [balance.heater for balance in solved.cooling], limits.heater_power_maximum),
        ("cooler_power", [balance.cooler for balance in solved.cooling], limits.cooler_power_maximum),
    ):
        value, branch, at = max(
            (
                (float(values.max()), power, int(values.argmax()))
                for power in powers
                for values in (power.heater if quantity == "heater_power" else power.cooler,)
            ),
            key=lambda entry: entry[0],
        )
        yield Extreme(
            quantity=quantity,
            value=value,
            place=largest_stream(branch, quantity, at),
            steady=max(steady, default=None),
            limit=limit,
            planned=planned,
            time=float(branch.times[at]),
            branch=branch.name,
            phase=branch.phases[branch.phase[at]].name,
        )
