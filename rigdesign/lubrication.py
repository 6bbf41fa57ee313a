"""Power losses by place and the oil that carries them, at one operating point."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from dynamics.gear import GearPair
from dynamics.journal_bearing import BearingState, JournalBearing, solve_bearing
from dynamics.losses import Loss, ToothPath, mesh_loss, squeeze_loss
from dynamics.oil_jet import JET_ANGLES, oil_acceleration
from dynamics.response_curve import CurvePoint
from dynamics.seal_loss import gap_seal_loss, lip_seal_loss
from dynamics.windage import GearRotor, Mist, gear_windage
from rigdesign.case.gearbox import Gearbox, HeatSplit
from rigdesign.loads import MeshModel
from rigdesign.oil import oil_outlet
from rigdesign.rig.model import Rig
from rigdesign.state import Feedback, OperatingPoint
from thermal.air import air

GRAVITY = 9.81


@dataclass(frozen=True, kw_only=True)
class PlacedLoss:
    """A loss with its place in the case and its way into oil and bodies."""

    gearbox: str
    part: str
    """Mesh, bearing, seals or gear of that gearbox."""
    loss: Loss
    into_body: float
    """Power that enters solid bodies [W]; the rest goes into the oil at once."""
    given: bool = False

    @property
    def name(self) -> str:
        """``gearbox.part``."""
        return f"{self.gearbox}.{self.part}"

    @property
    def into_oil(self) -> float:
        """Power that goes into the oil at once [W]."""
        return self.loss.power - self.into_body


@dataclass(frozen=True, kw_only=True)
class OilStream:
    """One oil stream of a gearbox: what it takes up between inlet and outlet."""

    name: str
    inlet: float
    outlet: float
    flow: float
    heat: float


def solve_bearings(rig: Rig, point: OperatingPoint, feedback: Feedback) -> dict[str, BearingState]:
    """Film of every journal bearing by ``gearbox.bearing``.

    Raises
    ------
    BearingError
        A hot clearance that is used up.
    BearingNotConvergedError
        No film temperature balances friction and oil flow.
    """
    states = {}
    loads = bearing_loads(rig, feedback)
    for name, box, entry in rig.bearings():
        oil = rig.oils[box.bearing_oil.oil]
        inlet = box.bearing_oil.inlet_temperature
        states[name] = solve_bearing(
            JournalBearing(
                diameter=entry.diameter,
                width=entry.width,
                diametral_clearance=feedback.bearing_clearance[name],
                feed_share=entry.feed_share,
            ),
            loads[name],
            rig.shaft_speed(entry.shaft, point.speed),
            inlet,
            box.bearing_oil.flow,
            oil.dynamic_viscosity,
            oil.density(inlet),
            oil.heat_capacity(inlet),
            feedback.bearing_heat[name],
        )
    return states


def bearing_loads(rig: Rig, feedback: Feedback) -> dict[str, float]:
    """Radial load of every bearing [N]: tooth force and weight by the lever rule on its shaft.

    Tangential forces of the meshes of a shaft add, as at an idler; weight is counted with the tangential
    force, which is on the safe side for the loaded bearings. Axial forces of a double-helical gear cancel.
    """
    loads = {}
    for name, box, entry in rig.bearings():
        if entry.radial_load is not None:
            loads[name] = entry.radial_load
            continue
        box_name = name.split(".")[0]
        tangential, radial, weight = 0.0, 0.0, 0.5 * GRAVITY * rig.shaft_mass(entry.shaft)
        for gear_name, gear in box.gears.items():
            if gear.shaft != entry.shaft:
                continue
            share = _lever(box, entry.shaft, entry.position, gear.position)
            for mesh_name, mesh in box.meshes.items():
                if gear_name not in (mesh.pinion, mesh.wheel):
                    continue
                full = f"{box_name}.{mesh_name}"
                pair = rig.pairs[full]
                force = abs(feedback.mesh_torque[full]) / pair.base_radii[0]
                tangential += share * force * math.cos(pair.working_pressure_angle)
                radial += share * force * math.sin(pair.working_pressure_angle)
                weight += share * GRAVITY * pair.masses[0 if gear_name == mesh.pinion else 1]
        loads[name] = math.hypot(tangential + weight, radial)
    return loads


def _lever(box: Gearbox, shaft: str, position: float | None, gear_position: float | None) -> float:
    """Share of a gear force that one of the two bearings of a shaft carries."""
    stations = [bearing.position for bearing in box.bearings.values() if bearing.shaft == shaft]
    if position is None or gear_position is None or None in stations or len(stations) != 2:
        return 1.0 / len(stations)
    first, second = (station for station in stations if station is not None)
    other = second if position == first else first
    return abs(other - gear_position) / abs(other - position)


def drag_torques(losses: Sequence[PlacedLoss], rig: Rig, speed: float) -> dict[str, float]:
    """Torque with which each bearing, gear windage and seal brakes its shaft [N m], by drivetrain name.

    Oil acceleration and squeezing brake the pinion of their mesh. Tooth friction is not among ``losses``: the
    mesh law holds it. Constant bearing drag is in the damping matrix, and then nothing else brakes, as in P2's
    own simulation.
    """
    torques: dict[str, float] = {}
    for placed in losses if rig.case.losses.bearing_drag == "film" else ():
        name, shaft = _brake(rig, placed)
        omega = rig.shaft_speed(shaft, speed)
        if omega > 0.0:
            torques[name] = torques.get(name, 0.0) + placed.loss.power / omega
    return torques


def _brake(rig: Rig, placed: PlacedLoss) -> tuple[str, str]:
    """Drag load of the drivetrain and shaft on which a loss acts."""
    box = rig.case.gearboxes[placed.gearbox]
    if placed.loss.kind in ("oil_acceleration", "squeeze"):
        pinion = box.meshes[placed.part].pinion
        return f"{placed.gearbox}.{pinion}", box.gears[pinion].shaft
    if placed.loss.kind == "seal":
        return f"{placed.gearbox}.seals.{placed.part}", box.seals[placed.part].shaft
    if placed.loss.kind == "windage":
        return placed.name, box.gears[placed.part].shaft
    return placed.name, box.bearings[placed.part].shaft


def rotating_losses(
    rig: Rig,
    point: OperatingPoint,
    feedback: Feedback,
    models: Sequence[MeshModel],
    bearings: Mapping[str, BearingState],
) -> list[PlacedLoss]:
    """Every loss that brakes a shaft from outside the teeth: bearings, windage, oil, seals, squeezing."""
    pairs = {model.name: model.pair for model in models}
    losses: list[PlacedLoss] = []
    for name, state in bearings.items():
        box_name, part = name.split(".")
        losses.append(_bearing_loss(rig, box_name, part, point, state))
    for box_name, box in rig.case.gearboxes.items():
        losses += _windage(rig, box_name, box, point, feedback, pairs)
        losses += _oil_jets(rig, box_name, box, point, pairs)
        losses += _seals(rig, box_name, box, point, feedback)
    losses += _squeezing(rig, point, models)
    return [taken for loss in losses for taken in _taken(rig, point, loss)]


def mesh_losses(
    rig: Rig, point: OperatingPoint, models: Sequence[MeshModel], response: CurvePoint | None = None
) -> list[PlacedLoss]:
    """Sliding and damping of every mesh.

    response : gives mu F_N v_g of the dynamic tooth forces and the damping work; without it the sliding is
        integrated over the path of contact at the mean load
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
        box_name, mesh = model.name.split(".")
        share = body_split(rig, box_name).mesh_into_gears
        placed = PlacedLoss(gearbox=box_name, part=mesh, loss=loss, into_body=share * loss.power)
        losses += _taken(rig, point, placed)
        if response is not None:
            damping = Loss(
                place=model.name,
                kind="mesh_damping",
                power=float(response.damping_power[index]),
                details={"source": "work of the mesh damper in the periodic response"},
            )
            losses.append(PlacedLoss(gearbox=box_name, part=mesh, loss=damping, into_body=0.0))
    return losses


def static_mesh_loss(rig: Rig, point: OperatingPoint, model: MeshModel) -> Loss:
    """Sliding loss at the mean load, integrated over the path of contact."""
    box, mesh = rig.mesh(model.name)
    force = rig.torque_ratio * point.torque / rig.pairs[rig.control_mesh].base_radii[0]
    return mesh_loss(
        model.name,
        ToothPath.of_pair(model.pair),
        force * model.pair.base_radii[0],
        rig.shaft_speed(box.gears[box.meshes[mesh].pinion].shaft, point.speed),
        model.friction,
        model.stiffness.at,
    )


def _squeezing(rig: Rig, point: OperatingPoint, models: Sequence[MeshModel]) -> Iterator[PlacedLoss]:
    share = rig.case.losses.squeeze_share
    for model in models if share > 0.0 else ():
        box_name, mesh = model.name.split(".")
        loss = squeeze_loss(model.name, static_mesh_loss(rig, point, model), share)
        yield PlacedLoss(gearbox=box_name, part=mesh, loss=loss, into_body=0.0)


def oil_streams(
    rig: Rig, losses: Sequence[PlacedLoss], bearing_heat: Mapping[str, float], wall_heat: Mapping[str, float]
) -> list[OilStream]:
    """The two oil streams of every gearbox: outlet = inlet + (loss + heat of bodies)/(rho c Q).

    bearing_heat : heat conducted into each bearing film [W]; wall_heat : heat taken from walls, shafts and
    gears by each stream [W]
    """
    streams = []
    for name, box in rig.case.gearboxes.items():
        gear, bearing = f"{name}.gear_oil", f"{name}.bearing_oil"
        own = [placed for placed in losses if placed.gearbox == name]
        into_bearings = math.fsum(placed.into_oil for placed in own if placed.loss.kind == "bearing")
        into_gears = math.fsum(placed.into_oil for placed in own if placed.loss.kind != "bearing")
        films = math.fsum(heat for part, heat in bearing_heat.items() if part.split(".")[0] == name)
        for stream, entry, count, loss, heat in (
            (gear, box.oil, len(box.meshes), into_gears, wall_heat[gear]),
            (bearing, box.bearing_oil, len(box.bearings), into_bearings, films + wall_heat[bearing]),
        ):
            flow = entry.flow * count
            outlet = entry.outlet_temperature
            if outlet is None:
                outlet = oil_outlet(rig.oils[entry.oil], entry.inlet_temperature, flow, loss, heat)
            streams.append(
                OilStream(
                    name=stream, inlet=entry.inlet_temperature, outlet=outlet, flow=flow, heat=loss + heat
                )
            )
    return streams


def _bearing_loss(
    rig: Rig, box_name: str, part: str, point: OperatingPoint, state: BearingState
) -> PlacedLoss:
    entry = rig.case.gearboxes[box_name].bearings[part]
    power = state.power
    if rig.case.losses.bearing_drag == "constant" and entry.torsional_damping is not None:
        power = entry.torsional_damping * rig.shaft_speed(entry.shaft, point.speed) ** 2
    loss = Loss(
        place=f"{box_name}.{part}",
        kind="bearing",
        power=power,
        details={
            "load_N": state.load,
            "specific_load_MPa": 1e-6 * state.specific_load,
            "minimum_film_um": 1e6 * state.minimum_film,
            "film_temperature_degC": state.film_temperature - 273.15,
            "torsional_damping_Nms_rad": state.torsional_damping,
            "transition_speed_rpm": state.transition_speed * 30.0 / math.pi,
            "source": "ISO 7902-1 / DIN 31652-1, film solved",
        },
        warnings=state.warnings,
    )
    return PlacedLoss(gearbox=box_name, part=part, loss=loss, into_body=0.0)


def _windage(
    rig: Rig,
    box_name: str,
    box: Gearbox,
    point: OperatingPoint,
    feedback: Feedback,
    pairs: Mapping[str, GearPair],
) -> Iterator[PlacedLoss]:
    mist = chamber_mist(rig, box_name, feedback)
    for mesh_name, mesh in box.meshes.items():
        pair = pairs[f"{box_name}.{mesh_name}"]
        for index, gear_name in enumerate((mesh.pinion, mesh.wheel)):
            rotor = GearRotor.of_pair(pair, index)
            omega = rig.shaft_speed(box.gears[gear_name].shaft, point.speed)
            loss = gear_windage(f"{box_name}.{gear_name}", rotor, omega, mist)
            share = body_split(rig, box_name).windage_into_gears
            yield PlacedLoss(gearbox=box_name, part=gear_name, loss=loss, into_body=share * loss.power)


def chamber_mist(rig: Rig, box_name: str, feedback: Feedback) -> Mist:
    """What the gears and seals turn in: density of the case, viscosity of air at the oil temperature."""
    box = rig.case.gearboxes[box_name]
    gas = air(0.5 * (box.oil.inlet_temperature + feedback.oil_outlet[f"{box_name}.gear_oil"]))
    density = rig.case.losses.chamber_density
    return Mist(density=gas.density if density is None else density, viscosity=gas.viscosity)


def _oil_jets(
    rig: Rig, box_name: str, box: Gearbox, point: OperatingPoint, pairs: Mapping[str, GearPair]
) -> Iterator[PlacedLoss]:
    oil = rig.oils[box.oil.oil]
    for mesh_name, mesh in box.meshes.items():
        name = f"{box_name}.{mesh_name}"
        omega = rig.shaft_speed(box.gears[mesh.pinion].shaft, point.speed)
        loss = oil_acceleration(
            name,
            box.oil.flow,
            oil.density(box.oil.inlet_temperature),
            omega * pairs[name].working_radii[0],
            box.oil.jet_velocity,
            JET_ANGLES[box.oil.jet_direction],
        )
        yield PlacedLoss(gearbox=box_name, part=mesh_name, loss=loss, into_body=0.0)


def _seals(
    rig: Rig, box_name: str, box: Gearbox, point: OperatingPoint, feedback: Feedback
) -> Iterator[PlacedLoss]:
    """Seals of each shaft; their lengths are those of the walls, so a gearbox without a housing has none."""
    geometry = rig.geometries.get(box_name)
    if geometry is None:
        return
    mist = chamber_mist(rig, box_name, feedback)
    shafts = {shaft.name: shaft for shaft in geometry.shafts}
    for name, seals in box.seals.items():
        shaft = shafts[seals.shaft]
        omega = rig.shaft_speed(seals.shaft, point.speed)
        gaps = [(shaft.seal_diameter, geometry.partition_thickness)] * 2
        gaps += [
            (shaft.overhang_diameter, geometry.bearing_depths(shaft)[0])
            for overhang in (shaft.overhang_front, shaft.overhang_rear)
            if overhang > 0.0
        ]
        place = f"{box_name}.{name}"
        if seals.kind == "radial_lip":
            parts = [lip_seal_loss(place, diameter, omega) for diameter, _ in gaps]
        else:
            parts = [
                gap_seal_loss(
                    place, 0.5 * diameter, seals.radial_gap, length, omega, mist.density, mist.viscosity
                )
                for diameter, length in gaps
            ]
        loss = Loss(
            place=place,
            kind="seal",
            power=math.fsum(part.power for part in parts),
            details=parts[0].details | {"seals": float(len(parts))},
            warnings=tuple(dict.fromkeys(warning for part in parts for warning in part.warnings)),
        )
        split = box.heat_split
        body = (split.seal_into_shaft + split.seal_into_housing) * loss.power
        yield PlacedLoss(gearbox=box_name, part=name, loss=loss, into_body=body)


def body_split(rig: Rig, name: str) -> HeatSplit:
    """How losses of a gearbox divide; without a housing all heat ends in the oil."""
    box = rig.case.gearboxes[name]
    if box.housing is not None:
        return box.heat_split
    return HeatSplit(mesh_into_gears=0.0, windage_into_gears=0.0, seal_into_shaft=0.0, seal_into_housing=0.0)


def _taken(rig: Rig, point: OperatingPoint, placed: PlacedLoss) -> list[PlacedLoss]:
    """The loss of the case in place of the computed one, where the case gives it.

    With basis ``input`` a place that the case does not give loses nothing.
    """
    for entry in rig.case.losses.given.values():
        same = (entry.gearbox, entry.kind, entry.part) == (placed.gearbox, placed.loss.kind, placed.part)
        if same and (not entry.stages or point.stage in entry.stages):
            share = placed.into_body / placed.loss.power if placed.loss.power else _split(rig, placed)
            given = PlacedLoss(
                gearbox=placed.gearbox,
                part=placed.part,
                loss=Loss(
                    place=placed.loss.place,
                    kind=placed.loss.kind,
                    power=entry.power,
                    details={"computed_power": placed.loss.power, "source": "input of the case"},
                ),
                into_body=share * entry.power,
                given=True,
            )
            return [given]
    return [placed] if rig.case.losses.basis == "computed" else []


def _split(rig: Rig, placed: PlacedLoss) -> float:
    split = body_split(rig, placed.gearbox)
    return {
        "mesh": split.mesh_into_gears,
        "windage": split.windage_into_gears,
        "seal": split.seal_into_shaft + split.seal_into_housing,
    }.get(placed.loss.kind, 0.0)
