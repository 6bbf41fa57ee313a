"""Checks of temperatures, clearances, bearings, oil and room."""

import math
from collections.abc import Iterable, Iterator

from dynamics.bearing.protocol import BearingState
from rigdesign.checks.rules import Rule, hold, not_applicable
from rigdesign.coupling.loads import MeshModel
from rigdesign.records.solved_rig import NO_HOUSING, NO_LIMIT, SolvedRig, worst
from rigdesign.results.result import Check

ZERO = 273.15
MM, UM = 1e3, 1e6


Values = Iterable[tuple[float, str]]
GROUPS = {"temperature": "temperatures", "clearance": "clearances", "bearing": "bearings", "oil": "oil"}
"""First part of the id of a check -> its group in the report."""


def checks(solved: SolvedRig) -> list[Check]:
    """All of them in the order of the report."""
    return [
        *_temperatures(solved),
        *_clearances(solved),
        *_bearings(solved),
        *_oil(solved),
    ]


NO_PLAY = "no shaft states an axial play between stops at both of its bearings"
NO_SEAL = "no shaft has a seal without contact"


def _held(
    id: str,  # noqa: A002 - the name in the contract of the results
    title: str,
    unit: str,
    limit: float | None,
    values: Values,
    *,
    source: str,
    at_least: bool = False,
    absent: str = NO_HOUSING,
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
        return not_applicable(rule, absent)
    value, where = worst(listed, smallest=at_least)
    return hold(rule, value, where)


def _degrees(limit: float | None) -> float | None:
    return None if limit is None else limit - ZERO


def _scaled(limit: float | None, scale: float) -> float | None:
    return None if limit is None else scale * limit


def _temperatures(solved: SolvedRig) -> Iterator[Check]:
    limits = solved.case.limits.temperatures
    films = ((state.film_temperature - ZERO, where) for where, state in _films(solved))
    outlets = (
        (stream.outlet - ZERO, f"{stream.name}, stage {point.point.stage}")
        for point in solved.points
        for stream in point.last.streams
    )
    housings = (
        (row.bodies["housing"]["max_degC"], f"{row.gearbox}, stage {row.stage}") for row in solved.thermal
    )
    for key, title, limit, values, basis in (
        ("housing", "hottest place of the housing", limits.housing_maximum, housings, ""),
        (
            "bearing_film",
            "hottest bearing film",
            limits.bearing_film_maximum,
            films,
            "; ISO 7902-1 heat balance",
        ),
        ("oil_outlet", "hottest oil outlet", limits.oil_outlet_maximum, outlets, ""),
    ):
        yield _held(
            f"temperature.{key}", title, "degC", _degrees(limit), values,
            source=f"limits.temperatures.{key}_maximum{basis}",
        )  # fmt: skip
    yield _held(
        "temperature.gear_bulk", "gear bulk temperature below tempering temperature", "K",
        limits.tempering_distance_minimum, _tempering_distances(solved),
        source="limits.temperatures.tempering_distance_minimum", at_least=True,
    )  # fmt: skip


def _tempering_distances(solved: SolvedRig) -> Iterator[tuple[float, str]]:
    """Tempering temperature less the gear's own, of its teeth where a flank film gives them [K].

    A gear whose gearbox has no housing takes the temperature of its oil outlet; gears of a material without a
    tempering temperature are left out.
    """
    teeth = {
        (split.gear, row.stage): split.tooth_degC + ZERO
        for row in solved.thermal
        for split in row.heat_split
        if split.tooth_degC is not None
    }
    for point in solved.points:
        stage = point.point.stage
        for name, bulk in point.last.coupling_state.gear_temperature.items():
            box, gear = name.split(".")
            material = solved.rig.materials[solved.case.gearboxes[box].gears[gear].material]
            if material.tempering_temperature is None:
                continue
            hottest = max(bulk, teeth.get((name, stage), bulk))
            part = "teeth of " if hottest > bulk else ""
            basis = "" if box in solved.rig.models else ", its oil outlet"
            where = f"{part}{name} at {hottest - ZERO:.1f} degC{basis}, stage {stage}"
            yield material.tempering_temperature - hottest, where


def _films(solved: SolvedRig) -> list[tuple[str, BearingState]]:
    """(place and stage, state) of every bearing at every held stage."""
    return [
        (f"{name}, stage {point.point.stage}", state)
        for point in solved.points
        for name, state in point.last.bearings.items()
    ]


def _clearances(solved: SolvedRig) -> Iterator[Check]:
    """Hot clearances; of a gearbox whose housing is not expanded those of its drawing.

    Its gears and axes have the temperatures of its oil, so that backlash and tip clearance are those of the meshes
    that carry the load. What expansion would do to the rest is left out, and `omissions` says so.
    """
    limits = solved.case.limits.clearances
    rows: tuple[tuple[str, str, float | None, float, str, Values], ...] = (
        (
            "seal_gap", "smallest hot radial gap of a seal", limits.seal_gap_minimum, MM, "mm", _seal_gaps(solved),
        ),
        (
            "axial_play", "smallest hot axial play of a shaft", limits.axial_play_minimum, MM, "mm", _plays(solved),
        ),
        (
            "backlash", "smallest hot backlash", limits.backlash_minimum, MM, "mm",
            ((MM * model.pair.transverse_backlash, where) for where, model in _pairs(solved)),
        ),
        (
            "tip_clearance", "smallest hot tip clearance", limits.tip_clearance_minimum, MM, "mm",
            ((MM * min(model.pair.tip_clearances), where) for where, model in _pairs(solved)),
        ),
        (
            "bearing_clearance", "smallest hot diametral bearing clearance", limits.bearing_clearance_minimum,
            UM, "um", (
                (UM * clearance, f"{name}, stage {point.point.stage}")
                for point in solved.points
                for name, clearance in point.last.coupling_state.bearing_clearance.items()
            ),
        ),
    )  # fmt: skip
    absent = {"axial_play": NO_PLAY, "seal_gap": NO_SEAL}
    for key, title, limit, scale, unit, values in rows:
        yield _held(
            f"clearance.{key}", title, unit, _scaled(limit, scale), values,
            source=f"limits.clearances.{key}_minimum", at_least=True, absent=absent.get(key, NO_HOUSING),
        )  # fmt: skip
    yield from _seal_travel(solved)


def _pairs(solved: SolvedRig) -> Iterator[tuple[str, MeshModel]]:
    """Every mesh at every held stage."""
    for point in solved.points:
        for model in point.last.models:
            bare = model.name.split(".")[0] in solved.unexpanded
            basis = ", gears and axes at the temperature of their oil" if bare else ""
            yield f"{model.name}{basis}, stage {point.point.stage}", model


def _seal_gaps(solved: SolvedRig) -> Iterator[tuple[float, str]]:
    """Hot gap of every seal [mm]; cold where the housing is not expanded."""
    for row in solved.expansion:
        for seal in row.seal_gaps:
            yield seal["hot_min_mm"], f"{seal['seal']} at {seal['angle_of_min_deg']:.0f} deg"
    for name in solved.unexpanded:
        for part, seals in solved.case.gearboxes[name].seals.items():
            if seals.kind == "contactless":
                yield MM * seals.radial_gap, f"{name}.{part}, cold"


def _plays(solved: SolvedRig) -> Iterator[tuple[float, str]]:
    """Hot axial play of every shaft between stops [mm]; cold where the housing is not expanded."""
    for row in solved.expansion:
        for shaft in row.shafts:
            if shaft["axial_play_cold_mm"] > 0.0:
                yield shaft["axial_play_hot_mm"], shaft["shaft"]
    for name in solved.unexpanded:
        for bearing in solved.case.gearboxes[name].bearings.values():
            if bearing.axial_play > 0.0:
                yield MM * bearing.axial_play, f"{bearing.shaft}, {name}, cold"


def _seal_travel(solved: SolvedRig) -> Iterator[Check]:
    """Axial movement of every shaft in its seals against what they take, the worst of the held stages."""
    for box in dict.fromkeys(row.gearbox for row in solved.expansion):
        for name, seals in solved.case.gearboxes[box].seals.items():
            values = (
                (abs(seal["axial_shift_mm"]), f"{seal['seal']}, stage {row.stage}")
                for row in solved.expansion
                if row.gearbox == box
                for seal in row.seal_gaps
                if seal["shaft"] == seals.shaft
            )
            yield _held(
                f"clearance.seal_travel.{box}.{name}", f"axial movement of the {name} shaft in its seals ({box})",
                "mm", MM * seals.axial_travel, values, source=f"gearboxes.{box}.seals.{name}.axial_travel",
            )  # fmt: skip


def _bearings(solved: SolvedRig) -> Iterator[Check]:
    limits = solved.case.limits.bearing
    yield _held(
        "bearing.minimum_film", "smallest film of a journal bearing", "um",
        _scaled(limits.film_thickness_minimum, UM),
        (
            (UM * state.minimum_film, where)
            for where, state in _films(solved)
            if state.minimum_film is not None
        ),
        source="limits.bearing.film_thickness_minimum; film after ISO 7902-1", at_least=True,
    )  # fmt: skip
    yield _held(
        "bearing.specific_load", "largest specific load of a journal bearing", "MPa",
        _scaled(limits.specific_load_maximum, 1e-6),
        (
            (1e-6 * state.specific_load, where)
            for where, state in _films(solved)
            if state.specific_load is not None
        ),
        source="limits.bearing.specific_load_maximum",
    )  # fmt: skip


def _oil(solved: SolvedRig) -> Iterator[Check]:
    limits = solved.case.limits.oil
    rows = (
        ("flow", "oil flow of the rig", "l/min", "flow_maximum", 6e4, "flow_l_min", 1.0),
        ("cooler", "power the cooler carries", "kW", "cooler_power_maximum", 1e-3, "cooler_W", 1e-3),
        ("heater", "power the heaters of the warm circuits give", "kW", "heater_power_maximum", 1e-3, "heater_W", 1e-3),
        ("room", "heat to the room", "kW", "room_heat_maximum", 1e-3, "room_W", 1e-3),
    )  # fmt: skip
    for key, title, unit, name, limit_scale, entry, scale in rows:
        values = ((scale * float(row[entry]), f"stage {row['stage']}") for row in solved.cooler)
        yield _held(
            f"oil.{key}", title, unit, _scaled(getattr(limits, name), limit_scale), values,
            source=f"limits.oil.{name}",
        )  # fmt: skip


def transition_speeds_rpm(solved: SolvedRig, torque: float) -> list[tuple[float, str]]:
    """Vogelpohl transition speeds [rpm] of the bearings that have one under the load of a torque [N m], and where.

    Taken from the films of each loaded held stage; the speed grows with the load.
    """
    return [
        (
            torque / abs(point.point.torque) * state.transition_speed * 30.0 / math.pi,
            f"{name} at the viscosity of stage {point.point.stage}",
        )
        for point in solved.points
        if point.point.torque
        for name, state in point.last.bearings.items()
        if state.transition_speed is not None
    ]
