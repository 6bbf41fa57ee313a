"""Hidden effects of the heat part: those a catalogue names and those it does not, with size, unit and bounds."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Effect:
    """One kind of effect; its size is zero on a healthy rig."""

    unit: str
    lower: float
    upper: float
    family: str
    """loss, film, contact, flow, oil, state; of those outside the catalogue what a locator should point at."""
    meaning: str
    catalogue: bool = True
    field: bool = False
    """Only on a gearbox with housing."""


# fmt: off
CATALOGUE: Mapping[str, Effect] = {
    "mesh_loss": Effect(
        "1", -0.5, 1.0, "loss",
        "relative change of the friction coefficient of the mesh",
    ),
    "bearing_loss": Effect(
        "1", -0.4, 1.0, "loss",
        "relative change of the drag of all bearings",
    ),
    "windage_loss": Effect(
        "1", -0.8, 3.0, "loss",
        "relative change of disc and tooth drag in mist",
    ),
    "seal_loss": Effect(
        "W", 0.0, 800.0, "loss",
        "rubbing seals: power at the speed of the case, proportional to speed",
    ),
    "jet_loss": Effect(
        "1", -0.8, 2.0, "loss",
        "relative change of the momentum the jets take",
    ),
    "squeeze_loss": Effect(
        "1", 0.0, 3.0, "loss",
        "squeezing over the healthy 5 % of the mesh loss: 1 adds another 5 %",
    ),
    "loss_split": Effect(
        "1", -0.6, 0.9, "split",
        "relative change of the share of the mesh loss that enters the gears", field=True,
    ),
    "film:chamber_oil": Effect(
        "1", -0.8, 2.0, "film",
        "relative change of the film on the walls of the chamber", field=True,
    ),
    "film:chamber_sump": Effect(
        "1", -0.8, 2.0, "film",
        "relative change of the film on the floor of the chamber", field=True,
    ),
    "film:cold_oil": Effect(
        "1", -0.8, 2.0, "film",
        "relative change of the film in the cold sections", field=True,
    ),
    "film:gear_rims": Effect(
        "1", -0.8, 2.0, "film",
        "relative change of the film on the flanks", field=True,
    ),
    "film:gear_sides": Effect(
        "1", -0.8, 2.0, "film",
        "relative change of the film on the sides of the gears", field=True,
    ),
    "ambient_film": Effect(
        "1", -0.5, 2.0, "film",
        "relative change of convection to room air, housing and field", field=True,
    ),
    "emissivity": Effect(
        "1", -0.8, 0.6, "film",
        "relative change of the emissivity of the housing", field=True,
    ),
    "bearing_film": Effect(
        "1", -0.8, 2.0, "film",
        "relative change of the conductance of the bearing films", field=True,
    ),
    "shell_contact": Effect(
        "m2 K/W", 0.0, 5e-3, "contact",
        "resistance between shell and housing on the area of the bore", field=True,
    ),
    "foot_contact": Effect(
        "m2 K/W", 0.0, 2e-2, "contact",
        "resistance between foot and clamping field", field=True,
    ),
    "leak_warm_cold": Effect(
        "1", 0.0, 0.3, "flow",
        "share of the gear oil that leaves with the bearing oil",
    ),
    "bypass": Effect(
        "1", 0.0, 0.5, "flow",
        "share of the gear oil that goes straight to the outlet",
    ),
    "blocked_jet": Effect(
        "1", 0.0, 0.75, "flow",
        "share of the jets that is closed at the same flow",
    ),
    "aeration": Effect(
        "1", 0.0, 0.2, "oil",
        "share of air in the volume of the oil of gears and bearings",
    ),
    "oil_viscosity": Effect(
        "1", -0.4, 0.6, "oil",
        "relative change of the viscosity",
    ),
    "oil_heat_capacity": Effect(
        "1", -0.2, 0.2, "oil",
        "relative change of the heat capacity",
    ),
    "not_steady": Effect(
        "1/h", 0.0, 2.0, "state",
        "one over the time each point has run from ambient", field=True,
    ),
    "ambient": Effect(
        "K", -8.0, 8.0, "state",
        "true room temperature less the one read", field=True,
    ),
    "leak_one_side": Effect(
        "1", 0.0, 0.25, "cold section, front",
        "gear oil into the front cold section, lost before the outlet", field=True,
    ),
    "one_bearing": Effect(
        "W", 0.0, 800.0, "bearing, wheel rear",
        "one tight bearing: power at the speed of the case, as its square", field=True,
    ),
}
"""What a catalogue of effects of a gearbox has."""
OUTSIDE: Mapping[str, Effect] = {
    "draught_one_side": Effect(
        "W/(m2 K)", 0.0, 40.0, "outer wall, right",
        "fan on the right-hand wall", catalogue=False, field=True,
    ),
    "hot_neighbour": Effect(
        "K", 0.0, 200.0, "outer wall, left",
        "hot machine beside the left-hand wall", catalogue=False, field=True,
    ),
    "coupling_heat": Effect(
        "W", 0.0, 400.0, "shaft, rear",
        "heat through the coupling into the pinion shaft", catalogue=False, field=True,
    ),
    "stratified_chamber": Effect(
        "K", 0.0, 40.0, "chamber",
        "oil mist warmer at the top of the chamber", catalogue=False, field=True,
    ),
    "oil_on_end_wall": Effect(
        "W/(m2 K)", 0.0, 200.0, "end wall, rear",
        "cold oil running down the outside of the rear end wall", catalogue=False, field=True,
    ),
    "pump_heat": Effect(
        "W", 0.0, 800.0, "sump",
        "heat of a pump in the sump that the motor does not pay", catalogue=False,
    ),
    "insulating_deposit": Effect(
        "m2 K/W", 0.0, 0.2, "outer wall, top",
        "paint or dust on top of the housing", catalogue=False, field=True,
    ),
    "frame_bolted": Effect(
        "W/K", 0.0, 20.0, "end wall, front",
        "steel frame bolted to the front end wall, cold at its far end", catalogue=False, field=True,
    ),
    "feed_gallery": Effect(
        "W/K", 0.0, 40.0, "cold section",
        "bearing oil fed through the hot partition", catalogue=False, field=True,
    ),
    "barrier_air": Effect(
        "W/K", 0.0, 15.0, "seals",
        "barrier air blown into the partition seals, at room temperature", catalogue=False, field=True,
    ),
    "spline_fretting": Effect(
        "W", 0.0, 400.0, "gear seat, pinion",
        "fretting seat: power at speed and torque of the case, as T n", catalogue=False, field=True,
    ),
    "lamp_on_top": Effect(
        "W/m2", 0.0, 800.0, "outer wall, top",
        "radiant heater above the housing", catalogue=False, field=True,
    ),
    "floor_heating": Effect(
        "W/m2", -150.0, 250.0, "field",
        "heat flux of a heated or cooled foundation under the field", catalogue=False, field=True,
    ),
    "heated_inlet": Effect(
        "W", -400.0, 600.0, "gear oil inlet",
        "heat lost or gained between inlet sensor and jets", catalogue=False,
    ),
}
"""What it has not; ``family`` says where a locator should point."""
# fmt: on
EFFECTS: Mapping[str, Effect] = {**CATALOGUE, **OUTSIDE}
"""By kind, or ``film:entry``. Names add the place: ``mesh_loss:test.main``, ``film:test.chamber_oil``, else
``kind:gearbox``."""


# fmt: off
SUMP: Mapping[str, Effect] = {
    **{key: EFFECTS[key] for key in (
        "mesh_loss", "bearing_loss", "seal_loss", "aeration", "oil_viscosity", "ambient_film", "bearing_film",
        "shell_contact", "not_steady", "ambient", "draught_one_side", "hot_neighbour", "coupling_heat",
        "stratified_chamber", "insulating_deposit", "frame_bolted", "one_bearing", "spline_fretting", "lamp_on_top",
        "floor_heating",
    )},
    "film:oil": Effect(
        "1", -0.7, 2.0, "film",
        "relative change of the films on all inner walls", field=True,
    ),
    "film:shafts": Effect(
        "1", -0.8, 4.0, "film",
        "relative change of the films on shafts and under seals", field=True,
    ),
    "film:sides": Effect(
        "1", -0.8, 4.0, "film",
        "relative change of the films on the sides of the gears", field=True,
    ),
    "churning_loss": Effect(
        "1", -0.8, 3.0, "loss, sump",
        "relative change of the churning of both gears", catalogue=False,
    ),
    "oil_level": Effect(
        "m", -0.045, 0.02, "sump",
        "level of the oil over that of the case: churning, wetted walls and sides", catalogue=False,
    ),
}
# fmt: on
"""What a gearbox with a sump has: no streams, so none of their effects; the sump is held, so its heat shows nowhere.
Emissivity is not among them: the case has one film for convection and radiation."""


def heat_key(name: str) -> str:
    """Key of a name in the tables: its kind, of a film with its part."""
    kind, _, place = name.partition(":")
    return f"film:{place.partition('.')[2]}" if kind == "film" else kind


def is_heat(name: str) -> bool:
    """Whether a name is an effect of the heat part."""
    return heat_key(name) in EFFECTS or heat_key(name) in SUMP


def effect_of(name: str) -> tuple[Effect, str, str]:
    """Entry, key and gearbox of a name; KeyError for a name not in the tables."""
    key = heat_key(name)
    gearbox = name.partition(":")[2].partition(".")[0]
    return (EFFECTS[key] if key in EFFECTS else SUMP[key]), key, gearbox


def effect_names(tree: Mapping[str, Any], catalogue: bool | None = None) -> Iterator[str]:
    """Every name that makes sense on a case; only those in or outside the catalogue if asked."""
    for gearbox, box in tree["gearboxes"].items():
        dips = box["oil"].get("lubrication") == "dip"
        for key, effect in (SUMP if dips else EFFECTS).items():
            if (effect.field and "housing" not in box) or catalogue not in (None, effect.catalogue):
                continue
            if key == "mesh_loss":
                yield from (f"mesh_loss:{gearbox}.{mesh}" for mesh in box["meshes"])
            elif key.startswith("film:"):
                yield f"film:{gearbox}.{key.removeprefix('film:')}"
            else:
                yield f"{key}:{gearbox}"
