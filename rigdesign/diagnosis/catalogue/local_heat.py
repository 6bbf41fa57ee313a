"""Catalogue of the heat at one place: one bearing, one wall, the leak into one side.

Only of gearboxes with a housing, whose temperatures tell one place from another. A healthy rig has none of them: what
one bearing, wall or seal differs from its like by is in the healthy spread of all of them together. All but
oil and joint of a bearing answer nearly in proportion to their size and are run once.
"""

from collections.abc import Iterator, Mapping

from rigdesign.case.geometry import conditions_of, housing_geometry
from rigdesign.case.model import Case
from rigdesign.diagnosis.catalogue.effects import (
    FILM,
    FLOW,
    LOSS,
    ONE_FEED,
    ONE_JOINT,
    PRACTICE,
    Changes,
    Effect,
    GearboxPart,
    Parameter,
    of_gearbox,
    share,
)
from rigdesign.diagnosis.catalogue.heat import FLOW_METER, LOOSE, PRESSED, Resistance
from thermal.housing.housing_surfaces import surface_names
from thermal.housing.shaft_geometry import SIDES

TIGHT = 4.0
"""Largest friction of a bearing beyond its own, over it: a shell that closes its clearance to a fifth."""

UNEVEN = 0.05
"""Share by which the friction of one bearing differs from its like by the tolerance of its clearance."""

FAN = 3.0
"""Largest film to room air beyond that of a still room, over it: a fan of some metres per second on the wall."""

DRAUGHTY = 0.10
"""Share by which the air of a hall moves more along one wall than along the others."""


class _Times:
    """Multiplies the value at a path by one more than the excess."""

    def __init__(self, path: str, stated: float) -> None:
        self._path, self._stated = path, stated

    def __call__(self, case: Case, values: tuple[float, ...]) -> Changes:
        return {self._path: self._stated * (1.0 + values[0])}


class _Starved:
    """Takes a share of its oil from the film of a bearing."""

    def __init__(self, path: str, stated: float) -> None:
        self._path, self._stated = path, stated

    def __call__(self, case: Case, values: tuple[float, ...]) -> Changes:
        return {self._path: self._stated * (1.0 - values[0])}


@of_gearbox(housing=True)
def single_bearings(part: GearboxPart) -> Iterator[Effect]:
    """Friction, oil and shell joint of every bearing by itself."""
    for name, bearing in part.box.bearings.items():
        path, label = f"{part.path}.bearings.{name}", f"{part.name}.{name}"
        yield Effect(
            name=f"one_bearing_loss:{label}",
            title=f"friction of the bearing {label} alone",
            family=LOSS,
            signature="one shell and its end of the shaft warmer, drive torque higher; the other bearings as before",
            parameters=(Parameter(name="excess", unit="", low=-0.5, high=TIGHT, source=PRACTICE),),
            change=_Times(f"{path}.friction_factor", bearing.friction_factor),
            linear=True,
            matters=UNEVEN,
        )
        if bearing.type == "journal":
            yield Effect(
                name=f"one_bearing_oil:{label}",
                title=f"oil that does not reach the film of the bearing {label}",
                family=ONE_FEED,
                signature="one shell warmer with the same oil outlet, drive torque slightly lower",
                parameters=(share("share", 0.8),),
                change=_Starved(f"{path}.feed_share", bearing.feed_share),
                matters=0.05,
            )
            yield Effect(
                name=f"one_bearing_joint:{label}",
                title=f"joint between the shell of the bearing {label} and the housing",
                family=ONE_JOINT,
                signature="a step of temperature at one shell, its shaft end warmer",
                parameters=(
                    Parameter(name="resistance", unit="m2 K/W", low=0.0, high=LOOSE, source=PRACTICE),
                ),
                change=Resistance({f"{path}.shell_conductance": bearing.shell_conductance}),
                matters=PRESSED,
            )


class _OneSide:
    """Adds to the leak and sends the addition to one side."""

    def __init__(self, path: str, front: float) -> None:
        self._path, self._front = path, front

    def __call__(self, case: Case, values: tuple[float, ...]) -> Changes:
        paths = case.gearboxes[self._path.split(".")[1]].oil_paths
        leak, more = paths.leak_warm_cold, values[0]
        if more <= 0.0:
            return {}
        front = (leak * paths.leak_front_share + more * self._front) / (leak + more)
        return {f"{self._path}.leak_warm_cold": leak + more, f"{self._path}.leak_front_share": front}


@of_gearbox(housing=True)
def leaks_by_side(part: GearboxPart) -> Iterator[Effect]:
    """Gear oil that leaks into the cold chamber of one side only."""
    box, housing = part.box, part.housing
    if housing.one_chamber or box.jets is None or box.fed_bearings is None:
        return
    for side in SIDES:
        yield Effect(
            name=f"leak_one_side:{part.name}.{side}",
            title=f"leakage of gear oil into the {side} cold chamber of {part.name} only",
            family=FLOW,
            signature=f"{side} cold walls warmer than those of the other side; warm outlet falls, cold rises",
            parameters=(share("share", 0.15),),
            change=_OneSide(f"{part.path}.oil_paths", 1.0 if side == "front" else 0.0),
            linear=True,
            matters=FLOW_METER,
        )


class _OneWall:
    """Multiplies the factor of one wall by one more than the excess."""

    def __init__(self, path: str, stated: Mapping[str, float], wall: str) -> None:
        self._path, self._stated, self._wall = path, stated, wall

    def __call__(self, case: Case, values: tuple[float, ...]) -> Changes:
        factor = self._stated.get(self._wall, 1.0) * (1.0 + values[0])
        return {self._path: {**self._stated, self._wall: factor}}


@of_gearbox(housing=True)
def draughts(part: GearboxPart) -> Iterator[Effect]:
    """Room air that moves along one wall of the housing only."""
    housing = part.housing
    if housing.part_file is not None:
        return
    names = tuple(surface_names(housing_geometry(part.box)))
    walls = {
        surface
        for entry, surface, _ in conditions_of(housing, names)
        if housing.boundary[entry].wetted_by == "ambient" and surface.startswith("outer_")
    }
    if len(walls) < 2:
        return
    for wall in sorted(walls):
        yield Effect(
            name=f"draught:{part.name}.{wall}",
            title=f"draught on {wall.replace('_', ' ')} of {part.name}",
            family=FILM,
            signature="one wall colder than its neighbours, oil and drive torque nearly unchanged",
            parameters=(Parameter(name="excess", unit="", low=-0.5, high=FAN, source=PRACTICE),),
            change=_OneWall(f"{part.path}.housing.surface_film_factors", housing.surface_film_factors, wall),
            linear=True,
            matters=DRAUGHTY,
            stands_for="a cold neighbour, or a frame bolted to the wall",
            likeness_of_place=True,
        )
