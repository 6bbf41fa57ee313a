"""Operating cases: speeds, loads and oil temperature of each load case over what the components themselves state."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from rigdesign.rexs.attribute_log import AttributeLog
from rigdesign.rexs.gear_unit import OperatingCase, ShaftLoad
from rigdesign.rexs.model import Component, RexsModel
from rigdesign.rexs.positions import shaft_of


@dataclass(frozen=True)
class _State:
    """What one set of components says of the operation."""

    speeds: Mapping[int, float]
    loads: Mapping[int, ShaftLoad]
    lubricant_temperature: float | None
    time_share: float | None
    duration: float | None

    def over(self, base: "_State") -> "_State":
        """This state, with ``base`` where it says nothing."""
        loads = {
            number: _over(self.loads[number], base.loads[number]) if number in self.loads else load
            for number, load in base.loads.items()
        }
        temperature = self.lubricant_temperature
        return replace(
            self,
            speeds={**base.speeds, **self.speeds},
            loads={**loads, **{number: load for number, load in self.loads.items() if number not in loads}},
            lubricant_temperature=base.lubricant_temperature if temperature is None else temperature,
        )

    def case(self, number: str | None) -> OperatingCase:
        return OperatingCase(
            number,
            self.speeds,
            tuple(self.loads.values()),
            self.time_share,
            self.duration,
            self.lubricant_temperature,
        )


def read_operation(model: RexsModel, log: AttributeLog) -> tuple[tuple[OperatingCase, ...], float | None]:
    """Operating cases, and the operating time of the whole [s].

    Without a load spectrum, what the components state is the one case, if it has a speed or a torque.
    """
    base = _state(model, log, model.components)
    cases = []
    for spectrum in model.load_spectra:
        prefix = f"{spectrum.id}." if len(model.load_spectra) > 1 else ""
        for load_case in spectrum.load_cases:
            log.load_case = f"{prefix}{load_case.id}"
            parts = tuple(_typed(model, part) for part in load_case.components)
            cases.append(_state(model, log, parts).over(base).case(log.load_case))
            for part in parts:
                log.list_rest(part, "no counterpart in the operation of a case")
        log.load_case = f"{prefix}accumulation"
        for part in spectrum.accumulation:
            log.list_rest(_typed(model, part), "a value over all load cases")
        log.load_case = None
    stated = base.speeds or any(load.torque or load.power for load in base.loads.values())
    if not cases and stated:
        cases = [replace(base, time_share=None, duration=None).case(None)]
    return tuple(cases), base.duration


def _state(model: RexsModel, log: AttributeLog, components: tuple[Component, ...]) -> _State:
    where = "operating_cases" if log.load_case is None else f"operating_cases[{log.load_case}]"
    casings = [part for part in components if part.type == "gear_casing"]
    units = [part for part in components if part.type == "gear_unit"]
    temperatures = [
        log.number(part, "temperature_lubricant", "C", f"{where}.lubricant_temperature", above=0.0)
        for part in casings
    ]
    share = [log.number(part, "operating_time_fraction", "%", f"{where}.time_share") for part in units]
    duration = [log.number(part, "operating_time", "h", f"{where}.duration", above=0.0) for part in units]
    speeds = {
        part.id: log.number(part, "rotational_speed", "1 / min", f"{where}.speeds[{part.id}]")
        for part in components
        if part.type == "shaft"
    }
    loads = [_load(model, log, part, where) for part in components if part.type == "external_load"]
    return _State(
        speeds={number: speed for number, speed in speeds.items() if speed is not None},
        loads={load.id: load for load in loads},
        lubricant_temperature=_first(temperatures),
        time_share=_first(share),
        duration=_first(duration),
    )


def _load(model: RexsModel, log: AttributeLog, part: Component, where: str) -> ShaftLoad:
    here = f"{where}.loads[{part.id}]"
    return ShaftLoad(
        id=part.id,
        shaft=shaft_of(model, part.id),
        position=log.number(part, "u_coordinate_on_shaft", "mm", f"{here}.position"),
        torque=log.number(part, "torque_around_u_axis", "N m", f"{here}.torque"),
        power=log.number(part, "power", "kW", f"{here}.power"),
        transmits_torque=log.flag(part, "transmits_torque", f"{here}.transmits_torque"),
    )


def _over(load: ShaftLoad, base: ShaftLoad) -> ShaftLoad:
    """``load`` with ``base`` where it says nothing; torque and power of ``base`` count only where it has neither."""
    if load.torque is not None or load.power is not None:
        base = replace(base, torque=None, power=None)
    stated = {
        name: value
        for name in ("position", "torque", "power", "transmits_torque")
        if (value := getattr(load, name)) is not None
    }
    return replace(base, **stated)


def _typed(model: RexsModel, part: Component) -> Component:
    """A component of a load case with the type that the model gives it."""
    return replace(part, type=model.component(part.id).type)


def _first(values: list[float | None]) -> float | None:
    return next((value for value in values if value is not None), None)
