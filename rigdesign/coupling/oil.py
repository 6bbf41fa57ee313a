"""Oil circuits of the gearboxes at one operating point: what each stream takes up on its way."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.part_name import BearingName, OilStreamName
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.lubrication import FedOil, JetOil, place_of
from rigdesign.case.model import Case
from rigdesign.coupling.located_loss import PlacedLoss, heat_into_gear_oil
from rigdesign.properties.oil import Portion, mixed, oil_outlet
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import AS_STATED, OilFeed, bearing_feed, gear_feed, wall_flow

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class OilStream:
    """One oil stream of a gearbox: what it takes up between inlet and outlet."""

    name: OilStreamName
    inlet: float
    """[K]"""
    outlet: float
    """All that comes back by its drain, mixed: what a thermometer there reads [K]."""
    chamber: float
    """As it leaves the walls it wets; the outlet, but for oil that went past them [K]."""
    flow: float
    """Fed [m3/s]."""
    heat: float
    """With which the oil of its drain leaves, above the temperatures it was fed with [W]."""
    leaked: float = 0.0
    """Heat of gear oil, as fed, above the bearing oil it leaks into and is made up from, into the bearing oil [W]:
    what the tanks see besides ``heat``; minus that of the gear oil."""

    @property
    def to_tank(self) -> float:
        """Heat into the tank of its own circuit, above the supply temperature [W]."""
        return self.heat + self.leaked


def oil_streams(
    rig: Rig,
    losses: Sequence[PlacedLoss],
    bearing_heat: Mapping[str, float],
    wall_heat: Mapping[str, float],
    chambers: Mapping[str, float],
    supplies: Mapping[str, float] = AS_STATED,
) -> list[OilStream]:
    """The two oil streams of every gearbox: outlet = inlet + (loss + heat of bodies)/(rho c Q).

    bearing_heat : heat conducted into each bearing film [W]; wall_heat : heat taken from walls, shafts and
    gears by each stream [W]; chambers : gearbox -> temperature of its sump [K], of gearboxes with a sump
    supplies : ``gearbox.stream`` -> supply temperature of what oil circuits feed [K]; others as the case states

    A sump has one temperature; its heat is what its cooler takes to hold it there, and nothing where it finds its own.
    Bearings that are not fed leave their heat in the oil of the gears.

    Oil that goes past meshes or walls leaves less for them, which then warms up more; at the drain all mix again.
    Gear oil that leaks to the bearings takes its heat there.
    """
    streams = []
    for name, box in rig.case.gearboxes.items():
        own = [placed for placed in losses if placed.gearbox == name]
        into_bearings = math.fsum(placed.into_bearing_oil for placed in own)
        into_gears = heat_into_gear_oil(own, name, bearings_fed=True)
        films = math.fsum(
            heat for part, heat in bearing_heat.items() if BearingName.read(part).gearbox == name
        )
        heat = wall_heat[f"{name}.gear_oil"]
        if box.fed_bearings is None:
            into_gears, films = math.fsum((into_gears, into_bearings, films)), 0.0
            heat += wall_heat[f"{name}.bearing_oil"]
        leak = None
        if box.jets is None:
            gear = _sump(name, chambers[name], into_gears + heat)
        else:
            fed = gear_feed(rig, name, chambers.get(name, 0.0), supplies)
            gear_oil = OilStreamName(name, "gear_oil")
            gear, leak = _gear_stream(fed, box, box.jets, gear_oil, into_gears, heat)
        streams.append(gear)
        if box.fed_bearings is None:
            streams.append(replace(gear, name=OilStreamName(name, "bearing_oil"), flow=0.0, heat=0.0))
        else:
            films += wall_heat[f"{name}.bearing_oil"]
            fed = bearing_feed(rig, name, 0.0, supplies)
            fed = replace(fed, flow=fed.flow * len(box.bearings))
            own_oil = _bearing_stream(
                fed, box.fed_bearings, OilStreamName(name, "bearing_oil"), into_bearings, films, leak
            )
            if leak is not None:
                moved = _above(leak, fed.inlet)
                streams[-1] = replace(streams[-1], leaked=-moved)
                own_oil = replace(own_oil, leaked=moved)
            streams.append(own_oil)
    return streams


def heater_and_cooler(case: Case, heats: Mapping[str, FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Power that heaters give and that the cooler carries [W], to feed every oil at its inlet temperature.

    heats : ``gearbox.stream`` -> (n,) heat with which its oil comes back above its inlet temperature, with what leaks
        carry from tank to tank (`OilStream.to_tank`) [W]

    Streams of one oil and inlet temperature are one circuit and mix in its tank. A circuit that comes back
    colder than it went needs a heater: its oil is too warm to cool another one, so nothing is netted. What an oil
    circuit of the case feeds is left out: its heater and cooler are those of its balance.
    """
    circuits: dict[tuple[str, float], FloatArray] = {}
    for stream, heat in heats.items():
        if place_of(case.oil_circuits, stream) is not None:
            continue
        name = OilStreamName.read(stream)
        entry = case.gearboxes[name.gearbox]
        fed = entry.feeds.get(name.part)
        if fed is not None:
            key = fed[0].oil, fed[0].inlet_temperature
        elif name.part == "gear_oil" and entry.gear_oil_temperature is not None:
            key = f"sump of {name.gearbox}", entry.gear_oil_temperature
        else:
            continue
        circuits[key] = circuits.get(key, np.zeros_like(heat)) + heat
    if not circuits:
        nothing = np.zeros_like(next(iter(heats.values())))
        return nothing, nothing
    powers = np.array(list(circuits.values()))
    return np.maximum(-powers, 0.0).sum(axis=0), np.maximum(powers, 0.0).sum(axis=0)


def _sump(name: str, temperature: float, heat: float) -> OilStream:
    """Oil of one temperature that stays in the gearbox."""
    return OilStream(
        name=OilStreamName(name, "gear_oil"),
        inlet=temperature,
        outlet=temperature,
        chamber=temperature,
        flow=0.0,
        heat=heat,
    )


def _above(leak: Portion, temperature: float) -> float:
    """Heat of a leak as it was fed above another temperature [W]."""
    return leak.capacity(temperature) * (leak.inlet - temperature)


def _gear_stream(
    fed: OilFeed, box: Gearbox, jets: JetOil, name: OilStreamName, loss: float, heat: float
) -> tuple[OilStream, Portion | None]:
    """The stream of the gears, and what of it leaks to the bearings."""
    paths, oil, inlet, flow = box.oil_paths, fed.oil, fed.inlet, fed.flow
    along = wall_flow(box)
    to_walls = 1.0 - paths.short_circuit / (1.0 - paths.bypass)
    outlet = jets.outlet_temperature
    if outlet is None:
        chamber = oil_outlet(oil, inlet, along, to_walls * loss, heat)
    elif along == flow:
        chamber = outlet
    else:
        carried = Portion(oil=oil, inlet=inlet, flow=flow).heat_at(outlet)
        chamber = oil_outlet(oil, inlet, along, carried - (1.0 - to_walls) * loss)
    leak = None
    leaving = loss + heat
    if paths.leak_warm_cold:
        leak = Portion(oil=oil, inlet=inlet, flow=paths.leak_warm_cold * flow).warmed(chamber)
        leaving -= leak.heat
    if outlet is None:
        back = (1.0 - paths.leak_warm_cold) * flow
        outlet = chamber if along == flow else oil_outlet(oil, inlet, back, leaving)
    stream = OilStream(name=name, inlet=inlet, outlet=outlet, chamber=chamber, flow=flow, heat=leaving)
    return stream, leak


def _bearing_stream(
    feed: OilFeed, fed: FedOil, name: OilStreamName, loss: float, heat: float, leak: Portion | None
) -> OilStream:
    """The stream of all bearings, with what leaks into it from the gears."""
    oil, inlet, flow = feed.oil, feed.inlet, feed.flow
    taken = loss + heat
    outlet = fed.outlet_temperature
    if leak is None:
        outlet = oil_outlet(oil, inlet, flow, loss, heat) if outlet is None else outlet
    else:
        taken += leak.heat
        outlet = (
            mixed((Portion(oil=oil, inlet=inlet, flow=flow), leak), loss + heat) if outlet is None else outlet
        )
    return OilStream(name=name, inlet=inlet, outlet=outlet, chamber=outlet, flow=flow, heat=taken)
