"""Rules of a housing: its parts fit together and every surface has a boundary condition."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from fnmatch import fnmatchcase

import numpy as np

from rigdesign.base.errors import Fault
from rigdesign.base.units import show
from rigdesign.case.faults import unknown, written
from rigdesign.case.films import FLUIDS, SurfaceSite, matched
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.geometry import bearing_on, conditions_of, covering, housing_geometry, wetted_surfaces
from rigdesign.case.housing import LINKED, EnclosureInput, Housing
from rigdesign.case.paths import nearest
from rigdesign.case.surface_conditions import ConstantFilm, FlankFilm
from thermal.conditions.view_factor_closure import EnclosureError, close_view_factors
from thermal.errors import ThermalInputError
from thermal.housing.housing_surfaces import exact_areas, surface_names

POSITION_TOLERANCE = 1e-4
"""Most difference [m] between the distance of two axes and the centre distance of their mesh."""

BEARING_SURFACES = ("bearing_bore_*", "shaft_*_journal_*")
"""Surfaces that a lubricant film joins."""


def housing_faults(name: str, gearbox: Gearbox) -> list[Fault]:
    """Everything wrong with the housing of a gearbox; empty for one without a housing."""
    housing = gearbox.housing
    if housing is None:
        return []
    at = f"gearboxes.{name}"
    faults = [*_shafts(at, gearbox, housing), *_centre_distances(at, gearbox, housing)]
    if faults:
        return faults
    try:
        names = tuple(surface_names(housing_geometry(gearbox)))
    except ThermalInputError as error:
        return [Fault(f"{at}.housing", "", str(error), "correct the measures of the housing")]
    if housing.part_file is None:
        return boundary_faults(name, gearbox, housing, names)
    return list(_idle_sizes(at, housing))


def _idle_sizes(at: str, housing: Housing) -> Iterator[Fault]:
    """Element sizes of zones that a housing from a file does not have."""
    if housing.mesh_file is not None and housing.mesh.sizes():
        yield Fault(
            f"{at}.housing.mesh", "", "element sizes do nothing to a mesh that is read from a file",
            "remove them or mesh_file",
        )  # fmt: skip
    if housing.step_file is not None and (idle := sorted(set(housing.mesh.sizes()) - {"wall"})):
        yield Fault(
            f"{at}.housing.mesh", "", f"element sizes of {', '.join(idle)} do nothing to a STEP file, which has one",
            "remove them; walls is that of the whole part",
        )  # fmt: skip


def boundary_faults(name: str, gearbox: Gearbox, housing: Housing, names: tuple[str, ...]) -> list[Fault]:
    """What is wrong with the boundary conditions of the housing of a gearbox whose surfaces have ``names``."""
    at = f"gearboxes.{name}.housing.boundary"
    return [
        *_boundary(at, housing, names),
        *_on_their_surfaces(at, gearbox, housing, names),
        *_film_factors(f"gearboxes.{name}.housing.surface_film_factors", housing, names),
        *enclosure_faults(name, gearbox, housing, names),
        *housing_fluid_faults(name, gearbox, housing, names),
        *flank_faults(name, gearbox, housing, names),
    ]


def _shafts(at: str, gearbox: Gearbox, housing: Housing) -> Iterator[Fault]:
    for shaft in housing.shafts:
        front, rear = (bearing_on(gearbox, shaft, side) for side in ("front", "rear"))
        if not (front.locating or rear.locating):
            yield Fault(
                f"{at}.bearings",
                "",
                f"no bearing locates shaft {shaft}",
                "write locating = true at one of them",
            )
        if [seals.shaft for seals in gearbox.seals.values()].count(shaft) != 1:
            yield Fault(f"{at}.seals", "", f"shaft {shaft} needs one table of seals", "add or remove seals")
        gears = [gear_name for gear_name, gear in gearbox.gears.items() if gear.shaft == shaft]
        if len(gears) > 1:
            yield Fault(
                f"{at}.gears", "",
                f"{' and '.join(gears)} sit on one shaft, the housing model has one gear per shaft",
                "put them on shafts of their own",
            )  # fmt: skip
        yield from _seal_diameter(at, housing, shaft)
        yield from _rubbing_without_a_seal(at, gearbox, housing, shaft)


def _rubbing_without_a_seal(at: str, gearbox: Gearbox, housing: Housing, shaft: str) -> Iterator[Fault]:
    """One chamber has seals only where a shaft leaves it."""
    entry = housing.shafts[shaft]
    if not housing.one_chamber or entry.overhang_front > 0.0 or entry.overhang_rear > 0.0:
        return
    for name, seals in gearbox.seals.items():
        if seals.shaft == shaft and seals.rubbing_torque:
            yield Fault(
                f"{at}.seals.{name}.rubbing_torque", show(seals.rubbing_torque, "torque"),
                f"has no seal to rub in: shaft {shaft} leaves the one chamber nowhere",
                "set it to 0, or give the shaft its overhang_front or overhang_rear",
            )  # fmt: skip


def _seal_diameter(at: str, housing: Housing, shaft: str) -> Iterator[Fault]:
    """The diameter in the seals of the partitions goes with the partitions."""
    path, diameter = f"{at}.housing.shafts.{shaft}.seal_diameter", housing.shafts[shaft].seal_diameter
    if diameter is None and not housing.one_chamber:
        yield Fault(
            path, "", "a housing with partitions needs the shaft diameter in their seals",
            "add it, or leave out cold_length_front, cold_length_rear and partition_thickness",
        )  # fmt: skip
    if diameter is not None and housing.one_chamber:
        yield Fault(
            path, show(diameter, "length"),
            "does nothing in a housing without partitions, in which a shaft has the bore of its gear from bearing to "
            "bearing",
            "remove it, or give the housing its partitions",
        )  # fmt: skip


def _centre_distances(at: str, gearbox: Gearbox, housing: Housing) -> Iterator[Fault]:
    for name, mesh in gearbox.meshes.items():
        shafts = [gearbox.gears[gear].shaft for gear in (mesh.pinion, mesh.wheel)]
        apart = abs(housing.shafts[shafts[0]].lateral_position - housing.shafts[shafts[1]].lateral_position)
        if abs(apart - mesh.centre_distance) > POSITION_TOLERANCE:
            yield Fault(
                f"{at}.meshes.{name}.centre_distance", show(mesh.centre_distance, "length"),
                f"the axes of {shafts[0]} and {shafts[1]} are {show(apart, 'length')} apart",
                "correct lateral_position of the shafts or the centre distance",
            )  # fmt: skip


def _boundary(at: str, housing: Housing, names: tuple[str, ...]) -> Iterator[Fault]:
    for name, condition in housing.boundary.items():
        for pattern in condition.surfaces:
            if not matched([pattern], names):
                meant = nearest(pattern, names)
                hint = "did you mean " + " or ".join(meant) + "? " if meant else ""
                yield Fault(
                    f"{at}.{name}.surfaces",
                    written(pattern),
                    "no such surface",
                    f"{hint}known: {', '.join(names)}",
                )
    for name, surface, stood_for in conditions_of(housing, names):
        partner = housing.boundary[name].partner_of(stood_for)
        if partner is not None and partner not in names:
            meant = nearest(partner, names)
            hint = "did you mean " + " or ".join(meant) + "?" if meant else "write a surface name"
            yield Fault(
                f"{at}.{name}.partner", written(partner), f"no such surface, partner of {surface}", hint
            )
    for surface, conditions in covering(housing, names).items():
        films = [name for name in conditions if name]
        if not conditions:
            usual = ("flank_film", "constant_film"), ("constant_film", "insulated")
            laws = usual[0] if fnmatchcase(surface, GEAR_RIMS) else usual[1]
            yield Fault(
                at, "", f"surface {surface} has no boundary condition",
                f'add one, e.g. law = "{laws[0]}" or law = "{laws[1]}"',
            )  # fmt: skip
        if len(films) > 1:
            yield Fault(
                f"{at}.{films[1]}.surfaces", written(surface), f"already has {films[0]}", "name it once"
            )


def _film_factors(at: str, housing: Housing, names: tuple[str, ...]) -> Iterator[Fault]:
    """Factors of surfaces that have no film to room air."""
    in_air = {
        surface: None
        for name, surface, _ in conditions_of(housing, names)
        if housing.boundary[name].wetted_by == "ambient"
    }
    for surface, factor in housing.surface_film_factors.items():
        if surface not in in_air:
            meant = nearest(surface, tuple(in_air)) or tuple(in_air)
            yield Fault(
                f"{at}.{surface}", f"{factor:g}", "no surface of this name has a film to room air",
                f"write one of {', '.join(meant)}, or remove it",
            )  # fmt: skip


def _on_their_surfaces(
    at: str, gearbox: Gearbox, housing: Housing, names: tuple[str, ...]
) -> Iterator[Fault]:
    """What each condition needs of its surfaces and does not find there; a fault of the entry is said once."""
    found = dict.fromkeys(
        (name, fault)
        for name, surface, _ in conditions_of(housing, names)
        for fault in housing.boundary[name].faults_on(_site(gearbox, housing, surface))
    )
    for name, fault in found:
        yield replace(fault, path=f"{at}.{name}.{fault.path}")


def _site(gearbox: Gearbox, housing: Housing, surface: str) -> SurfaceSite:
    seals = next((s for s in gearbox.seals.values() if f"shaft_{s.shaft}_seal_" in surface), None)
    return SurfaceSite(
        surface=surface,
        housing_height=housing.height,
        on_shaft=any(f"_{shaft}_" in f"{surface}_" for shaft in housing.shafts),
        has_teeth=fnmatchcase(surface, GEAR_RIMS),
        in_bearing=any(fnmatchcase(surface, pattern) for pattern in BEARING_SURFACES),
        seal="" if seals is None else seals.shaft,
        seal_gap=None if seals is None else seals.radial_gap,
    )


# Rule of the oil films on the teeth: every gear has one if they decide the split.

GEAR_RIMS = "gear_*_rim"
"""Surfaces that stand for teeth."""


def flank_faults(name: str, gearbox: Gearbox, housing: Housing, names: Sequence[str]) -> Iterator[Fault]:
    """Rims without an oil film that the split of the friction heat needs.

    name : of the gearbox; names : every surface of the housing
    """
    at = f"gearboxes.{name}.housing.boundary"
    filmed = {
        surface
        for entry, surface, _ in conditions_of(housing, names)
        if isinstance(housing.boundary[entry], FlankFilm)
    }
    bare = [gear for gear, part in gearbox.gears.items() if f"gear_{part.shaft}_rim" not in filmed]
    if gearbox.heat_split.rule == "flank_film" and bare:
        yield Fault(
            f"gearboxes.{name}.heat_split.mesh", '"flank_film"',
            f"the rim of {' and '.join(bare)} has no flank film that could decide",
            f'write law = "flank_film" for gear_*_rim under {at}, or give mesh_into_gears',
        )  # fmt: skip


# Rules of the enclosures of a housing: which surfaces radiate at each other, and whether their view factors close.


def enclosure_faults(
    name: str, gearbox: Gearbox, housing: Housing, names: tuple[str, ...]
) -> Iterator[Fault]:
    """What is wrong with the enclosures of the housing of a gearbox whose surfaces have ``names``."""
    taken: dict[str, str] = {}
    for entry, enclosure in housing.enclosures.items():
        at = f"gearboxes.{name}.housing.enclosures.{entry}"
        surfaces = enclosure.emissivities(names)
        faults = [
            *_parts(at, enclosure, names),
            *_surfaces(at, entry, surfaces, taken),
            *_conditions(at, housing, tuple(surfaces), names),
        ]
        taken |= {surface: taken.get(surface, entry) for surface in surfaces}
        yield from faults
        if not faults and enclosure.view_factors != "computed":
            exact = exact_areas(housing_geometry(gearbox)) if housing.part_file is None else None
            yield from _view_factors(at, enclosure, surfaces, exact)


def _parts(at: str, enclosure: EnclosureInput, names: tuple[str, ...]) -> Iterator[Fault]:
    """Patterns that name nothing, surfaces that two parts name."""
    owner: dict[str, str] = {}
    for part, entry in enclosure.parts.items():
        path = f"{at}.parts.{part}.surfaces"
        for pattern in entry.surfaces:
            if not matched([pattern], names):
                meant = nearest(pattern, names)
                hint = "did you mean " + " or ".join(meant) + "? " if meant else ""
                yield Fault(path, written(pattern), "no such surface", f"{hint}known: {', '.join(names)}")
        for surface in matched(entry.surfaces, names):
            if owner.setdefault(surface, part) != part:
                yield Fault(
                    path, written(surface), f"is in the part {owner[surface]} already", "name it once"
                )


def _surfaces(
    at: str, entry: str, surfaces: Mapping[str, float], taken: Mapping[str, str]
) -> Iterator[Fault]:
    """Too few surfaces, surfaces of another enclosure, none that radiates."""
    if len(surfaces) < 2:
        found = ", ".join(surfaces) or "none"
        yield Fault(
            at, "", f"needs two surfaces that radiate at each other, has {found}",
            'name a chamber of the box, or more surfaces in its parts; a lone surface takes law = "radiation"',
        )  # fmt: skip
    elif not any(surfaces.values()):
        yield Fault(at, "", "every emissivity is 0, nothing radiates", "write one above 0")
    for surface in surfaces:
        if surface in taken:
            yield Fault(
                at, written(surface), f"is a surface of the enclosure {taken[surface]} already",
                "name it in one of them",
            )  # fmt: skip


def _conditions(
    at: str, housing: Housing, surfaces: tuple[str, ...], names: tuple[str, ...]
) -> Iterator[Fault]:
    """Surfaces whose condition leaves no radiation to an enclosure."""
    for entry, surface, _ in conditions_of(housing, names):
        condition = housing.boundary[entry]
        if surface not in surfaces:
            continue
        if (against := condition.against_enclosure(entry)) is not None:
            yield Fault(at, written(surface), *against)


def _view_factors(
    at: str, enclosure: EnclosureInput, surfaces: Mapping[str, float], exact: Mapping[str, float] | None
) -> Iterator[Fault]:
    """Given view factors: of the surfaces that take part, complete and reciprocal.

    exact : areas of all surfaces [m2]; None where a file has them
    """
    given = enclosure.view_factors
    assert given != "computed"
    path = f"{at}.view_factors"
    strange = set(given).union(*given.values()) - set(surfaces)
    if strange:
        yield Fault(
            path, written(", ".join(sorted(strange))), "is no surface of this enclosure",
            f"its surfaces: {', '.join(surfaces)}",
        )  # fmt: skip
        return
    if exact is None:
        return
    areas = {surface: exact[surface] for surface in surfaces}
    rows = enclosure.rows(areas)
    assert rows is not None
    opening = enclosure.opening_temperature is not None
    try:
        close_view_factors(np.array(rows), np.array([*areas.values()]), list(surfaces), opening)
    except EnclosureError as error:
        problem, _, remedy = str(error).rpartition("; ")
        yield Fault(path, "", problem, remedy)


# Rules of volumes, streams and links of a housing: names, films that they need, what a link may lead to.


def housing_fluid_faults(
    name: str, gearbox: Gearbox, housing: Housing, names: tuple[str, ...]
) -> Iterator[Fault]:
    """What is wrong with the fluids of the housing of a gearbox whose surfaces have ``names``."""
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
