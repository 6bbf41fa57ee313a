"""The inputs that would turn failing checks, the worst first: each moved alone until the check stands at its limit.

Root stress, root safety and flanks are solved again at the temperatures of the run: they follow torque and face width
directly, and warm teeth hardly matter; against scuffing and for the film teeth that get colder with less torque would
help, so that what is found is on the safe side. Temperatures, clearances and bearing films are solved again through the
coupling loop.
Teeth of another width take the influence numbers of the stated ones over, as slices far from the ends have them.
Checks that need the time run or the response over speed are not looked at, and named.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fnmatch import fnmatchcase
from functools import partial

from rigdesign.base.errors import CaseError, NotConvergedError
from rigdesign.base.parallel import BackgroundTasks
from rigdesign.base.units import number_match
from rigdesign.case.loader import changed_together
from rigdesign.case.model import Case
from rigdesign.checks.registry import REGISTRY
from rigdesign.checks.rules import REFERENCE_TEMPERATURE
from rigdesign.coupling.iteration import PointProblem, solve_loads
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.time_run import held_points
from rigdesign.postprocessing.dynamics import DynamicRun
from rigdesign.postprocessing.solved_rig import SolvedRig
from rigdesign.results.check import Check
from rigdesign.results.result import Flip, FlipSearch, RunResult
from rigdesign.rig.model import Rig, build_rig
from rigdesign.rig.reuse import same_housings, with_housings_of
from rigdesign.run.solver_errors import solver_errors
from rigdesign.studies.modified_rig import coupled_again, with_records

STRESSED = ("specimen.root_stress*", "strength.root_safety*")
"""Checks that follow torque and face width in proportion, about."""
BY_LOADS = (*STRESSED, "flank.*")
"""Checks that follow the loads at given temperatures."""
BY_HEAT = (
    "temperature.*",
    "clearance.*",
    "bearing.minimum_film",
    "oil.cooler",
    "oil.heater",
    "oil.room",
    "oil.room_temperature",
    "alignment.*",
)
"""Checks that follow the temperatures."""
PROBE = 1.1
"""Factor of the first move; a temperature moves by its excess over `BASE`."""
BASE = {"degC": 20.0, "°C": 20.0, "K": 293.15, "degF": 68.0}
"""Temperature from which an inlet temperature counts, in the unit it is stated in."""
LEAST_EXCESS = 0.05
"""Share of a temperature by which it has to differ from `BASE` to be moved by a factor."""
FARTHEST = 5.0
"""Factor by which an input may move either way."""
CLOSE = 0.01
"""Distance of the share of the limit from 1 at which the value is found; the search aims at half of it beyond 1."""
STEPS = 5
SHOWN = 3
"""Checks looked at, and rows kept beside that of the limit."""


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

    def case_at(self, case: Case, factor: float) -> Case:
        """The case with the input moved; raises CaseError for a value it does not take."""
        return changed_together(case, dict.fromkeys(self.paths, self.written(self.moved(factor))))

    def written(self, value: float) -> str:
        """As the case writes it."""
        return f"{value:g} {self.unit}"

    def first_move(self, target: Check, used: float) -> float:
        """Logarithm of the factor tried first for a check that uses a share of its limit: stresses grow with the torque
        and fall with the width, all others are probed."""
        if not target.is_one_of(STRESSED):
            return math.log(PROBE)
        move = math.log(used) if self.paths[0].endswith(".face_width") else -math.log(used)
        return math.copysign(min(max(abs(move), CLOSE), math.log(FARTHEST)), move)


SIDE_STEPS = 3
"""Steps of 1 % by which a value found on the wrong side of the limit is moved over it."""

Solve = Callable[[Case], "Mapping[str, Check]"]
"""The checks of a changed case, by id."""


def with_flips(solved: SolvedRig, result: RunResult) -> RunResult:
    """The result with the inputs that would turn its failing checks, each alone, and with what was looked at.

    Without a failing check the one nearest to its limit is looked at.
    """
    failing = [check for check in sorted(result.checks, key=_order) if check.status == "fail"]
    wanted = failing or [check for check in sorted(result.checks, key=_order) if _predicted(check)][:1]
    by_loads = [check for check in wanted if check.is_one_of(BY_LOADS)][:SHOWN]
    # each of heat solves the coupling loop again
    by_heat = [check for check in wanted if check.is_one_of(BY_HEAT)][:1]
    targets = [check for check in wanted if check in (*by_loads, *by_heat)]
    others = tuple(check.id for check in wanted if check not in targets)
    if not targets:
        return replace(result, flip_search=FlipSearch(not_searched=others))
    rows, inputs = list[tuple[float, Flip]](), dict[str, None]()
    held = [check for check in result.checks if _holds(check)]
    for group, heat in ((by_loads, False), (by_heat, True)):
        solve = partial(_checks, solved, through_heat=heat)
        search = Search(group, held, solve, final=len(group) == len(wanted))
        candidates = list(_candidates(solved, group, heat)) if group else []
        works = [partial(_flips, solved.case, candidate, search) for candidate in candidates]
        if heat:  # runs compiled threads, which a copy of this process has not
            rows += [row for work in works for row in work()]
        else:
            with BackgroundTasks(works) as tasks:
                rows += [row for found in tasks.results() for row in found]
        inputs |= dict.fromkeys(candidate.title for candidate in candidates)
    nearest = [flip for _, flip in sorted(rows, key=lambda row: (not row[1].turns, row[0]))]
    of_each = [next((flip for flip in nearest if flip.check == target.id), None) for target in targets]
    leading = [flip for flip in of_each if flip is not None]
    rest = [flip for flip in nearest if flip not in leading]
    flips = [*[*leading, *rest][:SHOWN], _limit(targets[0], final=len(wanted) == 1)]
    looked_at = FlipSearch(
        inputs=tuple(inputs), checks=tuple(target.id for target in targets), not_searched=others
    )
    return replace(result, flips=sorted(flips, key=lambda flip: not flip.turns), flip_search=looked_at)


def _order(check: Check) -> float:
    return math.inf if check.distance is None else check.distance


def _predicted(check: Check) -> bool:
    return check.distance is not None and not check.by_definition


@dataclass(frozen=True)
class Search:
    """What an input has to turn: the checks looked at, those that hold at the stated values, and how to solve them.

    Each changed case is solved once. final : no check fails but those looked at.
    """

    targets: Sequence[Check]
    held: Sequence[Check]
    solve: Solve
    final: bool
    _solved: dict[str, Mapping[str, Check] | None] = field(default_factory=dict, compare=False, repr=False)

    def used(self, case: Case, target: Check) -> float | None:
        """Share of its limit that one of the checks uses; None where it or the case has no result."""
        checks = self.checks(case)
        return None if checks is None or target.id not in checks else _used(checks[target.id])

    def checks(self, case: Case) -> Mapping[str, Check] | None:
        """Checks of a changed case; None where it has no result."""
        if case.hash not in self._solved:
            try:
                self._solved[case.hash] = self.solve(case)
            except (CaseError, NotConvergedError):
                self._solved[case.hash] = None
        return self._solved[case.hash]

    def broken(self, case: Case) -> list[Check]:
        """Checks that hold at the stated values and break in this case, which has a result."""
        checks = self.checks(case) or {}
        return [checks[held.id] for held in self.held if held.id in checks and not _holds(checks[held.id])]


def _holds(check: Check) -> bool:
    return check.margin is not None and check.margin >= 0.0


def _used(check: Check) -> float | None:
    """Share of the limit used, 1 at the limit and in proportion to the load: of a safety limit over value."""
    if check.value is None or check.limit is None:
        return None
    datum = REFERENCE_TEMPERATURE if check.unit == "degC" else 0.0
    upper = check.limit if check.comparison == "<=" else check.upper_limit
    shares = [] if upper is None or upper <= datum else [(check.value - datum) / (upper - datum)]
    if check.comparison != "<=" and check.limit > 0.0:
        shares.append(check.limit / check.value if check.value > 0.0 else math.inf)
    return max(shares, default=None)


def _candidates(solved: SolvedRig, targets: Sequence[Check], heat: bool) -> Iterator[Candidate]:
    """Inputs of the design that may move the checks; gears of one box with the same width move together."""
    written = solved.case.origin.value_of
    for title, paths, in_heat in _inputs(solved.case, targets, heat):
        by_text: dict[str, list[str]] = {}
        for path in paths:
            by_text.setdefault(written.get(path, ""), []).append(path)
        for text, together in by_text.items():
            found = number_match(text)
            if found is None:
                continue
            value, unit = float(found[1]), found[2]
            own = [path.split(".")[3] for path in together if path.endswith(".face_width")]
            offset = BASE.get(unit, 0.0) if in_heat else 0.0
            if abs(value - offset) > LEAST_EXCESS * abs(value):
                yield Candidate(tuple(together), f"{title}{' and '.join(own)}", value, unit, offset)


def _inputs(case: Case, targets: Sequence[Check], heat: bool) -> Iterator[tuple[str, list[str], bool]]:
    """Title and paths of the inputs by what the checks follow, and whether they are temperatures."""
    yield "test torque", ["schedule.test_torque"], False
    if any(target.id == "oil.room_temperature" for target in targets):
        yield "air flow of the room", ["rig_heat.room.air_flow"], False
    for name, box in case.gearboxes.items():
        own = f"gearboxes.{name}"
        if heat and box.housing is not None:
            yield f"oil inlet temperature of {name}", [f"{own}.oil.inlet_temperature"], True
            yield f"bearing oil inlet temperature of {name}", [f"{own}.bearing_oil.inlet_temperature"], True
            yield f"oil flow of {name}", [f"{own}.oil.flow"], False
        if any(target.is_one_of(BY_LOADS) and f".{name}." in target.id for target in targets):
            yield f"face width of {name} ", [f"{own}.gears.{gear}.face_width" for gear in box.gears], False


def _flips(case: Case, candidate: Candidate, search: Search) -> list[tuple[float, Flip]]:
    """For every check that the input turns: how far it has to move (a logarithm), and the row."""
    rows = []
    for target in search.targets:
        factor = _factor(case, candidate, search, target)
        if factor is not None:
            rows.append((abs(math.log(factor)), _flip(candidate, search, target, case, factor)))
    return rows


def _flip(candidate: Candidate, search: Search, target: Check, case: Case, factor: float) -> Flip:
    moved = candidate.case_at(case, factor)
    broken = [] if _holds(target) else search.broken(moved)
    checks = search.checks(moved) or {}
    still = [other for other in search.targets if other.id in checks and not _holds(checks[other.id])]
    then = f"; then {broken[0].title} breaks its limit" if broken else ""
    return Flip(
        path=candidate.paths[0] if len(candidate.paths) == 1 else _shared(candidate.paths),
        title=candidate.title,
        stated=candidate.written(candidate.stated),
        needed=candidate.written(candidate.moved(factor)),
        check=target.id,
        holds=_holds(target),
        turns=_holds(target) or (search.final and not broken and not still),
        effect=f"{target.title} {_turn(target)}{then}",
    )


def _factor(case: Case, candidate: Candidate, search: Search, target: Check) -> float | None:
    """Factor of the input that brings the check to its limit, just beyond; by secants on the logarithms."""
    stated = _used(target)
    if not stated or stated == 1.0 or math.isinf(stated):
        return None
    goal = math.copysign(0.5 * CLOSE, 1.0 - stated)

    def at(logarithm: float) -> float | None:
        try:
            used = search.used(candidate.case_at(case, math.exp(logarithm)), target)
        except CaseError:
            return None
        return math.log(used) if used and math.isfinite(used) else None

    before, y_before = 0.0, math.log(stated)
    here = candidate.first_move(target, math.exp(y_before - goal))
    for _ in range(STEPS):
        y_here = at(here)
        if y_here is not None and abs(y_here) < CLOSE:
            return _beyond(here, at, held=stated <= 1.0)
        if y_here is None or abs(y_here - y_before) < 1e-3 * abs(here - before):
            return None
        slope = (y_here - y_before) / (here - before)
        before, here, y_before = here, here + (goal - y_here) / slope, y_here
        if abs(here) > math.log(FARTHEST):
            return None
    return None


def _beyond(logarithm: float, at: Callable[[float], float | None], *, held: bool) -> float | None:
    """Factor near this one at which a broken check holds, or a held one breaks."""
    for step in range(SIDE_STEPS + 1):
        moved = logarithm + math.copysign(CLOSE * step, logarithm)
        found = at(moved)
        if found is not None and (found > 0.0) == held:
            return math.exp(moved)
    return None


def _checks(stated: SolvedRig, case: Case, *, through_heat: bool) -> dict[str, Check]:
    """The checks of a changed case that follow what is solved again, by id."""
    patterns = (*BY_LOADS, *BY_HEAT) if through_heat else BY_LOADS
    with solver_errors(case):
        rig = build_rig(case, stated.rig.fidelity)
        rig = replace(
            rig, tooth_influence=stated.rig.tooth_influence.for_widths_near(stated.rig.pairs.values())
        )
        if not through_heat or same_housings(rig, stated.rig):
            rig = with_housings_of(rig, stated.rig)
        point = coupled_again if through_heat else _at_stated_temperatures
        points = [point(rig, stated, number) for number in range(len(stated.points))]
        run = None
        if stated.run is not None:
            run = DynamicRun(tuple(points), stated.run.curves, stated.run.ramp)
        solved = with_records(rig, points, run)
        topics = [
            topic for topic in REGISTRY.topics() if any(_follows(f.key, patterns) for f in topic.families)
        ]
        found = [check for topic in topics for check in topic.checks(solved)]
    return {check.id: check for check in found if check.is_one_of(patterns)}


def _follows(key: str, patterns: Sequence[str]) -> bool:
    """Whether checks of a family fit a pattern: its key or an id under it."""
    return any(fnmatchcase(key, pattern) or fnmatchcase(f"{key}.", pattern) for pattern in patterns)


def _at_stated_temperatures(rig: Rig, stated: SolvedRig, number: int) -> PointResult:
    """A held point of the changed rig: its loads at the temperatures of the stated one."""
    point, near = held_points(rig)[number], stated.points[number]
    problem = PointProblem.braced(rig, point)
    loads = solve_loads(problem, near.last.coupling_state)
    return replace(near, point=point, last=replace(near.last, **vars(loads)), setting=problem.bracing)


def _limit(target: Check, *, final: bool) -> Flip:
    """The limit of a check, moved just past its value; ``final``: no other check fails."""
    assert target.value is not None and target.margin is not None
    upper = target.comparison == "<="
    limit = target.limit
    if target.upper_limit is not None and target.margin == target.upper_limit - target.value:
        limit, upper = target.upper_limit, True
    unit = "" if target.unit in ("1", "-") else target.unit
    needed = _rounded(target.value, up=upper != _holds(target))
    return Flip(
        path="", title="limit of the check", stated=f"{limit:.4g} {unit}".strip(), needed=f"{needed:g} {unit}".strip(),
        check=target.id, holds=_holds(target), turns=final or _holds(target),
        effect=f"{target.title} {_turn(target)}",
    )  # fmt: skip


def _rounded(value: float, *, up: bool) -> float:
    """To four digits, not to the other side."""
    if value == 0.0:
        return 0.0
    unit = 10.0 ** (math.floor(math.log10(abs(value))) - 3)
    return (math.ceil if up else math.floor)(value / unit) * unit


def _turn(target: Check) -> str:
    return "breaks its limit" if _holds(target) else "holds"


def _shared(paths: Sequence[str]) -> str:
    """The paths as one, ``*`` where they differ."""
    columns = zip(*(path.split(".") for path in paths), strict=True)
    return ".".join(names[0] if len(set(names)) == 1 else "*" for names in columns)
