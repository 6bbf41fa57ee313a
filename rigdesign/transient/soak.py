"""How long the rig must soak before full torque: the shortest warm-up after which every clearance limit holds.

The gears warm in minutes, the box in hours. What the gears are ahead takes backlash and tip clearance away for a
while; a warm-up at standstill with the oil on brings the box along.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.part_name import BearingName, MeshName
from rigdesign.case.model import Case
from rigdesign.coupling.alignment import Alignment
from rigdesign.coupling.bearing_seats import WarmBearing
from rigdesign.coupling.expansion import hot_clearances, named_expansion
from rigdesign.rig.model import Rig
from rigdesign.transient.phases import Timeline
from thermal.expansion.alignment import ShaftAxis
from thermal.expansion.expansion import Expansion

# Temperatures and clearances of one housing over the schedule or an event, and the limits they are held against.

# Clearances of one housing at one moment: seals, shafts, bearings and meshes.

Quantity = Literal["seal_gap", "axial_play", "bearing_clearance", "backlash", "tip_clearance"]
QUANTITIES: tuple[Quantity, ...] = get_args(Quantity)
Clearances = Mapping[Quantity, Mapping[str, float]]
"""Quantity -> place -> clearance [m]."""


def clearances(
    rig: Rig,
    name: str,
    temperature: NDArray[np.float64],
    shape: Expansion,
    speed: float,
    seated: Mapping[str, WarmBearing] | None = None,
) -> Clearances:
    """Every clearance of the housing of gearbox ``name``.

    speed : where the case counts it [rad/s]; seated : bearings that conduct heat to their seats, by ``gearbox.bearing``

    Gears grow with the mean temperature of their bodies and with their speed, journals with theirs.
    """
    expansion = named_expansion(rig, name, shape)
    box = rig.case.gearboxes[name]
    bulk = {
        gear: rig.conduction[name].elements.body_mean(temperature, f"gear_{entry.shaft}")
        for gear, entry in box.gears.items()
    }
    backlash: dict[str, float] = {}
    tip: dict[str, float] = {}
    for mesh_name, mesh in box.meshes.items():
        full = MeshName(name, mesh_name)
        gears = box.gears[mesh.pinion], box.gears[mesh.wheel]
        first, second = (rig.materials[gear.material].expansion_coefficient for gear in gears)
        pair = rig.pairs[full].warm(
            bulk[mesh.pinion],
            bulk[mesh.wheel],
            expansion.centre_distance[full],
            reference_temperature=rig.case.ambient.reference_temperature,
            expansion_coefficients=(first, second),
            speed=rig.shaft_speed(gears[0].shaft, speed),
        )
        backlash[full], tip[full] = pair.transverse_backlash, min(pair.tip_clearances)
    play = {b.shaft: b.axial_play for b in box.bearings.values() if b.locating}
    bearings = hot_clearances(rig, speed, {name: expansion}, seated)
    return {
        "seal_gap": {seal.name: seal.minimum for seal in shape.seals.values()},
        "axial_play": {s.name: play[s.name] - s.axial_play_change for s in shape.shafts.values()},
        "bearing_clearance": {
            bearing: bearings[bearing] for bearing in (BearingName(name, part) for part in box.bearings)
        },
        "backlash": backlash,
        "tip_clearance": tip,
    }


def smallest(clearances: Clearances, quantity: Quantity) -> tuple[float, str]:
    """Least clearance of a kind [m] and where it is."""
    place = min(clearances[quantity], key=lambda key: clearances[quantity][key])
    return clearances[quantity][place], place


FloatArray = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Branch(Timeline):
    """Thermal history of one housing: over the schedule, or over what an event makes of it."""

    temperatures: Mapping[str, FloatArray]
    """Probe -> (n,) [K]."""
    clearances: tuple[Clearances, ...]
    """At every time."""
    alignment: tuple[Alignment, ...]
    """At every time."""
    axes: tuple[Mapping[str, ShaftAxis], ...]
    """Hot axis of every shaft at every time."""
    energy_closure: float
    warnings: tuple[str, ...]

    def ends(self, name: str) -> int:
        """Number of the last time of a phase."""
        number = [phase.name for phase in self.phases].index(name)
        return int(np.flatnonzero(self.phase == number)[-1])


def clearance_limits(case: Case) -> dict[Quantity, float]:
    """Least clearance of every kind the case limits [m]."""
    limits = case.limits.clearances
    films = any(bearing.has_film for box in case.gearboxes.values() for bearing in box.bearings.values())
    stated: dict[Quantity, float | None] = {
        "seal_gap": limits.seal_gap_minimum,
        "axial_play": limits.axial_play_minimum,
        "bearing_clearance": limits.bearing_clearance_minimum if films else None,
        "backlash": limits.backlash_minimum,
        "tip_clearance": limits.tip_clearance_minimum,
    }
    return {quantity: limit for quantity, limit in stated.items() if limit is not None}


def limited(case: Case, clearances: Clearances) -> Clearances:
    """Those that limits are for: clearances of plain bearings where the rig has any, else of its rolling bearings."""
    films = {
        f"{name}.{part}"
        for name, box in case.gearboxes.items()
        for part, bearing in box.bearings.items()
        if bearing.has_film
    }
    if not films:
        return clearances
    plain = {place: value for place, value in clearances["bearing_clearance"].items() if place in films}
    return {**clearances, "bearing_clearance": plain}


def broken(case: Case, clearances: Clearances) -> Iterator[tuple[Quantity, str, float]]:
    """Quantity, place and clearance [m] of every limit that does not hold at a moment."""
    with_limits = limited(case, clearances)
    for quantity, limit in clearance_limits(case).items():
        if not with_limits[quantity]:
            continue
        value, place = smallest(with_limits, quantity)
        if value < limit:
            yield quantity, place, value


# Warm-up that a gearbox needs before full torque.


@dataclass(frozen=True, kw_only=True)
class Soak:
    """Warm-up a gearbox needs before it may run up to full torque."""

    gearbox: str
    stage: str
    soak_time_s: float | None
    """Shortest warm-up after which every clearance limit holds up to the end of the dwell; None if none does."""
    reason: str


TRIALS = 4
"""Runs between a warm-up that is too short and one that is long enough."""
Trial = Callable[[int], bool]
"""Whether all limits of clearances hold after the warm-up has been left at this of its time steps."""


def soak_of(case: Case, planned: Branch, unwarmed: Branch | None, trial: Trial) -> Soak:
    """Soak time of one gearbox.

    planned : the schedule with its warm-up; unwarmed : without it, None if the case does not ask for it
    trial : runs the schedule from a time step of the warm-up to the end of the dwell
    """
    stage = next(phase.name for phase in planned.phases if phase.held)
    if not clearance_limits(case):
        return _soak(planned, stage, None, "the case states no limit of a clearance")
    last = planned.ends(next(phase.name for phase in reversed(planned.phases) if phase.held))
    lasting = [
        f"{kind.replace('_', ' ')} of {place}" for kind, place, _ in broken(case, planned.clearances[last])
    ]
    if lasting:
        return _soak(
            planned,
            stage,
            None,
            f"{', '.join(lasting)} stays below its limit at the end of the dwell: no warm-up mends that",
        )
    text = first_broken(case, planned)
    if text is not None:
        return _soak(
            planned, stage, None, f"after the planned warm-up of {hours(planned.phases[0].duration)}: {text}"
        )
    if unwarmed is None:
        return _soak(
            planned, stage, planned.phases[0].duration,
            "the planned warm-up is enough; a shorter one was not tried (event cold_start is not listed)",
        )  # fmt: skip
    text = first_broken(case, unwarmed)
    if text is None:
        return _soak(planned, stage, 0.0, "every limit of a clearance holds from a cold start")
    steps = [i for i, number in enumerate(planned.phase) if number == 0]
    enough = shortest(steps, trial)
    return _soak(
        planned, stage, float(planned.times[enough]),
        f"from a cold start {text}; shortest of {len(steps)} time steps of the warm-up after which all limits of "
        "clearances hold",
    )  # fmt: skip


def shortest(steps: Sequence[int], trial: Trial) -> int:
    """The first of ``steps`` found to be enough: the first is too short, the last long enough."""
    low, high = 0, len(steps) - 1
    for _ in range(TRIALS):
        if high - low < 2:
            break
        middle = (low + high) // 2
        low, high = (low, middle) if trial(steps[middle]) else (middle, high)
    return steps[high]


def first_broken(case: Case, branch: Branch) -> str | None:
    """The first limit a branch breaks up to the end of its last dwell, in words; None if all hold."""
    last = max(i for i, phase in enumerate(branch.phases) if phase.held)
    for time, number, clearances in zip(branch.times, branch.phase, branch.clearances, strict=True):
        if number > last:
            break
        for quantity, place, value in broken(case, clearances):
            limit = clearance_limits(case)[quantity]
            return (
                f"{quantity.replace('_', ' ')} of {place} falls to {1e6 * value:.1f} um, below {1e6 * limit:.1f} um, "
                f"{hours(float(time))} after the start, in phase {branch.phases[number].name}"
            )
    return None


def hours(time: float) -> str:
    """A time [s] as an engineer says it."""
    if time < 120.0:
        return f"{time:.0f} s"
    return f"{time / 60.0:.0f} min" if time < 7200.0 else f"{time / 3600.0:.1f} h"


def _soak(branch: Branch, stage: str, time: float | None, reason: str) -> Soak:
    return Soak(gearbox=branch.gearbox, stage=stage, soak_time_s=time, reason=reason)
