"""Where the residual is and what it goes along with: groups of features against speed, torque and oil temperature.

A residual is divided by its standard deviation (noise and what is declared of the sensor); within a group every
channel and order may lean on one variable with its own factor, ``r = a x``. The variable that explains the most
is named; a simpler one that explains nearly as much goes first.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.part_name import OilStreamName
from rigdesign.case.geometry import housing_geometry
from rigdesign.measurement.places import MESH_ORDERS, SHAFT_ORDERS, Places
from rigdesign.measurement.reading.measurement_set import MeasurementSet
from rigdesign.prediction.model import Channel, Feature, OperatingCondition

Array = NDArray[np.float64]
VARIABLES: Mapping[str, str] = {
    "constant": "is nearly constant over the operating points",
    "speed": "grows with speed",
    "torque": "grows with torque",
    "oil_temperature": "grows with the oil temperature",
    "speed_squared": "grows with the square of the speed",
    "torque_speed": "grows with torque times speed",
}
"""Leading variables, simple ones first, and how they read in a sentence."""
NEARLY = 0.04
"""Explained share that a less simple variable has to add."""
LEAST_SHARE = 0.5
"""Explained share below which no variable leads."""


@dataclass(frozen=True, kw_only=True)
class Located:
    """One group of features and its residual.

    rms : of the whitened residual, 1 where only the declared uncertainty acts
    excess : probability that chance alone makes the residual this large
    variable, share : the variable it goes along with and the part of its square that explains; empty and 0 for none
    positive : share of the whitened residual's weight that is above the simulation
    largest : residual [SI] of each channel that is largest in size
    """

    group: str
    features: tuple[int, ...]
    channels: tuple[str, ...]
    points: tuple[str, ...]
    """Operating points where some number is off by more than 3 sigma."""
    all_points: int
    rms: float
    excess: float
    variable: str
    share: float
    positive: float
    largest: Mapping[str, float]


def leading_variables(settings: Sequence[OperatingCondition], ambient: float) -> dict[str, Array]:
    """Each variable at each setting (n_settings,), as a share of its largest value."""
    speed = np.array([setting.speed for setting in settings])
    torque = np.array([setting.torque for setting in settings])
    oil = np.array(
        [
            np.mean(list(setting.inlet_temperature.values())) - (setting.ambient_temperature or ambient)
            if setting.inlet_temperature else 0.0
            for setting in settings
        ]
    )  # fmt: skip
    raw = {
        "constant": np.ones(len(settings)), "speed": speed, "torque": torque, "oil_temperature": oil,
        "speed_squared": speed**2, "torque_speed": torque * speed,
    }  # fmt: skip
    return {name: values / max(float(np.abs(values).max()), 1e-300) for name, values in raw.items()}


def locate(
    features: Sequence[Feature],
    residual: Array,
    spread: Array,
    groups: Sequence[str],
    settings: Sequence[OperatingCondition],
    ambient: float,
) -> tuple[Located, ...]:
    """Groups by the size of their whitened residual, largest first.

    residual, spread : (n,) [SI], NaN where a feature is not usable; groups : (n,) name of the group of each feature
    """
    variables = _Variables(
        leading_variables(settings, ambient), {setting.name: i for i, setting in enumerate(settings)}
    )
    usable = np.isfinite(residual)
    located = []
    for group in dict.fromkeys(groups):
        chosen = [i for i, name in enumerate(groups) if name == group and usable[i]]
        if chosen:
            located.append(_located(group, chosen, features, residual, spread, variables))
    return tuple(sorted(located, key=lambda item: -item.rms))


@dataclass(frozen=True)
class _Variables:
    """Leading variables by name over the settings, and the row of each setting in them."""

    values: Mapping[str, Array]
    row: Mapping[str, int]


def _located(
    group: str,
    chosen: Sequence[int],
    features: Sequence[Feature],
    residual: Array,
    spread: Array,
    variables: _Variables,
) -> Located:
    from scipy.stats import chi2

    whitened = residual[list(chosen)] / spread[list(chosen)]
    squares = whitened**2
    off = dict.fromkeys(features[i].setting for i, z in zip(chosen, whitened) if abs(z) > 3.0)
    points = {features[i].setting for i in chosen}
    variable, share = _leading(chosen, features, whitened, variables)
    largest: dict[str, float] = {}
    for i in chosen:
        largest[features[i].channel] = max(largest.get(features[i].channel, 0.0), float(residual[i]), key=abs)
    return Located(
        group=group,
        features=tuple(chosen),
        channels=tuple(dict.fromkeys(features[i].channel for i in chosen)),
        points=tuple(off),
        all_points=len(points),
        rms=float(np.sqrt(squares.mean())),
        excess=float(chi2.sf(squares.sum(), len(chosen))),
        variable=variable,
        share=share,
        positive=float(squares[whitened > 0.0].sum() / squares.sum()) if squares.any() else 0.5,
        largest=largest,
    )


def _leading(
    chosen: Sequence[int], features: Sequence[Feature], whitened: Array, variables: _Variables
) -> tuple[str, float]:
    """The variable that explains the most; nothing is said of fewer than three operating points."""
    if len({features[i].setting for i in chosen} & set(variables.row)) < 3:
        return "", 0.0
    of_points = np.array([variables.row[features[i].setting] for i in chosen])
    series: dict[tuple[str, float, str], list[int]] = {}
    for row, i in enumerate(chosen):
        series.setdefault((features[i].channel, features[i].order, features[i].part), []).append(row)
    whole = float(np.sum(whitened**2))
    if whole == 0.0:
        return "", 0.0
    best, best_share = "", 0.0
    for name, values in variables.values.items():
        left = 0.0
        for rows in series.values():
            x, r = values[of_points[rows]], whitened[rows]
            slope = float(x @ r) / max(float(x @ x), 1e-300)
            left += float(np.sum((r - slope * x) ** 2))
        share = 1.0 - left / whole
        if share > best_share + (NEARLY if best else 0.0):
            best, best_share = name, share
    return (best, best_share) if best_share >= LEAST_SHARE else ("", best_share)


# Where on the rig, and in which order band, a number belongs: the words a difference is located with.

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

    def _zone_at(self, name: str, place: tuple[float, float, float]) -> str:
        if place[2] < 0.0:
            return "the field"
        geometry = housing_geometry(self._case.gearboxes[name])
        front, rear = geometry.warm_limits
        return "the warm chamber" if front <= place[0] <= rear else "the cold ends"

    def _stream(self, place: str) -> str:
        stream = OilStreamName.read(place)
        return f"the {stream.part.replace('_', ' ')} of gearbox {stream.gearbox}"

    def _gearbox(self, place: str) -> str:
        return place.partition(".")[0] if "." in place else next(iter(self._case.gearboxes))
