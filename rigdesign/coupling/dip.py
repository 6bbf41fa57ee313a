"""Gears that dip into the sump of their gearbox: the bath they run in, what they churn, what wets their teeth."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from dynamics.gear.pair import GearPair
from dynamics.losses.churning import ChurningLaw, stage_churning
from dynamics.losses.churning_comparison import compare_churning
from dynamics.losses.immersion import (
    DippedGear,
    OilBath,
    RunningGear,
    immersion,
    splash_flow,
    tooth_space_flow,
)
from dynamics.losses.mesh_loss import RIVAL_LAW, RIVAL_POWER, Loss
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.lubrication import DipOil
from rigdesign.coupling.state import OperatingPoint
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import gear_oil
from thermal.films.bath import dipped_rim_film
from thermal.films.convection import scaled
from thermal.films.flank import FilmOil, ToothRing
from thermal.films.law import FilmLaw

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
    rig: Rig, name: str, point: OperatingPoint, temperature: float, pairs: Mapping[str, GearPair]
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
                gear=dipped_gear(box, gear, pairs[f"{name}.{mesh_name}"], index),
                speed=rig.shaft_speed(box.gears[gear].shaft, point.speed),
            )
            for index, gear in enumerate(gears)
        ]
        losses = _by_law((running[0], running[1]), bath, sump)
        for gear, own, loss in zip(gears, running, losses, strict=True):
            if first[gear][0] == mesh_name and immersion(own.gear, bath).depth > 0.0:
                yield gear, loss


def splash_to_bearing(rig: Rig, name: str, point: OperatingPoint, temperature: float, share: float) -> float:
    """Oil that the dipped gears of the gearbox ``name`` throw on each bearing [m3/s]; none at low speed.

    temperature : of the sump [K]; share : of what they lift
    """
    box = rig.case.gearboxes[name]
    assert box.sump is not None
    bath = oil_bath(rig, name, box.sump, temperature)
    return sum(
        splash_flow(
            dipped_gear(box, gear, rig.pairs[f"{name}.{mesh}"], index),
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
    pair = rig.pairs[f"{name}.{mesh_name}"]
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
