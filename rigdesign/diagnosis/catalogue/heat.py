"""Catalogue of the heat: losses, how they divide, films, contacts, flows, oil, and a rig not yet steady.

Bounds are starting values of rig practice (design of the workflow, section 4); a healthy spread is what handbooks
and suppliers leave open. What a healthy rig does not have at all has a smallest size that matters instead: flow shares
as well as a good flow meter knows them (1 %), air as much as a tank hands on anyway (1 %), contact resistance that of a
pressed metal joint with oil in its gap (5e4 W/m2K), friction of seals 10 W at 10,000 rpm.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from rigdesign.case.films import SurfaceFilm
from rigdesign.case.model import Case
from rigdesign.case.surface_conditions import ThermalRadiation
from rigdesign.diagnosis.catalogue.effects import (
    CONTACT,
    FILM,
    FLOW,
    LOSS,
    OIL,
    PRACTICE,
    SPLIT,
    STATE,
    Added,
    Changes,
    Effect,
    GearboxPart,
    Parameter,
    Scaled,
    factor,
    of_gearbox,
    of_rig,
    share,
)


@dataclass(frozen=True, kw_only=True)
class _Loss:
    """A loss of a gearbox that the case scales.

    key : of ``loss_factors``; bounds : of the factor; healthy : spread of its logarithm
    in_gear_oil : whether the gear oil takes most of it; exponents : settings over which the exponent of its law is
    uncertain
    """

    key: str
    words: str
    bounds: tuple[float, float]
    healthy: float
    signature: str
    in_gear_oil: bool = True
    exponents: tuple[str, ...] = ()


LOSSES = (
    _Loss(
        key="mesh", words="friction of the teeth", bounds=(0.6, 1.6), healthy=0.12,
        signature="grows with torque and speed: oil rise, gears and drive torque together",
        exponents=("speed", "torque"),
    ),
    _Loss(
        key="bearing", words="friction of the bearing films", bounds=(0.5, 2.0), healthy=0.12,
        signature="grows with n^1.6 to n^2 at any torque: bearing oil, shells and drive torque", in_gear_oil=False,
        exponents=("speed",),
    ),
    _Loss(
        key="windage", words="windage of the gears", bounds=(0.3, 3.0), healthy=0.25,
        signature="grows with n^2.5 to n^3 at any torque: gear oil and drive torque",
        exponents=("speed",),
    ),
    _Loss(
        key="jet", words="acceleration of the jet oil", bounds=(0.3, 3.0), healthy=0.20,
        signature="grows with flow and n^2: gear oil and drive torque",
    ),
    _Loss(
        key="squeeze", words="squeezing of oil out of the mesh", bounds=(0.2, 5.0), healthy=0.25,
        signature="grows with torque and speed, straight into the oil",
    ),
)  # fmt: skip


@of_rig()
def not_steady(case: Case) -> Iterator[Effect]:
    """A rig whose points were read too early."""
    yield Effect(
        name="not_steady",
        title="readings before steady temperatures",
        family=STATE,
        signature="heavy parts too cold at every point; oil a little colder, drive torque a little higher",
        parameters=(
            Parameter(name="rate", unit="1/s", low=0.0, high=2.0 / 3600.0, source="two runs within an hour"),
        ),
        change=_Warming(),
        matters=1.0 / (24.0 * 3600.0),
        stands_for="a heavy part that is cooled, such as a clamping field",
    )


@of_gearbox()
def losses(part: GearboxPart) -> Iterator[Effect]:
    """Every loss that the case scales."""
    for loss in LOSSES:
        loss_factor: float = getattr(part.box.loss_factors, loss.key)
        yield Effect(
            name=f"{loss.key}_loss:{part.name}",
            title=f"{loss.words} in the {part.box.title}",
            family=LOSS,
            signature=loss.signature,
            parameters=(factor("factor", *loss.bounds),),
            change=Scaled(((f"{part.path}.loss_factors.{loss.key}", loss_factor),)),
            healthy=loss.healthy,
            exponents=loss.exponents,
            heats=f"{part.name}.gear_oil" if loss.in_gear_oil else "",
        )


class _Rubbing:
    """A friction torque shared evenly by the seals of a gearbox."""

    def __init__(self, paths: Mapping[str, float]) -> None:
        self._paths = paths

    def __call__(self, case: Case, values: tuple[float, ...]) -> Changes:
        more = values[0] / len(self._paths)
        return {path: stated + more for path, stated in self._paths.items()}


@of_gearbox()
def seals(part: GearboxPart) -> Iterator[Effect]:
    """Seals that rub."""
    name, box = part.name, part.box
    paths = {
        f"gearboxes.{name}.seals.{seal}.rubbing_torque": entry.rubbing_torque
        for seal, entry in box.seals.items()
    }
    if paths:
        yield Effect(
            name=f"seal_loss:{name}",
            title=f"seal friction of {name}",
            family=LOSS,
            signature="grows with n at any torque: shafts, seal bores and drive torque",
            parameters=(Parameter(name="friction torque", unit="N m", low=0.0, high=2.0, source=PRACTICE),),
            change=_Rubbing(paths),
            matters=0.01,
        )


class _Warming:
    """The time a point has run since the start, from the rate that is its inverse."""

    def __call__(self, case: Case, values: tuple[float, ...]) -> Changes:
        return {"ambient.warming_time": 1.0 / values[0]} if values[0] > 0.0 else {}


FLOW_METER = 0.01
"""Share of a flow that no meter on a rig sees."""

FLOWS = {
    "leak_warm_cold": (
        "leakage of gear oil into the bearing oil",
        0.15,
        "warm outlet falls, cold rises, sum unchanged",
        0.0,
    ),
    "bypass": (
        "gear oil bypassing the meshes",
        0.30,
        "gears and walls warmer, outlet mixed, less jet loss",
        0.0,
    ),
    "short_circuit": (
        "gear oil leaving without wall contact",
        0.30,
        "walls respond less to the oil, outlet nearly unchanged",
        0.2,
    ),
}
"""Key under oil_paths -> words, largest share, signature, healthy spread.

How much oil falls from the jets straight to the floor is not known of any rig: a fifth, more or less.
"""


@of_gearbox()
def flows(part: GearboxPart) -> Iterator[Effect]:
    """Oil that takes another way, blocked jets."""
    name, box = part.name, part.box
    for key, (words, most, signature, healthy) in FLOWS.items():
        yield Effect(
            name=f"{key}:{name}",
            title=f"{words} in {name}",
            family=FLOW,
            signature=signature,
            parameters=(share("share", most),),
            change=Added(f"gearboxes.{name}.oil_paths.{key}", getattr(box.oil_paths, key)),
            healthy=healthy,
            matters=0.0 if healthy else FLOW_METER,
        )
    if box.jets is None:
        return
    yield Effect(
        name=f"blocked_jet:{name}",
        title=f"blocked jets of {name}",
        family=FLOW,
        signature="gears warmer with dry flanks, jet loss lower as the oil is faster at the same flow",
        parameters=(share("share", 0.6),),
        change=Added(f"gearboxes.{name}.oil.blocked_jets", box.jets.blocked_jets),
        matters=FLOW_METER,
    )


@of_gearbox()
def oil(part: GearboxPart) -> Iterator[Effect]:
    """Properties of the oil and air in it."""
    name, box = part.name, part.box
    path, state = f"gearboxes.{name}.oil_state", box.oil_state
    yield Effect(
        name=f"aeration:{name}",
        title=f"air in the oil of {name}",
        family=OIL,
        signature="every oil rise of the gearbox larger, losses nearly unchanged",
        parameters=(share("air content", 0.2),),
        change=Added(f"{path}.air_content", state.air_content),
        matters=0.01,
    )
    yield Effect(
        name=f"oil_viscosity:{name}",
        title=f"viscosity of the oil of {name}",
        family=OIL,
        signature="bearing losses and tooth friction together, more when cold",
        parameters=(factor("factor", 0.7, 1.4),),
        change=Scaled(((f"{path}.viscosity_factor", state.viscosity_factor),)),
        healthy=0.06,
    )
    yield Effect(
        name=f"oil_heat_capacity:{name}",
        title=f"heat capacity of the oil of {name}",
        family=OIL,
        signature="every oil rise of the gearbox by one factor, drive torque unchanged",
        parameters=(factor("factor", 0.8, 1.25),),
        change=Scaled(((f"{path}.heat_capacity_factor", state.heat_capacity_factor),)),
        healthy=0.03,
    )


@of_gearbox(housing=True)
def split(part: GearboxPart) -> Iterator[Effect]:
    """How the friction heat of the teeth divides."""
    name, box = part.name, part.box
    into = box.heat_split.mesh_into_gears
    if into is None:
        return
    yield Effect(
        name=f"loss_split:{name}",
        title=f"share of the mesh heat that enters the gears of the {box.title}",
        family=SPLIT,
        signature="moves the gears, leaves oil rise and drive torque",
        parameters=(factor("factor", 0.3, min(2.0, 1.0 / into) if into else 2.0),),
        change=Scaled(((f"gearboxes.{name}.heat_split.mesh_into_gears", into),), 1.0),
        healthy=0.25,
    )


IN_MIST = 0.8
"""Healthy spread of the logarithm of a film on turning parts in a chamber: between dry air and mist, whose drops take
the temperature of the wall, lies a factor of five (`thermal.films.convection`)."""


IN_BEARING = 0.5
"""The same of the film in a bearing: between heat from its middle (Nu = 2) and heat made evenly in it (Nu = 6) lies a
factor of three (`thermal.films.convection.bearing_film`)."""


@of_gearbox(housing=True)
def films(part: GearboxPart) -> Iterator[Effect]:
    """Films to oil, room air and bearings, emissivity of the walls."""
    name, housing = part.name, part.housing
    path = f"gearboxes.{name}.housing"
    for entry, condition in housing.boundary.items():
        if not isinstance(condition, SurfaceFilm) or condition.wetted_by == "ambient":
            continue
        given = condition.coefficient_given
        low, high = (0.3, 3.0) if given else (0.2, 5.0)
        yield Effect(
            name=f"film:{name}.{entry}",
            title=f"oil film {entry.replace('_', ' ')} of {name}",
            family=FILM,
            signature="moves the bodies it wets against the oil, leaves drive torque",
            parameters=(factor("factor", low, high),),
            change=Scaled(((f"{path}.boundary.{entry}.film_factor", condition.film_factor),)),
            healthy=0.25 if given else IN_MIST,
            links=_wetted(name, condition.surfaces),
            likeness_of_place=True,
        )
    yield _film(
        f"ambient_film:{name}",
        "film to room air",
        f"{path}.ambient_film_factor",
        housing.ambient_film_factor,
        tuple(
            link
            for c in housing.boundary.values()
            if c.wetted_by == "ambient"
            for link in _wetted(name, c.surfaces)
        ),
    )
    yield _film(
        f"bearing_film:{name}",
        "film in the bearings",
        f"{path}.bearing_film_factor",
        housing.bearing_film_factor,
        (f"bearing_film:{name}.*",),
    )
    painted = {
        entry: condition
        for entry, condition in housing.boundary.items()
        if isinstance(condition, ThermalRadiation)
        and not any(surface.startswith(("field_", "shaft_")) for surface in condition.surfaces)
    }
    if painted:
        grey = {
            f"{path}.boundary.{entry}.emissivity_excess": c.emissivity_excess for entry, c in painted.items()
        }
        whole = [condition.emissivity for condition in painted.values()]
        most = 0.99 - max(whole)
        yield Effect(
            name=f"emissivity:{name}",
            title=f"emissivity of the walls of {name}",
            family=FILM,
            signature="moves the housing as dT^4 does, the field little",
            parameters=(
                Parameter(
                    name="excess", unit="", low=-0.9 * min(whole), high=max(most, 0.01), source=PRACTICE
                ),
            ),
            change=_Shifted(grey),
            healthy=0.06,
        )


def _wetted(name: str, surfaces: Sequence[str]) -> tuple[str, ...]:
    """Local conductances of the films on surfaces."""
    return tuple(f"film:{name}.{surface}" for surface in surfaces)


class _Shifted:
    """Adds the same to the values at several paths."""

    def __init__(self, paths: Mapping[str, float]) -> None:
        self._paths = paths

    def __call__(self, case: Case, values: tuple[float, ...]) -> Changes:
        return {path: stated + values[0] for path, stated in self._paths.items()}


def _film(name: str, title: str, path: str, stated: float, links: tuple[str, ...]) -> Effect:
    outside = name.startswith("ambient")
    return Effect(
        name=name,
        title=f"{title} of {name.split(':')[1]}",
        family=FILM,
        signature="moves the whole housing as dT does" if outside else "moves shells and journals",
        parameters=(factor("factor", 0.5, 3.0) if outside else factor("factor", 0.2, 3.0),),
        change=Scaled(((path, stated),)),
        healthy=0.15 if outside else IN_BEARING,
        links=links,
    )


LOOSE = 5e-3
"""Largest resistance between shell and bore [m2 K/W]: more than 0.1 mm of air, where little heat crosses any more."""

PRESSED = 2e-5
"""Resistance of a pressed metal joint with oil in its gap [m2 K/W]: less is no fault of a joint."""


class Resistance:
    """Puts a resistance [m2 K/W] in the way, on top of what the case has."""

    def __init__(self, paths: Mapping[str, float | None]) -> None:
        self._paths = paths

    def __call__(self, case: Case, values: tuple[float, ...]) -> Changes:
        """The change at a resistance."""
        more = values[0]
        return {
            path: 1.0 / (more + (0.0 if conductance is None else 1.0 / conductance))
            for path, conductance in self._paths.items()
            if more > 0.0
        }


@of_gearbox(housing=True)
def contacts(part: GearboxPart) -> Iterator[Effect]:
    """Resistance in the joints of bearing shells and foot."""
    name, box, housing = part.name, part.box, part.housing
    shells = {
        f"gearboxes.{name}.bearings.{bearing}.shell_conductance": entry.shell_conductance
        for bearing, entry in box.bearings.items()
    }
    yield _contact(f"shell_contact:{name}", "joint between bearing shells and housing", LOOSE, shells)
    joint = housing.foot_contact
    if joint is not None and joint.conductance is not None:
        foot: dict[str, float | None] = {
            f"gearboxes.{name}.housing.foot_contact.conductance": joint.conductance
        }
        yield _contact(f"foot_contact:{name}", "joint between foot and field", 0.02, foot)


def _contact(name: str, title: str, most: float, paths: Mapping[str, float | None]) -> Effect:
    return Effect(
        name=name,
        title=f"{title} of {name.split(':')[1]}",
        family=CONTACT,
        signature="a step of temperature at one joint",
        parameters=(Parameter(name="resistance", unit="m2 K/W", low=0.0, high=most, source=PRACTICE),),
        change=Resistance(paths),
        matters=PRESSED,
    )
