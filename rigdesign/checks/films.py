"""Checks of the films of the journal bearings, and what all values of a film leave out."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rigdesign.case.gearbox import Gearbox
from rigdesign.checks.omissions import Omissions, of_gearboxes, thrust, warming, without_housing
from rigdesign.checks.registry import REGISTRY, RigRule, Topic, Values
from rigdesign.checks.rules import Omission
from rigdesign.results.check import NO_HOUSING, Check
from rigdesign.results.units import MEGAPASCAL, MICROMETRE, UM

if TYPE_CHECKING:
    from dynamics.rotor.bearing import BearingState
    from rigdesign.postprocessing.solved_rig import SolvedRig

GROUP = "bearings"


def _films_without_housing(solved: SolvedRig, name: str, box: Gearbox) -> bool:
    """A gearbox without a housing that has plain bearings."""
    return without_housing(solved, name, box) and any(b.has_film for b in box.bearings.values())


SHAFT_HEAT = of_gearboxes(
    "heat of shafts and shells into the films of gearbox {box}: it has no housing", _films_without_housing
)
THRUST_TILT = of_gearboxes("tilting moment of the axial force of the gears of gearbox {box}", thrust)


def films(solved: SolvedRig) -> Iterator[tuple[str, BearingState]]:
    """(place and stage, state) of every journal bearing at every held stage."""
    for point in solved.points:
        for name, state in point.last.bearings.items():
            if state.star is None:
                yield f"{name}, stage {point.point.stage}", state


def no_film(solved: SolvedRig) -> str:
    """Why there are no films, where there are none."""
    boxes = solved.case.gearboxes.values()
    rolling = all(not bearing.has_film for box in boxes for bearing in box.bearings.values())
    return "all bearings are rolling bearings: they have no film" if rolling else NO_HOUSING


def _tilted(solved: SolvedRig, check: Check) -> Omissions:
    """The tilt of a shaft in its bore, which the expansion knows and the film does not."""
    journals = {name for name, _, entry in solved.rig.bearings() if entry.has_film}
    bores = [bore for warm in solved.warm for bore in warm.bores if bore.bearing in journals]
    if bores:
        worst = max(bores, key=lambda bore: bore.tilt * bore.width)
        size = 0.5 * (UM * worst.tilt * worst.width)
        text = f"tilt of the shaft in bearing {worst.bearing}, {size:.2g} um at the edges of the film"
        yield Omission(text, size)


def _thrust_load(solved: SolvedRig, check: Check) -> Omissions:
    """Tilting moment of the axial force of helical gears where the bearings of a shaft state no positions."""
    if any(thrust(solved, name, box) for name, box in solved.case.gearboxes.items()):
        yield Omission("tilting moment of the axial force of helical gears: bearings without position")


def _thicknesses(solved: SolvedRig) -> Values:
    return ((state.minimum_film, where) for where, state in films(solved) if state.minimum_film is not None)


def _specific_loads(solved: SolvedRig) -> Values:
    return ((state.specific_load, where) for where, state in films(solved) if state.specific_load is not None)


RULES = (
    RigRule(
        key="bearing.minimum_film",
        title="smallest film of a journal bearing",
        procedure=(
            "Film of every journal bearing at the held stages from load, speed, warm clearance and "
            "viscosity at film temperature (ISO 7902-1): least thickness."
        ),
        unit=MICROMETRE,
        group=GROUP,
        source="limits.bearing.film_thickness_minimum; film after ISO 7902-1",
        comparison=">=",
        limit=lambda limits: limits.bearing.film_thickness_minimum,
        values=_thicknesses,
        absent=no_film,
        leaves_out=(SHAFT_HEAT, THRUST_TILT, _tilted, warming),
        moved_by=frozenset({"housing"}),
    ),
    RigRule(
        key="bearing.specific_load",
        title="largest specific load of a journal bearing",
        procedure=(
            "Radial load of every journal bearing at the held stages, from the tooth forces unless "
            "stated, over diameter times width."
        ),
        unit=MEGAPASCAL,
        group=GROUP,
        source="limits.bearing.specific_load_maximum",
        limit=lambda limits: limits.bearing.specific_load_maximum,
        values=_specific_loads,
        absent=no_film,
        leaves_out=(_thrust_load, warming),
        moved_by=frozenset({"housing"}),
    ),
)


def checks(solved: SolvedRig) -> list[Check]:
    """Thickness of the films and load of the bearings."""
    return [rule.check(solved) for rule in RULES]


REGISTRY.register(Topic(order=34, families=RULES, checks=checks, of_housing_mesh=True))
