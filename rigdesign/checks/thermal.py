"""Checks of temperatures, clearances, bearings, oil and room."""

import math
from collections.abc import Iterable, Iterator

from dynamics.journal_bearing import BearingState
from rigdesign.checks.subject import NO_HOUSING, NO_LIMIT, Subject, worst
from rigdesign.results import Check
from rigdesign.rules import Rule, hold, not_applicable

ZERO = 273.15
MM, UM = 1e3, 1e6


Values = Iterable[tuple[float, str]]
GROUPS = {"temperature": "temperatures", "clearance": "clearances", "bearing": "bearings", "oil": "oil"}
"""First part of the id of a check -> its group in the report."""


def checks(subject: Subject) -> list[Check]:
    """All of them in the order of the report."""
    return [
        *_temperatures(subject),
        *_clearances(subject),
        *_bearings(subject),
        *_oil(subject),
    ]


def _held(
    id: str,  # noqa: A002 - the name in the contract of the results
    title: str,
    unit: str,
    limit: float | None,
    values: Values,
    resting: tuple[str, ...],
    *,
    source: str,
    at_least: bool = False,
) -> Check:
    """Hold the governing one of some values (value, where), or say why there is none; all in ``unit``."""
    rule = Rule(
        id=id, title=title, unit=unit, source=source, group=GROUPS[id.partition(".")[0]], limit=limit,
        comparison=">=" if at_least else "<=",
    )  # fmt: skip
    if limit is None:
        return not_applicable(rule, NO_LIMIT)
    listed = list(values)
    if not listed:
        return not_applicable(rule, NO_HOUSING)
    value, where = worst(listed, smallest=at_least)
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
        "temperature.housing", "hottest place of the housing", "degC", _degrees(limits.housing_maximum),
        ((row.bodies["housing"]["max_degC"], f"{row.gearbox}, stage {row.stage}") for row in subject.thermal),
        resting, source="limits.temperatures.housing_maximum",
    )  # fmt: skip
    yield _held(
        "temperature.bearing_film", "hottest bearing film", "degC", _degrees(limits.bearing_film_maximum),
        ((state.film_temperature - ZERO, where) for where, state in _films(subject)),
        subject.assumed(*(f"gearboxes.{name}.bearings" for name in subject.case.gearboxes)),
        source="limits.temperatures.bearing_film_maximum; ISO 7902-1 heat balance",
    )  # fmt: skip
    yield _held(
        "temperature.oil_outlet", "hottest oil outlet", "degC", _degrees(limits.oil_outlet_maximum),
        (
            (stream.outlet - ZERO, f"{stream.name}, stage {point.point.stage}")
            for point in subject.points
            for stream in point.last.streams
        ),
        resting, source="limits.temperatures.oil_outlet_maximum",
    )  # fmt: skip
    yield _held(
        "temperature.gear_bulk", "gear bulk temperature below tempering temperature", "K",
        limits.tempering_distance_minimum, _tempering_distances(subject), resting,
        source="limits.temperatures.tempering_distance_minimum", at_least=True,
    )  # fmt: skip


def _tempering_distances(subject: Subject) -> Iterator[tuple[float, str]]:
    """Tempering temperature less bulk temperature of every gear whose material has one [K]."""
    for point in subject.points:
        for name, temperature in point.last.feedback.gear_temperature.items():
            box, gear = name.split(".")
            material = subject.rig.materials[subject.case.gearboxes[box].gears[gear].material]
            if material.tempering_temperature is not None:
                where = f"{name} at {temperature - ZERO:.1f} degC, stage {point.point.stage}"
                yield material.tempering_temperature - temperature, where


def _films(subject: Subject) -> list[tuple[str, BearingState]]:
    """(place and stage, state) of every journal bearing at every held stage."""
    return [
        (f"{name}, stage {point.point.stage}", state)
        for point in subject.points
        for name, state in point.last.bearings.items()
    ]


def _clearances(subject: Subject) -> Iterator[Check]:
    limits = subject.case.limits.clearances
    resting = subject.assumed(*(f"gearboxes.{row.gearbox}.housing" for row in subject.growth))
    gears = [gear for row in subject.growth for gear in row.gears]
    seals = [seal for row in subject.growth for seal in row.seal_gaps]
    shafts = [shaft for row in subject.growth for shaft in row.shafts]
    bearings = [
        (UM * clearance, f"{name}, stage {point.point.stage}")
        for point in subject.points
        for name, clearance in point.last.feedback.bearing_clearance.items()
    ]
    rows: tuple[tuple[str, str, float | None, float, str, Values], ...] = (
        (
            "seal_gap", "smallest hot radial gap of a seal", limits.seal_gap_minimum, MM, "mm",
            ((s["hot_min_mm"], f"{s['seal']} at {s['angle_of_min_deg']:.0f} deg") for s in seals),
        ),
        (
            "axial_play", "smallest hot axial play of a shaft", limits.axial_play_minimum, MM, "mm",
            ((shaft["axial_play_hot_mm"], shaft["shaft"]) for shaft in shafts),
        ),
        (
            "backlash", "smallest hot backlash", limits.backlash_minimum, MM, "mm",
            ((gear["backlash_hot_mm"], gear["gear_pair"]) for gear in gears),
        ),
        (
            "tip_clearance", "smallest hot tip clearance", limits.tip_clearance_minimum, MM, "mm",
            ((gear["tip_clearance_hot_mm"], gear["gear_pair"]) for gear in gears),
        ),
        (
            "bearing_clearance", "smallest hot diametral bearing clearance", limits.bearing_clearance_minimum,
            UM, "um", bearings,
        ),
    )  # fmt: skip
    for key, title, limit, scale, unit, values in rows:
        yield _held(
            f"clearance.{key}", title, unit, _scaled(limit, scale), values, resting,
            source=f"limits.clearances.{key}_minimum", at_least=True,
        )  # fmt: skip
    yield from _seal_travel(subject, resting)


def _seal_travel(subject: Subject, resting: tuple[str, ...]) -> Iterator[Check]:
    """Axial movement of the shaft in its seals against what they take."""
    for row in subject.growth:
        for name, seals in subject.case.gearboxes[row.gearbox].seals.items():
            values = (
                (abs(seal["axial_shift_mm"]), seal["seal"])
                for seal in row.seal_gaps
                if seal["seal"].startswith(seals.shaft)
            )
            yield _held(
                f"clearance.seal_travel.{row.gearbox}.{name}",
                f"axial movement of the {name} shaft in its seals ({row.gearbox})", "mm",
                MM * seals.axial_travel, values, resting,
                source=f"gearboxes.{row.gearbox}.seals.{name}.axial_travel",
            )  # fmt: skip


def _bearings(subject: Subject) -> Iterator[Check]:
    limits = subject.case.limits.bearing
    resting = subject.assumed(
        *(f"gearboxes.{name}.bearings" for name in subject.case.gearboxes), "limits.bearing"
    )
    yield _held(
        "bearing.minimum_film", "smallest film of a journal bearing", "um",
        _scaled(limits.film_thickness_minimum, UM),
        ((UM * state.minimum_film, where) for where, state in _films(subject)), resting,
        source="limits.bearing.film_thickness_minimum; film after ISO 7902-1", at_least=True,
    )  # fmt: skip
    yield _held(
        "bearing.specific_load", "largest specific load of a journal bearing", "MPa",
        _scaled(limits.specific_load_maximum, 1e-6),
        ((1e-6 * state.specific_load, where) for where, state in _films(subject)), resting,
        source="limits.bearing.specific_load_maximum",
    )  # fmt: skip


def _oil(subject: Subject) -> Iterator[Check]:
    limits = subject.case.limits.oil
    streams = [
        f"gearboxes.{name}.{part}" for name in subject.case.gearboxes for part in ("oil", "bearing_oil")
    ]
    resting = subject.assumed("losses", *streams)
    rows = (
        ("flow", "oil flow of the rig", "l/min", "flow_maximum", 6e4, "flow_l_min", 1.0),
        ("cooler", "power the cooler carries", "kW", "cooler_power_maximum", 1e-3, "cooler_W", 1e-3),
        ("heater", "power the heaters of the warm circuits give", "kW", "heater_power_maximum", 1e-3, "heater_W", 1e-3),
        ("room", "heat to the room", "kW", "room_heat_maximum", 1e-3, "room_W", 1e-3),
    )  # fmt: skip
    for key, title, unit, name, limit_scale, entry, scale in rows:
        values = ((scale * float(row[entry]), f"stage {row['stage']}") for row in subject.cooler)
        yield _held(
            f"oil.{key}", title, unit, _scaled(getattr(limits, name), limit_scale), values, resting,
            source=f"limits.oil.{name}",
        )  # fmt: skip


def transition_speed_rpm(subject: Subject, torque: float) -> tuple[float, str]:
    """Highest Vogelpohl transition speed [rpm] of all bearings under the load of a stated torque [N m], and where.

    Taken from the films of each loaded held stage; the speed grows with the load.
    """
    return worst(
        (
            torque / abs(point.point.torque) * state.transition_speed * 30.0 / math.pi,
            f"{name} at the viscosity of stage {point.point.stage}",
        )
        for point in subject.points
        if point.point.torque
        for name, state in point.last.bearings.items()
    )
