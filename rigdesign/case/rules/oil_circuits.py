"""Rules of the oil circuits: whom they feed, with which oil and temperature, and whether their parts can do it."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rigdesign.base.errors import CaseError, Fault
from rigdesign.base.units import show
from rigdesign.case.circuit_parts import oil_circuit
from rigdesign.case.faults import unknown, written
from rigdesign.case.oil_circuits import STREAM_KEYS
from rigdesign.properties.oil import OILS

if TYPE_CHECKING:
    from rigdesign.case.model import Case

SAME = 1e-6
"""Difference below which a stated inlet temperature is the setpoint [K]."""


def oil_circuit_faults(case: "Case") -> Iterator[Fault]:
    """Everything wrong with the oil circuits; their parts are built once their consumers are sound."""
    faults = [*_oils(case), *_consumers(case)]
    yield from faults
    if not faults:
        yield from _setpoints(case)
        yield from _parts(case)


def _oils(case: "Case") -> Iterator[Fault]:
    oils = [*case.oils, *OILS]
    for name, circuit in case.oil_circuits.items():
        if circuit.oil not in oils:
            yield unknown(f"oil_circuits.{name}.oil", circuit.oil, oils, "oil")


def _consumers(case: "Case") -> Iterator[Fault]:
    """Consumers that exist, are fed, once, and with the oil of their circuit."""
    streams = {
        f"{box}.{kind}": feed for box, entry in case.gearboxes.items() for kind, (feed, _) in entry.feeds.items()
    }  # fmt: skip
    oils = [*case.oils, *OILS]
    fed: dict[str, str] = {}
    for name, circuit in case.oil_circuits.items():
        for key, line in circuit.lines.items():
            at = f"oil_circuits.{name}.lines.{key}.consumers"
            for stream in line.consumers:
                if stream not in streams:
                    yield unknown(at, stream, streams, "oil stream that is fed")
                    continue
                if stream in fed:
                    yield Fault(
                        at, written(stream), f"is fed by {fed[stream]} already",
                        "name every consumer in one line of one circuit",
                    )  # fmt: skip
                fed.setdefault(stream, f"oil_circuits.{name}.lines.{key}")
                if circuit.oil in oils and streams[stream].oil != circuit.oil:
                    box, _, kind = stream.partition(".")
                    yield Fault(
                        f"oil_circuits.{name}.oil", written(circuit.oil),
                        f"{stream} is fed with another oil, {written(streams[stream].oil)}",
                        f"write the same oil here and in gearboxes.{box}.{STREAM_KEYS[kind]}.oil, or give it a circuit",
                    )  # fmt: skip


def _setpoints(case: "Case") -> Iterator[Fault]:
    """Inlet temperatures that agree with the circuit; setpoints that oil and coolant allow."""
    for name, circuit in case.oil_circuits.items():
        at = f"oil_circuits.{name}"
        for key, line in circuit.lines.items():
            meant = circuit.supply_setpoint(key)
            for stream in line.consumers:
                box, _, kind = stream.partition(".")
                stated = case.gearboxes[box].feeds[kind][0].inlet_temperature
                if meant is not None and abs(stated - meant) > SAME:
                    yield Fault(
                        f"gearboxes.{box}.{STREAM_KEYS[kind]}.inlet_temperature", show(stated, "temperature"),
                        f"{at}.lines.{key} feeds it with {show(meant, 'temperature')}",
                        "leave it out, or change the setpoint of the line",
                    )  # fmt: skip
            setpoint = line.setpoint
            if setpoint is not None:
                yield from _above_oil(f"{at}.lines.{key}.setpoint", circuit.oil, setpoint)
                if line.cooler is not None:
                    coolant = line.cooler.coolant.inlet_temperature
                    yield from _below_coolant(f"{at}.lines.{key}.setpoint", setpoint, coolant)
        if circuit.heater is not None:
            yield from _above_oil(f"{at}.heater.setpoint", circuit.oil, circuit.heater.setpoint)
        if circuit.tank_cooler is not None:
            coolant = circuit.tank_cooler.coolant.inlet_temperature
            yield from _below_coolant(f"{at}.tank_cooler.setpoint", circuit.tank_cooler.setpoint, coolant)


def _above_oil(path: str, name: str, setpoint: float) -> Iterator[Fault]:
    """Only built-in oils state a highest temperature."""
    oil = OILS.get(name)
    if oil is not None and setpoint > oil.highest_temperature:
        limit = show(oil.highest_temperature, "temperature")
        yield Fault(
            path, show(setpoint, "temperature"), f"is above the {limit} that {name} stands for long",
            "lower it, or take an oil made for it",
        )  # fmt: skip


def _below_coolant(path: str, setpoint: float, coolant: float) -> Iterator[Fault]:
    if setpoint <= coolant:
        yield Fault(
            path, show(setpoint, "temperature"),
            f"is not above the coolant, {show(coolant, 'temperature')}: no cooler holds it, however large",
            "raise it, or take colder coolant",
        )  # fmt: skip


def _parts(case: "Case") -> Iterator[Fault]:
    """What tank, pump, heater, coolers and lines say about themselves and each other."""
    oils = dict(OILS) | {name: entry.properties(name) for name, entry in case.oils.items()}
    for name, circuit in case.oil_circuits.items():
        try:
            oil_circuit(case, name, oils[circuit.oil])
        except CaseError as error:
            yield from error.faults
