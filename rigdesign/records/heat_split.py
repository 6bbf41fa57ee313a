"""The heat split: share of the friction heat of each gear that goes into the oil, with its range."""

import math
from collections.abc import Mapping
from dataclasses import replace

from rigdesign.case.geometry import conditions_of
from rigdesign.case.surface_conditions import FlankFilm
from rigdesign.coupling.flank_heat import GearFlanks, flank_films, gear_flanks, rim_surfaces
from rigdesign.coupling.housing_context import GEAR_OIL
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.temperatures import HousingField, body_mean
from rigdesign.results.housing import GearHeatSplit
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import ChamberOil
from thermal.conditions.boundary import Film, SurfaceSource
from thermal.conduction.condition_checks import Condition
from thermal.conduction.steady import solve_steady
from thermal.films.flank import fin_efficiency, tooth_excess

RANGED = ("wetted_share", "film_factor")
"""Inputs of a flank film whose ranges make the range of the split, both at their low and both at their high end."""

COMPARED = 1e-7
"""Heat left over, relative to the heat turned over, of fields that are solved only to compare: microkelvins."""


def heat_splits(rig: Rig, result: PointResult, field: HousingField) -> tuple[GearHeatSplit, ...]:
    """Heat split of every gear of a housing at a held stage, with its range.

    The range keeps losses, oil and warm gears of the converged state and solves the housing anew.
    """
    friction = friction_heat(rig, result, field.gearbox)
    films = _films(rig, field.gearbox)
    splits = split_as_solved(rig, result, field)
    found: list[dict[str, GearHeatSplit]] = []
    for end in (0, 1):
        ends = _ends(rig, field.gearbox, films, end)
        if ends is None:
            return tuple(splits.values())
        other = _solved_again(rig, result, field, friction, ends)
        found.append({gear: _split(rig, result, other, gear, ends[gear]) for gear in splits})
    low, high = found
    return tuple(
        replace(split, weak_film=low[gear], strong_film=high[gear]) for gear, split in splits.items()
    )


def split_as_solved(rig: Rig, result: PointResult, field: HousingField) -> dict[str, GearHeatSplit]:
    """Split of every meshed gear that friction heats, without its range: nothing is solved again."""
    films, box = _films(rig, field.gearbox), rig.case.gearboxes[field.gearbox]
    bodies = rig.models[field.gearbox].mesh.bodies
    return {
        gear: _split(rig, result, field, gear, films.get(gear))
        for gear, heat in friction_heat(rig, result, field.gearbox).items()
        if heat and f"gear_{box.gears[gear].shaft}" in bodies
    }


def friction_heat(rig: Rig, result: PointResult, name: str) -> dict[str, float]:
    """Friction heat of all its meshes that enters the flanks of each gear of a gearbox [W]."""
    box = rig.case.gearboxes[name]
    heat = dict.fromkeys(box.gears, 0.0)
    for placed in result.last.losses:
        if placed.gearbox == name and placed.split is not None:
            mesh = box.meshes[placed.part]
            heat[mesh.pinion] += placed.split.pinion * placed.loss.power
            heat[mesh.wheel] += (1.0 - placed.split.pinion) * placed.loss.power
    return heat


def _films(rig: Rig, name: str) -> dict[str, FlankFilm]:
    box = rig.case.gearboxes[name]
    return flank_films(box, rim_surfaces(box))


def _ends(rig: Rig, name: str, films: Mapping[str, FlankFilm], end: int) -> dict[str, FlankFilm] | None:
    """The films at one end of the ranges of the case; None where it states no range."""
    box = rig.case.gearboxes[name]
    if box.housing is None or box.heat_split.rule != "flank_film":
        return None
    ranges = {mark.path: mark.range for mark in rig.case.origin.marks if mark.range is not None}
    rims = rim_surfaces(box)
    entries = {surface: entry for entry, surface, _ in conditions_of(box.housing, rims.values())}
    changed = {}
    for gear, film in films.items():
        at = f"gearboxes.{name}.housing.boundary.{entries[rims[gear]]}"
        given = {key: float(ranges[f"{at}.{key}"][end]) for key in RANGED if f"{at}.{key}" in ranges}
        changed[gear] = film.model_copy(update=given)
    return changed if changed != dict(films) else None


def _flanks(rig: Rig, result: PointResult, name: str, gear: str, film: FlankFilm) -> GearFlanks:
    state = result.last.coupling_state
    chamber = ChamberOil.of(name, state.oil_outlet, state.oil_supply)
    return gear_flanks(rig, name, gear, result.point, film, chamber)


def _solved_again(
    rig: Rig,
    result: PointResult,
    field: HousingField,
    friction: Mapping[str, float],
    films: Mapping[str, FlankFilm],
) -> HousingField:
    """The field with other films on the teeth and what these let through to the rims."""
    name = field.gearbox
    gears = {surface: gear for gear, surface in rim_surfaces(rig.case.gearboxes[name]).items()}
    bulk = result.last.coupling_state.gear_temperature
    conditions: list[Condition] = []
    for condition in field.conditions:
        gear = gears.get(getattr(condition, "surface", ""))
        if gear is not None and isinstance(condition, Film):
            condition = _flanks(rig, result, name, gear, films[gear]).film(condition.surface, condition.kind)
        elif gear is not None and isinstance(condition, SurfaceSource):
            kept = _flanks(rig, result, name, gear, films[gear]).kept(bulk[f"{name}.{gear}"])
            condition = replace(condition, power=kept * friction[gear])
        conditions.append(condition)
    setup = rig.conduction[name]
    solution = solve_steady(setup, conditions, near=field.solution, tolerance=COMPARED)
    return HousingField(gearbox=name, conditions=tuple(conditions), solution=solution)


def _split(
    rig: Rig, result: PointResult, field: HousingField, gear: str, condition: FlankFilm | None
) -> GearHeatSplit:
    name = field.gearbox
    box = rig.case.gearboxes[name]
    rim = rim_surfaces(box)[gear]
    heat = friction_heat(rig, result, name)[gear]
    rows = [row for row in field.solution.balance.rows if row.surface == rim]
    reached = math.fsum(row.power for row in rows if row.kind == "mesh_loss")
    coefficient = efficiency = tooth = None
    if condition is not None:
        flanks = _flanks(rig, result, name, gear, condition)
        wall = rows[0].mean_temperature
        coefficient = flanks.law(wall, flanks.oil_temperature).value
        efficiency = fin_efficiency(flanks.ring, coefficient)
        excess = tooth_excess(flanks.ring, coefficient, heat, wall - flanks.oil_temperature)
        tooth = flanks.oil_temperature + excess
    return GearHeatSplit(
        gear=f"{name}.{gear}",
        rule=box.heat_split.rule,
        friction=heat,
        at_once=heat - reached,
        film=-math.fsum(row.power for row in rows if row.kind == GEAR_OIL),
        bulk_temperature=body_mean(rig, field, f"gear_{box.gears[gear].shaft}"),
        tooth_temperature=tooth,
        coefficient=coefficient,
        fin_efficiency=efficiency,
    )
