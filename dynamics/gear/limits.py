"""What a gear pair must respect to be makeable and to mesh, and what is worth a warning."""

from dynamics.gear.involute import GearGeometryError
from dynamics.gear.pair_geometry import PairGeometry

NAMES = ("pinion", "wheel")
FILLET_OVERLAP_LIMIT = 0.02
"""Overlap of a mating flank with the fillet, in normal modules, above which the pair is refused."""
THIN_RIM, NO_RIM = 1.2, 0.5
"""Rim under the root, in tooth heights: below the first it adds to the root stress, at the second it carries no
tooth (ISO 6336-3:2006, clause 9)."""


def require_sizes(pair: PairGeometry) -> None:
    """Raise GearGeometryError for numbers that describe no gear."""
    positive = {
        "normal_module": (pair.normal_module, "m"),
        "centre_distance": (pair.centre_distance, "m"),
        "face_widths[0]": (pair.face_widths[0], "m"),
        "face_widths[1]": (pair.face_widths[1], "m"),
        "teeth[0]": (pair.teeth[0], ""),
        "teeth[1]": (pair.teeth[1], ""),
    }
    for name, (value, unit) in positive.items():
        if not value > 0.0:
            raise GearGeometryError(f"{name} = {value} {unit} must be positive; correct the gear data")
    for i in (0, 1):
        if not 0.0 <= pair.bore_diameters[i] < 2.0 * pair.root_radii[i]:
            raise GearGeometryError(
                f"bore_diameters[{i}] = {1e3 * pair.bore_diameters[i]:.3f} mm must lie between 0 and the "
                f"root diameter {2e3 * pair.root_radii[i]:.3f} mm; reduce the bore"
            )
        if not pair.tip_radii[i] > pair.gears[i].form_radius:
            raise GearGeometryError(
                f"tip_diameters[{i}] = {1e3 * pair.tip_diameters[i]:.3f} mm must exceed the form diameter "
                f"{2e3 * pair.gears[i].form_radius:.3f} mm; no involute is left: "
                "increase tip diameter or shift"
            )
        _require_rim(pair, i)
    if not sum(pair.base_radii) < pair.centre_distance:
        raise GearGeometryError(
            f"centre_distance = {1e3 * pair.centre_distance:.4f} mm gives no working pressure angle: it must "
            f"exceed the sum of the base radii, {1e3 * sum(pair.base_radii):.4f} mm; "
            "increase it or reduce module, teeth or helix angle"
        )


def _require_rim(pair: PairGeometry, index: int) -> None:
    """Raise GearGeometryError for a rim that is too thin for its teeth or reaches into the bore."""
    rim, bore = pair.details[index].rim_thickness, pair.bore_diameters[index]
    web = pair.details[index].web_thickness
    if rim is not None and pair.root_radii[index] - rim <= 0.5 * bore:
        raise GearGeometryError(
            f"{NAMES[index]}: rim_thickness = {1e3 * rim:.3f} mm reaches into the bore, limit "
            f"{1e3 * (pair.root_radii[index] - 0.5 * bore):.3f} mm between root circle and bore; reduce it, or leave "
            "it out for a solid body"
        )
    if web is not None and (rim is None or not 0.0 < web <= pair.face_widths[index]):
        raise GearGeometryError(
            f"{NAMES[index]}: web_thickness = {1e3 * web:.3f} mm needs a rim_thickness and must lie above 0 and at "
            f"most at the face width {1e3 * pair.face_widths[index]:.3f} mm; correct it"
        )
    height = rim_in_tooth_heights(pair, index)
    if (bore or rim is not None) and height <= NO_RIM:
        subject = (
            f"bore_diameters[{index}] = {1e3 * bore:.3f} mm leaves a rim"
            if rim is None
            else f"{NAMES[index]}: rim_thickness = {1e3 * rim:.3f} mm is a rim"
        )
        raise GearGeometryError(
            f"{subject} of {height:.3f} tooth heights under the root, must exceed {NO_RIM}; "
            + ("reduce the bore" if rim is None else "make it thicker")
        )


def require_meshing(pair: PairGeometry) -> None:
    """Raise GearGeometryError for a pair at reference temperature that cannot run."""
    for name, gear in zip(NAMES, pair.gears, strict=True):
        if not gear.tip_thickness > 0.0:
            raise GearGeometryError(
                f"{name}: tip thickness {1e3 * gear.tip_thickness:.4f} mm must be positive (pointed tooth); "
                "reduce profile shift or tip diameter"
            )
    for name, clearance in zip(NAMES, pair.tip_clearances, strict=True):
        if not clearance > 0.0:
            raise GearGeometryError(
                f"{name}: tip clearance {1e3 * clearance:.4f} mm must be positive; "
                "shorten the tip, deepen the mating root or increase the centre distance"
            )
    limit = FILLET_OVERLAP_LIMIT * pair.normal_module
    for name, overlap in zip(NAMES, pair.fillet_overlaps, strict=True):
        if overlap > limit:
            raise GearGeometryError(
                f"{name}: interference, its fillet overlaps the path of the mating tip by "
                f"{1e6 * overlap:.1f} um (limit {1e6 * limit:.1f} um); "
                "shorten the mating tip or shift the profile"
            )
    ratio = pair.total_contact_ratio
    if not (ratio >= 1.0 and pair.path.length > 0.0):
        raise GearGeometryError(
            f"total contact ratio {ratio:.4f} must be at least 1 "
            f"(transverse {pair.transverse_contact_ratio:.4f}); "
            "lengthen the tips or reduce the centre distance"
        )


def rim_in_tooth_heights(pair: PairGeometry, index: int) -> float:
    """Rim under the root circle of a gear, stated or down to the bore, per height of its teeth [-]."""
    stated = pair.details[index].rim_thickness
    rim = pair.root_radii[index] - 0.5 * pair.bore_diameters[index] if stated is None else stated
    return rim / (pair.tip_radii[index] - pair.root_radii[index])


def unusual(pair: PairGeometry) -> tuple[str, ...]:
    """Warnings about a pair that can run: name, value, limit, remedy."""
    warnings: list[str] = []
    for i, name in enumerate(NAMES):
        rim = rim_in_tooth_heights(pair, i)
        stated = pair.details[i].rim_thickness is not None
        if (stated or pair.bore_diameters[i]) and rim < THIN_RIM:
            warnings.append(
                f"{name}: rim under the root {rim:.2f} tooth heights (limit {THIN_RIM}): it adds to the root stress; "
                + ("make the rim thicker" if stated else "reduce the bore")
            )
    if pair.transverse_backlash < -1e-9:
        warnings.append(
            f"backlash {1e6 * pair.transverse_backlash:.1f} um on the working pitch circles is negative: "
            "the teeth jam; thin them (thickness_allowances) or increase the centre distance"
        )
    return tuple(warnings)
