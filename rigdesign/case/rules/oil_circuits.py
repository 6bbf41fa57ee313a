"""Rules of the oil circuits: whom they feed, with which oil and temperature, and whether their parts can do it."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rigdesign.base.errors import CaseError, Fault
from rigdesign.base.part_name import OilStreamName
from rigdesign.base.units import show
from rigdesign.case.circuit_parts import oil_circuit
from rigdesign.case.faults import unknown, written
from rigdesign.case.geometry import pitch_diameters
from rigdesign.case.lubrication import STREAM_KEYS
from rigdesign.properties.oil import OILS

if TYPE_CHECKING:
    from rigdesign.case.gearbox import Gearbox
    from rigdesign.case.lubrication import DipOil
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
            for stream in map(OilStreamName.read, line.consumers):
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
                    box, kind = stream.both
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
            for stream in map(OilStreamName.read, line.consumers):
                box, kind = stream.both
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


# Rules of the lubrication: what a sump needs, and bearings that cannot live on what they get.


def lubrication_faults(case: "Case") -> Iterator[Fault]:
    """Everything wrong with how gears and bearings get their oil."""
    for name, box in case.gearboxes.items():
        at = f"gearboxes.{name}"
        yield from _bearings(at, box)
        if box.sump is not None:
            yield from _sump(at, box, box.sump)
    yield from _drift(case)


def _bearings(at: str, box: "Gearbox") -> Iterator[Fault]:
    """Plain bearings need oil that is fed."""
    for name, bearing in box.bearings.items():
        if box.fed_bearings is None and bearing.needs_fed_oil:
            yield Fault(
                f"{at}.bearing_oil.lubrication", f'"{box.bearing_oil.lubrication}"',
                f"bearing {name} is a plain bearing, which needs oil that is fed",
                f"add [{at}.bearing_oil] with oil, inlet_temperature and flow",
            )  # fmt: skip
            return


def _sump(at: str, box: "Gearbox", sump: "DipOil") -> Iterator[Fault]:
    if box.housing is None and sump.sump_temperature is None:
        yield Fault(
            f"{at}.oil.sump_temperature", "",
            "without a housing nothing says what cools the sump",
            'add it, e.g. sump_temperature = "90 degC", or a [housing] table',
        )  # fmt: skip
    least = 0.5 * min(map(box.seat_diameter, box.gears))
    if sump.level >= least:
        yield Fault(
            f"{at}.oil.level", show(sump.level, "length"),
            f"reaches the top of a shaft, {show(least, 'length')} above its axis",
            "write a level below that, measured from the shaft axes and negative below them",
        )  # fmt: skip
    modules = {gear: mesh.normal_module for mesh in box.meshes.values() for gear in (mesh.pinion, mesh.wheel)}
    reach = max(0.5 * diameter + modules[gear] for gear, diameter in pitch_diameters(box).items())
    if sump.level <= -reach:
        yield Fault(
            f"{at}.oil.level", show(sump.level, "length"),
            f"no gear reaches the oil: the largest ends {show(reach, 'length')} below the axes",
            "raise the level, measured from the shaft axes and negative below them",
        )  # fmt: skip
    paths = box.oil_paths
    for key in ("leak_warm_cold", "bypass", "short_circuit"):
        if getattr(paths, key):
            yield Fault(
                f"{at}.oil_paths.{key}", f"{getattr(paths, key):g}", "the gears dip: no oil flows past them",
                'remove it, or write lubrication = "jet"',
            )  # fmt: skip
    films = {} if box.housing is None else box.housing.boundary
    for name, film in films.items():
        if getattr(film, "correlation", "") == "jet_renewal":
            yield Fault(
                f"{at}.housing.boundary.{name}.correlation", '"jet_renewal"', "the gears dip: no jet wets them",
                'write correlation = "fling_off"',
            )  # fmt: skip


def _drift(case: "Case") -> Iterator[Fault]:
    """A bracing that drifts with the gear oil needs to know its temperature before the run."""
    power = case.power_circuit
    if power.bracing.temperature_drift == 0.0:
        return
    box = case.gearboxes.get(power.counting_gear.gearbox)
    if box is not None and box.gear_oil_temperature is None:
        yield Fault(
            "drivetrain.bracing.temperature_drift", f"{power.bracing.temperature_drift:g}",
            "counts from the temperature of the gear oil, which this case leaves to the heat balance of the sump",
            "state gearboxes.….oil.sump_temperature, or write 0",
        )  # fmt: skip
