"""Gear pairs of a case: geometry as drawn from centre distance, tips, shifts and bodies."""

from collections.abc import Mapping

import numpy as np

from dynamics.errors import DynamicsInputError
from dynamics.gear.cylindrical_gear import CylindricalGear, Rack
from dynamics.gear.flank import require_whole_flanks
from dynamics.gear.involute import shift_sum
from dynamics.gear.microgeometry import Topography
from dynamics.gear.pair import GearPair
from dynamics.gear.pair_geometry import GearBodies, TipShortening
from dynamics.gear.tooth_form import FlankEnds, GearDetails, TipEdge
from rigdesign.base.errors import CaseError, Fault, named
from rigdesign.base.part_name import MeshName
from rigdesign.case.faults import written
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.gears import Gear, GearMesh
from rigdesign.case.model import Case
from rigdesign.case.topography_file import TopographyGrid, read_topography
from rigdesign.properties.materials import Material


def build_pairs(case: Case, materials: Mapping[str, Material]) -> dict[MeshName, GearPair]:
    """Gear pair as drawn of every mesh by ``gearbox.mesh``.

    Raises
    ------
    GearGeometryError
        Gears that cannot be made or cannot mesh; pointed teeth; undercut or protuberance within the path of contact.
    """
    pairs: dict[MeshName, GearPair] = {}
    for box_name, box in case.gearboxes.items():
        for mesh_name, mesh in box.meshes.items():
            with named(f"gearboxes.{box_name}.meshes.{mesh_name}"):
                pair = build_pair(box, mesh, materials)
                require_whole_flanks(pair)
                pairs[MeshName(box_name, mesh_name)] = pair
    return pairs


def build_pair(box: Gearbox, mesh: GearMesh, materials: Mapping[str, Material]) -> GearPair:
    """Gear pair as drawn of one mesh."""
    pinion, wheel = box.gears[mesh.pinion], box.gears[mesh.wheel]
    solid = [materials[gear.material] for gear in (pinion, wheel)]
    rack = Rack(addendum=mesh.rack.addendum, dedendum=mesh.rack.dedendum, tip_radius=mesh.rack.tip_radius)
    bodies: GearBodies = {
        "pressure_angle": mesh.pressure_angle,
        "helix_angle": mesh.helix_angle,
        "racks": (rack, rack),
        "bore_diameters": (pinion.bore_diameter, wheel.bore_diameter),
        "thickness_allowances": (pinion.tooth_thinning, wheel.tooth_thinning),
        "youngs_moduli": (solid[0].elastic_modulus, solid[1].elastic_modulus),
        "poisson_ratios": (solid[0].poisson_ratio, solid[1].poisson_ratio),
        "densities": (solid[0].density, solid[1].density),
        "details": (_details(pinion, mesh), _details(wheel, mesh)),
    }
    first = mesh.profile_shift_split or _pinion_shift(box, mesh)
    assert first is not None
    return GearPair.from_centre_distance(
        normal_module=mesh.normal_module,
        teeth=(pinion.teeth, wheel.teeth),
        centre_distance=mesh.centre_distance,
        face_widths=(pinion.face_width, wheel.face_width),
        profile_shift_1=first,
        tips=TipShortening(
            shortening=(pinion.tip_shortening, wheel.tip_shortening),
            contact_ratio=mesh.contact_ratio,
            cut_gear=mesh.tip_cut or "both",
        ),
        **bodies,
    )


def _details(gear: Gear, mesh: GearMesh) -> GearDetails:
    edge, rack = gear.tip_edge, mesh.rack
    return GearDetails(
        tip_edge=TipEdge(rounding=edge.rounding, chamfer=edge.chamfer),
        protuberance=rack.protuberance * mesh.normal_module,
        protuberance_angle=rack.protuberance_angle,
        rim_thickness=gear.rim_thickness,
        web_thickness=gear.web_thickness,
    )


def _pinion_shift(box: Gearbox, mesh: GearMesh) -> float | None:
    """Profile shift of the pinion, stated or as what the wheel's leaves of the sum."""
    pinion, wheel = box.gears[mesh.pinion], box.gears[mesh.wheel]
    if pinion.profile_shift is not None or wheel.profile_shift is None:
        return pinion.profile_shift

    total = shift_sum(
        mesh.normal_module,
        mesh.pressure_angle,
        mesh.helix_angle,
        (pinion.teeth, wheel.teeth),
        mesh.centre_distance,
    )
    return total - wheel.profile_shift


# Measured topographies of the gears of a case, held against their flanks.

FlankTopographies = tuple[Topography | None, Topography | None]
"""Of the front and back flanks of a gear."""
NOT_MEASURED: FlankTopographies = (None, None)
KEYS = ("topography", "back_topography")


def flank_topographies(case: Case, pairs: Mapping[MeshName, GearPair]) -> dict[str, FlankTopographies]:
    """Topographies by ``gearbox.gear`` of the gears that have any.

    Raises
    ------
    CaseError
        As `rigdesign.case.topography_file.read_topography`, and for a grid that does not cover the flank from form to
        tip circle and the whole face, or has the flanks of some teeth only.
    """
    found = {}
    for box_name, box in case.gearboxes.items():
        for mesh_name, mesh in box.meshes.items():
            pair = pairs[MeshName(box_name, mesh_name)]
            for name, toothing, ends in zip((mesh.pinion, mesh.wheel), pair.gears, pair.flanks, strict=True):
                gear = box.gears[name]
                if gear.flank.topography is None and gear.flank.back_topography is None:
                    continue
                at = f"gearboxes.{box_name}.gears.{name}.flank"
                front, back = (_topography(case, gear, (toothing, ends), f"{at}.{key}") for key in KEYS)
                found[f"{box_name}.{name}"] = front, back
    return found


def _topography(
    case: Case, gear: Gear, flank: tuple[CylindricalGear, FlankEnds], at: str
) -> Topography | None:
    toothing, involute = flank
    name = getattr(gear.flank, at.rpartition(".")[2])
    if name is None:
        return None
    grid = read_topography(case.path.parent / name, at, case.path)
    if len(grid.removed) not in (1, gear.teeth):
        problem = f"has the flanks of {len(grid.removed)} teeth, the gear has {gear.teeth}"
        raise CaseError([Fault(at, written(name), problem, "give all teeth or one for all")], str(case.path))
    try:
        topography = Topography(
            roll_angle=_roll_angle(grid, toothing),
            face=np.array(grid.face),
            removed=np.array(grid.removed),
            interpolation=gear.flank.topography_interpolation,
        )
        ends = (toothing.roll_length(radius) for radius in (involute.form_radius, involute.tip_radius))
        root, tip = (roll / toothing.base_radius for roll in ends)
        topography.require_cover((root, tip), gear.face_width)
    except DynamicsInputError as error:
        problem, _, remedy = str(error).removeprefix("topography: ").rpartition("; ")
        raise CaseError([Fault(at, written(name), problem, remedy)], str(case.path)) from None
    return topography


def _roll_angle(
    grid: TopographyGrid, toothing: CylindricalGear
) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    places, base = np.array(grid.profile), toothing.base_radius
    if grid.coordinate == "roll_angle":
        return places
    if grid.coordinate == "roll_length":
        return places / base
    if places[0] < 2.0 * base:
        raise DynamicsInputError(
            f"diameter {1e3 * places[0]:.3f} mm is below the base diameter {2e3 * base:.3f} mm; "
            "remove places without involute"
        )
    return np.sqrt((0.5 * places / base) ** 2 - 1.0)
