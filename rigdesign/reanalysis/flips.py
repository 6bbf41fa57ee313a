"""The inputs that would turn the verdict: each moved alone until the governing check stands at its limit.

Root stress and root safety are solved again at the temperatures of the run: they follow torque and face width
directly, and warm teeth hardly matter. Temperatures, clearances and films are solved again through the coupling loop.
Checks that need the time run or the response over speed are left out.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from functools import partial

from rigdesign.base.errors import RigdesignError
from rigdesign.base.parallel import BackgroundTasks
from rigdesign.case.loader import changed_together
from rigdesign.case.model import Case
from rigdesign.checks.registry import REGISTRY
from rigdesign.coupling.acceleration import Anderson
from rigdesign.coupling.iteration import PointProblem, solve_loads
from rigdesign.coupling.loop import PointResult, solve_point
from rigdesign.coupling.time_run import held_points
from rigdesign.reanalysis.modified_rig import with_records
from rigdesign.records.dynamics import DynamicRun, dynamic_loads
from rigdesign.records.solved_rig import SolvedRig
from rigdesign.results.check import Check
from rigdesign.results.flips import Flip
from rigdesign.results.result import RunResult
from rigdesign.rig.model import Rig, build_rig
from rigdesign.rig.reuse import HOUSINGS, same_housings, take_over
from rigdesign.run.solver_errors import solver_errors

BY_LOADS = ("specimen.root_stress*", "strength.root_safety*")
"""Checks that follow the loads at given temperatures."""
BY_HEAT = (
    "temperature.*",
    "clearance.*",
    "bearing.minimum_film",
    "oil.cooler",
    "oil.heater",
    "oil.room",
    "alignment.*",
)
"""Checks that follow the temperatures."""
PROBE = 1.1
"""Factor of the first move; a temperature moves by its excess over `BASE`."""
BASE = 20.0
"""Temperature from which an inlet temperature counts [degC]."""
FARTHEST = 5.0
"""Factor by which an input may move either way."""
CLOSE = 0.01
"""Distance of the utilisation from 1 at which the value is found."""
STEPS = 4
SHOWN = 3


@dataclass(frozen=True)
class Candidate:
    """An input that may turn a check: paths that move together, the text before and after its number."""

    paths: tuple[str, ...]
    title: str
    stated: float
    unit: str
    offset: float = 0.0

    def moved(self, factor: float) -> float:
        """Value whose excess over the offset is ``factor`` times the stated one, to four digits."""
        return float(f"{self.offset + factor * (self.stated - self.offset):.4g}")

    def written(self, value: float) -> str:
        """As the case writes it."""
        return f"{value:g} {self.unit}"


Solve = Callable[[Case], float]
"""Highest utilisation of the governing checks of a case."""


def with_flips(solved: SolvedRig, result: RunResult) -> RunResult:
    """The result with the inputs that would turn its verdict, the nearest first; as it was where none is known."""
    targets = governing(result.checks)
    if not targets:
        return result
    heat = any(_is(target, BY_HEAT) for target in targets)
    solve = partial(_utilisation, solved, targets, through_heat=heat)
    works = [
        partial(_flip, solved.case, candidate, targets, solve)
        for candidate in _candidates(solved, targets, heat)
    ]
    with BackgroundTasks(works) as tasks:
        found = [flip for flip in tasks.results() if flip is not None]
    flips = [flip for _, flip in sorted(found, key=lambda item: item[0])]
    edges = {(target.limit, target.upper_limit, target.unit) for target in targets}
    limits = [_limit(targets)] if len(edges) == 1 else []
    return replace(result, flips=[*flips[: SHOWN - len(limits)], *limits])


def governing(checks: Sequence[Check]) -> list[Check]:
    """All broken checks, the worst first; without one, the held one nearest to its limit of those looked at.

    Empty where a broken check is not looked at: no input could be shown to turn the verdict then.
    """
    used = sorted(
        (check for check in checks if check.utilisation is not None),
        key=lambda check: -(check.utilisation or 0.0),
    )
    broken = [check for check in used if check.verdict == "fail"]
    if broken:
        return broken if all(_is(check, (*BY_LOADS, *BY_HEAT)) for check in broken) else []
    return [check for check in used if _is(check, (*BY_LOADS, *BY_HEAT))][:1]


def _is(check: Check, patterns: Sequence[str]) -> bool:
    return any(fnmatchcase(check.id, pattern) for pattern in patterns)


def _candidates(solved: SolvedRig, targets: Sequence[Check], heat: bool) -> Iterator[Candidate]:
    """Inputs of the design that may move the checks; gears of one box with the same width move together."""
    written = {row.path: row.value for row in solved.case.inputs}
    for title, paths, offset in _inputs(solved.case, targets, heat):
        by_text: dict[str, list[str]] = {}
        for path in paths:
            by_text.setdefault(written.get(path, ""), []).append(path)
        for text, together in by_text.items():
            number, _, unit = text.partition(" ")
            own = [path.split(".")[3] for path in together if path.endswith(".face_width")]
            try:
                value = float(number)
            except ValueError:
                continue
            yield Candidate(tuple(together), f"{title}{' and '.join(own)}", value, unit, offset)


def _inputs(case: Case, targets: Sequence[Check], heat: bool) -> Iterator[tuple[str, list[str], float]]:
    """Title, paths and offset of the inputs by what the checks follow."""
    yield "test torque", ["schedule.test_torque"], 0.0
    for name, box in case.gearboxes.items():
        own = f"gearboxes.{name}"
        if heat and box.housing is not None:
            yield f"oil inlet temperature of {name}", [f"{own}.oil.inlet_temperature"], BASE
            yield f"bearing oil inlet temperature of {name}", [f"{own}.bearing_oil.inlet_temperature"], BASE
            yield f"oil flow of {name}", [f"{own}.oil.flow"], 0.0
        if any(_is(target, BY_LOADS) and f".{name}." in target.id for target in targets):
            yield f"face width of {name} ", [f"{own}.gears.{gear}.face_width" for gear in box.gears], 0.0


def _flip(
    case: Case, candidate: Candidate, targets: Sequence[Check], solve: Solve
) -> tuple[float, Flip] | None:
    """How far the input has to move (a logarithm) and its row; None where it does not turn the checks."""
    target = targets[0]
    assert target.utilisation is not None
    factor = _factor(case, candidate, target.utilisation, solve)
    if factor is None:
        return None
    value = candidate.written(candidate.moved(factor))
    stated = candidate.written(candidate.stated)
    holds = target.utilisation <= 1.0
    row = Flip(
        path=candidate.paths[0] if len(candidate.paths) == 1 else _shared(candidate.paths),
        title=candidate.title,
        stated=stated,
        needed=value,
        check=target.id,
        holds=holds,
        reachable=True,
        effect=f"{_what(targets)} {_turn(targets)}",
    )
    return abs(math.log(factor)), row


def _factor(case: Case, candidate: Candidate, stated: float, solve: Solve) -> float | None:
    """Factor of the input at which the utilisation is 1, by secants on the logarithms; None where none is found."""

    def at(logarithm: float) -> float | None:
        value = candidate.written(candidate.moved(math.exp(logarithm)))
        try:
            return math.log(solve(changed_together(case, dict.fromkeys(candidate.paths, value))))
        except (RigdesignError, ValueError):
            return None

    if stated <= 0.0:
        return None
    before, y_before = 0.0, math.log(stated)
    here, y_here = math.log(PROBE), at(math.log(PROBE))
    for _ in range(STEPS):
        if y_here is None or abs(y_here - y_before) < 1e-3 * abs(here - before):
            return None
        before, here, y_before = here, here - y_here * (here - before) / (y_here - y_before), y_here
        if abs(here) > math.log(FARTHEST):
            return None
        y_here = at(here)
        if y_here is not None and abs(y_here) < CLOSE:
            return math.exp(here)
    return None


def _utilisation(stated: SolvedRig, targets: Sequence[Check], case: Case, *, through_heat: bool) -> float:
    """Highest utilisation of the checks of a changed case."""
    with solver_errors(case):
        rig = build_rig(case, stated.rig.fidelity)
        if not through_heat or same_housings(rig, stated.rig):
            take_over(rig, stated.rig, HOUSINGS)
        points = [
            _point(rig, number, near, through_heat=through_heat) for number, near in enumerate(stated.points)
        ]
        run = None
        if stated.run is not None:
            run = DynamicRun(points=tuple(points), curves=stated.run.curves, ramp=stated.run.ramp)
        loads = None if run is None else dynamic_loads(rig, run, over_speed=False)
        solved = with_records(rig, points, run, loads)
        topics = {topic.order: topic for topic in (REGISTRY.topic_of(case, target) for target in targets)}
        wanted = {target.id for target in targets}
        found = [check for topic in topics.values() for check in topic.checks(solved) if check.id in wanted]
        return max(check.utilisation or 0.0 for check in found)


def _point(rig: Rig, number: int, near: PointResult, *, through_heat: bool) -> PointResult:
    """A held point of the changed rig, coupled again or at the temperatures of the stated one."""
    point, start = held_points(rig)[number], near.last.coupling_state
    if through_heat:
        same = all(name in near.last.fields for name in rig.models)
        return solve_point(
            rig, point, start=start, before=near.last if same else None, acceleration=Anderson(start)
        )
    problem = PointProblem.braced(rig, point)
    loads = solve_loads(problem, start)
    return replace(near, point=point, last=replace(near.last, **vars(loads)), setting=problem.bracing)


def _limit(targets: Sequence[Check]) -> Flip:
    """The limit that the checks share, at the value of the governing one."""
    target = targets[0]
    assert target.value is not None and target.utilisation is not None
    limit = target.limit
    if target.upper_limit is not None and target.margin == target.upper_limit - target.value:
        limit = target.upper_limit
    unit = "" if target.unit in ("1", "-") else target.unit
    stated, needed = f"{limit:.4g} {unit}".strip(), f"{target.value:.4g} {unit}".strip()
    holds = target.utilisation <= 1.0
    return Flip(
        path="", title="limit of the check", stated=stated, needed=needed, check=target.id, holds=holds, reachable=True,
        effect=f"{_what(targets)} {_turn(targets)}",
    )  # fmt: skip


def _what(targets: Sequence[Check]) -> str:
    more = len(targets) - 1
    return targets[0].title + (f" and {more} more" if more else "")


def _turn(targets: Sequence[Check]) -> str:
    if (targets[0].utilisation or 0.0) <= 1.0:
        return "breaks its limit"
    return "holds" if len(targets) == 1 else "hold"


def _shared(paths: Sequence[str]) -> str:
    """The paths as one, ``*`` where they differ."""
    columns = zip(*(path.split(".") for path in paths), strict=True)
    return ".".join(names[0] if len(set(names)) == 1 else "*" for names in columns)
