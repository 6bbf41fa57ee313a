"""Rules that span several keys: references, pairs that belong together, directions, covered surfaces."""

import math
from collections.abc import Callable, Collection, Iterator
from typing import TYPE_CHECKING

from rigdesign.case.faults import written
from rigdesign.case.paths import nearest
from rigdesign.case.substances import BUILT_IN_MATERIALS, BUILT_IN_OILS
from rigdesign.errors import Fault
from rigdesign.units import show

if TYPE_CHECKING:
    from rigdesign.case.gearbox import Gearbox
    from rigdesign.case.gears import Gear, GearMesh
    from rigdesign.case.model import Case


def broken_rules(case: "Case") -> list[Fault]:
    """Every rule the case breaks; empty for one that can be computed."""
    rules: tuple[Callable[[Case], Iterator[Fault]], ...] = (
        _substances,
        _gearboxes,
        _drivetrain,
        _losses,
        _schedule,
        _limits,
        _numerics,
    )
    faults = [fault for rule in rules for fault in rule(case)]
    if not faults:
        from rigdesign.case.surfaces import housing_faults

        faults = [fault for name, box in case.gearboxes.items() for fault in housing_faults(name, box)]
    return faults


def unknown(path: str, name: str, known: Collection[str], what: str) -> Fault:
    """A reference to a part that is not there."""
    meant = nearest(name, known, 1)
    hint = f'did you mean "{meant[0]}"? ' if meant else ""
    return Fault(path, written(name), f"no such {what}", f"{hint}known: {', '.join(known) or 'none'}")


def _substances(case: "Case") -> Iterator[Fault]:
    oils = [*case.oils, *BUILT_IN_OILS]
    materials = [*case.materials, *BUILT_IN_MATERIALS]
    for name, box in case.gearboxes.items():
        at = f"gearboxes.{name}"
        used = {f"{at}.oil.oil": box.oil.oil, f"{at}.bearing_oil.oil": box.bearing_oil.oil}
        for path, oil in used.items():
            if oil not in oils:
                yield unknown(path, oil, oils, "oil")
        used = {f"{at}.gears.{gear}.material": part.material for gear, part in box.gears.items()}
        if box.housing is not None:
            used |= {f"{at}.housing.material": box.housing.material}
            used |= {f"{at}.housing.field.material": box.housing.field.material}
            used |= {f"{at}.housing.shafts.{s}.material": part.material for s, part in box.housing.shafts.items()}
        for path, material in used.items():
            if material not in materials:
                yield unknown(path, material, materials, "material")
    if case.drivetrain is not None:
        for shaft, part in case.drivetrain.shafts.items():
            if part.material not in materials:
                yield unknown(f"drivetrain.shafts.{shaft}.material", part.material, materials, "material")


def _gearboxes(case: "Case") -> Iterator[Fault]:
    for name, box in case.gearboxes.items():
        at = f"gearboxes.{name}"
        meshed = [gear for mesh in box.meshes.values() for gear in (mesh.pinion, mesh.wheel)]
        for mesh_name, mesh in box.meshes.items():
            yield from _mesh(f"{at}.meshes.{mesh_name}", mesh, box)
        for gear_name, gear in box.gears.items():
            if gear_name not in meshed:
                yield Fault(f"{at}.gears.{gear_name}", "", "meshes with no other gear", "name it in a mesh or remove it")
            yield from _gear(f"{at}.gears.{gear_name}", gear)
        yield from _bearings(at, box)
        shafts = _shafts_of(case, box)
        for kind, parts in (("gears", box.gears), ("bearings", box.bearings), ("seals", box.seals)):
            for part_name, part in parts.items():
                if shafts and part.shaft not in shafts:
                    yield unknown(f"{at}.{kind}.{part_name}.shaft", part.shaft, shafts, "shaft")


def _shafts_of(case: "Case", box: "Gearbox") -> list[str]:
    """Shafts a part of this gearbox may sit on; empty when nothing names any."""
    if box.housing is not None:
        return list(box.housing.shafts)
    return list(case.drivetrain.shafts) if case.drivetrain is not None else []


def _gear(at: str, gear: "Gear") -> Iterator[Fault]:
    pitch = gear.flank.single_pitch
    if pitch and len(pitch) != gear.teeth:
        yield Fault(
            f"{at}.flank.single_pitch", f"{len(pitch)} entries", f"the gear has {gear.teeth} teeth",
            "write one deviation per tooth, or none",
        )  # fmt: skip


def _mesh(at: str, mesh: "GearMesh", box: "Gearbox") -> Iterator[Fault]:
    unknown_gears = [key for key in ("pinion", "wheel") if getattr(mesh, key) not in box.gears]
    for key in unknown_gears:
        yield unknown(f"{at}.{key}", getattr(mesh, key), list(box.gears), "gear in this gearbox")
    if unknown_gears:
        return
    pinion, wheel = box.gears[mesh.pinion], box.gears[mesh.wheel]
    if pinion.teeth > wheel.teeth:
        yield Fault(
            f"{at}.pinion", f'"{mesh.pinion}"', f"has {pinion.teeth} teeth, more than the wheel's {wheel.teeth}",
            "call the gear with fewer teeth the pinion",
        )  # fmt: skip
    given = [gear.profile_shift is not None for gear in (pinion, wheel)]
    if sum(given) + (mesh.profile_shift_split is not None) != 1:
        yield Fault(
            at, "", "the centre distance fixes the sum of the profile shifts, one more statement their split",
            'write profile_shift for one of the two gears, or profile_shift_split = "equal"',
        )  # fmt: skip
    if mesh.contact_ratio is not None and (pinion.tip_shortening or wheel.tip_shortening):
        yield Fault(
            f"{at}.contact_ratio", str(mesh.contact_ratio), "the tips are also cut by tip_shortening of a gear",
            "keep contact_ratio or tip_shortening",
        )  # fmt: skip
    yield from _too_close(at, mesh, pinion.teeth + wheel.teeth)


def _too_close(at: str, mesh: "GearMesh", teeth: int) -> Iterator[Fault]:
    """Two gears mesh only where cos(alpha_wt) = a_d cos(alpha_t) / a is below 1 (ISO 21771, section 5)."""
    alpha_t = math.atan(math.tan(mesh.pressure_angle) / math.cos(mesh.helix_angle))
    reference = 0.5 * mesh.normal_module * teeth / math.cos(mesh.helix_angle)
    least = reference * math.cos(alpha_t)
    if mesh.centre_distance <= least:
        yield Fault(
            f"{at}.centre_distance", show(mesh.centre_distance, "length"),
            f"these gears cannot mesh at or below {show(least, 'length')}, where their base circles touch",
            f"write a centre distance near {show(reference, 'length')}, or change module or tooth numbers",
        )  # fmt: skip


def _bearings(at: str, box: "Gearbox") -> Iterator[Fault]:
    locating = [bearing.shaft for bearing in box.bearings.values() if bearing.locating]
    for name, bearing in box.bearings.items():
        here = f"{at}.bearings.{name}"
        if bearing.locating and locating.count(bearing.shaft) > 1:
            yield Fault(
                f"{here}.locating", "true", f"shaft {bearing.shaft} is fixed axially more than once",
                "let one bearing per shaft be locating",
            )  # fmt: skip
        if bearing.diametral_clearance >= 0.05 * bearing.diameter:
            yield Fault(
                f"{here}.diametral_clearance", show(bearing.diametral_clearance, "length"),
                f"is above a twentieth of the diameter {show(bearing.diameter, 'length')}",
                "write bore minus journal, usually 0.001 to 0.003 of the diameter",
            )  # fmt: skip
        if bearing.axial_play and not bearing.locating:
            yield Fault(
                f"{here}.axial_play", show(bearing.axial_play, "length"), "the bearing is not locating",
                "give the play to the locating bearing of this shaft",
            )  # fmt: skip


def _drivetrain(case: "Case") -> Iterator[Fault]:
    train = case.drivetrain
    if train is None:
        return
    shafts = list(train.shafts)
    gears = {f"{name}.{gear}": part for name, box in case.gearboxes.items() for gear, part in box.gears.items()}
    lengths = {name: math.fsum(s.length for s in shaft.sections) for name, shaft in train.shafts.items()}
    for name, shaft in train.shafts.items():
        for index, section in enumerate(shaft.sections):
            if section.inner_diameter >= section.outer_diameter:
                yield Fault(
                    f"drivetrain.shafts.{name}.sections.{index}.inner_diameter",
                    show(section.inner_diameter, "length"),
                    f"is not below the outer diameter {show(section.outer_diameter, 'length')}",
                    "write the bore of the section",
                )
        for disc_name, disc in shaft.discs.items():
            yield from _on_shaft(f"drivetrain.shafts.{name}.discs.{disc_name}.position", disc.position, lengths[name])
    for name, coupling in train.couplings.items():
        for shaft_name in coupling.shafts:
            if shaft_name not in shafts:
                yield unknown(f"drivetrain.couplings.{name}.shafts", shaft_name, shafts, "shaft")
        if coupling.shafts[0] == coupling.shafts[1]:
            yield Fault(
                f"drivetrain.couplings.{name}.shafts", written(coupling.shafts[0]), "joins a shaft to itself",
                "name two shafts",
            )  # fmt: skip
    if train.motor.shaft not in shafts:
        yield unknown("drivetrain.motor.shaft", train.motor.shaft, shafts, "shaft")
    if train.torque_at not in gears:
        yield unknown("drivetrain.torque_at", train.torque_at, list(gears), "gear (gearbox.gear)")
    yield from _bracing(case, gears)
    for name, box in case.gearboxes.items():
        for kind, parts in (("gears", box.gears), ("bearings", box.bearings)):
            for part_name, part in parts.items():
                path = f"gearboxes.{name}.{kind}.{part_name}"
                if part.shaft not in shafts:
                    yield unknown(f"{path}.shaft", part.shaft, shafts, "shaft in the drivetrain")
                elif part.position is None:
                    yield Fault(
                        f"{path}.position", "", "a part on a shaft of the drivetrain needs its place",
                        "add the distance of its middle from the start of the shaft",
                    )  # fmt: skip
                else:
                    yield from _on_shaft(f"{path}.position", part.position, lengths[part.shaft])


def _on_shaft(path: str, position: float, length: float) -> Iterator[Fault]:
    if position > length * (1.0 + 1e-9):
        yield Fault(
            path, show(position, "length"), f"lies beyond the end of the shaft at {show(length, 'length')}",
            "move the part or lengthen the shaft",
        )  # fmt: skip


def _bracing(case: "Case", gears: "dict[str, Gear]") -> Iterator[Fault]:
    assert case.drivetrain is not None
    bracing, couplings = case.drivetrain.bracing, case.drivetrain.couplings
    at = "drivetrain.bracing"
    if bracing.coupling is not None and bracing.coupling not in couplings:
        yield unknown(f"{at}.coupling", bracing.coupling, list(couplings), "coupling")
    if bracing.shifted_gear is not None and bracing.shifted_gear not in gears:
        yield unknown(f"{at}.shifted_gear", bracing.shifted_gear, list(gears), "gear (gearbox.gear)")
    if bracing.mode == "twist_held" and bracing.coupling is None:
        yield Fault(f"{at}.coupling", "", "a held twist needs the coupling it is made in", "name a coupling")
    if bracing.mode == "shift_held" and bracing.shifted_gear is None:
        yield Fault(f"{at}.shifted_gear", "", "a held shift needs the gear that is shifted", "name a helical gear")
    if bracing.coupling is None and bracing.shifted_gear is None:
        yield Fault(
            at, "", "nothing makes the torque", "name the coupling that is twisted or the helical gear that is shifted"
        )
    if bracing.shifted_gear in gears:
        box, _, gear = bracing.shifted_gear.partition(".")
        helices = [m.helix_angle for m in case.gearboxes[box].meshes.values() if gear in (m.pinion, m.wheel)]
        if not any(helices):
            yield Fault(
                f"{at}.shifted_gear", written(bracing.shifted_gear), "its helix angle is zero, a shift makes no torque",
                "name a helical gear or brace by the twist of a coupling",
            )  # fmt: skip


def _losses(case: "Case") -> Iterator[Fault]:
    losses = case.losses
    stages = [stage.name for stage in case.schedule.stages]
    if losses.basis == "computed" and case.drivetrain is None:
        yield Fault(
            "losses.basis", '"computed"', "losses can only be computed with a drivetrain",
            'add a [drivetrain] table, or write basis = "input" and give the losses',
        )  # fmt: skip
    if losses.basis == "computed" and losses.chamber_density is None:
        yield Fault(
            "losses.chamber_density", "", "windage needs the density round the gears",
            'add it, e.g. { value = "5 kg/m3", assumed = "oil mist", range = ["1.2 kg/m3", "20 kg/m3"] }',
        )  # fmt: skip
    if losses.basis == "input" and not losses.given:
        yield Fault("losses.given", "", "no loss is given", "add a table per place, e.g. [losses.given.test_mesh]")
    if losses.friction.law == "constant" and losses.friction.coefficient is None:
        yield Fault("losses.friction.coefficient", "", "a constant friction needs its coefficient", "add it, e.g. 0.04")
    for name, loss in losses.given.items():
        at = f"losses.given.{name}"
        if loss.gearbox not in case.gearboxes:
            yield unknown(f"{at}.gearbox", loss.gearbox, list(case.gearboxes), "gearbox")
            continue
        parts = _parts_that_lose(case.gearboxes[loss.gearbox], loss.kind)
        if loss.part not in parts:
            yield unknown(f"{at}.part", loss.part, parts, f"part with {loss.kind} loss in gearbox {loss.gearbox}")
        for stage in loss.stages:
            if stage not in stages:
                yield unknown(f"{at}.stages", stage, stages, "stage")
    if losses.bearing_drag == "constant":
        for box_name, box in case.gearboxes.items():
            for name, bearing in box.bearings.items():
                if bearing.torsional_damping is None:
                    yield Fault(
                        f"gearboxes.{box_name}.bearings.{name}.torsional_damping", "",
                        "a constant bearing drag needs it", 'add it, e.g. "0.0007 N m s/rad"',
                    )  # fmt: skip


def _parts_that_lose(box: "Gearbox", kind: str) -> list[str]:
    return {
        "mesh": list(box.meshes),
        "squeeze": list(box.meshes),
        "oil_acceleration": list(box.meshes),
        "bearing": list(box.bearings),
        "seal": list(box.seals),
        "windage": list(box.gears),
    }[kind]


def _schedule(case: "Case") -> Iterator[Fault]:
    names = [stage.name for stage in case.schedule.stages]
    for name in dict.fromkeys(names):
        if names.count(name) > 1:
            yield Fault(f"schedule.stages.{name}", "", f"{names.count(name)} stages have this name", "rename all but one")
    for stage in case.schedule.resolved():
        at = f"schedule.stages.{stage.name}"
        changes = {"speed": (stage.speed_start, stage.speed_end), "torque": (stage.torque_start, stage.torque_end)}
        rising = {"run_up": "speed", "load": "torque"}.get(stage.kind)
        falling = {"run_down": "speed", "unload": "torque"}.get(stage.kind)
        for quantity, (start, end) in changes.items():
            path, given = f"{at}.{quantity}", show(end, quantity)
            before = f"the stage before ends at {show(start, quantity)}"
            if quantity == rising and end <= start:
                yield Fault(path, given, f"does not rise in a {stage.kind} stage, {before}", _direction(stage.kind))
            elif quantity == falling and end >= start:
                yield Fault(path, given, f"does not fall in a {stage.kind} stage, {before}", _direction(stage.kind))
            elif quantity not in (rising, falling) and not math.isclose(start, end, rel_tol=1e-9, abs_tol=1e-9):
                yield Fault(path, given, f"changes in a {stage.kind} stage, {before}", _direction(stage.kind))
        if stage.held and stage.kind != "dwell":
            yield Fault(f"{at}.held", "true", "only a dwell can be held at steady temperatures", "make it a dwell")
    if not any(stage.held for stage in case.schedule.stages):
        yield Fault("schedule.stages", "", "no stage is held", "write held = true in the dwell whose temperatures count")
    if case.schedule.test_speed <= 0.0:
        yield Fault("schedule.test_speed", show(case.schedule.test_speed, "speed"), "is not above 0 rpm", "correct it")


def _direction(kind: str) -> str:
    what = {"run_up": "speed up", "run_down": "speed down", "load": "torque up", "unload": "torque down"}
    change = what.get(kind, "neither")
    return f'a {kind} stage changes the {change} and nothing else; correct the value or the kind of the stage'


def _limits(case: "Case") -> Iterator[Fault]:
    from rigdesign.case.paths import known_paths, nearest_paths

    plain = case.model_dump(mode="python")
    paths: list[str] = []
    for name, bought in case.limits.bought_parts.items():
        paths = paths or known_paths(type(case), plain)
        if bought.part not in paths or _missing(plain, bought.part):
            present = [path for path in paths if not _missing(plain, path)]
            meant = nearest_paths(bought.part, present, 2)
            yield Fault(
                f"limits.bought_parts.{name}.part", written(bought.part), "no such part in this case",
                "did you mean " + " or ".join(meant) + "?" if meant else "write the case path of the part",
            )  # fmt: skip


def _missing(plain: object, path: str) -> bool:
    node = plain
    for key in path.split("."):
        if not isinstance(node, dict) or node.get(key) is None:
            return True
        node = node[key]
    return False


def _numerics(case: "Case") -> Iterator[Fault]:
    numbers = case.numerics
    if numbers.curve_speed_start >= numbers.curve_speed_end:
        yield Fault(
            "numerics.curve_speed_start", show(numbers.curve_speed_start, "speed"),
            f"is not below curve_speed_end = {show(numbers.curve_speed_end, 'speed')}", "exchange or correct them",
        )  # fmt: skip
    if not 0.0 < numbers.torque_tolerance <= 0.1:
        yield Fault(
            "numerics.torque_tolerance", str(numbers.torque_tolerance), "is not within 0 and 0.1", "write e.g. 0.001"
        )
