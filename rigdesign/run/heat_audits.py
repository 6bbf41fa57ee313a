"""Audits of the temperature fields: heat that cannot be, films taken at another difference, radiation counted twice."""

from collections.abc import Iterable, Iterator

from rigdesign.coupling.boundary import printed_films
from rigdesign.coupling.flank_heat import film_of_oil, rim_surfaces
from rigdesign.coupling.housing_context import GEAR_OIL
from rigdesign.coupling.temperatures import HousingField
from rigdesign.records.solved_rig import SolvedRig
from rigdesign.rig.oil_supply import ChamberOil
from thermal.conditions.boundary import Film, Radiation
from thermal.conduction.audit import assumed_difference, audit_conditions, radiation_too_small

FILM_FACTOR = 3.0
"""Between a given film on the rim of a gear and the one its oil makes, from which it is named."""


def heat_audits(solved: SolvedRig) -> Iterator[str]:
    """Heat that cannot be, films taken at another temperature difference, radiation counted twice."""
    for field in _fields(solved):
        found = (
            *audit_conditions(field.conditions),
            *_radiation_bound(field),
            *_assumed_differences(solved, field),
            *thin_rim_films(solved, field),
        )
        yield from (f"{field.gearbox}: {text}" for text in found)


def _radiation_bound(field: HousingField) -> Iterator[str]:
    rows = {(row.surface, row.kind): row for row in field.solution.balance.rows}
    films = {c.surface: c for c in field.conditions if isinstance(c, Film)}
    for condition in field.conditions:
        if not isinstance(condition, Radiation) or condition.surface not in films:
            continue
        film, own = films[condition.surface], rows[(condition.surface, condition.kind)]
        convection = rows[(film.surface, film.kind)]
        if convection.coefficient is None or condition.surroundings_temperature != film.fluid_temperature:
            continue
        text = radiation_too_small(
            condition.surface,
            convection=-convection.power,
            radiation=-own.power,
            emissivity=condition.emissivity,
            film=convection.coefficient.value,
            ambient=film.fluid_temperature,
        )
        if text is not None:
            yield text


def _assumed_differences(solved: SolvedRig, field: HousingField) -> Iterator[str]:
    rows = {(row.surface, row.kind): row for row in field.solution.balance.rows}
    films = {c.surface: c for c in field.conditions if isinstance(c, Film)}
    for surface, taken in printed_films(solved.rig, field.gearbox):
        film = films[surface]
        text = assumed_difference(
            surface,
            assumed=taken.temperature_difference,
            solved=rows[(surface, film.kind)].mean_temperature - film.fluid_temperature,
            law=taken.film_law(),
            fluid_temperature=film.fluid_temperature,
        )
        if text is not None:
            yield text


def thin_rim_films(solved: SolvedRig, field: HousingField) -> Iterator[str]:
    """Gears whose friction heat is split by assumption under a given film far from the one their jets make."""
    name, rig = field.gearbox, solved.rig
    box = rig.case.gearboxes[name]
    result = next(p for p in solved.points if p.last.fields.get(name) is field)
    point, state = result.point, result.last.coupling_state
    chamber = ChamberOil.of(name, state.oil_outlet, state.oil_supply)
    if box.heat_split.rule != "assumed" or point.speed == 0.0:
        return
    rows = {row.surface: row for row in field.solution.balance.rows if row.kind == GEAR_OIL}
    for gear, rim in rim_surfaces(box).items():
        row = rows.get(rim)
        if row is None or row.coefficient is None:
            continue
        given = row.coefficient.value
        made = film_of_oil(rig, name, gear, point, wall=row.mean_temperature, chamber=chamber)
        if not given * FILM_FACTOR >= made >= given / FILM_FACTOR:
            yield (
                f"{gear}: film on its rim = {given:.0f} W/(m2 K) with mesh_into_gears = "
                f"{box.heat_split.mesh_into_gears:g}, its oil makes {made:.0f} W/(m2 K) (fling-off): its bulk "
                f'temperature depends on the assumption; write law = "flank_film" and give no share, or ranges'
            )


def _fields(solved: SolvedRig) -> Iterable[HousingField]:
    for point in solved.points:
        yield from point.last.fields.values()
