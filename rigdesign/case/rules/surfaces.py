"""Rules of a housing: its parts fit together and every surface has a boundary condition."""

from collections.abc import Iterator
from dataclasses import replace
from fnmatch import fnmatchcase

from rigdesign.base.errors import Fault
from rigdesign.base.units import show
from rigdesign.case.faults import written
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.geometry import bearing_on, conditions_of, covering, housing_geometry
from rigdesign.case.housing import Housing
from rigdesign.case.matching import matched
from rigdesign.case.paths import nearest
from rigdesign.case.rules.enclosures import enclosure_faults
from rigdesign.case.rules.flanks import GEAR_RIMS, flank_faults
from rigdesign.case.rules.housing_fluids import housing_fluid_faults
from rigdesign.case.surface_place import SurfaceSite
from thermal.errors import ThermalInputError
from thermal.housing.surfaces import surface_names

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
        return boundary_faults(name, gearbox, names)
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


def boundary_faults(name: str, gearbox: Gearbox, names: tuple[str, ...]) -> list[Fault]:
    """What is wrong with the boundary conditions of a housing whose surfaces have ``names``."""
    housing = gearbox.housing
    assert housing is not None
    at = f"gearboxes.{name}.housing.boundary"
    return [
        *_boundary(at, housing, names),
        *_on_their_surfaces(at, gearbox, housing, names),
        *_film_factors(f"gearboxes.{name}.housing.surface_film_factors", housing, names),
        *enclosure_faults(name, gearbox, names),
        *housing_fluid_faults(name, gearbox, names),
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
