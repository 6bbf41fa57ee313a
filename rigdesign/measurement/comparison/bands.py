"""Where on the rig, and in which order band, a number belongs: the words a difference is located with."""

from rigdesign.case.geometry import housing_geometry
from rigdesign.measurement.places import MESH_ORDERS, SHAFT_ORDERS, Places
from rigdesign.measurement.reading.measurement_set import MeasurementSet
from rigdesign.prediction.model import Channel, Feature

NEAR = 1e-6
OUTSIDE = ("outer_",)
FIELD = ("field", "housing_foot")
COLD = ("cold", "bearing_bore", "journal", "_end")
WINDOWS = {"unloaded": "unloaded tooth"}
"""Window of a root gauge -> in words, where it needs others."""
ROTATING = ("gear_", "shaft_")


class Bands:
    """Names of the groups that features are gathered in."""

    def __init__(self, measurement: MeasurementSet) -> None:
        self._case = measurement.case
        self._channels = {name: entry.channel for name, entry in measurement.channels.items()}
        self._places = Places(measurement.case)

    def of(self, feature: Feature) -> str:
        """The group of a feature, as it stands in a sentence."""
        channel = self._channels[feature.channel]
        match channel.quantity:
            case "temperature":
                return f"temperatures of {self._zone(channel)}"
            case "warming_rate":
                return f"warming rates of {self._zone(channel)}"
            case "oil_outlet_temperature":
                return f"outlet temperature of {self._stream(channel.place)}"
            case "motor_power" | "drive_torque":
                return "drive power and torque"
            case "torque" | "angle":
                return f"{channel.quantity} {self._where(channel)}, {self.order_band(feature.order)}"
            case "acceleration" | "shaft_displacement":
                word = channel.quantity.replace("_", " ")
                return f"{word} at {channel.place}, {self.order_band(feature.order)}"
            case "resonance_speed":
                return "resonance speeds (run-up and run-down)"
            case "natural_frequency":
                return "natural frequencies (static tests)"
            case "backlash":
                return "backlash of the cold rig"
            case "root_strain":
                gear = channel.place.rpartition(".")[0]
                return f"root strain of {gear}, {WINDOWS.get(feature.part, feature.part)}"
            case "seal_gap":
                return f"seal gaps of gearbox {self._gearbox(channel.place)}"
        return str(channel.quantity)

    def order_band(self, order: float) -> str:
        """Mean, shaft orders, mesh orders, sidebands or other orders."""
        if order == 0.0:
            return "mean"
        turns = sorted({float(turn) for turn in self._places.gear_orders.values()})
        meshes = sorted({float(mesh) for mesh in self._places.mesh_orders.values()})
        if any(abs(order - k * mesh) < NEAR for mesh in meshes for k in range(1, max(MESH_ORDERS) + 4)):
            return "mesh orders"
        if any(abs(order - k * turn) < NEAR for turn in turns for k in SHAFT_ORDERS):
            return "shaft orders"
        sidebands = (
            abs(abs(order - k * mesh) - j * turn) < NEAR
            for mesh in meshes for k in MESH_ORDERS for turn in turns for j in (1, 2)
        )  # fmt: skip
        return "sidebands of the mesh orders" if any(sidebands) else "other orders"

    def _where(self, channel: Channel) -> str:
        word = "in coupling" if channel.quantity == "torque" else "of shaft"
        return f"{word} {channel.place}"

    def _zone(self, channel: Channel) -> str:
        name, _, part = channel.place.partition(".")
        if channel.at is not None:
            return f"{self._zone_at(name, channel.at)} of gearbox {name}"
        if part.startswith(FIELD):
            return f"the field under gearbox {name}"
        if part.startswith(OUTSIDE):
            zone = "the outside of the cold ends" if "cold" in part else "the outside of the warm chamber"
        elif part.startswith(ROTATING) and not any(word in part for word in COLD):
            zone = "gears and shafts"
        elif any(word in part for word in COLD):
            zone = "the cold ends"
        else:
            zone = "the warm chamber"
        return f"{zone} of gearbox {name}"

    def _zone_at(self, name: str, at: tuple[float, float, float]) -> str:
        if at[2] < 0.0:
            return "the field"
        geometry = housing_geometry(self._case.gearboxes[name])
        front, rear = geometry.warm_limits
        return "the warm chamber" if front <= at[0] <= rear else "the cold ends"

    def _stream(self, place: str) -> str:
        name, _, oil = place.partition(".")
        return f"the {oil.replace('_', ' ')} of gearbox {name}"

    def _gearbox(self, place: str) -> str:
        return place.partition(".")[0] if "." in place else next(iter(self._case.gearboxes))
