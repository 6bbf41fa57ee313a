"""What is predicted: operating points as run, channels of the rig, and the numbers a channel gives at a point."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal, TypeVar

import numpy as np
from numpy.typing import NDArray

from rigdesign.base import units
from rigdesign.base.units import KINDS, QuantityKind
from rigdesign.case.drivetrain import MeshStiffness, ShaftModel
from rigdesign.case.loader import changed_together
from rigdesign.case.model import Case
from rigdesign.case.paths import slot_at
from rigdesign.case.provenance import take_off

Quantity = Literal[
    "temperature",
    "warming_rate",
    "oil_outlet_temperature",
    "motor_power",
    "drive_torque",
    "torque",
    "angle",
    "natural_frequency",
    "backlash",
    "seal_gap",
    "acceleration",
    "shaft_displacement",
    "resonance_speed",
    "root_strain",
]
RootWindow = Literal["entry", "maximum", "exit", "unloaded"]
"""Numbers of the curve of a root gauge; see `rigdesign.strain_gauge.turn_average`."""
Part = Literal["value", "real", "imaginary"] | RootWindow
ROOT_WINDOWS: tuple[RootWindow, ...] = ("entry", "maximum", "exit", "unloaded")
"""All of them, in their order."""


@dataclass(frozen=True, kw_only=True)
class PredictionModel:
    """Shafts and teeth of the power circuit in a prediction.

    shafts : that only twist, or that bend on their bearings in six degrees of freedom; None as the case says
    teeth : tooth model of the meshes; None as the case says, at ``quick`` the analytic one in place of influence
        numbers, with which the constants of the diagnosis were fitted
    """

    shafts: ShaftModel | None = None
    teeth: MeshStiffness | None = None


OWN_MODEL = PredictionModel()
"""What the case asks for."""
TORSIONAL = PredictionModel(shafts="torsional")
"""Shafts that only twist."""
MEASURED_AGAINST = OWN_MODEL
"""Model that measured data are held against, and that the constants of the diagnosis were fitted with; of sets with
root gauges it is `GAUGES_AGAINST`, in the shafts that lateral channels need (`measured_against`)."""
GAUGES_AGAINST = PredictionModel(shafts="torsional", teeth="influence_numbers")
"""The same of sets with root gauges, whose stress needs the influence numbers of the teeth anyway."""

LATERAL_QUANTITIES = frozenset({"acceleration", "shaft_displacement"})
"""Quantities that shafts which only twist do not have."""

ORDER_QUANTITIES = frozenset({"torque", "angle"}) | LATERAL_QUANTITIES
"""Quantities that are read as complex orders of the rotating shaft."""

WITHOUT_MEAN = frozenset({"angle"}) | LATERAL_QUANTITIES
"""Those of them whose mean says nothing: an angle counts from anywhere, a probe is set to zero, a piezo has no mean."""

MODAL_QUANTITIES = frozenset({"natural_frequency", "resonance_speed"})
"""Quantities that are a mode of the rig: its frequency at rest, the speed at which an order meets it."""

STANDING_QUANTITIES = MODAL_QUANTITIES | {"backlash"}
"""Quantities that are one number of the rig, whatever the operating points."""


@dataclass(frozen=True, kw_only=True)
class OperatingCondition:
    """One operating point as it was run. What is left out is as in the case. SI, kelvin."""

    name: str
    speed: float
    """At the gear where the case counts it [rad/s]."""
    torque: float
    """Bracing torque at that gear [N m]."""
    inlet_temperature: Mapping[str, float] = field(default_factory=dict)
    """By oil stream, ``gearbox.gear_oil`` or ``gearbox.bearing_oil`` [K]."""
    flow: Mapping[str, float] = field(default_factory=dict)
    """By oil stream, as the case counts it: per mesh or per bearing [m3/s]."""
    ambient_temperature: float | None = None
    tooth_offset: Mapping[str, int] = field(default_factory=dict)
    """By mesh, ``gearbox.mesh``: teeth by which the wheel was put on further than in the case."""


@dataclass(frozen=True, kw_only=True)
class Channel:
    """One sensor as the model sees it.

    place : of ``temperature`` a surface or body of a housing, ``test.outer_warm``, or the gearbox alone where
        ``at`` gives coordinates; of ``warming_rate`` that of a temperature among the channels, whose change with
        time it is; of ``oil_outlet_temperature`` a stream, ``test.gear_oil``; of ``torque`` a
        coupling; of ``angle`` a shaft; of ``natural_frequency``, rig at rest, the number of a torsional mode from 1
        or the name of any mode (`dynamics.rotor.damped_modes`); of ``backlash`` a mesh, ``test.main``; of
        ``seal_gap`` a seal as results name it; of ``motor_power`` and ``drive_torque`` the motor; of ``root_strain`` a
        strain gauge, ``test.pinion.ii``; of ``acceleration`` a bearing, ``test.pinion_front``; of
        ``shaft_displacement`` a bearing, or a shaft with ``position``; of ``resonance_speed`` a mode as of
        ``natural_frequency``
    """

    name: str
    quantity: Quantity
    place: str = ""
    at: tuple[float, float, float] | None = None
    """Coordinates in the housing [m]."""
    orders: tuple[float, ...] = ()
    """Of `ORDER_QUANTITIES`: per turn of the reference gear; 0 is the mean. Of ``resonance_speed`` the one tracked."""
    direction: tuple[float, float, float] | None = None
    """Of `LATERAL_QUANTITIES`: unit vector (x, y, z) in the frame of the case, x along the shafts, y across, z up."""
    position: float | None = None
    """Of ``shaft_displacement`` of a shaft: distance from the start of the shaft [m]."""
    torque: float | None = None
    """Of ``resonance_speed``: bracing torque of the sweep [N m]; that at rest when left out."""

    windows: tuple[RootWindow, ...] = ROOT_WINDOWS
    """Of ``root_strain``: the numbers that are read."""
    face: float = 0.0
    """Of ``root_strain``: face position of the gauge, from mid-face, as the case has it [m]."""

    @property
    def reads(self) -> tuple[object, ...]:
        """What and where it reads; names and orders of two channels that read the same may differ."""
        tracked = self.orders if self.quantity == "resonance_speed" else ()
        return self.quantity, self.place, self.at, self.direction, self.position, self.torque, tracked


@dataclass(frozen=True, order=True)
class Feature:
    """One number: a channel at an operating point, of orders the real or imaginary part, of a root gauge the window.

    The signal is the sum of Re(X_k exp(i k phi)) over its orders k; phi is the angle of the reference gear,
    zero where its tooth 0 stands at the pitch point of its first mesh (plus the phase of the case).
    """

    channel: str
    setting: str
    """Empty for a standing quantity."""
    order: float = 0.0
    part: Part = "value"


@dataclass(frozen=True, kw_only=True)
class Prediction:
    """Numbers of all features, SI."""

    features: tuple[Feature, ...]
    values: NDArray[np.float64]
    """(n_features,)"""
    error: float = 0.0
    """Stated error of temperatures against the full model [K]."""


def features_of(settings: Iterable[OperatingCondition], channels: Iterable[Channel]) -> tuple[Feature, ...]:
    """Features in their fixed order: settings, then channels, then orders; standing quantities at the end."""
    channels = tuple(channels)
    found = [
        feature
        for setting in settings
        for channel in channels
        if channel.quantity not in STANDING_QUANTITIES
        for feature in _at(channel, setting.name)
    ]
    standing = (channel for channel in channels if channel.quantity in STANDING_QUANTITIES)
    return (*found, *(Feature(channel.name, "") for channel in standing))


def _at(channel: Channel, setting: str) -> list[Feature]:
    if channel.quantity == "root_strain":
        return [Feature(channel.name, setting, part=window) for window in channel.windows]
    if channel.quantity not in ORDER_QUANTITIES:
        return [Feature(channel.name, setting)]
    return [Feature(channel.name, setting, order, part) for order in channel.orders for part in _parts(order)]


def _parts(order: float) -> tuple[Part, ...]:
    return ("real", "imaginary") if order else ("value",)


def measured_against(channels: Iterable[Channel]) -> PredictionModel:
    """Model that data of these channels are held against: lateral ones need shafts that bend, root gauges teeth of
    influence numbers."""
    quantities = {channel.quantity for channel in channels}
    lateral, gauges = not LATERAL_QUANTITIES.isdisjoint(quantities), "root_strain" in quantities
    if lateral:
        return replace(OWN_MODEL, teeth=GAUGES_AGAINST.teeth) if gauges else OWN_MODEL
    return GAUGES_AGAINST if gauges else MEASURED_AGAINST


# Changes of a case by dotted path, with bare numbers in SI where the file would want a unit.

Changes = Mapping[str, object]
"""Dotted path -> value as the file would hold it; a bare number at a place with a unit counts in SI, kelvin."""


def changed_case(case: Case, changes: Changes) -> Case:
    """The case with some values replaced, validated once.

    Raises
    ------
    CaseError
        A path that does not exist, or faults of the changed case.
    """
    if not changes:
        return case
    plain, _, _ = take_off(dict(case.origin.tree))
    return changed_together(case, {path: _written(plain, path, value) for path, value in changes.items()})


WARMING = "ambient.warming_time"
"""Path of the time that a point had run where it was not steady."""


def only_warming(changes: Changes | Sequence[Changes]) -> bool:
    """Whether the time that points had run is all that changes."""
    given = [changes] if isinstance(changes, Mapping) else changes
    return any(given) and all(set(one) <= {WARMING} for one in given)


def written(case: Case, path: str, value: object) -> object:
    """A value of ``Changes`` as the file of this case would hold it."""
    plain, _, _ = take_off(dict(case.origin.tree))
    return _written(plain, path, value)


def _written(plain: Mapping[str, object], path: str, value: object) -> object:
    """The value as a file holds it."""
    if isinstance(value, bool) or not isinstance(value, int | float) or "*" in path:
        return value
    slot = slot_at(Case, plain, path.split("."))
    if slot is None or slot.quantity is None:
        return value
    return _with_unit(float(value), KINDS[slot.quantity.kind])


def _with_unit(value: float, kind: QuantityKind) -> str:
    """A number in SI with the unit a file knows it by."""
    spelling = next(unit for unit in kind.units if units.worth(kind.name, unit) == (1.0, 0.0))
    return f"{value!r} {spelling}"


# Operating points met again: how far two of them lie apart, and which of one set are those of another.

NEAR = {"speed": 0.05, "torque": 0.05, "flow": 0.15, "temperature": 8.0}
"""How far a point may lie from the plan for derivatives to carry it over: relative, temperatures in kelvin."""
AGAIN = 2.0
"""How far a point may lie from one of another set to be the same, met again (`apart`)."""

T = TypeVar("T")


def nearest_of(
    wanted: Sequence[T], offered: Sequence[T], distance: Callable[[T, T], float], most: float
) -> dict[int, int]:
    """Place of a wanted one -> that of the nearest offered one, none used twice; without those that are farther off."""
    found: dict[int, int] = {}
    for number, one in enumerate(wanted):
        free = [place for place in range(len(offered)) if place not in found.values()]
        nearest = min(free, key=lambda place: distance(offered[place], one), default=None)
        if nearest is not None and distance(offered[nearest], one) <= most:
            found[number] = nearest
    return found


def apart(planned: OperatingCondition, run: OperatingCondition) -> float:
    """Distance of a point from one of a plan, at most one where derivatives serve; infinite where they state
    different things."""
    if dict(planned.tooth_offset) != dict(run.tooth_offset):
        return float("inf")
    if set(planned.inlet_temperature) != set(run.inlet_temperature) or set(planned.flow) != set(run.flow):
        return float("inf")
    if (planned.ambient_temperature is None) != (run.ambient_temperature is None):
        return float("inf")
    shares = [
        abs(run.speed / planned.speed - 1.0) / NEAR["speed"],
        abs(run.torque - planned.torque) / max(abs(planned.torque), 1e-9) / NEAR["torque"],
    ]
    shares += [abs(run.flow[place] / value - 1.0) / NEAR["flow"] for place, value in planned.flow.items()]
    warmer = [run.inlet_temperature[place] - value for place, value in planned.inlet_temperature.items()]
    if planned.ambient_temperature is not None and run.ambient_temperature is not None:
        warmer.append(run.ambient_temperature - planned.ambient_temperature)
    return max(*shares, *(abs(step) / NEAR["temperature"] for step in warmer))


def met_again(now: Sequence[OperatingCondition], before: Sequence[OperatingCondition]) -> dict[str, str]:
    """Operating point -> that of the other set it is; the rig at rest is one of them."""
    pairs = nearest_of(now, before, apart, AGAIN)
    return {"": ""} | {now[here].name: before[there].name for here, there in pairs.items()}
