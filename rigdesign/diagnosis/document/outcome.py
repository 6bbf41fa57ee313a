"""A diagnosis as it is reported: effects with their sizes, suspects, what may be patched and what is refused."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from functools import cached_property
from typing import Any

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.stats import chi2

from rigdesign.base.errors import CaseError, RigdesignError, UsageError
from rigdesign.diagnosis.catalogue.effects import Effect
from rigdesign.diagnosis.catalogue.not_modelled import WAITING
from rigdesign.diagnosis.decision.naming import (
    Names,
    Sized,
    display_scale,
    formatted,
    from_evidence,
    from_fit,
)
from rigdesign.diagnosis.decision.patch import Fitted, patched_title, patched_values
from rigdesign.diagnosis.decision.proposals import NextMeasurements, RequiredCause, required_causes
from rigdesign.diagnosis.residual.sensors import SensorError, index_pulse_offset
from rigdesign.diagnosis.run import Result
from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.evidence import JOIN, Evidence
from rigdesign.diagnosis.statistics.heldout import Gap, gap_in_words
from rigdesign.measurement import MeasuredChannel, MeasurementSet
from rigdesign.measurement.comparison.locate import Bands, Located, locate
from rigdesign.measurement.reading.columns import direction_text

# What a diagnosis corrects in the measurement: exchanged channels, units, and sensors that read off.
#
# What measurement.toml has a key for becomes a JSON Patch on it; the rest is a correction in words and numbers, to be
# made in the table or at the rig. No file of the user is written to.

MISREAD_UNITS = {
    ("degC", "fahrenheit"): "degF",
    ("degC", "kelvin as celsius"): "K",
    ("W", "kilowatt"): "kW",
    ("N m", "kilonewton metre"): "kN m",
    ("Nm", "kilonewton metre"): "kN m",
    ("N m", "newton millimetre"): "N mm",
    ("Nm", "newton millimetre"): "N mm",
}
"""Unit as stated and what was found -> unit to state."""


@dataclass(frozen=True, kw_only=True)
class Correction:
    """One thing to put right in the data.

    operations : JSON Patch on measurement.toml, empty where no key says it; size : of a sensor that reads off
    """

    name: str
    text: str
    operations: tuple[dict[str, Any], ...] = ()
    size: Sized | None = None


def of_sensor(sized: Sized) -> Correction:
    """Of a sensor or setting that reads off."""
    assert isinstance(sized.entry, SensorError)
    value = sized.shown[0]
    channel = sized.name.partition(":")[2] or sized.name
    text = f"{sized.entry.title}: {formatted(value)}; "
    if sized.name == "angle_zero":
        text += _turned(f"{value.value:.4g} rad")
        return Correction(name=sized.name, text=text, size=sized)
    if sized.name.startswith("torque_lag"):
        corner = 1.0 / (2.0 * math.pi * value.value)
        text += (
            f'state transfer = {{ kind = "low_pass", frequency = "{corner:.4g} Hz" }} for {channel}, or have cell and '
            "amplifier tested for their bandwidth"
        )
        return Correction(name=sized.name, text=text, size=sized)
    if sized.entry.kind == "input":
        text += "the rig ran at another value than was read; correct the column of this setting"
    elif sized.name.startswith("sensor_scale"):
        text += f"divide the readings of {channel} by 1 + {value.value:.4g}, of a thermocouple its excess over ambient"
    else:
        text += f"subtract {value.value:.4g} {value.unit} from every reading of {channel}"
    return Correction(name=sized.name, text=f"{text}, or have the sensor calibrated", size=sized)


def of_data(name: str, measurement: MeasurementSet) -> Correction:
    """Of data that are wrong as they stand, by the name of the explanation."""
    kind, _, rest = name.partition(":")
    first, _, second = rest.partition(",")
    if kind == "swapped_channels":
        here, there = measurement.channels[first], measurement.channels[second]
        return Correction(
            name=name,
            text=f"exchange the places of channels {first} and {second}, and look at the wiring",
            operations=(*_placed(here, there), *_placed(there, here)),
        )
    if kind == "swapped_points":
        return Correction(
            name=name,
            text=f"exchange the readings of operating points {first} and {second} in the table, settings kept, once "
            "the log of the test says so",
        )
    if angle := index_pulse_offset(name):
        return Correction(name=name, text=_turned(angle))
    channel, _, misread = rest.partition(" (")
    misread = misread.removesuffix(")")
    entry = measurement.channels.get(channel)
    unit = None if entry is None else MISREAD_UNITS.get((entry.unit, misread))
    if unit is not None:
        return Correction(
            name=name,
            text=f"state {unit} as the unit of {channel}, in the units row of the table too",
            operations=({"op": "replace", "path": f"/channels/{_token(channel)}/unit", "value": unit},),
        )
    return Correction(
        name=name,
        text=f"the readings of {channel} look as if of another unit or sign ({misread}); convert its column",
    )


def _turned(angle: str) -> str:
    return f"add {angle} to the angle of the reference gear (zero under data.tach of recordings)"


def _placed(channel: MeasuredChannel, other: MeasuredChannel) -> list[dict[str, Any]]:
    """Put a channel where another one is."""
    path = f"/channels/{_token(channel.name)}"
    operations: list[dict[str, Any]] = [{"op": "add", "path": f"{path}/place", "value": other.channel.place}]
    if other.channel.at is not None:
        place = [f"{value:.10g} m" for value in other.channel.at]
        operations.append({"op": "add", "path": f"{path}/at", "value": place})
    elif channel.channel.at is not None:
        operations.append({"op": "remove", "path": f"{path}/at"})
    if other.channel.direction is not None:
        spelled = direction_text(other.channel.direction)
        operations.append({"op": "add", "path": f"{path}/direction", "value": spelled})
    if other.channel.position is not None:
        position = f"{other.channel.position:.10g} m"
        operations.append({"op": "add", "path": f"{path}/position", "value": position})
    elif channel.channel.position is not None:
        operations.append({"op": "remove", "path": f"{path}/position"})
    return operations


def _token(name: str) -> str:
    return name.replace("~", "~0").replace("/", "~1")


SHOWN = 3
"""Explanations that are reported where nothing is named."""


@dataclass(frozen=True, kw_only=True)
class Suspect:
    """An effect that may be present but is not named.

    inclusion : posterior mass of what it stands for, of all suspects one at most; size : at its own best fit, None for
        what has none
    """

    name: str
    title: str
    inclusion: float
    size: Sized | None


@dataclass(frozen=True, kw_only=True)
class CasePatch:
    """What is changed in the case: title of the variant, path -> marked value."""

    title: str
    values: Mapping[str, Mapping[str, Any]]


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """Everything the document, the page and the terminal say.

    named : of verdict ``named``, and what stands apart from an alias group; suspected : of verdict ``suspected``
    suspects : the suspected effect, members of an alias group, suspected data, or the leading explanations
    picked : what the user chose among those not named; case_patch : None where refused, with the reason in ``refused``
    offered : the patch of a suspected effect, to be tried and not applied
    answer : (n,) what named, suspected or picked effects add to the kept numbers
    gap : with them on the points held out; full_run : whether the model was run in full there
    before, after : where the residual sits without and with them
    """

    result: Result
    names: Names
    named: tuple[Sized, ...]
    suspected: Sized | None
    suspects: tuple[Suspect, ...]
    picked: Sized | None
    case_patch: CasePatch | None
    refused: str
    offered: CasePatch | None
    answer: Array
    gap: Gap | None
    full_run: bool
    corrections: tuple[Correction, ...]
    before: tuple[Located, ...]
    after: tuple[Located, ...]
    ahead: NextMeasurements

    @property
    def verdict(self) -> str:
        """Of the decision."""
        return self.result.diagnosis.decision.verdict

    @cached_property
    def in_question(self) -> tuple[str, Array]:
        """What is drawn beside the readings: effects in the model, or the leading suspect alone, and what it adds."""
        if self.in_model:
            return " and ".join(self.in_model), self.answer
        sized = [suspect.size for suspect in self.suspects if suspect.size is not None]
        if not sized or self.verdict in ("within_noise", "input_error_suspected"):
            return "", self.answer
        first = sized[0]
        return first.explanation, self.result.diagnosis.proof.stored({first.explanation: first.coordinates})

    @property
    def applied(self) -> tuple[Sized, ...]:
        """What a patch holds: the named effects, or the one the user picked with those apart from its group."""
        return _applied(self.verdict, self.named, self.picked)

    @property
    def in_model(self) -> tuple[str, ...]:
        """Explanations in ``answer`` and ``gap``; a group from which others stand apart is there by its leader."""
        if self.picked is None and self.suspected is not None:
            return (self.suspected.explanation,)
        if self.picked is None:
            return tuple(explanation.hypothesis.name for explanation in self.result.diagnosis.found)
        return tuple(sized.explanation for sized in self.applied)


def _applied(verdict: str, named: tuple[Sized, ...], picked: Sized | None) -> tuple[Sized, ...]:
    if picked is None:
        return named
    others = tuple(sized for sized in named if sized.name != picked.name) if verdict == "alias_group" else ()
    return (*others, picked)


def outcome(result: Result, *, pick: str | None = None) -> Outcome:
    """Put a diagnosis into words and patches.

    pick : name of an effect that the user decides for although, or of those that, the data name

    Raises
    ------
    UsageError
        An effect picked that these data do not evaluate, or that is not among the named ones.
    """
    diagnosis = result.diagnosis
    names = Names(result.effects, result.problem.residuals.errors)
    fit = diagnosis.fit if pick is None else diagnosis.fits.get(pick, diagnosis.fit)
    fitted = () if fit is None else from_fit(names, fit.sizes)
    group = diagnosis.decision.verdict == "alias_group"
    named = tuple(sized for sized in fitted if not group or sized.name in diagnosis.decision.apart)
    picked = None if pick is None else _picked(result, names, fitted, pick)
    applied = _applied(diagnosis.decision.verdict, named, picked)
    suspicion = diagnosis.suspicion
    suspected = None if suspicion is None else from_fit(names, suspicion.fit.sizes)[0]
    answer, gap = (
        (diagnosis.answer, diagnosis.gap) if suspicion is None else (suspicion.answer, suspicion.gap)
    )
    full_run = suspicion is None and diagnosis.proof.rerun is not None and not diagnosis.unconfirmed
    offered = None
    if suspected is not None and picked is None:
        offered, _ = _case_patch(result, [suspected], None)
    if group and picked is None:
        patch, refused = None, _why_not(result, False)
    else:
        patch, refused = _case_patch(result, applied, picked)
    if patch is not None and diagnosis.unconfirmed:
        patch, refused = None, diagnosis.unconfirmed
    if picked is not None:
        answer, gap, full_run, failure = _put_to_the_proof(result, applied)
        if patch is not None and failure:
            patch, refused = None, failure
    corrections = [of_sensor(sized) for sized in applied if not isinstance(sized.entry, Effect)]
    if diagnosis.decision.verdict == "input_error_suspected":
        corrections += [of_data(name, result.measurement) for name in diagnosis.decision.named]
    return Outcome(
        result=result,
        names=names,
        named=named,
        suspected=suspected,
        suspects=() if named and not group else _suspects(result, names),
        picked=picked,
        case_patch=patch,
        refused=refused,
        offered=offered,
        answer=answer,
        gap=gap,
        full_run=full_run,
        corrections=tuple(corrections),
        before=located(result, diagnosis.residual),
        after=located(result, diagnosis.residual - answer),
        ahead=result.next_measurements,
    )


def check_pick(effects: Sequence[Effect], pick: str) -> None:
    """Refuse a name that is in no catalogue before anything is computed; sensors are known with the data only.

    Raises
    ------
    UsageError
        With the nearest names.
    """
    known = dict.fromkeys(name for effect in effects for name in (effect.claim, effect.name))
    sensors = ("sensor_", "torque_zero:", "torque_lag:", "flow_", "inlet_", "speed_", "torque_")
    if pick in known or pick in ("ambient", "angle_zero") or pick.startswith(sensors):
        return
    if any(effect.any_tooth and pick.rpartition("/")[0] == effect.name for effect in effects):
        return
    raise UsageError(f"--name {pick}: no such effect for this case; {_nearest(pick, list(known))}")


def _nearest(pick: str, known: Sequence[str]) -> str:
    near = get_close_matches(pick, known, n=3, cutoff=0.4)
    return f"did you mean {' or '.join(near)}?" if near else f"known are {', '.join(known)}"


def _suspects(result: Result, names: Names) -> tuple[Suspect, ...]:
    """Members of the group the verdict gives, or the leading explanations; of these the posteriors exclude each other.

    An explanation that holds several members of a group counts in equal parts for each.
    """
    diagnosis = result.diagnosis
    weights, evidence = diagnosis.deciding.weights, diagnosis.deciding.evidence
    wanted: list[tuple[str, ...]] = [(name,) for name in diagnosis.decision.named]
    masses = dict.fromkeys(wanted, 0.0)
    if wanted:
        for explanation in evidence:
            members = [part for part in wanted if part[0] in explanation.hypothesis.parts]
            masses |= {
                part: masses[part] + weights.masses[explanation.hypothesis.name] / len(members)
                for part in members
            }
    else:
        few = diagnosis.decision.verdict == "data_insufficient"
        for explanation in evidence:
            parts = tuple(sorted(explanation.hypothesis.parts))
            if not few or explanation.hypothesis.family not in ("pair", "input"):
                masses[parts] = masses.get(parts, 0.0) + weights.masses[explanation.hypothesis.name]
        wanted = sorted(masses, key=lambda parts: -masses[parts])[:SHOWN]
    suspects = []
    for parts in wanted:
        best = _best(result, names, parts[0]) if len(parts) == 1 else None
        size = None if best is None else from_evidence(names, best, result.calibration.signature_error)
        leads = max(
            (explanation for explanation in evidence if tuple(sorted(explanation.hypothesis.parts)) == parts),
            key=lambda explanation: weights.masses[explanation.hypothesis.name],
            default=None,
        )
        title = names.title(parts[0]) if leads is None else names.title_of(leads)
        suspects.append(
            Suspect(
                name=JOIN.join(parts),
                title=title if size is None else size.title,
                inclusion=masses[parts],
                size=size,
            )
        )
    return tuple(suspects)


def _best(result: Result, names: Names, name: str) -> Evidence | None:
    """The best explanation by this effect alone, of those with an entry."""
    first = result.diagnosis.evaluations[0]
    for explanation in (*first.evidence, *first.contradicted):
        alone = explanation.hypothesis.parts == (name,) or explanation.hypothesis.name == name
        if alone and names.entry(explanation.hypothesis.name) is not None:
            return explanation
    return None


def _picked(result: Result, names: Names, fitted: Sequence[Sized], pick: str) -> Sized:
    picked = next((sized for sized in fitted if pick in (sized.name, sized.explanation)), None)
    if picked is not None:
        return picked
    if result.diagnosis.decision.verdict == "named":
        named = ", ".join(sized.name for sized in fitted)
        raise UsageError(f"--name {pick}: the data name {named}; leave --name out or pick of them")
    best = _best(result, names, pick)
    if best is None:
        evaluated = [
            explanation.hypothesis.name
            for explanation in result.diagnosis.evaluations[0].evidence
            if names.entry(explanation.hypothesis.name) is not None
        ]
        raise UsageError(
            f"--name {pick}: these sensors and points do not see it; {_nearest(pick, evaluated)}"
        )
    return from_evidence(names, best, result.calibration.signature_error)


def _put_to_the_proof(result: Result, applied: Sequence[Sized]) -> tuple[Array, Gap | None, bool, str]:
    """What picked effects add, the gap with them on the points held out, whether the model ran in full there, and why
    they are not patched or nothing."""
    proof = result.diagnosis.proof
    sizes = {sized.explanation: sized.coordinates for sized in applied}
    together = " and ".join(sizes)
    if not proof.points:
        return proof.stored(sizes), None, False, ""
    try:
        answer = proof.again(sizes)
    except RigdesignError as error:
        answer = proof.stored(sizes)
        return answer, proof.gap(answer), False, f"the case with {together} does not run in full: {error}"
    gap = proof.gap(answer)
    failure = f"with {together} in the model the gap {gap_in_words(gap)}" if gap.grown else ""
    return answer, gap, proof.rerun is not None, failure


def _case_patch(
    result: Result, applied: Sequence[Sized], picked: Sized | None
) -> tuple[CasePatch | None, str]:
    """The patch, or why there is none."""
    fitted = [
        Fitted(
            effect=sized.entry, values=sized.values, ends=sized.ends, tooth=sized.tooth,
            reason=_evidence_text(result, sized, sized is picked),
        )
        for sized in applied
        if isinstance(sized.entry, Effect)
    ]  # fmt: skip
    if not fitted:
        return None, _why_not(result, bool(applied))
    try:
        values = patched_values(result.case, fitted)
    except CaseError as error:
        return None, f"the case does not admit the fitted value: {error}"
    return CasePatch(title=patched_title(result.case, fitted), values=values), ""


def _why_not(result: Result, sensors: bool) -> str:
    if sensors:
        return "only sensors or settings are off; the case stays as it is"
    match result.diagnosis.decision.verdict:
        case "suspected":
            return "the effect is suspected, not proven; try the case in suspected/, or pick the effect with --name"
        case "alias_group":
            return (
                "the data do not separate the members of the group; choose one with --name, or make a measurement "
                "that separates them"
            )
        case "unknown_located":
            return "an effect is present, the data do not identify it; pick one with --name, or measure more"
        case "input_error_suspected":
            return "the data look wrong, not the model; correct them first"
        case "data_insufficient":
            return "these data cannot name anything"
        case "too_small":
            return (
                "what may be present is too small to be distinguished from competing causes; pick one with --name, "
                "or measure more"
            )
    return "nothing is missing that these data could show"


def _evidence_text(result: Result, sized: Sized, picked: bool) -> str:
    sizes = ", ".join(formatted(value) for value in sized.shown)
    strength = f"named, {result.diagnosis.strength}"
    if picked:
        strength = "picked by the user among explanations the data do not tell apart"
    elif result.diagnosis.decision.verdict == "suspected":
        strength = "suspected, not proven"
    origin = f"fitted to measurement '{result.measurement.title}' ({result.measurement.hash[:16]})"
    return f"{origin}: {sized.title}, {sizes}, 95 %; {strength}"


# Where a residual sits: groups of numbers held against the residual of a healthy rig in them.


def located(result: Result, residual: Array) -> tuple[Located, ...]:
    """Groups of the numbers that were kept, the most conspicuous first.

    residual : (n_kept,). A group is evaluated by its own block of the covariance of a healthy rig, so that numbers
    that go up and down together count once: ``rms`` is 1 in the mean of healthy rigs, ``excess`` the probability that
    the residual of a healthy rig is as large.
    """
    diagnosis = result.diagnosis
    features = [result.problem.residuals.features[row] for row in diagnosis.kept]
    bands = Bands(result.measurement)
    matrix = diagnosis.covariance.matrix
    items = locate(
        features, residual, np.sqrt(np.diagonal(matrix)), [bands.of(feature) for feature in features],
        result.data.settings, result.case.ambient.temperature,
    )  # fmt: skip
    evaluated = [_weighed(item, residual, matrix) for item in items]
    return tuple(sorted(evaluated, key=lambda item: -item.rms))


def _weighed(item: Located, residual: Array, matrix: Array) -> Located:
    square = _square(residual, matrix, item.features)
    return replace(
        item,
        rms=float(np.sqrt(square / len(item.features))),
        excess=float(chi2.sf(square, len(item.features))),
    )


def _square(residual: Array, matrix: Array, rows: Sequence[int]) -> float:
    places = np.array(rows, dtype=np.intp)
    block = cho_factor(matrix[np.ix_(places, places)], lower=True)
    return float(residual[places] @ cho_solve(block, residual[places]))


# With too few data to name anything: a table of the size that each cause would need to explain the residual.

FAR = 20.0
"""Size over its bound beyond which no number is given: the answer was continued too far."""
MOST_FACTOR = 100.0
"""Factor up or down beyond which no number is given."""
WITHIN = "within the bound"
BEYOND = "beyond the bound"
NOT_IT = "does not explain it"
UNMOVED = "does not move these numbers"
NOT_COMPUTED = "not computed"
NOT_MODELLED = "not modelled"
ORDER = (WITHIN, BEYOND, NOT_IT, UNMOVED, NOT_COMPUTED, NOT_MODELLED)
"""Verdicts of the rows, in their order."""


@dataclass(frozen=True, kw_only=True)
class RequiredRow:
    """A cause with the size that it needs.

    size : in words, with unit; empty where it does not answer or needs too much; share : that it takes away of the
    square of the residual; verdict : one of `ORDER`; reach : size over the bound
    """

    effect: str
    title: str
    size: str
    parameters: tuple[Mapping[str, Any], ...]
    share: float | None
    bounds: str
    verdict: str
    why: str = ""
    reach: float = 0.0


def required_rows(outcome: Outcome) -> tuple[RequiredRow, ...]:
    """Of verdict ``data_insufficient``: every effect and every error of sensors and settings, the least needed first.

    Effects that no channel of the set can show are left out; of a tooth that may be any the first one is meant.
    """
    if outcome.verdict != "data_insufficient":
        return ()
    residuals = outcome.result.problem.residuals.rows(outcome.result.diagnosis.kept)
    rows = [_row(outcome.names, cause) for cause in required_causes(residuals)]
    ordered = sorted(rows, key=lambda row: (ORDER.index(row.verdict), row.reach))
    return (*ordered, *_not_modelled(outcome))


def _row(names: Names, cause: RequiredCause) -> RequiredRow:
    title, bounds, size = names.title(cause.explanation), _bounds(cause.entry), cause.size
    if size is None:
        verdict = UNMOVED if cause.computed else NOT_COMPUTED
        why = "" if cause.computed else "no channel of the set shows it, or the model refuses it"
        return RequiredRow(
            effect=cause.explanation, title=title, size="", parameters=(), share=None, bounds=bounds,
            verdict=verdict, why=why,
        )  # fmt: skip
    verdict = (WITHIN if cause.within else BEYOND) if cause.explains else NOT_IT
    if size.reach > FAR:
        return RequiredRow(
            effect=cause.explanation, title=title, size="", parameters=(), share=size.share, bounds=bounds,
            verdict=verdict, why=f"more than {FAR:g} times its bound", reach=size.reach,
        )  # fmt: skip
    shown = names.sized(cause.explanation, size.coordinates, [(end, end) for end in size.coordinates]).shown
    first = shown[0]
    scale, unit = display_scale(first.unit, first.factor)
    number = f"x {first.value:.3g}" if first.factor else f"{scale * first.value:.3g} {unit}".rstrip()
    far = first.factor and not 1.0 / MOST_FACTOR <= first.value <= MOST_FACTOR
    return RequiredRow(
        effect=cause.explanation,
        title=title,
        size="" if far else f"{first.name} {number}",
        parameters=() if far else tuple(
            {"name": value.name, "value": value.value, "unit": value.unit, "factor": value.factor} for value in shown
        ),
        share=size.share,
        bounds=bounds,
        verdict=verdict,
        why=_why(cause, far),
        reach=size.reach,
    )  # fmt: skip


def _why(cause: RequiredCause, far: bool) -> str:
    """What to know of a size."""
    assert cause.size is not None
    if far:
        return f"a factor beyond {MOST_FACTOR:g}"
    if cause.reversed:
        return "the other way round than it can be"
    return "continued beyond the runs of the model" if cause.size.extrapolated else ""


def _bounds(entry: Effect | SensorError) -> str:
    """Bounds of the first parameter, as its size is shown."""
    if isinstance(entry, SensorError):
        scale, unit = display_scale(entry.unit if entry.unit != "SI" else "", False)
        return f"+-{scale * entry.bound:.3g} {unit}, {entry.times:g} times its uncertainty"
    parameter = entry.parameters[0]
    scale, unit = display_scale(parameter.unit, parameter.factor)
    return f"{scale * parameter.low:.3g} to {scale * parameter.high:.3g} {unit}".rstrip()


def _not_modelled(outcome: Outcome) -> Iterator[RequiredRow]:
    """What engineers know of and no entry holds."""
    known = {effect.kind for effect in outcome.result.effects}
    for cause in WAITING:
        if cause.name not in known:
            yield RequiredRow(
                effect=cause.name, title=cause.title, size="", parameters=(), share=None, bounds="",
                verdict=NOT_MODELLED, why=cause.lacks,
            )  # fmt: skip


def required_document(outcome: Outcome) -> list[dict[str, Any]]:
    """The rows as plain values."""
    return [
        {
            "effect": row.effect, "title": row.title, "size": row.size or None, "parameters": list(row.parameters),
            "explains": row.share, "bounds": row.bounds or None, "verdict": row.verdict, "why": row.why or None,
        }
        for row in required_rows(outcome)
    ]  # fmt: skip
