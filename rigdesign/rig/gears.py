"""Gear pairs of a case: geometry as drawn from centre distance, tips, shifts and bodies."""

from collections.abc import Mapping

from dynamics.flank.field import require_whole_flanks
from dynamics.gear.cylindrical_gear import Rack
from dynamics.gear.details import GearDetails
from dynamics.gear.pair import GearPair
from dynamics.gear.pair_geometry import GearBodies, TipShortening
from dynamics.gear.tooth_form import TipEdge
from rigdesign.base.errors import named
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.gears import Gear, GearMesh
from rigdesign.case.model import Case
from rigdesign.properties.materials import Material


def build_pairs(case: Case, materials: Mapping[str, Material]) -> dict[str, GearPair]:
    """Gear pair as drawn of every mesh by ``gearbox.mesh``.

    Raises
    ------
    GearGeometryError
        Gears that cannot be made or cannot mesh; pointed teeth; undercut or protuberance within the path of contact.
    """
    pairs = {}
    for box_name, box in case.gearboxes.items():
        for mesh_name, mesh in box.meshes.items():
            with named(f"gearboxes.{box_name}.meshes.{mesh_name}"):
                pair = build_pair(box, mesh, materials)
                require_whole_flanks(pair)
                pairs[f"{box_name}.{mesh_name}"] = pair
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
    from dynamics.gear.line_of_action import shift_sum

    total = shift_sum(
        mesh.normal_module,
        mesh.pressure_angle,
        mesh.helix_angle,
        (pinion.teeth, wheel.teeth),
        mesh.centre_distance,
    )
    return total - wheel.profile_shift
