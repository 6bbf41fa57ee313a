"""Heaters and coolers over time, of all gearboxes together: those of the oil circuits, and what the others would need.

The heater and coolers of an oil circuit give and carry what they can; an oil without a circuit is held at its inlet
temperature: it needs a heater where it comes back colder than it is fed, the cooler where it comes back warmer. The
oil of a housing leaves with the temperature of its stream; a gearbox without a housing gives its losses to its oil.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.part_name import OilStreamName
from rigdesign.case.gearbox import injected_flow
from rigdesign.case.model import Case
from rigdesign.coupling.housing_context import BEARING_OIL, GEAR_OIL
from rigdesign.coupling.oil import heater_and_cooler, oil_streams
from rigdesign.coupling.oil_circuits import one_tank
from rigdesign.coupling.state import OperatingPoint
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import gear_oil, wall_flow
from rigdesign.transient.heating import Heating
from rigdesign.transient.oil import FEED, HEATER_AND_COOLER, LEAK
from rigdesign.transient.oil_supply import StreamHeats, SupplyHistory, in_parts
from rigdesign.transient.phases import Phase, Timeline
from thermal.conditions.streams import StreamNetwork

FloatArray = NDArray[np.float64]

LEAKED = " leaked"
"""Behind the name of a stream: what leaks carry from tank to tank."""


@dataclass(frozen=True, kw_only=True)
class OilHistory(Timeline):
    """One housing over time as far as its oil is concerned."""

    outlets: Mapping[str, FloatArray]
    """GEAR_OIL and BEARING_OIL -> (n,) temperature with which each oil leaves [K]."""
    from_rest: bool
    """Whether it starts with the rig at rest, before the oil runs: nothing is needed at that time."""


@dataclass(frozen=True, kw_only=True)
class OilPower:
    """Heaters and cooler over one branch."""

    name: str
    """``schedule`` or the event."""
    phases: tuple[Phase, ...]
    times: FloatArray
    """(n,) since the start of the schedule [s], those of all housings."""
    phase: NDArray[np.int32]
    """(n,) number of the phase each time ends."""
    heater: FloatArray
    """(n,) of all oil circuits; and of oils without one that come back colder than they are fed [W]."""
    cooler: FloatArray
    """(n,) of all oil circuits; and of the other oils without one [W]."""
    streams: Mapping[str, FloatArray] = field(default_factory=dict)
    """``gearbox.stream`` -> (n,) heat with which its oil comes back above its inlet temperature [W]."""
    supply: SupplyHistory | None = None
    """Of the oil circuits, at the same times; None without any."""


def stream_heats(
    rig: Rig, heating: Heating, histories: Sequence[OilHistory], supply: SupplyHistory | None = None
) -> StreamHeats:
    """Heat of every oil stream over one branch from the histories of all its housings.

    The housings have times of their own: each heat is interpolated to the times of all, and to parts of the steps that
    the circuits need.

    supply : temperatures with which the housings were fed; None without oil circuits
    """
    first = histories[0]
    times = np.unique(np.concatenate([history.times for history in histories]))
    if supply is not None:
        times = in_parts(times)
    numbers = first.phase[np.minimum(np.searchsorted(first.times, times), len(first.times) - 1)]
    heats: dict[str, FloatArray] = {}
    for history in histories:
        of_housing = _housing_heats(rig, heating, history, supply)
        heats |= {name: np.interp(times, history.times, values) for name, values in of_housing.items()}
    housed = {history.gearbox for history in histories}
    without = [name for name in rig.case.gearboxes if name not in housed]
    if without:
        rows = [
            _without_housing(rig, heating, first, int(number), float(time))
            for number, time in zip(numbers, times, strict=True)
        ]
        heats |= {
            key: np.array([row[key] for row in rows])
            for key in rows[0]
            if OilStreamName.read(key).gearbox in without
        }
    return StreamHeats(
        times=times,
        phases=first.phases,
        phase=numbers,
        heats={name: heat for name, heat in heats.items() if not name.endswith(LEAKED)},
        leaked={name.removesuffix(LEAKED): heat for name, heat in heats.items() if name.endswith(LEAKED)},
        supplies={} if supply is None else supply.sampled(times),
    )


def oil_power(case: Case, name: str, given: StreamHeats, supply: SupplyHistory | None = None) -> OilPower:
    """Heaters and coolers over the branch ``name`` from the heats of its oil streams.

    supply : what the oil circuits do under these heats; None without any
    """
    heater, cooler = heater_and_cooler(case, given.to_tank)
    circuits = [] if supply is None else list(supply.circuits.values())
    return OilPower(
        name=name,
        phases=tuple(given.phases),
        times=given.times,
        phase=given.phase,
        heater=np.sum([heater, *(each.heater for each in circuits)], axis=0),
        cooler=np.sum([cooler, *(each.cooler for each in circuits)], axis=0),
        streams=given.heats,
        supply=supply,
    )


def _local_time(history: OilHistory, number: int, time: float) -> float:
    """Time since the start of a phase [s]."""
    before = sum(phase.duration for phase in history.phases[:number])
    return min(max(time - history.start - before, 0.0), history.phases[number].duration)


def _housing_heats(
    rig: Rig, heating: Heating, history: OilHistory, supply: SupplyHistory | None
) -> dict[str, FloatArray]:
    """Heat of both oils of a housing at its own times [W], and what leaks carry; none while no oil runs."""
    heats = {
        f"{history.gearbox}.{kind}{suffix}": np.zeros(len(history.times))
        for kind in (GEAR_OIL, BEARING_OIL)
        for suffix in ("", LEAKED)
    }
    begins = history.start + np.concatenate([[0.0], np.cumsum([phase.duration for phase in history.phases])])
    for row, (time, number) in enumerate(zip(history.times, history.phase, strict=True)):
        phase = history.phases[number]
        if not phase.oil or (row == 0 and history.from_rest):
            continue
        stage = heating.stage(history.gearbox, phase, float(begins[number]), supply)
        conditions = stage.conditions
        if callable(conditions):
            conditions = conditions(_local_time(history, int(number), float(time)))
        networks = {c.volumes[0].name: c for c in conditions if isinstance(c, StreamNetwork)}
        outlets = {kind: float(values[row]) for kind, values in history.outlets.items()}
        gear, leaked = _gear_heat(rig, history.gearbox, networks[GEAR_OIL], outlets[GEAR_OIL])
        heats[f"{history.gearbox}.{GEAR_OIL}"][row] = gear - leaked
        if BEARING_OIL in networks:
            heats[f"{history.gearbox}.{BEARING_OIL}"][row] = _bearing_heat(
                rig.case, history.gearbox, networks, outlets[BEARING_OIL]
            )
        if not one_tank(rig.case, history.gearbox):
            moved = _moved_by_leak(networks)
            heats[f"{history.gearbox}.{GEAR_OIL}{LEAKED}"][row] = -moved
            heats[f"{history.gearbox}.{BEARING_OIL}{LEAKED}"][row] = moved
    return heats


def _fed(networks: Mapping[str, StreamNetwork], kind: str) -> float:
    """Temperature at which an oil is fed [K]."""
    return next(each.temperature for each in networks[kind].supplies if each.name == f"{kind} {FEED}")


def _moved_by_leak(networks: Mapping[str, StreamNetwork]) -> float:
    """Heat of gear oil that leaks to the bearings, as fed, above the bearing oil that makes it up [W]."""
    network = networks[BEARING_OIL]
    flow = sum(stream.mass_flow for stream in network.streams if stream.source == LEAK)
    if not flow:
        return 0.0
    return network.specific_heat * flow * (_fed(networks, GEAR_OIL) - _fed(networks, BEARING_OIL))


def _gear_heat(rig: Rig, name: str, network: StreamNetwork, outlet: float) -> tuple[float, float]:
    """Heat of the gear oil above its inlet, and what of it leaks to the bearings [W].

    Oil past the walls takes its part of the losses along, which the stream of the walls does not have.
    """
    box = rig.case.gearboxes[name]
    if box.jets is None:
        set_temperature = box.gear_oil_temperature
        ties = (link.conductance for link in network.links if link.kind == HEATER_AND_COOLER)
        return sum(ties) * (outlet - (set_temperature or outlet)), 0.0
    inlet = _fed({GEAR_OIL: network}, GEAR_OIL)
    flow = sum(stream.mass_flow for stream in network.streams if stream.target is None)
    taken = flow * network.specific_heat * (outlet - inlet)
    whole = injected_flow(box) * len(box.meshes)
    past = network.volumes[0].power * (whole / wall_flow(box) - 1.0)
    oil = gear_oil(rig, name)
    leak = box.oil_paths.leak_warm_cold * oil.density(inlet) * box.jets.flow * len(box.meshes)
    return taken + past, leak * network.specific_heat * (outlet - inlet)


def _bearing_heat(case: Case, name: str, networks: Mapping[str, StreamNetwork], outlet: float) -> float:
    """Heat of the bearing oil above what it and the gear oil leaked into it were fed with [W]."""
    box, network = case.gearboxes[name], networks[BEARING_OIL]
    if box.fed_bearings is None:
        return 0.0
    flow = sum(stream.mass_flow for stream in network.streams if stream.target is None)
    leak = sum(stream.mass_flow for stream in network.streams if stream.source == LEAK)
    warm = leak * _fed(networks, GEAR_OIL) if leak else 0.0
    fed = (flow - leak) * _fed(networks, BEARING_OIL) + warm
    return network.specific_heat * (flow * outlet - fed)


def _without_housing(
    rig: Rig, heating: Heating, history: OilHistory, number: int, time: float
) -> dict[str, float]:
    """Heat of every oil stream by the losses alone [W]; none while no oil runs, or at the start from rest."""
    phase = history.phases[number]
    before, after, share = phase.between(_local_time(history, number, time))
    first, second = (_loss_heats(rig, heating, knot.point) for knot in (before, after))
    runs = phase.oil and not (history.from_rest and time <= history.start)
    return {
        name: (1.0 - share) * heat + share * second[name] if runs else 0.0 for name, heat in first.items()
    }


def _loss_heats(rig: Rig, heating: Heating, point: OperatingPoint) -> dict[str, float]:
    """Heat of every oil stream at an operating point as if no gearbox had walls [W]."""
    none = {f"{name}.{kind}": 0.0 for name in rig.case.gearboxes for kind in (GEAR_OIL, BEARING_OIL)}
    state = heating.state(point)
    chambers = {
        name: box.gear_oil_temperature or state.coupling_state.oil_outlet[f"{name}.{GEAR_OIL}"]
        for name, box in rig.case.gearboxes.items()
    }
    streams = oil_streams(rig, state.losses, {}, none, chambers)
    return {stream.name: stream.heat for stream in streams}
