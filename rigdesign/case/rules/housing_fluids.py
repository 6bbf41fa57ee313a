"""Rules of volumes, streams and links of a housing: names, films that they need, what a link may lead to."""

from collections.abc import Collection, Iterator

from rigdesign.base.errors import Fault
from rigdesign.base.units import show
from rigdesign.case.faults import unknown, written
from rigdesign.case.films import FLUIDS
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.given_film import ConstantFilm
from rigdesign.case.housing import Housing
from rigdesign.case.housing_fluids import LINKED
from rigdesign.case.matching import matched
from rigdesign.case.wetting import wetted_surfaces


def housing_fluid_faults(name: str, gearbox: Gearbox, names: tuple[str, ...]) -> Iterator[Fault]:
    """What is wrong with the fluids of a housing whose surfaces have ``names``."""
    housing = gearbox.housing
    assert housing is not None
    at = f"gearboxes.{name}.housing"
    yield from _names(at, gearbox, housing, names)
    yield from _films(at, housing)
    wetted = {fluid: wetted_surfaces(housing, names, fluid) for fluid in (*housing.volumes, *housing.streams)}
    linked = {end for link in housing.links.values() for end in link.between}
    for volume in housing.volumes:
        if not wetted[volume] and volume not in linked:
            yield Fault(
                f"{at}.volumes.{volume}", "", "no film and no link reaches it: nothing determines its temperature",
                f'write fluid = "{volume}" in a film of boundary, or link it',
            )  # fmt: skip
    for stream, entry in housing.streams.items():
        yield from _stream(f"{at}.streams.{stream}", stream, entry.surfaces, wetted[stream], names)
    pairs: dict[frozenset[str], str] = {}
    for link, joined in housing.links.items():
        first = pairs.setdefault(frozenset(joined.between), link)
        if first != link:
            yield Fault(
                f"{at}.links.{link}.between", written(", ".join(joined.between)), f"is linked by {first} already",
                f"add the conductances in {first}",
            )  # fmt: skip
        yield from _link(f"{at}.links.{link}", joined.between, gearbox, housing)


def _names(at: str, gearbox: Gearbox, housing: Housing, names: Collection[str]) -> Iterator[Fault]:
    bodies = {"housing", "field"}
    bodies |= {f"{kind}_{shaft}" for shaft in housing.shafts for kind in ("shaft", "gear")}
    reserved = {*FLUIDS, *LINKED, "air", "bearing_film", *names, *bodies}
    for kind, entries in (("volumes", housing.volumes), ("streams", housing.streams)):
        for fluid in entries:
            other = kind == "streams" and fluid in housing.volumes
            if fluid in reserved or other:
                yield Fault(
                    f"{at}.{kind}.{fluid}", "", f"is the name of {'a volume' if other else 'a fluid, surface or body'}",
                    "choose another name",
                )  # fmt: skip


def _films(at: str, housing: Housing) -> Iterator[Fault]:
    """Fluids that films name."""
    own = (*housing.volumes, *housing.streams)
    for entry, condition in housing.boundary.items():
        fluid = condition.wetted_by
        if fluid is None or fluid in FLUIDS:
            continue
        if fluid not in own:
            yield unknown(f"{at}.boundary.{entry}.fluid", fluid, (*FLUIDS, *own), "fluid")
        elif isinstance(condition, ConstantFilm) and condition.fluid_temperature is not None:
            yield Fault(
                f"{at}.boundary.{entry}.fluid_temperature", show(condition.fluid_temperature, "temperature"),
                f"the temperature of {fluid} is found with the field",
                "remove it",
            )  # fmt: skip


def _stream(
    at: str, stream: str, order: tuple[str, ...], wetted: tuple[str, ...], names: tuple[str, ...]
) -> Iterator[Fault]:
    """Surfaces of a stream: at least one, and those of its order are those of its films."""
    if not wetted:
        yield Fault(
            at, "", "wets no surface", f'write fluid = "{stream}" in a film of boundary, e.g. law = "constant_film"'
        )  # fmt: skip
        return
    for pattern in order:
        if not matched([pattern], names):
            yield unknown(f"{at}.surfaces", pattern, names, "surface")
    if not order:
        return
    listed = tuple(matched(order, names))
    for surface in listed:
        if surface not in wetted:
            yield Fault(
                f"{at}.surfaces", written(surface), f"has no film to {stream}",
                f'write fluid = "{stream}" in its film, or take it out',
            )  # fmt: skip
    if missing := [surface for surface in wetted if surface not in listed]:
        yield Fault(
            f"{at}.surfaces", written(", ".join(missing)), "has a film to the stream and no place in its order",
            "add it where the stream passes it, or leave surfaces out",
        )  # fmt: skip


def _link(at: str, between: tuple[str, str], gearbox: Gearbox, housing: Housing) -> Iterator[Fault]:
    path = f"{at}.between"
    for end in between:
        if end in housing.streams:
            yield Fault(path, written(end), "is a stream; only volumes have links", "name a volume")
        elif end not in housing.volumes and end not in LINKED:
            yield unknown(path, end, (*housing.volumes, *LINKED), "volume")
    if between[0] == between[1] or not set(between) & set(housing.volumes):
        yield Fault(
            path,
            written(", ".join(between)),
            "needs a volume and another place",
            "name a volume of the housing",
        )
    if "bearing_oil" in between and gearbox.fed_bearings is None:
        yield Fault(
            path, '"bearing_oil"', "the bearings are not fed, they have no oil of their own", "write gear_oil"
        )
