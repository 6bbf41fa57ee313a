"""Defaults of a housing: walls from its size, shafts from bearings, the standard set of boundary conditions."""

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from rigdesign.case.defaults.rule import (
    Filling,
    RawTree,
    RuleBook,
    around,
    assumed,
    bearing_width,
    bearings_on,
    follows,
    gear_on,
    inner_length,
    millimetres,
    only_mesh,
    shaft_diameter,
    shafts_of,
    with_marks,
)
from rigdesign.case.films import matched
from rigdesign.case.geometry import covering, housing_geometry
from thermal.errors import ThermalInputError
from thermal.housing.housing_surfaces import surface_names

if TYPE_CHECKING:
    from rigdesign.case.model import Case

HOUSING = "gearboxes.*.housing"
book = RuleBook(within=HOUSING)
SEAL_WIDTH = 7e-3
"""Width of a radial shaft seal for shafts of 25 to 50 mm [m] (ISO 6194-1)."""
LEAST_WALL = 8e-3
"""Least wall of a cast box [m]."""

CARRIED_OFF = "less where running gears hold the level down, more by the oil that they carry above it"
"""Why the film of parts that dip is known to a third and the double only: no measurement of it was found."""


def has_partitions(tree: RawTree, box: str) -> bool:
    """Whether a housing has cold sections between its chamber and its end walls."""
    return tree.has(f"gearboxes.{box}.housing.partition_thickness")


def _wall(tree: RawTree, box: str) -> float | None:
    """0.01 of the longest side and 6 mm, at least 8 mm [m]."""
    at = f"gearboxes.{box}.housing"
    sides = [tree.length(f"{at}.width"), tree.length(f"{at}.height"), inner_length(tree, box)]
    known = [side for side in sides if side is not None]
    return max(0.01 * max(known) + 6e-3, LEAST_WALL) if len(known) == len(sides) else None


def _of_wall(tree: RawTree, box: str, factor: float, reason: str) -> Filling:
    wall = _wall(tree, box)
    return None if wall is None else around(1e3 * factor * wall, "mm", reason, (0.7, 1.5))


@book.default(f"{HOUSING}.material")
def _material(tree: RawTree, box: str) -> Filling:
    return assumed("grey_iron", "cast box")


@book.default(f"{HOUSING}.wall_thickness")
def _wall_thickness(tree: RawTree, box: str) -> Filling:
    return _of_wall(tree, box, 1.0, "cast box: 0.01 of its longest side and 6 mm")


@book.default(f"{HOUSING}.top_thickness")
def _top_thickness(tree: RawTree, box: str) -> Filling:
    return _of_wall(tree, box, 1.0, "as the side walls")


@book.default(f"{HOUSING}.floor_thickness")
def _floor_thickness(tree: RawTree, box: str) -> Filling:
    return _of_wall(tree, box, 1.25, "a quarter thicker than the walls, for the feet")


@book.default(f"{HOUSING}.end_seal_width")
def _end_seal(tree: RawTree, box: str) -> Filling:
    return assumed(millimetres(SEAL_WIDTH), "width of a radial shaft seal, ISO 6194-1", "5 mm", "10 mm")


@book.default(f"{HOUSING}.end_wall_thickness")
def _end_wall(tree: RawTree, box: str) -> Filling:
    """No range: bearings stand at the inner side of this wall, so that their places would have to move with it."""
    found = (bearing_width(tree, box, name) for name in tree.names(f"gearboxes.{box}.bearings"))
    widths = [width for width in found if width is not None]
    seal = tree.length(f"gearboxes.{box}.housing.end_seal_width")
    if not widths or seal is None:
        return None
    return assumed(millimetres(max(widths) + seal), "width of the bearing and of the seal outside of it")


@book.default(f"{HOUSING}.shaft_height")
def _shaft_height(tree: RawTree, box: str) -> Filling:
    height = tree.length(f"gearboxes.{box}.housing.height")
    return None if height is None else assumed(millimetres(0.5 * height), "shafts at half the height")


@book.default(f"{HOUSING}.radiation_included")
def _radiation(tree: RawTree, box: str) -> Filling:
    return assumed(True, "Niemann/Winter measured housings that radiate")


@book.default(f"{HOUSING}.field.length")
def _field_length(tree: RawTree, box: str) -> Filling:
    return _twice(inner_length(tree, box))


@book.default(f"{HOUSING}.field.width")
def _field_width(tree: RawTree, box: str) -> Filling:
    return _twice(tree.length(f"gearboxes.{box}.housing.width"))


def _twice(size: float | None) -> Filling:
    if size is None:
        return None
    length = 2e3 * size + 100.0
    return assumed(f"{length:.6g} mm", "share of the bed that one box warms: twice the box and 100 mm")


@book.default(f"{HOUSING}.field.thickness")
def _field_thickness(tree: RawTree, box: str) -> Filling:
    return assumed("50 mm", "steel bed plate", "25 mm", "100 mm")


@book.default(f"{HOUSING}.field.material")
def _field_material(tree: RawTree, box: str) -> Filling:
    return assumed("structural_steel", "steel bed plate")


# ------------------------------------------------------------------ shafts


@book.default(f"{HOUSING}.shafts", completes=True)
def _shafts(tree: RawTree, box: str) -> Filling:
    return {shaft: {} for shaft in shafts_of(tree, box)} or None


@book.default(f"{HOUSING}.shafts.*.lateral_position")
def _lateral(tree: RawTree, box: str, shaft: str) -> Filling:
    mesh = only_mesh(tree, box)
    at = f"gearboxes.{box}.meshes.{mesh}"
    distance, gear = tree.length(f"{at}.centre_distance"), gear_on(tree, box, shaft)
    if mesh is None or distance is None or gear is None:
        return None
    side = -0.5 if gear == tree.text(f"{at}.pinion") else 0.5
    return follows(
        millimetres(side * distance), "pinion and wheel at half the centre distance from the middle"
    )


@book.default(f"{HOUSING}.shafts.*.seal_diameter")
def _seal_diameter(tree: RawTree, box: str, shaft: str) -> Filling:
    return _as_in_bearings(tree, box, shaft) if has_partitions(tree, box) else None


@book.default(f"{HOUSING}.shafts.*.outside_diameter")
def _outside_diameter(tree: RawTree, box: str, shaft: str) -> Filling:
    return _as_in_bearings(tree, box, shaft)


def _as_in_bearings(tree: RawTree, box: str, shaft: str) -> Filling:
    diameter = shaft_diameter(tree, box, shaft)
    return None if diameter is None else assumed(millimetres(diameter), "as in the bearings")


@book.default(f"{HOUSING}.shafts.*.overhang_front")
def _overhang_front(tree: RawTree, box: str, shaft: str) -> Filling:
    return _overhang(tree, box, shaft, "front")


@book.default(f"{HOUSING}.shafts.*.overhang_rear")
def _overhang_rear(tree: RawTree, box: str, shaft: str) -> Filling:
    return _overhang(tree, box, shaft, "rear")


def _overhang(tree: RawTree, box: str, shaft: str, side: str) -> Filling:
    """From the outside of the end wall to the end of the shaft, by places and sections in the drivetrain."""
    wall = tree.length(f"gearboxes.{box}.housing.end_wall_thickness")
    found = [
        name for name in bearings_on(tree, box, shaft)
        if tree.text(f"gearboxes.{box}.bearings.{name}.side") == side
    ]  # fmt: skip
    if not found:
        return follows("0 mm", "no bearing at this end")
    if wall is None:
        return None
    middle = tree.length(f"gearboxes.{box}.bearings.{found[0]}.position")
    width = bearing_width(tree, box, found[0])
    at = f"drivetrain.shafts.{shaft}.sections"
    lengths = [tree.length(f"{at}.{index}.length") for index in range(tree.count(at))]
    if middle is None or width is None or not lengths or None in lengths:
        return None
    beyond = middle if side == "front" else sum(length or 0.0 for length in lengths) - middle
    outside = max(beyond - (wall - 0.5 * width), 0.0)
    outside = outside if outside >= 1e-3 else 0.0
    return follows(millimetres(outside), "from the end wall to the end of the shaft in the drivetrain")


@book.default(f"{HOUSING}.shafts.*.material")
def _shaft_material(tree: RawTree, box: str, shaft: str) -> Filling:
    stated = tree.text(f"drivetrain.shafts.{shaft}.material")
    return (
        follows(stated, "as in the drivetrain")
        if stated
        else assumed("case_hardened_steel", "usual for shafts")
    )


# ------------------------------------------------------------------ boundary


@book.default(f"{HOUSING}.boundary")
def _boundary(tree: RawTree, box: str) -> Filling:
    """Niemann/Winter and Recknagel outside, oil inside, rotating cylinders and discs, films of bearings and flanks."""
    if tree.has(f"gearboxes.{box}.housing.mesh_file") or tree.has(f"gearboxes.{box}.housing.step_file"):
        return None
    inside = ["partition_*", "cold_*"] if has_partitions(tree, box) else ["end_wall_*"]
    turning = ["shaft_*_warm", "shaft_*_seal_*", *(["shaft_*_cold_*"] if has_partitions(tree, box) else [])]
    oil = "gear_oil_mean"
    walls = ["chamber_*", *inside, "seal_bore_*"]
    dips = tree.text(f"gearboxes.{box}.oil.lubrication") == "dip"
    outside = _any_overhang(tree, box)
    return {
        "air": _film(["outer_*"], "niemann_winter", "box in still room air", film_factor=(1.0, 0.7, 1.3)),
        "field": _film(["field_top", "field_sides"], "recknagel_plate", "plate in still room air"),
        "bottom": _film(["field_bottom"], "insulated", "the bed stands on its foundation"),
        "oil": _film(walls, "bath", "walls over a sump")
        if dips
        else {
            "surfaces": walls,
            "law": follows("constant_film", "walls that are wetted by thrown oil"),
            "heat_transfer_coefficient": around(300.0, "W/(m2 K)", "walls wetted by thrown oil", (1 / 3, 10 / 3)),
            "fluid": follows(oil, "oil of the gears"),
        },
        "bearings": _film(
            ["bearing_bore_*", "shaft_*_journal_*"], "bearing_film", "film of the bearing", film_factor=(1.0, 0.5, 2.0)
        ),
        "shafts": _turning(turning, "rotating_cylinder", oil, "shafts turning in the chamber", dips=dips),
        "outside": _turning(["shaft_*_outside_*"], "rotating_cylinder", "ambient", "shafts outside")
        if outside
        else None,
        "ends": _turning(["shaft_*_end_*"], "rotating_disc", "ambient", "ends of the shafts"),
        "sides": _turning(["gear_*_side_*"], "rotating_disc", oil, "faces of the gears in the chamber", dips=dips),
        "rims": _film(
            ["gear_*_rim"], "flank_film", "oil film on the flanks, tooth as a fin", film_factor=(1.0, 0.5, 2.0)
        ),
    }  # fmt: skip


def missing_films(tree: Mapping[str, Any], case: "Case") -> Iterator[tuple[str, dict[str, Any]]]:
    """Path and entry of the standard films for surfaces that the films of a case leave bare.

    tree : of the case, with its defaults
    """
    for name, box in case.gearboxes.items():
        if box.housing is None or box.housing.part_file is not None:
            continue
        try:
            films = covering(box.housing, surface_names(housing_geometry(box)))
        except (ThermalInputError, LookupError):
            continue  # what the rules of the housing name
        bare = [surface for surface, stated in films.items() if not stated]
        standard = _boundary(RawTree(dict(tree)), name) if bare else None
        for film, entry in (with_marks(standard) or {}).items():
            if on := list(matched(entry["surfaces"], bare)):
                key = f"{film}_else" if film in box.housing.boundary else film
                yield f"gearboxes.{name}.housing.boundary.{key}", {**entry, "surfaces": on}


def _any_overhang(tree: RawTree, box: str) -> bool:
    """Whether any shaft leaves the box, so that it has a surface outside."""
    at = f"gearboxes.{box}.housing.shafts"
    return any(
        (tree.length(f"{at}.{shaft}.overhang_{side}") or 0.0) > 0.0
        for shaft in tree.names(at)
        for side in ("front", "rear")
    )


def _film(
    surfaces: list[str], law: str, reason: str, film_factor: tuple[float, float, float] | None = None
) -> dict[str, object]:
    film: dict[str, object] = {"surfaces": surfaces, "law": follows(law, f"standard set: {reason}")}
    if film_factor is not None:
        value, low, high = film_factor
        film["film_factor"] = assumed(value, f"scatter of the correlation: {reason}", low, high)
    return film


def _turning(
    surfaces: list[str], law: str, fluid: str, reason: str, *, dips: bool = False
) -> dict[str, object]:
    scatter = (1.0, 0.3, 2.0) if dips else (1.0, 0.5, 2.0)
    film = _film(surfaces, law, f"{reason}, {CARRIED_OFF}" if dips else reason, scatter)
    if dips:
        film["medium"] = follows("bath", "wet up to the level of the sump at rest")
    return {**film, "fluid": follows(fluid, f"standard set: {reason}")}
