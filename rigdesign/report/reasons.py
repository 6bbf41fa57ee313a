"""Why a run ends as it does, in two sentences made from its records, and what would decide it."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

from rigdesign.base.units import number_match
from rigdesign.report.numbers import (
    counted,
    limit_text,
    margin_unit,
    number_text,
    percent_text,
    quantity_text,
    stated_text,
    value_text,
)
from rigdesign.report.views import applicable, sorted_checks
from rigdesign.results.check import Check
from rigdesign.results.dynamics import GearboxDynamics
from rigdesign.results.ranges import CheckRange, RangedInput, RangeMargin, RangesResult
from rigdesign.results.result import Flip, RunResult
from rigdesign.results.teeth import FROM_INFLUENCE

AGREEMENT = 1.15
"""Ratio of two root stresses up to which the methods agree."""
MOST_NAMED = 3
"""Failing checks that are named beside the worst."""
CARRIES = 0.01
"""Share of the highest root stress above which a tooth counts as loaded."""


@dataclass(frozen=True, kw_only=True)
class Why:
    """The first page of a report in words.

    sentences : at most two; decided_by : what would tell which way it goes, empty where nothing is open
    root_stress : which root stress governs, with both figures; empty where the sentences say so or none is held
    """

    sentences: tuple[str, ...]
    decided_by: str = ""
    root_stress: str = ""


def why(result: RunResult) -> Why:
    """What decides the verdict of a run."""
    checks = sorted_checks(applicable(result.checks))
    if not checks:
        return Why(
            sentences=("No check applies: the case states no limit that this run could be held against.",)
        )
    failing = [check for check in checks if check.status == "fail"]
    if failing:
        methods = _two_methods(result.checks, failing[0])
        if methods:
            return _methods_differ(result, failing, *methods)
        return replace(_limit_missed(failing), root_stress=governing_stress(result))
    held = _undecided(checks) if checks[0].status == "open" else _all_hold(checks)
    return replace(held, root_stress=governing_stress(result))


def governing_stress(result: RunResult) -> str:
    """Which root stress governs and why: of the gear nearest to its limit, specimens first; empty if none."""
    pairs = [pair for check in applicable(result.checks) if (pair := _two_methods(result.checks, check))]
    if not pairs:
        return ""
    iso, path = max(pairs, key=lambda pair: (pair[1].role == "specimen", -(pair[1].distance or 0.0)))
    subject = _capital(iso.title.partition(",")[0])
    if _from_field(result, path):
        return (
            f"{subject}: the computed field governs with {value_text(path)}, from influence numbers under the dynamic "
            f"force of every tooth{_application(result, path)}; ISO 6336-3 method B has {value_text(iso)} as a hand "
            "check."
        )
    return (
        f"{subject}: {value_text(iso)} by ISO 6336-3 method B and {value_text(path)} by its factors under the dynamic "
        f"force of every tooth{_application(result, path)}; both count, as no stress field is computed here."
    )


def _application(result: RunResult, path: Check) -> str:
    """K_A of the mesh of a root stress check, in words; empty where it is 1."""
    mesh = _mesh(result, path.id.split(".", 2)[2].rpartition(".")[0])
    factor = 1.0 if mesh is None else float(mesh.iso_factors.get("K_A", 1.0))
    return "" if factor == 1.0 else f" times K_A {number_text(factor, 3)}"


def _from_field(result: RunResult, path: Check) -> bool:
    """Whether the stress over the path of a check is that of influence numbers."""
    label, _, gear = path.id.split(".", 2)[2].rpartition(".")
    mesh = _mesh(result, label)
    return mesh is not None and any(
        history.gear == gear and history.source == FROM_INFLUENCE for history in mesh.root_stress
    )


def _two_methods(checks: Sequence[Check], failing: Check) -> tuple[Check, Check] | None:
    """The root stress or safety of one gear by ISO 6336-3 and over the path of contact, if ``failing`` is of them."""
    family, dot, place = failing.id.partition(".")[2].partition(".")
    if not dot or family.rpartition("_")[0] not in ("root_stress", "root_safety"):
        return None
    ends = {
        method: failing.id.replace(f".{family}.", f".{family.rpartition('_')[0]}_{method}.")
        for method in METHODS
    }
    found = {check.id: check for check in checks if check.value}
    iso, path = (found.get(ends[method]) for method in METHODS)
    return None if iso is None or path is None or not place else (iso, path)


METHODS = ("iso", "path")
"""Ends of the families of root stress checks: ISO 6336-3 and over the path of contact."""


def _methods_differ(result: RunResult, failing: Sequence[Check], iso: Check, path: Check) -> Why:
    """Two values of one root: what each is, and what of the two models makes them differ."""
    assert iso.value is not None and path.value is not None
    subject = _capital(iso.title.partition(",")[0])
    by_field = _from_field(result, path)
    first = (
        f"{subject} is {value_text(path)} by the computed field, which governs ({path.verdict}), and {value_text(iso)} "
        f"by ISO 6336-3 as a hand check ({iso.verdict}), against {limit_text(iso)}{_others(failing, iso, path)}."
        if by_field
        else f"{subject} is {value_text(iso)} by ISO 6336-3 ({iso.verdict}) and {value_text(path)} over the path of "
        f"contact ({path.verdict}), against {limit_text(iso)}{_others(failing, iso, path)}."
    )
    stress = iso.id.startswith("specimen.")
    ratio = iso.value / path.value if stress else path.value / iso.value
    label, _, gear = iso.id.split(".", 2)[2].rpartition(".")
    measured = f"strain gauges in the root fillet of {label} {gear}"
    if 1.0 / AGREEMENT < ratio < AGREEMENT:
        return Why(sentences=(first, f"Both methods agree within {100.0 * abs(ratio - 1.0):.0f} %."))
    if ratio < 1.0:
        second = (
            f"The stress over the path is {number_text(1.0 / ratio, 2)} times that of ISO 6336-3: it follows the force "
            "of the single tooth, where the standard spreads the load by factors."
        )
    else:
        second = (
            f"The stress of ISO 6336-3 is {number_text(ratio, 2)} times the other: it is a nominal stress with the "
            "whole force on one tooth at the outer point of single contact"
            f"{_contact_ratio(result, label)}, times load factors; "
            f"over the path the deflected teeth meet early and share the force{_engagement(result, label, gear)}."
        )
    decided = (
        f"{_capital(measured)}."
        if by_field
        else f"A tooth contact analysis of the real pair by influence numbers, or {measured}."
    )
    return Why(sentences=(first, second), decided_by=decided)


def _others(failing: Sequence[Check], *named: Check) -> str:
    """The other failing checks, the worst by name."""
    others = [check for check in failing if check not in named]
    if not others:
        return ""
    listed = [
        f"{check.title} ({value_text(check)} against {limit_text(check)})" for check in others[:MOST_NAMED]
    ]
    listed += [f"{len(others) - MOST_NAMED} more"] if len(others) > MOST_NAMED else []
    return f"; {'fails' if len(others) == 1 else 'fail'} as well: {', '.join(listed)}"


def _mesh(result: RunResult, label: str) -> GearboxDynamics | None:
    return None if result.dynamics is None else result.dynamics.gearboxes.get(label)


def _contact_ratio(result: RunResult, label: str) -> str:
    """Of the rigid flanks, in brackets."""
    mesh = _mesh(result, label)
    ratio = None if mesh is None else mesh.geometry.get("transverse_contact_ratio")
    return f" (contact ratio {number_text(float(ratio), 3)})" if isinstance(ratio, int | float) else ""


def _engagement(result: RunResult, label: str, gear: str) -> str:
    """Over how many pitches a tooth carries load in the run."""
    pitches = loaded_pitches(_mesh(result, label), gear)
    return "" if pitches is None else f" over {number_text(pitches, 2)} pitches"


def loaded_pitches(mesh: GearboxDynamics | None, gear: str) -> float | None:
    """Angle over which the root of a tooth is stressed, quasi-static, over the angle of a pitch."""
    teeth = "" if mesh is None else str(mesh.geometry.get("teeth", ""))
    if mesh is None or " / " not in teeth:
        return None
    for history, number in zip(mesh.root_stress, teeth.split(" / "), strict=False):
        stress = history.quasi_static_MPa
        if history.gear != gear or not stress:
            continue
        loaded = [
            a for a, s in zip(history.rolling_angle_deg, stress, strict=True) if s > CARRIES * max(stress)
        ]
        return (loaded[-1] - loaded[0]) * int(number) / 360.0
    return None


LEAVES_OUT = "leaves out "
"""Where the reason of a check goes over to what its value does not count: no help to a limit that is missed."""


def _limit_missed(failing: Sequence[Check]) -> Why:
    """The governing check and how it came about."""
    worst = failing[0]
    missed = "" if worst.distance is None else f", missed by {percent_text(-worst.distance)}"
    values = f"{value_text(worst)} against {limit_text(worst)}{missed}"
    first = f"{_capital(worst.title)}: {values}{_others(failing, worst)}."
    reason = worst.reason.partition(LEAVES_OUT)[0].rstrip("; ")
    sentences = (first, f"{_capital(reason)}.") if reason else (first,)
    if worst.by_definition:
        return Why(sentences=sentences, decided_by="The case itself: it states value and limit.")
    if not worst.assumptions:
        return Why(sentences=sentences, decided_by="Another design, operating point or limit.")
    number = len(worst.assumptions)
    inputs = "the assumed input" if number == 1 else f"the {number} assumed inputs"
    text = f"Measured values in place of {inputs} it depends on, or another design, operating point or limit."
    return Why(sentences=sentences, decided_by=text)


def _undecided(checks: Sequence[Check]) -> Why:
    """Every limit that binds is kept, and some checks could not be judged."""
    undecided = [check for check in checks if check.verdict == "open"]
    reasons = Counter(text for check in undecided for text in check.left_out)
    near = [c for c in undecided if c.error is not None and c.margin is not None and abs(c.margin) < c.error]
    causes = {
        "leaving out a known contributor": sum(bool(check.left_out) for check in undecided),
        "not evaluated": sum(check.value is None for check in undecided),
        "nearer to the limit than the error of the value": len(near),
    }
    listed = ", ".join(f"{number} {cause}" for cause, number in causes.items() if number)
    words = f"No limit that binds is missed; {len(undecided)} of {len(checks)} checks are open"
    words += f": {listed}" if listed else ""
    often = reasons.most_common(1)
    decided = f"A model of what is left out most often: {often[0][0]}." if often else ""
    if not often and undecided[0].reason:
        decided = f"{_capital(undecided[0].title)}: {undecided[0].reason}."
    return Why(sentences=(f"{words}.", _nearest(checks)), decided_by=decided)


def _all_hold(checks: Sequence[Check]) -> Why:
    """Nothing is missed and nothing is open."""
    advisory = sum(check.status == "advisory" for check in checks)
    words = "All limits that bind hold" if advisory else f"All {len(checks)} checks that apply hold"
    words += f"; {counted(advisory, 'advisory limit')} missed" if advisory else ""
    return Why(sentences=(f"{words}.", _nearest(checks)))


def _nearest(checks: Sequence[Check]) -> str:
    """The check nearest to its limit, those of the case against itself left out."""
    real = [c for c in checks if not c.by_definition and c.distance is not None and c.distance >= 0.0]
    if not real:
        return "No check comes near its limit."
    first = min(real, key=lambda check: check.distance or 0.0)
    assert first.distance is not None
    return (
        f"Nearest to its limit is {first.title}: {value_text(first)} against {limit_text(first)}, "
        f"{percent_text(first.distance)} of it left."
    )


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]


# Which inputs would turn the verdict, by how much: from the ranges of a run, or as the run itself has found.

SHOWN = 4
"""Inputs on the first page."""


def flips(result: RunResult) -> list[Flip]:
    """The inputs nearest to turning the verdict: as the run found them, else from its ranges."""
    if result.flips or result.ranges is None:
        return result.flips[:SHOWN]
    return from_ranges(result.ranges)[:SHOWN]


def searched(result: RunResult) -> str:
    """What was moved to turn which checks, for how long, and what was not looked at; empty where nothing was asked."""
    search, titles = result.flip_search, {check.id: check.title for check in result.checks}
    if search is None:
        return ""
    said = []
    if search.checks:
        aim = "so that they hold" if any(c.status == "fail" for c in result.checks) else "until it fails"
        wanted = ", ".join(titles[name] for name in search.checks)
        turned = {flip.check for flip in result.flips if flip.path}
        outcome = "" if turned else "; none turns it within a factor of five"
        said.append(
            f"Looked at: {wanted}. Moved {aim}, each alone: {', '.join(search.inputs) or 'no input'}, in "
            f"{number_text(result.timings_s.get('flips', 0.0), 2)} s{outcome}."
        )
        if any(c.status == "fail" for c in result.checks) and not any(flip.turns for flip in result.flips):
            said.append("None of them alone turns the verdict.")
    if search.not_searched:
        listed = ", ".join(titles[name] for name in search.not_searched)
        said.append(f"Not looked at, as that would take the run again: {listed}.")
    return " ".join(said)


def within_ranges(result: RunResult) -> list[Flip]:
    """The assumed inputs that turn a check within their ranges, where the run evaluated them."""
    found = [] if result.ranges is None else from_ranges(result.ranges)
    return [flip for flip in found if flip.turns][:SHOWN]


def from_ranges(ranges: RangesResult) -> list[Flip]:
    """Failing checks first, each with the input that moves it furthest; then what would break a check that holds."""
    inputs = {row.path: row for row in ranges.inputs}
    failing = [row for row in ranges.checks if row.verdict_stated == "fail"]
    holding = [row for row in ranges.checks if row.verdict_stated != "fail" and row.decided_by]
    found = [flip for row in failing for flip in _of_check(ranges, row, inputs)[:1]]
    return found + [flip for row in holding for flip in _of_check(ranges, row, inputs)[:1] if flip.turns]


def _of_check(ranges: RangesResult, check: CheckRange, inputs: dict[str, RangedInput]) -> list[Flip]:
    """Every input that moves one check to the other side or nearest to it, the strongest first."""
    if check.margin is None:
        return []
    better = check.margin < 0.0
    rows = [row for row in ranges.margins if row.check == check.check and row.path in inputs]
    ends = [(end, row) for row in rows for end in ("low", "high") if _margin(row, end) is not None]
    ends.sort(key=lambda item: _margin(item[1], item[0]) or 0.0, reverse=better)
    return [_flip(check, inputs[row.path], row, end) for end, row in ends]


def _margin(row: RangeMargin, end: str) -> float | None:
    return row.margin_low if end == "low" else row.margin_high


def _flip(check: CheckRange, given: RangedInput, row: RangeMargin, end: str) -> Flip:
    """One end of one range: does the check change sides on the way there?"""
    at_end = _margin(row, end)
    assert at_end is not None and check.margin is not None
    limit = given.low if end == "low" else given.high
    turned = (at_end >= 0.0) != (check.margin >= 0.0)
    share = check.margin / (check.margin - at_end) if turned else 1.0
    needed = between(given.stated, limit, share) if turned else ""
    side = "holds" if check.margin < 0.0 else "fails"
    margin = quantity_text(at_end, margin_unit(check.unit))
    if turned:
        text = f"{side} from about {needed}" if needed else f"{side} at {stated_text(limit)}"
    else:
        text = f"still {'fails' if check.margin < 0.0 else 'holds'} at {stated_text(limit)}, margin {margin}"
    return Flip(
        path=given.path, title=given.path, holds=check.margin >= 0.0, stated=stated_text(given.stated), needed=needed,
        check=check.check, turns=turned, effect=text,
    )  # fmt: skip


def between(stated: str, end: str, share: float) -> str:
    """The value at ``share`` of the way between two of one unit; empty where they have no number or other units."""
    first, last = number_match(stated), number_match(end)
    if first is None or last is None or first[2] != last[2]:
        return ""
    value = float(first[1]) + share * (float(last[1]) - float(first[1]))
    return stated_text(f"{number_text(value, 3)} {first[2]}".strip())
