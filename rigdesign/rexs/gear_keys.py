"""Keys of gears and mesh: toothing, profile shifts that fit the centre distance, tips."""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass

from dynamics.gear.involute import GearGeometryError, shift_sum
from rigdesign.rexs.gear_stage import (
    Entry,
    GearStage,
    Origins,
    SeatedGear,
    assumed,
    millimetres,
    needed,
    quantity,
)
from rigdesign.rexs.gear_unit import UnitGear, UnitMaterial

CASE_HARDENING = re.compile(r"\d+\s*(Cr|Mn|Ni|Mo)[A-Za-z]*\s*\d")
"""Designations of alloyed steels in which case-hardening steels are written: 16MnCr5, 18CrNiMo7-6."""
LEAST_CARBON, MOST_CARBON = 10, 25
"""Hundredths of a per cent of carbon of case-hardening steels (ISO 683-3)."""
STANDARD_ANGLE = math.radians(20.0)


@dataclass(frozen=True)
class Toothing:
    """Toothing of a stage as far as the file determines it.

    centre_distance : stated, or from the profile shifts [m]
    shifts : profile shifts of pinion and wheel, None where neither file nor centre distance says it
    written : whether each shift goes into the case; that of the wheel does not where it contradicts the centre distance
    addendum : of the basic rack, in modules: that of the tip which is higher, at least 1
    """

    centre_distance: float | None
    shifts: tuple[float | None, float | None]
    written: tuple[bool, bool]
    addendum: float

    @property
    def contradiction(self) -> bool:
        """Whether stated shifts and centre distance exclude each other."""
        return self.shifts[1] is not None and self.written == (True, False)


def toothing_of(stage: GearStage) -> Toothing:
    """Centre distance, profile shifts and tips of a stage, each from the others where the file leaves it out."""
    gears = [seated.gear for seated in stage.gears]
    stated = (gears[0].profile_shift, gears[1].profile_shift)
    distance = stage.mesh.centre_distance
    total = _shift_sum(stage, distance)
    shifts, written = stated, (stated[0] is not None, stated[1] is not None)
    if distance is None and stated[0] is not None and stated[1] is not None:
        distance = _distance(stage, stated[0] + stated[1])
    elif total is not None:
        shifts, written = _fitting(stated, total)
    heights = [_height(gear, shift) for gear, shift in zip(gears, shifts, strict=True)]
    return Toothing(distance, shifts, written, max(1.0, *(height or 1.0 for height in heights)))


def _fitting(
    stated: tuple[float | None, float | None], total: float
) -> tuple[tuple[float, float], tuple[bool, bool]]:
    """Both shifts so that they fit the centre distance, and which of them the case states."""
    from rigdesign.case.rules.gears import SHIFT_TOLERANCE

    first, second = stated
    if first is None and second is None:
        return (0.5 * total, 0.5 * total), (False, False)
    if first is None:
        assert second is not None
        return (total - second, second), (False, True)
    if second is None or abs(first + second - total) > SHIFT_TOLERANCE:
        return (first, total - first), (True, False)
    return (first, second), (True, True)


def gear_entries(origins: Origins, stage: GearStage, seated: SeatedGear) -> Iterator[Entry]:
    """Keys of a gear; its material and quality only where the file states them."""
    gear, at = seated.gear, f"gears[{seated.gear.id}]"
    toothing, side = toothing_of(stage), stage.gears.index(seated)
    if gear.teeth is None:
        yield needed("teeth", "24", f"teeth of the {seated.name}")
    else:
        yield origins.stated("teeth", str(gear.teeth), f"{at}.teeth")
    if gear.face_width is None:
        yield needed("face_width", '"20 mm"', f"face width of the {seated.name}")
    else:
        yield origins.stated("face_width", millimetres(gear.face_width), f"{at}.face_width")
    shift = toothing.shifts[side]
    if toothing.written[side] and shift is not None:
        yield origins.stated("profile_shift", f"{shift:.9g}", f"{at}.profile_shift")
    height = _height(gear, shift)
    cut = 0.0 if height is None else (toothing.addendum - height) * (gear.normal_module or 0.0)
    if height is not None and cut > 1e-7:
        note = f"tip diameter {1e3 * (gear.tip_diameter or 0.0):.6g} mm"
        yield origins.stated("tip_shortening", millimetres(cut), f"{at}.tip_diameter", note=note)
    if gear.bore_diameter:
        yield origins.stated("bore_diameter", millimetres(gear.bore_diameter), f"{at}.bore_diameter")
    if side == 0 and gear.helix_angle and not stage.double_helical:
        hand = '"right"' if gear.helix_angle > 0.0 else '"left"'
        yield origins.stated("helix_hand", hand, f"{at}.helix_angle")
    if gear.quality_grade is not None and gear.quality_grade <= 11:
        yield origins.stated("quality_grade", str(gear.quality_grade), f"{at}.quality_grade")
    if gear.flank_roughness is not None:
        value = quantity(1e6 * gear.flank_roughness, "um")
        yield origins.stated("flank_roughness", value, f"{at}.flank_roughness")


def material_entry(origins: Origins, material: UnitMaterial | None) -> Entry | None:
    """The built-in steel for a case-hardening steel; None leaves it to the default."""
    designation = "" if material is None else material.designation or material.name
    found = re.match(r"\s*(\d+)", designation)
    if material is None or found is None or not CASE_HARDENING.match(designation.strip()):
        return None
    if not LEAST_CARBON <= int(found[1]) <= MOST_CARBON:
        return None
    target = f"materials[{material.id}].designation"
    return origins.stated("material", '"case_hardened_steel"', target, note=designation)


def mesh_entries(origins: Origins, stage: GearStage) -> Iterator[Entry]:
    """Keys of the mesh."""
    mesh, gear, at = stage.mesh, stage.pinion.gear, f"meshes[{stage.mesh.id}]"
    pinion = f"gears[{gear.id}]"
    if gear.normal_module is None:
        yield needed("normal_module", '"4.5 mm"', "module of the stage")
    else:
        yield origins.stated("normal_module", millimetres(gear.normal_module), f"{pinion}.normal_module")
    toothing = toothing_of(stage)
    if mesh.centre_distance is not None:
        yield origins.stated("centre_distance", millimetres(mesh.centre_distance), f"{at}.centre_distance")
    elif toothing.centre_distance is not None:
        targets = [f"gears[{seated.gear.id}].profile_shift" for seated in stage.gears]
        note = "from teeth, module and profile shifts"
        yield origins.stated("centre_distance", millimetres(toothing.centre_distance), *targets, note=note)
    else:
        yield needed("centre_distance", '"91.5 mm"', "centre distance of the stage")
    if gear.pressure_angle is not None:
        value = quantity(math.degrees(gear.pressure_angle), "deg")
        yield origins.stated("pressure_angle", value, f"{pinion}.pressure_angle")
    if gear.helix_angle is not None:
        value = quantity(abs(math.degrees(gear.helix_angle)), "deg")
        yield origins.stated("helix_angle", value, f"{pinion}.helix_angle")
    else:
        yield assumed("helix_angle", '"0 deg"', "not stated: spur gears")
    if stage.double_helical:
        targets = [f"gears[{other.pinion}].helix_angle" for other in stage.meshes]
        yield origins.stated("double_helical", "true", *targets, note="halves of opposite hand")
    if toothing.addendum > 1.0 + 1e-6:
        tips = [f"gears[{seated.gear.id}].tip_diameter" for seated in stage.gears]
        note = "the higher of the two tips, in modules"
        yield origins.stated("rack.addendum", f"{toothing.addendum:.6g}", *tips, note=note)
    if mesh.application_factor is not None and 1.0 <= mesh.application_factor <= 5.0:
        value = f"{mesh.application_factor:.9g}"
        yield origins.stated("application_factor", value, f"{at}.application_factor")
    if mesh.face_load_factor is not None and 1.0 <= mesh.face_load_factor <= 10.0:
        note = "K_Hbeta, which K_Fbeta does not exceed (ISO 6336-3)"
        value = f"{mesh.face_load_factor:.9g}"
        yield origins.stated("face_load_factor", value, f"{at}.face_load_factor", note=note)


def _height(gear: UnitGear, shift: float | None) -> float | None:
    """Tip height of a gear over its shifted reference circle, in modules."""
    module, tip = gear.normal_module, gear.tip_diameter
    if module is None or tip is None or gear.teeth is None or shift is None:
        return None
    reference = gear.teeth * module / math.cos(gear.helix_angle or 0.0)
    return 0.5 * (tip - reference) / module - shift


def _shift_sum(stage: GearStage, distance: float | None) -> float | None:
    """Sum of the profile shifts that a centre distance fixes; None where gears cannot mesh at it."""
    gear, teeth = stage.pinion.gear, _teeth(stage)
    if distance is None or gear.normal_module is None or teeth is None:
        return None

    angle, helix = gear.pressure_angle or STANDARD_ANGLE, abs(gear.helix_angle or 0.0)
    try:
        return shift_sum(gear.normal_module, angle, helix, teeth, distance)
    except GearGeometryError:
        return None


def _distance(stage: GearStage, total: float) -> float | None:
    """Centre distance [m] at which `_shift_sum` is ``total``, by bisection up to two modules beyond the shifts."""
    gear, teeth = stage.pinion.gear, _teeth(stage)
    if gear.normal_module is None or teeth is None:
        return None
    reference = 0.5 * gear.normal_module * sum(teeth) / math.cos(gear.helix_angle or 0.0)
    low, high = reference * math.cos(STANDARD_ANGLE), reference + (abs(total) + 2.0) * gear.normal_module
    for _ in range(60):
        middle = 0.5 * (low + high)
        found = _shift_sum(stage, middle)
        low, high = (middle, high) if found is None or found < total else (low, middle)
    return 0.5 * (low + high)


def _teeth(stage: GearStage) -> tuple[int, int] | None:
    first, second = (seated.gear.teeth for seated in stage.gears)
    return None if first is None or second is None else (first, second)
