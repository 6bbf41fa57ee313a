"""Sensors and points a rig offers beyond those of a set: computed with the library, so that they can be proposed."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from statistics import geometric_mean

from rigdesign.case.model import Case
from rigdesign.measurement.places import Places
from rigdesign.measurement.reading.measurement_set import ExtraPoint
from rigdesign.prediction.model import STANDING_QUANTITIES, Channel, OperatingCondition, Quantity

SPARE = "could be: "
"""Start of the names of sensors and points that are not measured."""

NOISE: dict[Quantity, float] = {
    "temperature": 0.5,
    "warming_rate": 1e-4,
    "oil_outlet_temperature": 0.4,
    "motor_power": 25.0,
    "drive_torque": 0.05,
    "torque": 0.3,
    "angle": 2e-6,
    "natural_frequency": 6.0,
    "backlash": 3e-6,
    "seal_gap": 1e-5,
    "acceleration": 0.05,
    "shaft_displacement": 2e-7,
    "resonance_speed": 1.0,
    "root_strain": 4e-6,
}
"""Standard deviation of a reading of a sensor that would be added, its systematic part included [SI]."""

MOST_TEMPERATURES = 12
"""Places of thermocouples that are proposed."""


@dataclass(frozen=True, kw_only=True)
class Extra:
    """A point that could be run."""

    title: str
    setting: OperatingCondition
    changed: ExtraPoint
    """What is changed for it, by which it costs."""


def spare_channels(case: Case, used: Sequence[Channel], orders: tuple[float, ...]) -> tuple[Channel, ...]:
    """Channels of the rig that the set does not have; orders, modes and root gauges only where some are read already.

    Where root gauges are all that is read, other gauges alone: what shows in temperatures then is not run.
    """
    places = Places(case)
    have = {(channel.quantity, channel.place) for channel in used}
    gauges_alone = {channel.quantity for channel in used} <= {"root_strain", *STANDING_QUANTITIES}
    quantities: list[Quantity] = [] if gauges_alone else ["oil_outlet_temperature", "motor_power"]
    if any(channel.orders for channel in used):
        quantities += ["torque", "natural_frequency"]
    if any(channel.quantity == "root_strain" for channel in used):
        quantities.append("root_strain")
    wanted = [(quantity, place) for quantity in quantities for place in places.of(quantity)]
    if not gauges_alone:
        wanted += [("temperature", place) for place in _thermocouples(places)]
    return tuple(
        Channel(
            name=SPARE + _label(quantity, place),
            quantity=quantity,
            place=place,
            orders=orders if quantity == "torque" else (),
            face=places.face_position(place) if quantity == "root_strain" else 0.0,
        )
        for quantity, place in wanted
        if (quantity, place) not in have
    )


def _label(quantity: Quantity, place: str) -> str:
    """Of a sensor, its place said once."""
    words = quantity.replace("_", " ")
    return words if place in words.split() else f"{words} {place}"


def _thermocouples(places: Places) -> list[str]:
    """Surfaces that a thermocouple reaches, and gears and bearing shells."""
    starts = ("outer_", "bearing_bore_", "gear_", "chamber_wall", "chamber_floor", "field_")
    return [
        place
        for place in places.surfaces
        if place.partition(".")[2].startswith(starts) and "side" not in place and "rim" not in place
    ][:MOST_TEMPERATURES]


def extra_points(settings: Sequence[OperatingCondition], meshes: Sequence[str]) -> tuple[Extra, ...]:
    """Points in addition to the plan: its corners if it has several, other oil, other flow, a wheel put on further."""
    middle = sorted(settings, key=lambda setting: setting.speed * abs(setting.torque))[len(settings) // 2]
    slow, fast = (pick(setting.speed for setting in settings) for pick in (min, max))
    light, heavy = (pick(abs(setting.torque) for setting in settings) for pick in (min, max))
    extras = []
    if len(settings) > 1 and light < heavy:
        extras += [
            Extra(
                title="a point at the least speed and the greatest torque",
                setting=replace(middle, name=f"{SPARE}slow", speed=slow, torque=heavy),
                changed="operating_point",
            ),
            Extra(
                title="a point at the greatest speed and the least torque",
                setting=replace(middle, name=f"{SPARE}fast", speed=fast, torque=light),
                changed="operating_point",
            ),
        ]
    extras += _between(middle, (slow, fast), (light, heavy))
    if middle.inlet_temperature:
        colder = {stream: value - 20.0 for stream, value in middle.inlet_temperature.items()}
        extras.append(
            Extra(
                title="a point with all oil 20 K colder",
                setting=replace(middle, name=f"{SPARE}colder", inlet_temperature=colder),
                changed="inlet_temperature",
            )
        )
    if middle.flow:
        more = {stream: 1.5 * value for stream, value in middle.flow.items()}
        extras.append(
            Extra(
                title="a point with half as much oil again",
                setting=replace(middle, name=f"{SPARE}flow", flow=more),
                changed="oil_flow",
            )
        )
    if meshes:
        offset = {meshes[0]: 5 + middle.tooth_offset.get(meshes[0], 0)}
        extras.append(
            Extra(
                title=f"a point with the wheel of {meshes[0]} put on five teeth further",
                setting=replace(middle, name=f"{SPARE}re-indexed", tooth_offset=offset),
                changed="reassembly",
            )
        )
    return tuple(extras)


def _between(
    middle: OperatingCondition, speeds: tuple[float, float], torques: tuple[float, float]
) -> list[Extra]:
    """Points where a plan has one torque, or two speeds: half the torque, and a speed between."""
    extras = []
    if torques[0] == torques[1]:
        extras.append(
            Extra(
                title="a point at half the torque",
                setting=replace(middle, name=f"{SPARE}half torque", torque=0.5 * middle.torque),
                changed="operating_point",
            )
        )
        if speeds[0] < speeds[1]:
            between = replace(middle, name=f"{SPARE}speed between", speed=0.5 * (speeds[0] + speeds[1]))
            extras.append(
                Extra(title="a point at a speed between", setting=between, changed="operating_point")
            )
    return extras


# What further sensors and operating points cost: as the measurement set states, else by their usual ratio.

USUAL_COST: dict[str, float] = {
    "temperature": 1.0,
    "warming_rate": 1.0,
    "oil_outlet_temperature": 1.0,
    "motor_power": 4.0,
    "drive_torque": 4.0,
    "torque": 8.0,
    "angle": 4.0,
    "natural_frequency": 3.0,
    "backlash": 1.0,
    "seal_gap": 6.0,
    "acceleration": 3.0,
    "shaft_displacement": 6.0,
    "resonance_speed": 4.0,
    "root_strain": 8.0,
    "operating_point": 1.0,
    "oil_flow": 1.0,
    "inlet_temperature": 1.5,
    "reassembly": 5.0,
}
"""Of a sensor by its quantity, of a further point by what is changed for it; relative to one thermocouple."""


@dataclass(frozen=True, kw_only=True)
class Costs:
    """Costs of sensors and points.

    stated : by item, in any one unit; all others keep their usual ratio to these
    """

    stated: Mapping[str, float] = field(default_factory=dict)

    def of(self, item: str) -> float:
        """Of one sensor or point, in the unit of the stated costs, else relative to one thermocouple."""
        return self.stated.get(item, self._thermocouple * USUAL_COST[item])

    @property
    def _thermocouple(self) -> float:
        """As stated, else the geometric mean of what the stated items say of it."""
        if "temperature" in self.stated:
            return self.stated["temperature"]
        ratios = [value / USUAL_COST[item] for item, value in self.stated.items()]
        return geometric_mean(ratios) if ratios else 1.0
