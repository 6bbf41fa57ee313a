"""Friction heat at the teeth: how the two gears share it, and what their oil films let through to the rims.

Friction heats both flanks where they touch. What the oil carries through the contact is left out: a film of half a
micrometre takes less than a hundredth of it. Each gear then is a fin with heated and cooled flanks: the share eta
of its heat reaches the rim, the rest leaves with the film (`thermal.films.flank`).
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from dynamics.gear.pair import GearPair
from dynamics.losses.churning import ChurningLaw, compare_churning, stage_churning
from dynamics.losses.immersion import (
    DippedGear,
    OilBath,
    RunningGear,
    immersion,
    splash_flow,
    tooth_space_flow,
)
from dynamics.losses.loss import RIVAL_LAW, RIVAL_POWER, Loss
from dynamics.losses.oil_jet import JET_ANGLES
from dynamics.tooth.friction import ToothPath
from rigdesign.base.part_name import GearName, MeshName
from rigdesign.case.gearbox import Gearbox, jet_velocity
from rigdesign.case.geometry import conditions_of
from rigdesign.case.lubrication import DipOil, JetOil
from rigdesign.case.surface_conditions import FlankFilm
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.properties.materials import Material
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import (
    ChamberOil,
    OilFeed,
    film_oil,
    gear_feed,
    gear_oil,
    wetted_width,
    wetting_flow,
)
from thermal.conditions.boundary import Film
from thermal.films.bath import dipped_rim_film
from thermal.films.convection import constant, scaled
from thermal.films.flank import (
    FilmOil,
    ToothRing,
    Wetting,
    fin_efficiency,
    fling_off,
    jet_renewal,
    on_rim,
)
from thermal.films.law import FilmLaw

JET_HALVES = 0.5
"""Of the oil injected at a mesh, the part that wets each of its two gears."""
PATH_POINTS = 201


@dataclass(frozen=True, kw_only=True)
class MeshSplit:
    """Way of the friction heat of a mesh into its gears.

    pinion : share of the heat that enters the flanks of the pinion; the rest enters those of the wheel
    kept : of the heat of pinion and wheel, the shares that reach their rims; the rest goes into the oil at once
    """

    pinion: float
    kept: tuple[float, float]

    @property
    def into_rims(self) -> tuple[float, float]:
        """Shares of the whole that reach the rims of pinion and wheel."""
        return self.pinion * self.kept[0], (1.0 - self.pinion) * self.kept[1]


@dataclass(frozen=True, kw_only=True)
class GearFlanks:
    """Teeth of one gear with the film on them."""

    ring: ToothRing
    law: FilmLaw
    """On the flanks."""
    oil_temperature: float
    """Of the oil as it lies on the flanks [K]."""
    rim_area: float

    def kept(self, wall: float) -> float:
        """Share of the heat of the flanks that reaches the rim, at a wall temperature [K]."""
        return fin_efficiency(self.ring, self.law(wall, self.oil_temperature).value)

    def film(self, surface: str, kind: str) -> Film:
        """The condition of the rim that stands for the teeth."""
        law = on_rim(self.law, self.ring, self.rim_area)
        return Film(surface=surface, kind=kind, fluid_temperature=self.oil_temperature, law=law)


def flank_films(box: Gearbox, rims: Mapping[str, str]) -> dict[str, FlankFilm]:
    """Gear -> condition of its teeth, for every gear whose rim has one; ``rims`` names the rim of each gear."""
    if box.housing is None:
        return {}
    gears = {surface: gear for gear, surface in rims.items()}
    return {
        gears[surface]: condition
        for entry, surface, _ in conditions_of(box.housing, rims.values())
        if isinstance(condition := box.housing.boundary[entry], FlankFilm)
    }


def rim_surfaces(box: Gearbox) -> dict[str, str]:
    """Gear -> its rim in the mesh of the housing."""
    return {name: f"gear_{gear.shaft}_rim" for name, gear in box.gears.items()}


def gear_flanks(
    rig: Rig, name: str, gear: str, point: OperatingPoint, condition: FlankFilm, chamber: ChamberOil
) -> GearFlanks:
    """Teeth and film of one gear of the housing ``name`` at an operating point.

    chamber : gear oil of the chamber
    """
    box = rig.case.gearboxes[name]
    mesh_name, index = box.first_meshes()[gear]
    pair = rig.pairs[MeshName(name, mesh_name)]
    material = rig.materials[box.gears[gear].material]
    ring = tooth_ring(pair, index, box.body_width(gear), material.conductivity)
    properties = film_oil(rig, name)
    factor = wetted_width(box) * condition.film_factor
    temperature = chamber.leaving
    if box.jets is not None:
        speed = rig.shaft_speed(box.gears[gear].shaft, point.speed)
        fed = gear_feed(rig, name, chamber.leaving, chamber.supplies(name))
        temperature = _after_impact(box, box.jets, speed, pair.working_radii[index], fed)
    if condition.correlation == "constant":
        assert condition.heat_transfer_coefficient is not None
        law = constant(factor * condition.heat_transfer_coefficient, "input of the case")
    elif box.jets is None:
        dipped = DippedFlanks(ring=ring, oil=properties, sump_temperature=chamber.leaving, factor=factor)
        law = flank_law(rig, name, gear, point, dipped)
    else:
        make = fling_off if condition.correlation == "fling_off" else jet_renewal
        law = make(ring, _jet_wetting(rig, name, gear, point, condition, box.jets), properties, factor)
    disc = next(s.gear for s in rig.geometries[name].shafts if s.name == box.gears[gear].shaft)
    assert disc is not None
    return GearFlanks(
        ring=ring, law=law, oil_temperature=temperature, rim_area=math.pi * disc.outer_diameter * disc.width
    )


def _jet_wetting(
    rig: Rig, name: str, gear: str, point: OperatingPoint, condition: FlankFilm, jets: JetOil
) -> Wetting:
    """How the jets wet a gear: every mesh has its own, so a gear in two meshes is wetted twice a turn."""
    box = rig.case.gearboxes[name]
    meshes = sum(gear in (mesh.pinion, mesh.wheel) for mesh in box.meshes.values())
    return Wetting(
        speed=rig.shaft_speed(box.gears[gear].shaft, point.speed),
        per_turn=meshes,
        flow=meshes * JET_HALVES * wetting_flow(box, jets),
        wetted_share=condition.wetted_share,
    )


def _after_impact(box: Gearbox, jets: JetOil, speed: float, radius: float, fed: OilFeed) -> float:
    """Temperature of injected oil as it lies on a flank [K]: warmed by its impact, (v - v_jet)^2/(2 c), vectors."""
    angle = JET_ANGLES[jets.jet_direction]
    rim_speed, jet = speed * radius, jet_velocity(box, jets)
    impact = rim_speed**2 + jet**2 - 2.0 * rim_speed * jet * math.cos(angle) if speed > 0.0 else 0.0
    return fed.inlet + 0.5 * impact / fed.oil.heat_capacity(fed.inlet)


def film_of_oil(
    rig: Rig, name: str, gear: str, point: OperatingPoint, *, wall: float, chamber: ChamberOil
) -> float:
    """Film on the rim of a gear [W/(m2 K)] that jets or sump make at a wall temperature [K] (fling-off).

    chamber : as in `gear_flanks`
    """
    rim = rim_surfaces(rig.case.gearboxes[name])[gear]
    flanks = gear_flanks(rig, name, gear, point, FlankFilm(surfaces=(rim,), law="flank_film"), chamber)
    return flanks.film(rim, "").law(wall, flanks.oil_temperature).value


def tooth_ring(pair: GearPair, index: int, width: float, conductivity: float) -> ToothRing:
    """Teeth of gear ``index`` of a pair on a body ``width`` wide [m], as the film sees them.

    The flank is the involute from form to tip circle, r_b (xi_a^2 - xi_f^2)/2, and the height of the fillet below;
    tip lands and the bottom of the spaces are left out.
    """
    gear = pair.gears[index]
    rolls = [gear.roll_length(radius) for radius in (gear.form_radius, gear.tip_radius)]
    involute = 0.5 * (rolls[1] ** 2 - rolls[0] ** 2) / gear.base_radius
    profile = involute + max(gear.form_radius - gear.root_radius, 0.0)
    middle = max(gear.mean_radius, gear.form_radius)
    return ToothRing(
        root_radius=gear.root_radius,
        tip_radius=gear.tip_radius,
        flank_area=2.0 * gear.teeth * profile * width / math.cos(gear.helix_angle),
        tooth_thickness=2.0 * middle * gear.half_angle(middle) * math.cos(gear.helix_angle),
        conductivity=conductivity,
    )


def pinion_share(pair: GearPair, materials: tuple[Material, Material]) -> float:
    """Share of the friction heat of a mesh that enters the pinion, by the thermal contact coefficients.

    In each contact B_1 sqrt(v_1) / (B_1 sqrt(v_1) + B_2 sqrt(v_2)) with B = sqrt(k rho c) and the speeds v of the
    contact over both flanks (Blok: both surfaces equally hot); weighted over the path with the sliding speed,
    pairs in contact sharing the load evenly. Half for equal gears of one material.
    """
    path = ToothPath.of_pair(pair)
    place = np.linspace(path.start, path.end, PATH_POINTS)
    rolling = pair.rolling_radii
    speeds = (rolling[0] + place, (rolling[1] - place) / pair.gear_ratio)
    first, second = (
        math.sqrt(m.conductivity * m.density * m.heat_capacity) * np.sqrt(np.maximum(v, 0.0))
        for m, v in zip(materials, speeds)
    )
    offsets = np.arange(-3, 4)[:, None] * path.base_pitch
    touching = ((place + offsets >= path.start) & (place + offsets <= path.end)).sum(axis=0)
    weight = np.abs(place) / touching
    return float(np.sum(weight * first / (first + second)) / np.sum(weight))


def mesh_split(
    rig: Rig, name: MeshName, point: OperatingPoint, coupling_state: CouplingState | None
) -> MeshSplit:
    """How the friction heat of a mesh divides, by the rule of the case.

    coupling_state : bulk temperatures of the gears, for the viscosity of the film; oil temperature when left out
    """
    box = rig.case.gearboxes[name.gearbox]
    mesh, split = box.meshes[name.part], box.heat_split
    gears = mesh.pinion, mesh.wheel
    share = split.mesh_pinion_share
    if share is None:
        first, second = (rig.materials[box.gears[gear].material] for gear in gears)
        share = pinion_share(rig.pairs[name], (first, second))
    if box.housing is None:
        return MeshSplit(pinion=share, kept=(0.0, 0.0))
    if split.rule == "assumed":
        assert split.mesh_into_gears is not None
        return MeshSplit(pinion=share, kept=(split.mesh_into_gears, split.mesh_into_gears))
    conditions = flank_films(box, rim_surfaces(box))
    chamber = ChamberOil(leaving=box.gear_oil_temperature or rig.case.ambient.temperature)
    if coupling_state is not None:
        chamber = ChamberOil.of(name.gearbox, coupling_state.oil_outlet, coupling_state.oil_supply)
    kept = []
    for gear in gears:
        flanks = gear_flanks(rig, name.gearbox, gear, point, conditions[gear], chamber)
        walls = {} if coupling_state is None else coupling_state.gear_temperature
        kept.append(flanks.kept(walls.get(GearName(name.gearbox, gear), flanks.oil_temperature)))
    return MeshSplit(pinion=share, kept=(kept[0], kept[1]))


# Gears that dip into the sump of their gearbox: the bath they run in, what they churn, what wets their teeth.

AXES = 0.0
"""Height of the shaft axes, from which the level of a sump is counted [m]."""
CUT_IN = 0.9
"""Radius of the shaft over that of the root circle of a pinion cut into a shaft that is thicker: its sides have no
face."""
CARRIED_BY_MESH = 0.5
"""Of the oil that a gear lifts out of the sump, the part that its mesh leaves on the partner (assumed)."""


def oil_bath(rig: Rig, name: str, sump: DipOil, temperature: float) -> OilBath:
    """The sump of the gearbox ``name`` at a temperature [K]."""
    oil = gear_oil(rig, name)
    return OilBath(
        level=sump.level,
        volume=sump.volume,
        density=oil.density(temperature),
        viscosity=oil.dynamic_viscosity(temperature),
        hydraulic_length=_hydraulic_length(rig.case.gearboxes[name], sump),
    )


def _hydraulic_length(box: Gearbox, sump: DipOil) -> float | None:
    """Four times the inner plan area over its perimeter [m]; None where the plan is not known."""
    housing = box.housing
    if housing is not None:
        length, width = housing.warm_length, housing.width - 2.0 * housing.wall_thickness
    elif sump.plan_length is not None and sump.plan_width is not None:
        length, width = sump.plan_length, sump.plan_width
    else:
        return None
    return 2.0 * length * width / (length + width)


def dipped_gear(box: Gearbox, gear: str, pair: GearPair, index: int) -> DippedGear:
    """Pinion (0) or wheel (1) of a pair as the bath sees it, with both halves of a double-helical gear."""
    shaft = 0.5 * box.seat_diameter(gear)
    if not box.gears[gear].bore_diameter:  # of a pinion thinner than its shaft the teeth are left
        shaft = min(shaft, CUT_IN * pair.gears[index].root_radius)
    own = DippedGear.of_pair(pair, index, AXES, shaft)
    return replace(own, face_width=box.body_width(gear))


def churning(
    rig: Rig, name: str, point: OperatingPoint, temperature: float, pairs: Mapping[MeshName, GearPair]
) -> Iterator[tuple[str, Loss]]:
    """(gear, its churning loss) of every gear of the gearbox ``name`` that reaches its sump.

    temperature : of the sump [K]; pairs : by ``gearbox.mesh``. A gear in several meshes counts in its first one.
    """
    box = rig.case.gearboxes[name]
    sump = box.sump
    assert sump is not None
    bath = oil_bath(rig, name, sump, temperature)
    first = box.first_meshes()
    for mesh_name, mesh in box.meshes.items():
        gears = mesh.pinion, mesh.wheel
        running = [
            RunningGear(
                place=f"{name}.{gear}",
                gear=dipped_gear(box, gear, pairs[MeshName(name, mesh_name)], index),
                speed=rig.shaft_speed(box.gears[gear].shaft, point.speed),
            )
            for index, gear in enumerate(gears)
        ]
        losses = _by_law((running[0], running[1]), bath, sump)
        for gear, own, loss in zip(gears, running, losses, strict=True):
            if first[gear][0] == mesh_name and immersion(own.gear, bath).depth > 0.0:
                yield gear, loss


def splash_to_bearing(
    rig: Rig, name: str, sump: DipOil, point: OperatingPoint, temperature: float, share: float
) -> float:
    """Oil that the dipped gears of the gearbox ``name`` throw on each bearing [m3/s]; none at low speed.

    temperature : of the sump [K]; share : of what they lift
    """
    box, bath = rig.case.gearboxes[name], oil_bath(rig, name, sump, temperature)
    return sum(
        splash_flow(
            dipped_gear(box, gear, rig.pairs[MeshName(name, mesh)], index),
            bath,
            rig.shaft_speed(box.gears[gear].shaft, point.speed),
            share,
        )
        for gear, (mesh, index) in box.first_meshes().items()
    )


def _by_law(stage: tuple[RunningGear, RunningGear], bath: OilBath, sump: DipOil) -> tuple[Loss, Loss]:
    """Loss of both gears by the law of the case, with the range over all laws and why this one was taken."""
    compared = compare_churning(stage, bath)
    if sump.churning == "recommended":
        losses, reason = compared.losses[compared.recommended], compared.reason
    else:
        losses = compared.losses.get(sump.churning) or stage_churning(stage, bath, sump.churning)
        reason = f"{sump.churning}: choice of the case"
    taken = losses[0].power + losses[1].power
    rival = max(compared.powers, key=lambda law: abs(compared.powers[law] - taken))
    first, second = (
        replace(
            loss,
            details=loss.details
            | {"powers_of_all_laws": _range(compared.losses, index), "reason": reason}
            | {RIVAL_LAW: rival, RIVAL_POWER: compared.losses[rival][index].power},
        )
        for index, loss in enumerate(losses)
    )
    return first, second


def _range(losses: Mapping[ChurningLaw, tuple[Loss, Loss]], index: int) -> str:
    """The power of one gear by every law, in a text."""
    return ", ".join(f"{law} {pair[index].power:.3g} W" for law, pair in losses.items())


@dataclass(frozen=True, kw_only=True)
class DippedFlanks:
    """Teeth of one gear over a sump: their ring, the oil, its temperature [K], a factor on the film."""

    ring: ToothRing
    oil: FilmOil
    sump_temperature: float
    factor: float


def flank_law(rig: Rig, name: str, gear: str, point: OperatingPoint, flanks: DippedFlanks) -> FilmLaw:
    """Film on the flanks of a gear of a gearbox with a sump: flooded once a turn, or wetted by its dipped partner."""
    box = rig.case.gearboxes[name]
    assert box.sump is not None
    bath = oil_bath(rig, name, box.sump, flanks.sump_temperature)
    mesh_name, index = box.first_meshes()[gear]
    pair = rig.pairs[MeshName(name, mesh_name)]
    own = dipped_gear(box, gear, pair, index)
    speed = rig.shaft_speed(box.gears[gear].shaft, point.speed)
    depth, lifted = immersion(own, bath).depth, tooth_space_flow(own, bath, speed)
    if depth == 0.0:
        mesh = box.meshes[mesh_name]
        partner = (mesh.wheel, mesh.pinion)[index]
        other = dipped_gear(box, partner, pair, 1 - index)
        turning = rig.shaft_speed(box.gears[partner].shaft, point.speed)
        depth = immersion(other, bath).depth
        lifted = CARRIED_BY_MESH * tooth_space_flow(other, bath, turning)
    return scaled(dipped_rim_film(flanks.ring, speed, depth, lifted, flanks.oil), flanks.factor)
