"""Oil circuits of the gearboxes at one operating point: what each stream takes up on its way."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from rigdesign.losses import PlacedLoss
from rigdesign.oil import oil_outlet
from rigdesign.rig.model import Rig


@dataclass(frozen=True, kw_only=True)
class OilStream:
    """One oil stream of a gearbox: what it takes up between inlet and outlet."""

    name: str
    inlet: float
    outlet: float
    flow: float
    heat: float


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
        into_bearings = math.fsum(placed.into_bearing_oil for placed in own)
        into_gears = math.fsum(placed.into_oil - placed.into_bearing_oil for placed in own)
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
