"""Power losses by place at one operating point, and how each divides between oil and bodies."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Protocol

from dynamics.gear.pair import GearPair
from dynamics.losses.loss import RIVAL_LAW, RIVAL_POWER, Loss
from dynamics.losses.mesh_loss import mesh_loss, squeeze_loss
from dynamics.losses.oil_jet import oil_acceleration
from dynamics.losses.seal_loss import SealGap
from dynamics.losses.windage import GearRotor, Mist, anderson_loewenthal, gear_windage
from dynamics.rotor.bearing import BearingState
from dynamics.tooth.friction import ToothPath
from dynamics.vibration.response_curve import CurvePoint
from rigdesign.base.part_name import BearingName, MeshName
from rigdesign.base.units import ZERO_CELSIUS
from rigdesign.case.gearbox import Gearbox, HeatSplit, mesh_jet
from rigdesign.case.seals import WALL, Seals
from rigdesign.coupling.bearing_loads import constant_drag
from rigdesign.coupling.bearing_seats import body_shares
from rigdesign.coupling.flank_heat import churning, mesh_split
from rigdesign.coupling.located_loss import PlacedLoss, given_power
from rigdesign.coupling.mesh_models import MeshModel
from rigdesign.coupling.preloaded_loop import first_torques
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import gear_feed, gear_oil
from rigdesign.rig.shaft_seals import ShaftSeal, shaft_seals
from thermal.films.still import air

DAMPER_SHARE = 0.1
"""Work of a mesh damper, as a share of the tooth friction, above which it warns."""
LEAST_DAMPER_WORK = 1.0
"""Work of a mesh damper [W] that warns at least: nothing of it matters below."""


def rotating_losses(
    rig: Rig,
    point: OperatingPoint,
    coupling_state: CouplingState,
    models: Sequence[MeshModel],
    bearings: Mapping[str, BearingState],
) -> list[PlacedLoss]:
    """Every loss that brakes a shaft from outside the teeth: bearings, windage, oil, seals, squeezing.

    Where the bearings have the constant drag of the case nothing else brakes, so nothing else loses: heat that no
    motor gives must not reach the housing.
    """
    pairs = {model.name: model.pair for model in models}
    losses: list[PlacedLoss] = []
    for name, state in bearings.items():
        losses.append(_bearing_loss(rig, BearingName.read(name), point, state))
    computed = {} if _bearings_alone(rig) else rig.case.gearboxes
    for box_name, box in computed.items():
        dipped = list(_churning(rig, box_name, box, point, coupling_state, pairs))
        losses += dipped
        dry = set(box.gears) - {placed.part for placed in dipped}
        losses += (
            placed
            for placed in _windage(rig, box_name, box, point, coupling_state, pairs)
            if placed.part in dry
        )
        losses += _seals(rig, box_name, box, point, coupling_state)
    if computed:
        losses += _squeezing(rig, point, models)
    counted = [taken for loss in losses for taken in _taken(rig, point, _scaled(rig, loss))]
    return [*counted, *oil_jets(rig, point, pairs)]


def oil_jets(rig: Rig, point: OperatingPoint, pairs: Mapping[MeshName, GearPair]) -> list[PlacedLoss]:
    """What the jets of every mesh take from its pinion shaft, or give to it, and what their pump gives.

    pairs : by ``gearbox.mesh``. At standstill the pump alone pays. None where the bearings have constant drag.
    """
    if _bearings_alone(rig):
        return []
    losses = [
        loss for name, box in rig.case.gearboxes.items() for loss in _oil_jets(rig, name, box, point, pairs)
    ]
    return [taken for loss in losses for taken in _taken(rig, point, _scaled(rig, loss))]


def _bearings_alone(rig: Rig) -> bool:
    """Whether nothing but bearings and teeth brakes the rig."""
    return rig.case.drivetrain is not None and rig.case.losses.bearing_drag == "constant"


def mesh_losses(
    rig: Rig,
    point: OperatingPoint,
    models: Sequence[MeshModel],
    response: CurvePoint | None = None,
    coupling_state: CouplingState | None = None,
) -> list[PlacedLoss]:
    """Sliding and damping of every mesh.

    response : gives mu F_N v_g of the dynamic tooth forces and the damping work; without it the sliding is
        integrated over the path of contact at the mean load
    coupling_state : bulk temperatures of the gears under the oil films on their flanks; oil temperature when left out
    """
    losses = []
    for index, model in enumerate(models):
        loss = static_mesh_loss(rig, point, model)
        if response is not None:
            source = f"mu F_N v_g of the dynamic tooth forces; {model.friction.source}"
            loss = replace(
                loss,
                power=float(response.friction_power[index]),
                details=loss.details | {"static_power": loss.power, "source": source},
            )
        split = mesh_split(rig, model.name, point, coupling_state)
        into_body = math.fsum(split.into_rims) * loss.power
        placed = PlacedLoss(
            gearbox=model.name.gearbox, part=model.name.part, loss=loss, into_body=into_body, split=split
        )
        losses += _taken(rig, point, placed)
        if response is not None:
            losses.append(_damper_work(rig, model, response, index))
    return losses


def _damper_work(rig: Rig, model: MeshModel, response: CurvePoint, index: int) -> PlacedLoss:
    """Work of a mesh damper in the periodic response; what it is beyond a share of the friction warns."""
    power, friction = float(response.damping_power[index]), float(response.friction_power[index])
    warnings: tuple[str, ...] = ()
    if power > max(DAMPER_SHARE * friction, LEAST_DAMPER_WORK):
        remedy = (
            'write damping_acts_on = "relative_rotation" at the mesh, or measure its damping'
            if model.law.damping_acts_on == "contact_closing_rate"
            else "the mesh vibrates strongly here: measure its damping, or keep away from the resonance"
        )
        warnings = (
            f"work of the mesh damper = {power:.3g} W, limit {DAMPER_SHARE:.0%} of the tooth friction of "
            f"{friction:.3g} W: the drive torque depends on a damping that is assumed; {remedy}",
        )
    loss = Loss(
        place=model.name,
        kind="mesh_damping",
        power=power,
        details={
            "damping_acts_on": model.law.damping_acts_on,
            "source": "work of the mesh damper in the periodic response",
        },
        warnings=warnings,
    )
    outside = 0.0 if rig.case.losses.mesh_damping_heats_oil else power
    return PlacedLoss(
        gearbox=model.name.gearbox, part=model.name.part, loss=loss, into_body=0.0, not_heat=outside
    )


def static_mesh_loss(rig: Rig, point: OperatingPoint, model: MeshModel) -> Loss:
    """Sliding loss at the mean load, integrated over the path of contact."""
    box, mesh = rig.mesh(model.name)
    return mesh_loss(
        model.name,
        ToothPath.of_pair(model.pair),
        first_torques(rig, point)[model.name],
        rig.shaft_speed(box.gears[box.meshes[mesh].pinion].shaft, point.speed),
        model.friction,
        model.stiffness.at,
    )


def _squeezing(rig: Rig, point: OperatingPoint, models: Sequence[MeshModel]) -> Iterator[PlacedLoss]:
    share = rig.case.losses.squeeze_share
    for model in models if share > 0.0 else ():
        loss = squeeze_loss(model.name, static_mesh_loss(rig, point, model), share)
        yield PlacedLoss(gearbox=model.name.gearbox, part=model.name.part, loss=loss, into_body=0.0)


class Rated(Protocol):
    """A bearing with what it may be rated by; None for what its kind does not have."""

    @property
    def specific_load(self) -> float | None:
        """[Pa]"""

    @property
    def minimum_film(self) -> float | None:
        """[m]"""

    @property
    def transition_speed(self) -> float | None:
        """[rad/s]"""


def bearing_ratings(state: Rated) -> dict[str, float]:
    """Entries of a record for what a bearing is rated by; those its kind does not have are left out."""
    ratings = {}
    if state.specific_load is not None:
        ratings["specific_load_MPa"] = 1e-6 * state.specific_load
    if state.minimum_film is not None:
        ratings["minimum_film_um"] = 1e6 * state.minimum_film
    if state.transition_speed is not None:
        ratings["transition_speed_rpm"] = state.transition_speed * 30.0 / math.pi
    return ratings


def _bearing_loss(rig: Rig, name: BearingName, point: OperatingPoint, state: BearingState) -> PlacedLoss:
    drag = constant_drag(rig, name.gearbox, rig.bearing(name), point)
    loss = Loss(
        place=name,
        kind="bearing",
        power=state.power if drag is None else drag,
        details={
            "load_N": state.load,
            **bearing_ratings(state),
            "film_temperature_degC": state.film_temperature - ZERO_CELSIUS,
            "torsional_damping_Nms_rad": state.torsional_damping,
            "source": state.source,
        },
        warnings=state.warnings,
    )
    share = math.fsum(share for _, share in body_shares(rig, name, state))
    return PlacedLoss(gearbox=name.gearbox, part=name.part, loss=loss, into_body=share * loss.power)


def _windage(
    rig: Rig,
    box_name: str,
    box: Gearbox,
    point: OperatingPoint,
    coupling_state: CouplingState,
    pairs: Mapping[MeshName, GearPair],
) -> Iterator[PlacedLoss]:
    """Windage of every gear, once however many meshes it is in; a double-helical gear has both its halves."""
    mist = chamber_mist(rig, box_name, coupling_state)
    oil_viscosity = gear_oil(rig, box_name).dynamic_viscosity(
        _chamber_temperature(rig, box_name, coupling_state)
    )
    share = body_split(rig, box_name).windage_into_gears
    for gear_name, (mesh_name, index) in box.first_meshes().items():
        rotor = GearRotor.of_pair(pairs[MeshName(box_name, mesh_name)], index)
        rotor = replace(rotor, face_width=box.body_width(gear_name))
        omega = rig.shaft_speed(box.gears[gear_name].shaft, point.speed)
        loss = gear_windage(f"{box_name}.{gear_name}", rotor, omega, mist)
        other = anderson_loewenthal(rotor.pitch_radius, rotor.face_width, omega, oil_viscosity)
        rival: dict[str, float | str] = {RIVAL_LAW: "Anderson and Loewenthal", RIVAL_POWER: other}
        loss = replace(loss, details=loss.details | rival)
        yield PlacedLoss(gearbox=box_name, part=gear_name, loss=loss, into_body=share * loss.power)


def _churning(
    rig: Rig,
    box_name: str,
    box: Gearbox,
    point: OperatingPoint,
    coupling_state: CouplingState,
    pairs: Mapping[MeshName, GearPair],
) -> Iterator[PlacedLoss]:
    """Churning of every gear that reaches the sump; none without a sump."""
    if box.sump is not None:
        chamber = coupling_state.oil_outlet[f"{box_name}.gear_oil"]
        for gear, loss in churning(rig, box_name, point, chamber, pairs):
            yield PlacedLoss(gearbox=box_name, part=gear, loss=loss, into_body=0.0)


def chamber_mist(rig: Rig, box_name: str, coupling_state: CouplingState) -> Mist:
    """What the gears and seals turn in: density of the case, viscosity of air at the oil temperature."""
    gas = air(_chamber_temperature(rig, box_name, coupling_state))
    density = rig.case.losses.chamber_density
    return Mist(density=gas.density if density is None else density, viscosity=gas.viscosity)


def _chamber_temperature(rig: Rig, box_name: str, coupling_state: CouplingState) -> float:
    """Of what fills the chamber: the mean of its oil [K]."""
    chamber = coupling_state.oil_outlet[f"{box_name}.gear_oil"]
    return gear_feed(rig, box_name, chamber, coupling_state.oil_supply).mean(chamber)


def _oil_jets(
    rig: Rig, box_name: str, box: Gearbox, point: OperatingPoint, pairs: Mapping[MeshName, GearPair]
) -> Iterator[PlacedLoss]:
    jets = box.jets
    if jets is None:
        return
    jet = mesh_jet(box, jets, gear_oil(rig, box_name))
    for mesh_name, mesh in box.meshes.items():
        name = MeshName(box_name, mesh_name)
        omega = rig.shaft_speed(box.gears[mesh.pinion].shaft, point.speed)
        loss = oil_acceleration(name, jet, omega * pairs[name].working_radii[0])
        yield PlacedLoss(gearbox=box_name, part=mesh_name, loss=loss, into_body=0.0, pumped=jet.power)


def _seals(
    rig: Rig, box_name: str, box: Gearbox, point: OperatingPoint, coupling_state: CouplingState
) -> Iterator[PlacedLoss]:
    """Seals of each shaft: gaps in the walls of the chamber, and what seals the shaft where it leaves the gearbox."""
    split = body_split(rig, box_name)
    into_body = split.seal_into_shaft + split.seal_into_housing
    for name, seals in box.seals.items():
        omega = rig.shaft_speed(seals.shaft, point.speed)
        place = f"{box_name}.{name}"
        parts = _seal_losses(rig, box_name, place, seals, omega, coupling_state)
        rubbing = seals.rubbing_torque * omega
        if not parts and not rubbing:
            continue
        losses = [part for _, part in parts]
        ends = [part for seal, part in parts if seal.leaves]
        details = dict(losses[-1].details) if parts else {"source": "friction torque of the case"}
        details |= {"seals": float(len(parts))} if parts else {}
        details |= {"rubbing_torque": seals.rubbing_torque} if rubbing else {}
        power = math.fsum(part.power for part in losses) + rubbing
        loss = Loss(
            place=place,
            kind="seal",
            power=power,
            details=details,
            warnings=tuple(dict.fromkeys(warning for part in losses for warning in part.warnings)),
        )
        outside = math.fsum(part.power for part in ends) + rubbing * len(ends) / max(len(parts), 1)
        share = outside / power if power > 0.0 else 0.0
        yield PlacedLoss(gearbox=box_name, part=name, loss=loss, into_body=into_body * power, end_share=share)


def _seal_losses(
    rig: Rig, box_name: str, place: str, seals: Seals, omega: float, coupling_state: CouplingState
) -> list[tuple[ShaftSeal, Loss]]:
    """Every seal of a shaft with its loss, those in the walls of the chamber first.

    The shaft passes the walls of a chamber in a gap; lips sit only where it leaves the gearbox, one a side. A gap
    without a stated wall has no length and is left out.
    """
    mist = chamber_mist(rig, box_name, coupling_state)
    found = []
    for seal in shaft_seals(rig, box_name, seals.shaft):
        gap = None
        if seal.length is not None:
            gap = SealGap(radius=0.5 * seal.diameter, gap=seals.radial_gap, length=seal.length)
        end = seals.end if seal.leaves else WALL
        loss = end.loss(place, seal.diameter, omega, gap, mist)
        if loss is not None:
            found.append((seal, loss))
    return found


def body_split(rig: Rig, name: str) -> HeatSplit:
    """How losses of a gearbox divide; without a housing all heat ends in the oil."""
    box = rig.case.gearboxes[name]
    if box.housing is not None:
        return box.heat_split
    return HeatSplit(mesh_into_gears=0.0, windage_into_gears=0.0, seal_into_shaft=0.0, seal_into_housing=0.0)


def _scaled(rig: Rig, placed: PlacedLoss) -> PlacedLoss:
    """The loss times the factor of its gearbox; friction of bearings and teeth holds theirs already."""
    factor = rig.case.gearboxes[placed.gearbox].loss_factors.of(placed.loss.kind)
    if factor == 1.0 or placed.kind.of_teeth or placed.kind.at_bearings:
        return placed
    loss = placed.loss
    loss = replace(loss, power=factor * loss.power, details=loss.details | {"loss_factor": factor})
    return replace(placed, loss=loss, into_body=factor * placed.into_body)


def _taken(rig: Rig, point: OperatingPoint, placed: PlacedLoss) -> list[PlacedLoss]:
    """The loss of the case in place of the computed one, where the case gives it.

    With basis ``input`` a place that the case does not give loses nothing.
    """
    power = given_power(rig.case, point, placed.gearbox, placed.loss.kind, placed.part)
    if power is None:
        return [placed] if rig.case.losses.basis == "computed" else []
    share = placed.into_body / placed.loss.power if placed.loss.power else _split(rig, placed)
    loss = Loss(
        place=placed.loss.place,
        kind=placed.loss.kind,
        power=power,
        details={"computed_power": placed.loss.power, "source": "input of the case"},
    )
    return [replace(placed, loss=loss, into_body=share * power, given=True)]


def _split(rig: Rig, placed: PlacedLoss) -> float:
    if placed.split is not None:
        return math.fsum(placed.split.into_rims)
    split = body_split(rig, placed.gearbox)
    return math.fsum(getattr(split, share) for share in placed.kind.body_shares)
