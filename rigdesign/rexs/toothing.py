"""Cylindrical gears and their meshes."""

from dataclasses import replace
from math import cos

from rigdesign.rexs.attribute_log import AttributeLog
from rigdesign.rexs.gear_unit import UnitGear, UnitMesh
from rigdesign.rexs.model import Component, RexsModel
from rigdesign.rexs.positions import gear_position, shaft_of

_APPLICATION_FACTORS = (
    "application_factor_iso_6336_2019", "application_factor_iso_6336_2006", "application_factor_din_3990_1987",
)  # fmt: skip
_DEEPEST_TIP, _HIGHEST_TIP = -1.25, 2.0
"""Modules from the shifted reference circle between which a tip circle lies."""


def read_gears(model: RexsModel, log: AttributeLog) -> tuple[UnitGear, ...]:
    """Cylindrical gears with outer teeth, in the order of the file."""
    return tuple(_gear(model, log, component) for component in model.of_type("cylindrical_gear"))


def read_meshes(model: RexsModel, log: AttributeLog, gears: tuple[UnitGear, ...]) -> tuple[UnitMesh, ...]:
    """Cylindrical stages of two such gears; stages with a ring gear are left out."""
    known = {gear.id: gear for gear in gears}
    meshes = []
    for stage in model.of_type("cylindrical_stage"):
        relations = model.relations_of("stage", "stage", stage.id)
        pair = [relations[0].with_role(role) for role in ("gear_1", "gear_2")] if relations else [None, None]
        first, second = (known.get(number) if number is not None else None for number in pair)
        if first is not None and second is not None and first is not second:
            meshes.append(_mesh(model, log, stage, first, second))
        else:
            log.list_rest(stage, "a stage that is not of two cylindrical gears with outer teeth")
    return tuple(meshes)


def _gear(model: RexsModel, log: AttributeLog, component: Component) -> UnitGear:
    here = f"gears[{component.id}]"
    width = log.number(component, "face_width", "mm", f"{here}.face_width", above=0.0)
    gear = UnitGear(
        id=component.id,
        name=component.name,
        shaft=shaft_of(model, component.id),
        position=gear_position(model, log, component, width),
        teeth=log.whole_number(component, "number_of_teeth", f"{here}.teeth", least=3),
        normal_module=log.number(component, "normal_module", "mm", f"{here}.normal_module", above=0.0),
        helix_angle=log.number(component, "helix_angle_reference_diameter", "deg", f"{here}.helix_angle"),
        face_width=width,
        tip_diameter=log.number(component, "tip_diameter", "mm", f"{here}.tip_diameter", above=0.0),
        bore_diameter=log.number(component, "inner_diameter", "mm", f"{here}.bore_diameter"),
        quality_grade=log.whole_number(
            component, "global_tolerance_class_iso_1328_2013", f"{here}.quality_grade", least=1
        ),
        flank_roughness=log.number(
            component,
            "arithmetic_mean_roughness_flank_iso_4287_1997",
            "mum",
            f"{here}.flank_roughness",
            above=0.0,
        ),
        material=_material_of(model, component.id),
    )
    return _with_plausible_tip(log, component, _with_flanks(model, log, component, gear))


def _with_flanks(model: RexsModel, log: AttributeLog, component: Component, gear: UnitGear) -> UnitGear:
    """Pressure angle and profile shift, which REXS states of each flank; the left one counts."""
    flanks = [
        flank for side in ("left", "right") for flank in model.related("flank", "gear", component.id, side)
    ]
    here = f"gears[{gear.id}]"
    angles = [
        log.number(flank, "normal_pressure_angle", "deg", f"{here}.pressure_angle", above=0.0)
        for flank in (*flanks, component)
    ]
    shifts = [_profile_shift(log, flank, gear, here) for flank in (*flanks, component)]
    for attribute, values in (
        ("normal_pressure_angle", angles), ("addendum_modification_coefficient", shifts),
    ):  # fmt: skip
        for flank, value in zip(flanks[1:], values[1:], strict=False):
            if value is not None and values[0] is not None and abs(value - values[0]) > 1e-9:
                log.refuse(flank, attribute, "not that of the left flank, which counts for both")
    return replace(gear, pressure_angle=_first(angles), profile_shift=_first(shifts))


def _profile_shift(log: AttributeLog, flank: Component, gear: UnitGear, here: str) -> float | None:
    target = f"{here}.profile_shift"
    stated = log.number(flank, "addendum_modification_coefficient", "none", target)
    if stated is not None or gear.normal_module is None:
        return stated
    length = log.number(flank, "addendum_modification", "mm", target)
    return None if length is None else length / gear.normal_module


def _with_plausible_tip(log: AttributeLog, component: Component, gear: UnitGear) -> UnitGear:
    """Drop a tip diameter that cannot be that of the gear; some exporters write 1 mm for one that is not set."""
    module, tip = gear.normal_module, gear.tip_diameter
    if module is None or gear.teeth is None or tip is None or gear.teeth > 10_000:
        return gear
    reference = gear.teeth * module / max(abs(cos(gear.helix_angle or 0.0)), 0.1)
    least, most = (
        reference + 2.0 * module * ((gear.profile_shift or 0.0) + height)
        for height in (_DEEPEST_TIP, _HIGHEST_TIP)
    )
    if least < tip < most:
        return gear
    reason = f"not the tip of {gear.teeth} teeth of this module ({least * 1e3:.4g} to {most * 1e3:.4g} mm)"
    log.refuse(component, "tip_diameter", reason)
    return replace(gear, tip_diameter=None)


def _mesh(
    model: RexsModel, log: AttributeLog, stage: Component, first: UnitGear, second: UnitGear
) -> UnitMesh:
    here = f"meshes[{stage.id}]"
    swapped = first.teeth is not None and second.teeth is not None and second.teeth < first.teeth
    pinion, wheel = (second, first) if swapped else (first, second)
    factors = [
        log.number(stage, name, "none", f"{here}.application_factor", above=0.0)
        for name in _APPLICATION_FACTORS
    ]
    return UnitMesh(
        id=stage.id,
        name=stage.name,
        pinion=pinion.id,
        wheel=wheel.id,
        centre_distance=log.number(stage, "center_distance", "mm", f"{here}.centre_distance", above=0.0),
        application_factor=_first(factors),
        face_load_factor=log.number(
            stage, "face_load_factor_contact_stress", "none", f"{here}.face_load_factor", above=0.0
        ),
    )


def _material_of(model: RexsModel, part: int) -> int | None:
    found = model.related("reference", "origin", part, "referenced")
    return next((item.id for item in found if item.type == "material"), None)


def _first(values: list[float | None]) -> float | None:
    return next((value for value in values if value is not None), None)
