"""What defaults need to know of the parts of a gearbox before it is validated: pairs, diameters, distances."""

import math
from typing import TYPE_CHECKING

from rigdesign.case.defaults.rule import RawTree

if TYPE_CHECKING:
    from dynamics.rotor.rolling_catalogue import CatalogueBearing


def shaft_of(tree: RawTree, box: str, kind: str, part: str) -> str | None:
    """Shaft of a gear, a bearing or seals."""
    return tree.text(f"gearboxes.{box}.{kind}.{part}.shaft")


def shafts_of(tree: RawTree, box: str) -> list[str]:
    """Shafts of the gears of a gearbox, each once."""
    found = (shaft_of(tree, box, "gears", gear) for gear in tree.names(f"gearboxes.{box}.gears"))
    return list(dict.fromkeys(shaft for shaft in found if shaft is not None))


def gear_on(tree: RawTree, box: str, shaft: str) -> str | None:
    """First gear on a shaft."""
    gears = tree.names(f"gearboxes.{box}.gears")
    return next((gear for gear in gears if shaft_of(tree, box, "gears", gear) == shaft), None)


def only_mesh(tree: RawTree, box: str) -> str | None:
    """The mesh of a gearbox that has one; None for any other."""
    meshes = tree.names(f"gearboxes.{box}.meshes")
    return meshes[0] if len(meshes) == 1 else None


def mesh_of(tree: RawTree, box: str, gear: str) -> str | None:
    """First mesh that a gear is in."""
    for mesh in tree.names(f"gearboxes.{box}.meshes"):
        at = f"gearboxes.{box}.meshes.{mesh}"
        if gear in (tree.text(f"{at}.pinion"), tree.text(f"{at}.wheel")):
            return mesh
    return None


def normal_module(tree: RawTree, box: str, gear: str) -> float | None:
    """Normal module of a gear [m]."""
    mesh = mesh_of(tree, box, gear)
    return None if mesh is None else tree.length(f"gearboxes.{box}.meshes.{mesh}.normal_module")


def root_diameter(tree: RawTree, box: str, gear: str) -> float | None:
    """Root circle [m] of rack A of ISO 53, without profile shift where the gear states none."""
    mesh, at = mesh_of(tree, box, gear), f"gearboxes.{box}.gears.{gear}"
    module, teeth = normal_module(tree, box, gear), tree.number(f"{at}.teeth")
    if mesh is None or module is None or teeth is None:
        return None
    helix = tree.si(f"gearboxes.{box}.meshes.{mesh}.helix_angle", "angle") or 0.0
    shift = tree.number(f"{at}.profile_shift") or 0.0
    return module * (teeth / math.cos(helix) + 2.0 * shift - 2.5)


def bearings_on(tree: RawTree, box: str, shaft: str) -> list[str]:
    """Bearings of a shaft by name."""
    bearings = tree.names(f"gearboxes.{box}.bearings")
    return [name for name in bearings if shaft_of(tree, box, "bearings", name) == shaft]


def tabled(tree: RawTree, box: str, bearing: str) -> "CatalogueBearing | None":
    """The rolling bearing of the catalogue that a bearing names; None for any other."""
    designation = tree.text(f"gearboxes.{box}.bearings.{bearing}.designation")
    if designation is None:
        return None
    from dynamics.rotor.bearing import BearingError
    from dynamics.rotor.rolling_catalogue import catalogue_bearing

    try:
        return catalogue_bearing(designation)
    except BearingError:
        return None


def bearing_bore(tree: RawTree, box: str, bearing: str) -> float | None:
    """Journal or bore of a bearing [m]: stated, or that of its designation."""
    at = f"gearboxes.{box}.bearings.{bearing}"
    found = tabled(tree, box, bearing)
    if found is not None:
        return found.bore
    stated = tree.length(f"{at}.diameter")
    return tree.length(f"{at}.catalogue.bore") if stated is None else stated


def bearing_width(tree: RawTree, box: str, bearing: str) -> float | None:
    """Width of a bearing [m]: stated, or that of its designation."""
    at = f"gearboxes.{box}.bearings.{bearing}"
    found = tabled(tree, box, bearing)
    if found is not None:
        return found.width
    stated = tree.length(f"{at}.width")
    return tree.length(f"{at}.catalogue.width") if stated is None else stated


def shaft_diameter(tree: RawTree, box: str, shaft: str) -> float | None:
    """Diameter of a shaft in its bearings [m], the smaller one where they differ."""
    return min(bearing_bores(tree, box, shaft), default=None)


def bearing_bores(tree: RawTree, box: str, shaft: str) -> list[float]:
    """Known bores of the bearings of a shaft [m]."""
    bores = (bearing_bore(tree, box, name) for name in bearings_on(tree, box, shaft))
    return [bore for bore in bores if bore is not None]


def section_diameter(tree: RawTree, shaft: str, position: float | None) -> float | None:
    """Outside diameter [m] of a stated shaft at a place; None where no section is stated there."""
    at, end = f"drivetrain.shafts.{shaft}.sections", 0.0
    for index in range(tree.count(at)):
        length = tree.length(f"{at}.{index}.length")
        if position is None or length is None:
            return None
        end += length
        if position <= end:
            return tree.length(f"{at}.{index}.outer_diameter")
    return None


def inner_length(tree: RawTree, box: str) -> float | None:
    """Length between the end walls of a housing [m]."""
    at = f"gearboxes.{box}.housing"
    chamber = tree.length(f"{at}.warm_length")
    if chamber is None:
        return None
    front, rear = tree.length(f"{at}.cold_length_front"), tree.length(f"{at}.cold_length_rear")
    partition = tree.length(f"{at}.partition_thickness")
    return chamber + (front or 0.0) + (rear or 0.0) + 2.0 * (partition or 0.0)


def bearing_distance(tree: RawTree, box: str, shaft: str) -> float | None:
    """Distance of the two bearings of a shaft [m]: at the inner side of the end walls; three diameters beside the gear
    in a gearbox without a housing."""
    if tree.has(f"gearboxes.{box}.housing"):
        inner = inner_length(tree, box)
        found = (bearing_width(tree, box, name) for name in bearings_on(tree, box, shaft))
        widths = [width for width in found if width is not None]
        return None if inner is None or not widths else inner + sum(widths) / len(widths)
    gear, diameter = gear_on(tree, box, shaft), shaft_diameter(tree, box, shaft)
    face = None if gear is None else tree.length(f"gearboxes.{box}.gears.{gear}.face_width")
    return None if face is None or diameter is None else face + 3.0 * diameter
