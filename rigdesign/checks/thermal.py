"""Checks of temperatures, clearances, bearings, oil and room."""

import math
from collections.abc import Iterable, Iterator

from rigdesign.checks.subject import NO_HOUSING, NO_LIMIT, Subject, worst
from rigdesign.results import Check
from rigdesign.rules import Rule, hold, not_applicable

ZERO = 273.15
MM, UM = 1e3, 1e6


def checks(subject: Subject) -> list[Check]:
    """All of them in the order of the report."""
    return [
        *_temperatures(subject),
        *_clearances(subject),
        *_bearings(subject),
        *_oil(subject),
    ]


def _held(
    subject: Subject, rule: Rule, values: Iterable[tuple[float, str]], resting: tuple[str, ...]
) -> Check:
    """Hold the governing one of some values, or say why there is none."""
    if rule.limit is None:
        return not_applicable(rule, NO_LIMIT)
    listed = list(values)
    if not listed:
        return not_applicable(rule, NO_HOUSING)
    value, where = worst(listed, smallest=rule.comparison == ">=")
    return hold(rule, value, where, resting)


def _degrees(limit: float | None) -> float | None:
    return None if limit is None else limit - ZERO


def _scaled(limit: float | None, scale: float) -> float | None:
    return None if limit is None else scale * limit


def _temperatures(subject: Subject) -> Iterator[Check]:
    limits = subject.case.limits.temperatures
    housed = [row.gearbox for row in subject.thermal]
    resting = subject.assumed(
        *(f"gearboxes.{name}.{part}" for name in housed for part in ("housing", "heat_split", "oil")),
        "losses",
    )
    yield _held(
        subject,
        Rule(
            id="temperature.housing", title="hottest place of the housing", unit="degC",
            source="limits.temperatures.housing_maximum", group="temperatures",
            limit=_degrees(limits.housing_maximum),
        ),
        ((row.bodies["housing"]["max_degC"], f"{row.gearbox}, stage {row.stage}") for row in subject.thermal),
        resting,
    )  # fmt: skip
    yield _held(
        subject,
        Rule(
            id="temperature.bearing_film", title="hottest bearing film", unit="degC",
            source="limits.temperatures.bearing_film_maximum; ISO 7902-1 heat balance", group="temperatures",
            limit=_degrees(limits.bearing_film_maximum),
        ),
        (
            (state.film_temperature - ZERO, f"{name}, stage {point.point.stage}")
            for point in subject.points
            for name, state in point.last.bearings.items()
        ),
        subject.assumed(*(f"gearboxes.{name}.bearings" for name in subject.case.gearboxes)),
    )  # fmt: skip
    yield _held(
        subject,
        Rule(
            id="temperature.oil_outlet", title="hottest oil outlet", unit="degC",
            source="limits.temperatures.oil_outlet_maximum", group="temperatures",
            limit=_degrees(limits.oil_outlet_maximum),
        ),
        (
            (stream.outlet - ZERO, f"{stream.name}, stage {point.point.stage}")
            for point in subject.points
            for stream in point.last.streams
        ),
        resting,
    )  # fmt: skip
    yield _tempering(subject, resting)


def _tempering(subject: Subject, resting: tuple[str, ...]) -> Check:
    limit = subject.case.limits.temperatures.tempering_distance_minimum
    rule = Rule(
        id="temperature.gear_bulk", title="gear bulk temperature below tempering temperature", unit="K",
        source="limits.temperatures.tempering_distance_minimum", group="temperatures", limit=limit,
        comparison=">=",
    )  # fmt: skip
    values = []
    for point in subject.points:
        for name, temperature in point.last.feedback.gear_temperature.items():
            box, gear = name.split(".")
            material = subject.rig.materials[subject.case.gearboxes[box].gears[gear].material]
            if material.tempering_temperature is not None:
                distance = material.tempering_temperature - temperature
                values.append(
                    (distance, f"{name} at {temperature - ZERO:.1f} degC, stage {point.point.stage}")
                )
    return _held(subject, rule, values, resting)


def _clearances(subject: Subject) -> Iterator[Check]:
    limits = subject.case.limits.clearances
    resting = subject.assumed(*(f"gearboxes.{row.gearbox}.housing" for row in subject.growth))
    lists: tuple[tuple[str, str, float | None, float, str, list[tuple[float, str]]], ...] = (
        (
            "seal_gap", "smallest hot radial gap of a seal", limits.seal_gap_minimum, MM, "mm",
            [
                (s["hot_min_mm"], f"{s['seal']} at {s['angle_of_min_deg']:.0f} deg")
                for r in subject.growth
                for s in r.seal_gaps
            ],
        ),
        (
            "axial_play", "smallest hot axial play of a shaft", limits.axial_play_minimum, MM, "mm",
            [(s["axial_play_hot_mm"], s["shaft"]) for r in subject.growth for s in r.shafts],
        ),
        (
            "backlash", "smallest hot backlash", limits.backlash_minimum, MM, "mm",
            [(g["backlash_hot_mm"], g["gear_pair"]) for r in subject.growth for g in r.gears],
        ),
        (
            "tip_clearance", "smallest hot tip clearance", limits.tip_clearance_minimum, MM, "mm",
            [(g["tip_clearance_hot_mm"], g["gear_pair"]) for r in subject.growth for g in r.gears],
        ),
        (
            "bearing_clearance", "smallest hot diametral bearing clearance", limits.bearing_clearance_minimum, UM, "um",
            [
                (UM * clearance, f"{name}, stage {p.point.stage}")
                for p in subject.points
                for name, clearance in p.last.feedback.bearing_clearance.items()
            ],
        ),
    )  # fmt: skip
    for key, title, limit, scale, unit, values in lists:
        rule = Rule(
            id=f"clearance.{key}", title=title, unit=unit, source=f"limits.clearances.{key}_minimum",
            group="clearances", limit=_scaled(limit, scale), comparison=">=",
        )  # fmt: skip
        yield _held(subject, rule, values, resting)
    yield from _seal_travel(subject, resting)


def _seal_travel(subject: Subject, resting: tuple[str, ...]) -> Iterator[Check]:
    """Axial movement of the shaft in its seals against what they take."""
    for row in subject.growth:
        for name, seals in subject.case.gearboxes[row.gearbox].seals.items():
            rule = Rule(
                id=f"clearance.seal_travel.{row.gearbox}.{name}",
                title=f"axial movement of the {name} shaft in its seals ({row.gearbox})", unit="mm",
                source=f"gearboxes.{row.gearbox}.seals.{name}.axial_travel", group="clearances",
                limit=MM * seals.axial_travel,
            )  # fmt: skip
            values = [
                (abs(seal["axial_shift_mm"]), seal["seal"])
                for seal in row.seal_gaps
                if seal["seal"].startswith(seals.shaft)
            ]
            yield _held(subject, rule, values, resting)


def _bearings(subject: Subject) -> Iterator[Check]:
    limits = subject.case.limits.bearing
    resting = subject.assumed(
        *(f"gearboxes.{name}.bearings" for name in subject.case.gearboxes), "limits.bearing"
    )
    states = [
        (f"{name}, stage {point.point.stage}", state)
        for point in subject.points
        for name, state in point.last.bearings.items()
    ]
    yield _held(
        subject,
        Rule(
            id="bearing.minimum_film", title="smallest film of a journal bearing", unit="um",
            source="limits.bearing.film_thickness_minimum; film after ISO 7902-1", group="bearings",
            limit=_scaled(limits.film_thickness_minimum, UM), comparison=">=",
        ),
        ((UM * state.minimum_film, where) for where, state in states),
        resting,
    )  # fmt: skip
    yield _held(
        subject,
        Rule(
            id="bearing.specific_load", title="largest specific load of a journal bearing", unit="MPa",
            source="limits.bearing.specific_load_maximum", group="bearings",
            limit=_scaled(limits.specific_load_maximum, 1e-6),
        ),
        ((1e-6 * state.specific_load, where) for where, state in states),
        resting,
    )  # fmt: skip


def _oil(subject: Subject) -> Iterator[Check]:
    limits = subject.case.limits.oil
    streams = [
        f"gearboxes.{name}.{part}" for name in subject.case.gearboxes for part in ("oil", "bearing_oil")
    ]
    resting = subject.assumed("losses", *streams)
    rows = (
        ("flow", "oil flow of the rig", "l/min", "flow_maximum", 6e4, 1.0, "flow_l_min"),
        ("cooler", "power the cooler carries", "kW", "cooler_power_maximum", 1e-3, 1e-3, "cooler_W"),
        ("room", "heat to the room", "kW", "room_heat_maximum", 1e-3, 1e-3, "room_W"),
    )
    for key, title, unit, name, limit_scale, scale, entry in rows:
        limit = _scaled(getattr(limits, name), limit_scale)
        rule = Rule(
            id=f"oil.{key}", title=title, unit=unit, source=f"limits.oil.{name}", group="oil", limit=limit
        )  # fmt: skip
        value = scale * subject.cooler[entry]
        yield (
            hold(rule, value, f"stage {subject.test.point.stage}", resting)
            if limit is not None
            else not_applicable(rule, NO_LIMIT)
        )


def transition_speed_rpm(subject: Subject, load_share: float) -> tuple[float, str]:
    """Highest Vogelpohl transition speed of all bearings [rpm] at a share of the test load, and where."""
    return worst(
        (load_share * state.transition_speed * 30.0 / math.pi, name)
        for name, state in subject.test.last.bearings.items()
    )
