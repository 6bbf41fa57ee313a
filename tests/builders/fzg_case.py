"""FZG back-to-back rig with C-type gears at load stage 10 (DIN ISO 14635), the test gearbox in a small housing.

The gears dip, or the sump is stood for by a weak big jet with churning of the size that ISO/TR 14179-2 gives; rolling
bearings are stood for by journals with the losses of NU406 by that document; what cools gears and shafts besides the
flanks is small.
"""

from collections.abc import Mapping
from pathlib import Path

BEARINGS = {"pinion": "38 W", "wheel": "25 W"}
CHURNING = {"pinion": "90 W", "wheel": "140 W"}
SPLIT = "windage_into_gears = 0.1\nseal_into_shaft = 0.25\nseal_into_housing = 0.25\n"
JETS = (
    'oil = { oil = "FVA 3", inlet_temperature = "90 degC", flow = "5 l/min", jet_direction = "into_mesh", '
    'jet_velocity = "0 m/s" }'
)
SUMP = 'oil = {{ lubrication = "dip", oil = "FVA 3", level = "0 mm", volume = "1.25 l"{keys} }}'
HELD = ', sump_temperature = "90 degC"'
FLANK_FILM = 'law = "flank_film"'
RIM_FILM = 'law = "constant_film"\nheat_transfer_coefficient = "300 W/(m2 K)"\nfluid = "gear_oil_mean"'


def fzg_case(
    folder: Path,
    *,
    split: str = "",
    rims: str = FLANK_FILM,
    sumps: Mapping[str, str] | None = None,
    one_chamber: bool = False,
) -> Path:
    """Write the case.

    split : what the case says of the way of the friction heat, nothing unless given; rims : condition of the gear rims
    sumps : gearbox -> keys of its sump beyond oil, level and volume; the gears then dip and churn by law
    one_chamber : the test gearbox without partitions, of the same length
    """
    text = HEAD + "".join(_gearbox(name, split if name == "test" else "") for name in ("test", "slave"))
    for name in ("test", "slave"):
        text += "".join(_given(name, gear, dips=sumps is not None) for gear in ("pinion", "wheel"))
        if sumps is not None:
            text = text.replace(JETS, SUMP.format(keys=sumps[name]), 1)
    path = folder / "case.toml"
    housing = _one_chamber(HOUSING) if one_chamber else HOUSING
    path.write_text(
        text + housing + f'[gearboxes.test.housing.boundary.rims]\nsurfaces = ["gear_*_rim"]\n{rims}\n'
    )
    return path


def step_case(folder: Path) -> Path:
    """Write the case with one chamber, its housing ``housing.step`` of that folder on a foot that conducts."""
    path = fzg_case(folder, one_chamber=True)
    text = path.read_text()
    for old, new in (
        ('shaft_height = "110 mm"', 'shaft_height = "110 mm"\nstep_file = "housing.step"'),
        ('field = { surfaces = ["field_top", "field_sides"], law = "recknagel_plate" }\n', ""),
        (
            'bottom = { surfaces = ["field_bottom"], law = "insulated" }',
            'foot = { surfaces = ["housing_foot"], law = "constant_film", heat_transfer_coefficient = "40 W/(m2 K)", '
            'fluid = "ambient" }',
        ),
    ):
        assert old in text
        text = text.replace(old, new)
    path.write_text(text)
    return path


def _one_chamber(housing: str) -> str:
    """The housing without its partitions; end walls are wetted like the rest of the chamber."""
    gone = ("cold_length_", "partition_thickness", "seal_diameter")
    kept = "\n".join(line for line in housing.splitlines() if not line.startswith(gone)) + "\n"
    for old, new in (
        ('warm_length = "60 mm"', 'warm_length = "116 mm"'),
        ('"partition_*", "cold_*"', '"end_wall_*"'),
        ('"shaft_*_cold_*", ', ""),
    ):
        assert old in kept
        kept = kept.replace(old, new)
    return kept


def _gearbox(box: str, split: str) -> str:
    role, width = ("specimen", "14 mm") if box == "test" else ("rig", "40 mm")
    start, middle, end = (0.0, 69.5, 139.0) if box == "test" else (80.0, 149.5, 219.0)
    text = f"""
[gearboxes.{box}]
title = "{box} gearbox"
role = "{role}"
meshes.main = {{ pinion = "pinion", wheel = "wheel", normal_module = "4.5 mm", pressure_angle = "20 deg", \
centre_distance = "91.5 mm", damping = "1000 N s/m" }}
{JETS}
bearing_oil = {{ oil = "FVA 3", inlet_temperature = "90 degC", flow = "0.5 l/min" }}
[gearboxes.{box}.heat_split]
{split}{SPLIT}"""
    for gear, teeth, shift in (("pinion", 16, "profile_shift = 0.182\n"), ("wheel", 24, "")):
        text += f"""
[gearboxes.{box}.gears.{gear}]
shaft = "{box}_{gear}"
teeth = {teeth}
face_width = "{width}"
bore_diameter = "30 mm"
position = "{middle} mm"
{shift}tip_shortening = "0.09 mm"
tooth_thinning = "60 um"
quality_grade = 5
flank_roughness = "0.4 um"
material = "case_hardened_steel"
[gearboxes.{box}.seals.{gear}]
shaft = "{box}_{gear}"
kind = "radial_lip"
radial_gap = "0.3 mm"
axial_travel = "5 mm"
"""
        for side, place in (("front", start), ("rear", end)):
            text += f"""
[gearboxes.{box}.bearings.{gear}_{side}]
shaft = "{box}_{gear}"
side = "{side}"
diameter = "30 mm"
width = "23 mm"
diametral_clearance = "50 um"
position = "{place} mm"
locating = {"true" if side == "rear" else "false"}
"""
    return text


def _given(box: str, gear: str, *, dips: bool) -> str:
    powers = [] if dips else [("windage", gear, CHURNING[gear])]
    powers += [("bearing", f"{gear}_{side}", BEARINGS[gear]) for side in ("front", "rear")]
    return "".join(
        f'[losses.given.{box}_{kind}_{part}]\ngearbox = "{box}"\nkind = "{kind}"\npart = "{part}"\npower = "{power}"\n'
        for kind, part, power in powers
    )


HEAD = """
schema_version = 1
name = "fzg"
title = "FZG back-to-back rig, C-type gears, load stage 10 (372.6 N m, 2250 rpm)"
ambient = { temperature = "25 degC" }
test_plan = { time = "300 h" }
[drivetrain]
torque_at = "test.pinion"
motor = { shaft = "slave_wheel", end = "end", torque_limit = "48 N m", inertia = "0.02 kg m2" }
bracing = { mode = "twist_held", coupling = "load_clutch" }
[drivetrain.shafts]
test_pinion = { material = "case_hardened_steel", sections = [{ length = "220 mm", outer_diameter = "30 mm" }] }
test_wheel = { material = "case_hardened_steel", sections = [{ length = "220 mm", outer_diameter = "30 mm" }] }
slave_pinion = { material = "case_hardened_steel", sections = [{ length = "260 mm", outer_diameter = "30 mm" }] }
slave_wheel = { material = "case_hardened_steel", sections = [{ length = "300 mm", outer_diameter = "30 mm" }] }
[drivetrain.couplings.load_clutch]
shafts = ["test_pinion", "slave_pinion"]
ends = ["end", "start"]
torsional_stiffness = "4e5 N m/rad"
torsional_damping = "8 N m s/rad"
[drivetrain.couplings.torque_clutch]
shafts = ["test_wheel", "slave_wheel"]
ends = ["end", "start"]
torsional_stiffness = "2e4 N m/rad"
torsional_damping = "2 N m s/rad"
[losses]
basis = "computed"
chamber_density = "20 kg/m3"
[schedule]
test_speed = "2250 rpm"
test_torque = "372.6 N m"
stages = [
    { name = "bracing", kind = "load", torque_share = 1.0, duration = "200 ms" },
    { name = "run_up", kind = "run_up", speed = "2250 rpm", duration = "2 s" },
    { name = "test", kind = "dwell", duration = "300 ms", held = true },
]
[numerics]
temperature_tolerance = "0.05 K"
growth_tolerance = "0.5 um"
torque_tolerance = 0.001
sample_rate = "20 kHz"
shaft_element_length = "100 mm"
curve_speed_start = "500 rpm"
curve_speed_end = "3500 rpm"
"""
HOUSING = """
[gearboxes.test.housing]
material = "structural_steel"
warm_length = "60 mm"
cold_length_front = "20 mm"
cold_length_rear = "20 mm"
width = "280 mm"
height = "220 mm"
wall_thickness = "12 mm"
floor_thickness = "15 mm"
top_thickness = "12 mm"
partition_thickness = "8 mm"
end_wall_thickness = "30 mm"
end_seal_width = "7 mm"
shaft_height = "110 mm"
radiation_included = true
field = { length = "600 mm", width = "700 mm", thickness = "60 mm", material = "structural_steel" }
[gearboxes.test.housing.shafts.test_pinion]
lateral_position = "-45.75 mm"
seal_diameter = "30 mm"
outside_diameter = "30 mm"
overhang_front = "0 mm"
overhang_rear = "40 mm"
material = "case_hardened_steel"
[gearboxes.test.housing.shafts.test_wheel]
lateral_position = "45.75 mm"
seal_diameter = "30 mm"
outside_diameter = "30 mm"
overhang_front = "0 mm"
overhang_rear = "40 mm"
material = "case_hardened_steel"
[gearboxes.test.housing.boundary]
air = { surfaces = ["outer_*"], law = "niemann_winter" }
field = { surfaces = ["field_top", "field_sides"], law = "recknagel_plate" }
bottom = { surfaces = ["field_bottom"], law = "insulated" }
oil = { surfaces = ["chamber_*", "partition_*", "cold_*", "seal_bore_*"], law = "constant_film", \
heat_transfer_coefficient = "300 W/(m2 K)", fluid = "gear_oil_mean" }
bearings = { surfaces = ["bearing_bore_*", "shaft_*_journal_*"], law = "bearing_film" }
shafts = { surfaces = ["shaft_*_warm", "shaft_*_cold_*", "shaft_*_seal_*"], law = "rotating_cylinder", \
fluid = "gear_oil_mean" }
outside = { surfaces = ["shaft_*_outside_*"], law = "rotating_cylinder", fluid = "ambient" }
ends = { surfaces = ["shaft_*_end_*"], law = "rotating_disc", fluid = "ambient" }
sides = { surfaces = ["gear_*_side_*"], law = "rotating_disc", fluid = "gear_oil_mean" }
"""
