"""The FZG test gearbox with chambers that radiate, a jacket, and the air of a cold section, as a case and as solved."""

from collections.abc import Mapping
from pathlib import Path

from rigdesign import load_case
from rigdesign.coupling.bearing_loads import solve_bearings
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.located_loss import PointLosses
from rigdesign.coupling.losses import rotating_losses
from rigdesign.coupling.mesh_models import mesh_models
from rigdesign.coupling.temperatures import HousingField, boundary_conditions, solve_housing
from rigdesign.coupling.time_run import held_points
from rigdesign.rig.model import Rig, build_rig
from tests.builders.fzg_case import fzg_case
from thermal.conduction.setup import Condition

HOUSING = "gearboxes.test.housing"
AIR = 'air = { surfaces = ["outer_*"], law = "niemann_winter" }'
OILED = '"partition_*", "cold_*", "seal_bore_*"'
COATED = """\
air = { surfaces = ["outer_cold_rear"], law = "niemann_winter" }
jacket = { surfaces = ["outer_warm", "outer_cold_front"], law = "constant_film", \
heat_transfer_coefficient = "400 W/(m2 K)", fluid = "jacket" }
cold = { surfaces = ["cold_wall_front", "partition_cold_front"], law = "constant_film", \
heat_transfer_coefficient = "15 W/(m2 K)", fluid = "cold_air" }"""
TABLES = """
[gearboxes.test.housing.volumes.cold_air]
power = "20 W"
[gearboxes.test.housing.links]
breather = { between = ["cold_air", "ambient"], flow = "120 l/min", medium = "Air" }
drain = { between = ["gear_oil", "cold_air"], conductance = "3 W/K" }
[gearboxes.test.housing.streams.jacket]
flow = "1.5 l/min"
inlet_temperature = "25 degC"
medium = "Water"
surfaces = ["outer_cold_front", "outer_warm"]
[gearboxes.test.housing.enclosures]
warm = { chamber = "warm", parts.dry = { surfaces = ["gear_*"], emissivity = 0.3 }, \
parts.floor = { surfaces = ["chamber_floor"], emissivity = 0.0 } }
ends = { parts.walls = { surfaces = ["cold_floor_rear", "cold_wall_rear"], emissivity = 0.6 }, \
opening_temperature = "25 degC", view_factors = { cold_floor_rear = { cold_wall_rear = 0.5 } } }
"""


def warm_chambers_case(folder: Path, *, tables: str = TABLES, sumps: Mapping[str, str] | None = None) -> Path:
    """Write the case; tables : what it says of enclosures, volumes, streams and links; sumps : as `fzg_case` has it."""
    path = fzg_case(folder, sumps=sumps)
    text = path.read_text()
    for old, new in (
        (AIR, COATED),
        (OILED, '"partition_warm_*", "partition_cold_rear", "cold_floor_*", "cold_wall_rear", "seal_bore_*"'),
    ):
        assert old in text
        text = text.replace(old, new)
    path.write_text(text + tables)
    return path


def first_losses(rig: Rig) -> PointLosses:
    """What heats the rig in the first iteration of its held point."""
    point = held_points(rig)[0]
    state = initial_state(rig, point)
    bearings = solve_bearings(rig, point, state)
    losses = rotating_losses(rig, point, state, mesh_models(rig, point, state), bearings)
    return PointLosses(point=point, coupling_state=state, bearings=bearings, losses=tuple(losses))


def solved_chambers(
    folder: Path, sumps: Mapping[str, str] | None = None
) -> tuple[Rig, PointLosses, HousingField]:
    """The test gearbox of the case in its first iteration."""
    rig = build_rig(load_case(warm_chambers_case(folder, sumps=sumps)), "quick")
    losses = first_losses(rig)
    return rig, losses, solve_housing(rig, "test", losses)


def stated_conditions(rig: Rig, losses: PointLosses) -> list[Condition]:
    """Conditions of the test gearbox as the case states them."""
    return list(boundary_conditions(rig, "test", losses, radiation_included=True))
