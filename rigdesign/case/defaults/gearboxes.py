"""Defaults of gears, meshes, their oil, bearings and seals."""

from dynamics.rotor.rolling_kinds import ROLLING_KINDS
from rigdesign.base.part_name import GearName
from rigdesign.case.defaults.rule import (
    Filling,
    RawTree,
    RuleBook,
    around,
    assumed,
    bearing_bore,
    bearing_width,
    follows,
    millimetres,
    normal_module,
    only_mesh,
    root_diameter,
    section_diameter,
    shaft_diameter,
    shaft_of,
    shafts_of,
    tabled,
)
from rigdesign.case.rolling_bearing import ROLLING_DAMPING_TIME
from rigdesign.case.seals import END_SEALS, WALL

book = RuleBook()
THIN_RIM, WHOLE_DEPTH = 1.2, 2.25
"""Rim in tooth heights below which it adds to the root stress (ISO 6336-3:2006, clause 9); tooth height in modules."""


@book.default("gearboxes.*.title")
def _title(tree: RawTree, box: str) -> Filling:
    return follows(f"{box} gearbox", "its name")


@book.default("gearboxes.*.role")
def _role(tree: RawTree, box: str) -> Filling:
    counted = GearName.read(tree.text("drivetrain.torque_at") or tree.names("gearboxes")[0]).gearbox
    role = "specimen" if box == counted else "rig"
    return follows(role, "the gearbox at which the torque counts, else the first, holds the specimens")


@book.default("gearboxes.*.meshes.*.pinion")
def _pinion(tree: RawTree, box: str, mesh: str) -> Filling:
    return _pair(tree, box, 0)


@book.default("gearboxes.*.meshes.*.wheel")
def _wheel(tree: RawTree, box: str, mesh: str) -> Filling:
    return _pair(tree, box, 1)


def _pair(tree: RawTree, box: str, side: int) -> Filling:
    """Pinion or wheel of the only two gears of a gearbox: by their names, else by their teeth."""
    gears = tree.names(f"gearboxes.{box}.gears")
    if len(gears) != 2:
        return None
    name = ("pinion", "wheel")[side]
    if name not in gears:
        teeth = [tree.number(f"gearboxes.{box}.gears.{gear}.teeth") for gear in gears]
        if None in teeth:
            return None
        name = sorted(gears, key=lambda gear: teeth[gears.index(gear)] or 0.0)[side]
    return follows(name, "the gearbox has two gears")


@book.default("gearboxes.*.meshes.*.pressure_angle")
def _pressure_angle(tree: RawTree, box: str, mesh: str) -> Filling:
    return assumed("20 deg", "basic rack of ISO 53")


@book.default("gearboxes.*.meshes.*.profile_shift_split")
def _profile_shift_split(tree: RawTree, box: str, mesh: str) -> Filling:
    at = f"gearboxes.{box}"
    pair = [tree.text(f"{at}.meshes.{mesh}.{side}") for side in ("pinion", "wheel")]
    if any(tree.has(f"{at}.gears.{gear}.profile_shift") for gear in pair):
        return None
    return assumed(
        "equal", "no gear states its profile shift: both get half of what the centre distance asks for"
    )


@book.default("gearboxes.*.meshes.*.damping_ratio")
def _damping_ratio(tree: RawTree, box: str, mesh: str) -> Filling:
    if tree.has(f"gearboxes.{box}.meshes.{mesh}.damping"):
        return None
    return assumed(0.06, "measured spur gears have a few per cent of critical damping in mesh", 0.02, 0.1)


@book.default("gearboxes.*.meshes.*.rack")
def _rack(tree: RawTree, box: str, mesh: str) -> Filling:
    text = "ISO 53 rack A"
    return {
        "addendum": assumed(1.0, text),
        "dedendum": assumed(1.25, text),
        "tip_radius": assumed(0.38, text, 0.2, 0.38),
    }


@book.default("gearboxes.*.gears.*.material")
def _material(tree: RawTree, box: str, gear: str) -> Filling:
    return assumed("case_hardened_steel", "usual material of test and rig gears")


@book.default("gearboxes.*.gears.*.quality_grade")
def _quality(tree: RawTree, box: str, gear: str) -> Filling:
    return assumed(5, "ground gears of a test rig, ISO 1328-1", 4, 6)


@book.default("gearboxes.*.gears.*.flank_roughness")
def _roughness(tree: RawTree, box: str, gear: str) -> Filling:
    return assumed("0.5 um", "ground flank, Ra", "0.3 um", "0.8 um")


@book.default("gearboxes.*.gears.*.tooth_thinning")
def _thinning(tree: RawTree, box: str, gear: str) -> Filling:
    module = normal_module(tree, box, gear)
    if module is None:
        return None
    return around(1e6 * 0.015 * module, "um", "0.015 modules a gear: backlash of small spur gearboxes")


@book.default("gearboxes.*.gears.*.bore_diameter")
def _bore(tree: RawTree, box: str, gear: str) -> Filling:
    """The shaft fills it; none where that leaves too thin a rim, as of a pinion cut into its shaft, nor in a gearbox
    with jets and without a housing, where it does not count."""
    at = f"gearboxes.{box}.gears.{gear}"
    shaft = tree.text(f"{at}.shaft")
    if shaft is None or not (tree.has(f"gearboxes.{box}.housing") or _dips(tree, box)):
        return None
    found = section_diameter(tree, shaft, tree.length(f"{at}.position")) or shaft_diameter(tree, box, shaft)
    if found is None:
        return None
    root = root_diameter(tree, box, gear)
    if root is not None and 0.5 * (root - found) < THIN_RIM * WHOLE_DEPTH * (
        normal_module(tree, box, gear) or 0.0
    ):
        text = f"cut into its shaft: {1e3 * found:.4g} mm would leave a rim below {THIN_RIM:g} tooth heights"
        return assumed("0 mm", text)
    return assumed(millimetres(found), "diameter of its shaft there")


def _dips(tree: RawTree, box: str) -> bool:
    return tree.text(f"gearboxes.{box}.oil.lubrication") == "dip"


def _injected(tree: RawTree, box: str) -> bool:
    at = f"gearboxes.{box}.oil"
    return tree.has(at) and tree.text(f"{at}.lubrication") in (None, "jet")


# ------------------------------------------------------------------ bearings


@book.default("gearboxes.*.bearings.*.width")
def _bearing_width(tree: RawTree, box: str, bearing: str) -> Filling:
    bore = bearing_bore(tree, box, bearing)
    if bore is None or not _plain(tree, box, bearing):
        return None
    return assumed(
        millimetres(0.75 * bore), "width over diameter 0.75", millimetres(0.5 * bore), millimetres(bore)
    )


@book.default("gearboxes.*.bearings.*.diametral_clearance")
def _clearance(tree: RawTree, box: str, bearing: str) -> Filling:
    bore = bearing_bore(tree, box, bearing)
    if bore is None or not _plain(tree, box, bearing):
        return None
    return around(
        1e6 * 2e-3 * bore, "um", "2 per mille of the diameter, usual in plain bearings", (0.75, 1.5)
    )


def _plain(tree: RawTree, box: str, bearing: str) -> bool:
    return tree.text(f"gearboxes.{box}.bearings.{bearing}.type") in (None, "journal")


@book.default("gearboxes.*.bearings.*.locating")
def _locating(tree: RawTree, box: str, bearing: str) -> Filling:
    """The bearing towards the coupling, or the only one that can, where none of the shaft is stated to be locating."""
    at = f"gearboxes.{box}.bearings"
    shaft = tree.text(f"{at}.{bearing}.shaft")
    mates = [name for name in tree.names(at) if tree.text(f"{at}.{name}.shaft") == shaft]
    if any(tree.has(f"{at}.{name}.locating") for name in mates):
        return None
    if not tree.has(f"gearboxes.{box}.housing") and (not _bends(tree) or _held_by_teeth(tree, box, shaft)):
        return None
    able = [name for name in mates if _holds_axially(tree, box, name)]
    if len(able) == 1 < len(mates):
        return follows(True, "the other one cannot hold the shaft") if bearing in able else None
    side = "rear" if box == tree.names("gearboxes")[0] else "front"
    if tree.text(f"{at}.{bearing}.side") != side:
        return None
    return assumed(True, "the bearing on the side of the coupling holds the shaft")


def _bends(tree: RawTree) -> bool:
    """Whether the case has, or gets, a power circuit of elastic shafts: each of them has to be located."""
    circuit = tree.has("drivetrain") or (
        len(tree.names("gearboxes")) == 2 and tree.text("losses.basis") != "input"
    )
    return circuit and tree.text("drivetrain.shaft_model") != "torsional"


def _held_by_teeth(tree: RawTree, box: str, shaft: str | None) -> bool:
    """Whether a double-helical mesh ties the shaft to one that a bearing locates."""
    at = f"gearboxes.{box}"
    located = {
        tree.text(f"{at}.bearings.{name}.shaft")
        for name in tree.names(f"{at}.bearings")
        if tree.at(f"{at}.bearings.{name}.locating") is True
    }
    for mesh in tree.names(f"{at}.meshes"):
        gears = [tree.text(f"{at}.meshes.{mesh}.{side}") or "" for side in ("pinion", "wheel")]
        shafts = [shaft_of(tree, box, "gears", gear) for gear in gears]
        if tree.at(f"{at}.meshes.{mesh}.double_helical") is True and shaft in shafts:
            return not located.isdisjoint(shafts)
    return False


def _holds_axially(tree: RawTree, box: str, bearing: str) -> bool:
    """Whether a bearing may be locating: any but those whose rings move past each other."""
    found, numbers = tabled(tree, box, bearing), f"gearboxes.{box}.bearings.{bearing}.catalogue"
    if found is not None:
        return found.carries_axial_load
    kind = ROLLING_KINDS.get(tree.text(f"{numbers}.kind") or "")
    able = kind is None or kind.carries_axial_load
    return able and tree.at(f"{numbers}.carries_axial_load") is not False


@book.default("gearboxes.*.bearings.*.radial_damping")
def _rolling_damping(tree: RawTree, box: str, bearing: str) -> Filling:
    """Of a rolling bearing whose stiffness the case states and uses."""
    at = f"gearboxes.{box}.bearings.{bearing}"
    stiffness = tree.si(f"{at}.radial_stiffness", "linear_stiffness")
    stated = tree.text("drivetrain.bearing_coefficients") == "stated"
    if stiffness is None or not stated or tree.text(f"{at}.type") != "rolling":
        return None
    damping = f"{ROLLING_DAMPING_TIME * stiffness:.4g} N s/m"
    return assumed(damping, "1.25e-5 s of the stiffness, middle of 0.25e-5 to 2.5e-5 s (Kraemer 1993)")


# ------------------------------------------------------------------ oil


@book.default("gearboxes.*.oil.jet_direction")
def _jet_direction(tree: RawTree, box: str) -> Filling:
    return None if not _injected(tree, box) else assumed("into_mesh", "usual at these pitch line velocities")


@book.default("gearboxes.*.oil.jet_velocity")
def _jet_velocity(tree: RawTree, box: str) -> Filling:
    return None if not _injected(tree, box) else assumed("15 m/s", "nozzle at about 2 bar", "8 m/s", "25 m/s")


@book.default("gearboxes.*.oil.flow")
def _jet_flow(tree: RawTree, box: str) -> Filling:
    speed, torque = tree.si("schedule.test_speed", "speed"), tree.si("schedule.test_torque", "torque")
    if not _injected(tree, box) or speed is None or torque is None:
        return None
    litres = max(6e4 * 0.01 * speed * torque / (870.0 * 2000.0 * 10.0), 0.5)
    return around(litres, "l/min", "carries one per cent of the power at 10 K, at least 0.5 l/min")


@book.default("gearboxes.*.oil.volume")
def _sump_volume(tree: RawTree, box: str) -> Filling:
    level = tree.length(f"gearboxes.{box}.oil.level")
    if not _dips(tree, box) or level is None:
        return None
    if not tree.has(f"gearboxes.{box}.housing"):
        return _volume_round_gears(tree, box, level)
    at = f"gearboxes.{box}.housing"
    keys = ("warm_length", "width", "wall_thickness", "shaft_height", "floor_thickness")
    sizes = [tree.length(f"{at}.{key}") for key in keys]
    known = [size for size in sizes if size is not None]
    if len(known) < len(keys):
        return None
    length, width, wall, axis, floor = known
    litres = 1e3 * length * (width - 2.0 * wall) * (axis + level - floor)
    reason = "chamber up to the oil level, without gears"
    return around(litres, "l", reason, (0.7, 1.1)) if litres > 0.0 else None


def _volume_round_gears(tree: RawTree, box: str, level: float) -> Filling:
    """A gearbox without a housing: walls 20 mm off the tips, 30 mm off the faces of its only pair."""
    mesh = f"gearboxes.{box}.meshes.{only_mesh(tree, box)}"
    module, distance = tree.length(f"{mesh}.normal_module"), tree.length(f"{mesh}.centre_distance")
    gears = [f"gearboxes.{box}.gears.{tree.text(f'{mesh}.{side}')}" for side in ("pinion", "wheel")]
    teeth = [number for gear in gears if (number := tree.number(f"{gear}.teeth")) is not None]
    faces = [face for gear in gears if (face := tree.length(f"{gear}.face_width")) is not None]
    if module is None or distance is None or len(teeth) < 2 or not faces:
        return None
    width = distance + module * (0.5 * sum(teeth) + 2.0) + 0.04
    depth = module * (0.5 * max(teeth) + 1.0) + 0.02 + level
    litres = 1e3 * width * (max(faces) + 0.06) * depth
    reason = "box with walls 20 mm off the tips and 30 mm off the faces of the gears"
    return around(litres, "l", reason) if litres > 0.0 else None


SCUFFING_STAGES = {
    "FVA 3": assumed(7.0, "FZG stage of mineral oil without additives; replace by a test", 6.0, 8.0),
    "FVA 3A": assumed(
        12.0, "most oils with 4 % sulphur-phosphorus additive pass it; replace by a test", 11.0, 14.0
    ),
}
SCUFFING_TEMPERATURES = {
    "MIL-PRF-23699": assumed(
        "220 degC",
        "mean for this oil on aviation gear steel after AGMA 925-A03, from memory, not confirmed",
        "205 degC",
        "260 degC",
    ),
}
"""What lets gears scuff in a built-in oil; none of these numbers is of its specification."""


@book.default("gearboxes.*.oil.scuffing_load_stage")
def _scuffing_load_stage(tree: RawTree, box: str) -> Filling:
    at = f"gearboxes.{box}.oil"
    return (
        None if tree.has(f"{at}.scuffing_temperature") else SCUFFING_STAGES.get(tree.text(f"{at}.oil") or "")
    )


@book.default("gearboxes.*.oil.scuffing_temperature")
def _scuffing_temperature(tree: RawTree, box: str) -> Filling:
    at = f"gearboxes.{box}.oil"
    return (
        None
        if tree.has(f"{at}.scuffing_load_stage")
        else SCUFFING_TEMPERATURES.get(tree.text(f"{at}.oil") or "")
    )


@book.default("gearboxes.*.bearing_oil")
def _bearing_oil(tree: RawTree, box: str) -> Filling:
    """Plain bearings are fed with the oil of the gears; all others by splash of the gears."""
    at = f"gearboxes.{box}.bearings"
    if not any(_plain(tree, box, bearing) for bearing in tree.names(at)):
        return None
    return {"lubrication": follows("fed", "plain bearings need oil that is fed")}


@book.default("gearboxes.*.bearing_oil.oil")
def _bearing_oil_name(tree: RawTree, box: str) -> Filling:
    name = tree.text(f"gearboxes.{box}.oil.oil")
    return assumed(name, "same oil as the gears") if _fed(tree, box) and name else None


@book.default("gearboxes.*.bearing_oil.inlet_temperature")
def _bearing_oil_temperature(tree: RawTree, box: str) -> Filling:
    at = f"gearboxes.{box}.oil"
    given = tree.at(f"{at}.inlet_temperature") or tree.at(f"{at}.sump_temperature")
    return assumed(given, "same tank as the oil of the gears") if _fed(tree, box) and given else None


@book.default("gearboxes.*.bearing_oil.flow")
def _bearing_oil_flow(tree: RawTree, box: str) -> Filling:
    sizes = [
        (bearing_bore(tree, box, name) or 0.0) * (bearing_width(tree, box, name) or 0.0)
        for name in tree.names(f"gearboxes.{box}.bearings")
    ]
    if not _fed(tree, box) or not sizes or not max(sizes) > 0.0:
        return None
    return around(
        max(sizes) / 12e-4, "l/min", "1 l/min for 12 cm2 of diameter times width: some 10 K of rise"
    )


def _fed(tree: RawTree, box: str) -> bool:
    at = f"gearboxes.{box}.bearing_oil"
    return tree.has(at) and tree.text(f"{at}.lubrication") in (None, "fed")


# ------------------------------------------------------------------ seals, heat


@book.default("gearboxes.*.seals")
def _seals(tree: RawTree, box: str) -> Filling:
    shafts = shafts_of(tree, box)
    return {shaft: {"shaft": follows(shaft, "every shaft leaves its gearbox")} for shaft in shafts} or None


@book.default("gearboxes.*.seals.*.kind")
def _seal_kind(tree: RawTree, box: str, seal: str) -> Filling:
    if tree.has(f"gearboxes.{box}.seals.{seal}.radial_gap"):
        return None
    if _dips(tree, box):
        return assumed("radial_lip", "a sump is kept in by radial shaft seals")
    return assumed("contactless", "labyrinths, usual with fed oil")


@book.default("gearboxes.*.seals.*.radial_gap")
def _seal_gap(tree: RawTree, box: str, seal: str) -> Filling:
    return assumed("0.3 mm", "gap of a wall or labyrinth of a small gearbox", "0.2 mm", "0.5 mm")


@book.default("gearboxes.*.seals.*.axial_travel")
def _seal_travel(tree: RawTree, box: str, seal: str) -> Filling:
    kind = END_SEALS.get(tree.text(f"gearboxes.{box}.seals.{seal}.kind") or "", WALL)
    return assumed(*kind.usual_travel)


@book.default("gearboxes.*.heat_split.windage_into_gears")
def _windage_share(tree: RawTree, box: str) -> Filling:
    return assumed(0.1, "the mist takes most of it", 0.0, 0.5)


@book.default("gearboxes.*.heat_split.seal_into_shaft")
def _seal_into_shaft(tree: RawTree, box: str) -> Filling:
    return assumed(0.25, "half into metal, the rest into oil", 0.0, 0.5)


@book.default("gearboxes.*.heat_split.seal_into_housing")
def _seal_into_housing(tree: RawTree, box: str) -> Filling:
    return assumed(0.25, "as into the shaft", 0.0, 0.5)
