"""The thermal course as a section of the result: curves, worst moments, settling times, soak."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from rigdesign.checks.assumptions import with_assumptions
from rigdesign.checks.omissions import omissions
from rigdesign.checks.rules import overall, with_omissions
from rigdesign.checks.transient import transient_checks
from rigdesign.records.solved_rig import SolvedRig
from rigdesign.results.result import Check, Checks, Finding, RunResult
from rigdesign.results.transient import Settling, TransientCurve, TransientResult, WorstMoment
from rigdesign.rig.model import Rig
from rigdesign.run.transient_alignment import UNITS, misalignments, worst_misalignments
from rigdesign.run.transient_oil import oil_power_curve, worst_powers
from rigdesign.run.warnings import cold_oil
from rigdesign.transient.branch import Branch
from rigdesign.transient.clearances import QUANTITIES, Quantity, smallest
from rigdesign.transient.course import TransientRun, run_transient
from rigdesign.transient.limits import clearance_limits
from rigdesign.transient.phases import SCHEDULE
from rigdesign.transient.soak import hours
from thermal.transient.history import settling_time

ZERO = 273.15
MM = 1e3
RPM = 30.0 / np.pi
SETTLING: tuple[Quantity, ...] = ("seal_gap", "bearing_clearance", "backlash")
FloatArray = NDArray[np.float64]
STEADY = "temperature over time: "
"""Begin of the sentence on what a steady run does not model."""


def with_transient(
    solved: SolvedRig, result: RunResult, say: Callable[[str], None] = lambda message: None
) -> RunResult:
    """The result of a steady run with the thermal course beside it, its checks and its warnings.

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
    record = transient_result(solved, run)
    added = [
        with_assumptions(solved.case, with_omissions(check, omissions(solved, check)))
        for check in transient_checks(solved.case, record)
    ]
    checks: list[Check] = [*result.checks, *added]
    return replace(
        result,
        transient=record,
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
        warnings=[*result.warnings, *_cold_oil(solved), *_warnings(run)],
    )


def transient_result(solved: SolvedRig, run: TransientRun) -> TransientResult:
    """All branches as records."""
    plan = solved.case.transient
    return TransientResult(
        curves=[curve(solved.rig, branch, run.branches) for branch in run.branches],
        worst=[
            row
            for planned in (True, False)
            for branches in ([b for b in run.branches if (b.name != "cold_start") is planned],)
            if branches
            for row in (
                *_least(solved, branches, planned),
                *_hottest(solved, branches, planned),
                *worst_misalignments(solved, branches, run.branches, planned),
                *worst_powers(solved, [p for p in run.power if (p.name != "cold_start") is planned], planned),
            )
        ],
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
    """One branch in the units of the result, beside the ``branches`` of all gearboxes."""
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
        temperatures_degC={
            place: (values - ZERO).tolist() for place, values in branch.temperatures.items()
        },
        clearances_mm={
            quantity: {
                place: [MM * found[quantity][place] for found in branch.clearances]
                for place in branch.clearances[0][quantity]
            }
            for quantity in QUANTITIES
        },
        alignment={
            quantity if UNITS[quantity][0] == "-" else f"{quantity}_{UNITS[quantity][0]}": {
                place: values.tolist() for place, values in places.items()
            }
            for quantity, places in misalignments(rig, branch, branches).items()
        },
    )  # fmt: skip


def _least(solved: SolvedRig, branches: Sequence[Branch], planned: bool) -> Iterator[WorstMoment]:
    """Smallest clearance of every kind over some branches."""
    limits = clearance_limits(solved.case)
    for quantity in QUANTITIES:
        value, place, branch, at = min(
            (
                (*smallest(found, quantity), branch, at)
                for branch in branches
                for at, found in enumerate(branch.clearances)
            ),
            key=lambda entry: entry[0],
        )
        limit = limits.get(quantity)
        yield WorstMoment(
            quantity=quantity,
            value=MM * value,
            unit="mm",
            place=place,
            steady=_steady(solved, quantity),
            limit=None if limit is None else MM * limit,
            planned=planned,
            time_s=float(branch.times[at]),
            branch=branch.name,
            phase=branch.phases[branch.phase[at]].name,
        )


def _steady(solved: SolvedRig, quantity: Quantity) -> float | None:
    """Worst steady clearance of the held stages [mm]."""
    rows = {
        "seal_gap": [s["hot_min_mm"] for g in solved.expansion for s in g.seal_gaps],
        "axial_play": [s["axial_play_hot_mm"] for g in solved.expansion for s in g.shafts],
        "bearing_clearance": [
            1e-3 * b["diametral_clearance_hot_um"] for g in solved.expansion for b in g.bearings
        ],
        "backlash": [gear["backlash_hot_mm"] for g in solved.expansion for gear in g.gears],
        "tip_clearance": [gear["tip_clearance_hot_mm"] for g in solved.expansion for gear in g.gears],
    }
    return min(rows[quantity], default=None)


def _hottest(solved: SolvedRig, branches: Sequence[Branch], planned: bool) -> Iterator[WorstMoment]:
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
        yield WorstMoment(
            quantity=quantity,
            value=value - ZERO,
            unit="degC",
            place=f"{branch.gearbox}.{place}",
            steady=_steady_temperature(solved, quantity),
            limit=None if limit is None else limit - ZERO,
            planned=planned,
            time_s=float(branch.times[at]),
            branch=branch.name,
            phase=branch.phases[branch.phase[at]].name,
        )


def _steady_temperature(solved: SolvedRig, quantity: str) -> float:
    if quantity == "housing_temperature":
        return max(row.bodies["housing"]["max_degC"] for row in solved.thermal)
    return max(
        entry["mean_degC"]
        for row in solved.thermal
        for body, entry in row.bodies.items()
        if body.startswith("gear_")
    )


def _settling(solved: SolvedRig, branch: Branch) -> Iterator[Settling]:
    """Field, housing, bearings, seals and backlash: when each stays near its end value in every dwell."""
    share = solved.case.transient.settled_share
    bodies = [body for body in ("field", "housing") if body in branch.temperatures]
    for number, phase in enumerate(branch.phases):
        if not phase.held:
            continue
        inside = np.flatnonzero(branch.phase == number)
        at = np.arange(inside[0] - 1, inside[-1] + 1) if inside[0] else inside
        courses: dict[str, tuple[FloatArray, str]] = {
            body: (branch.temperatures[body][at] - ZERO, "degC") for body in bodies
        }
        for quantity in SETTLING:
            least = [MM * smallest(branch.clearances[i], quantity)[0] for i in at]
            courses[quantity] = (np.array(least), "mm")
        for name, (values, unit) in courses.items():
            yield _settled(branch, phase.name, name, branch.times[at], values, unit, share)


def _settled(
    branch: Branch, stage: str, quantity: str, times: FloatArray, values: FloatArray, unit: str, share: float
) -> Settling:
    end = float(values[-1])
    band = share * float(np.abs(values - end).max())
    found = settling_time(times, values, end, band) if band > 0.0 else float(times[0])
    return Settling(
        gearbox=branch.gearbox,
        stage=stage,
        quantity=quantity,
        settled_after_s=None if found is None else found - float(times[0]),
        start=float(values[0]),
        end=end,
        unit=unit,
    )


def _cold_oil(solved: SolvedRig) -> Iterator[Finding]:
    """What is too thick to be pumped when the rig is as cold as the room."""
    yield from (Finding(id="oil", text=text) for text in cold_oil(solved.rig))


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
    """What the thermal course leaves out."""
    return (
        "over time: losses and films are those of the coupled steady run, interpolated over speed and torque; "
        "thicker oil and tighter bearings of a rig still cold are not fed back into them",
        "over time: every oil is fed at its inlet temperature from the first moment on, whatever heaters and cooler "
        "must give or take for it; the heat content of tanks and pipes is left out",
        "over time: at standstill gears stand still; jets do not reach them, still air and the shafts warm them",
        "over time: oil has no mass, a bearing without feed keeps its film, tooth friction without oil is that "
        "with oil",
    )
