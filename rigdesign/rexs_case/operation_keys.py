"""Keys of oil and schedule: lubricant and its temperature, the load case with the most torque at the pinion."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

from rigdesign.base.quantity_kinds import ZERO_CELSIUS
from rigdesign.rexs.gear_unit import GearUnit, UnitLubricant
from rigdesign.rexs_case.entries import CaseTable, Entry, Origins, assumed, needed, quantity, quoted
from rigdesign.rexs_case.pinion_load import PinionLoad
from rigdesign.rexs_case.stage import GearStage

FASTEST_DIP = 15.0
"""Pitch line velocity up to which gears dip, beyond which oil is injected [m/s]."""
ALIKE = 0.02
"""Difference of viscosities up to which an oil of a built-in name is that oil."""
FEWEST, MOST = 1e-6, 1e-1
"""Kinematic viscosities that an oil may have [m^2/s]."""
RPM = math.pi / 30.0


@dataclass(frozen=True)
class Operation:
    """Operating cases at the pinion, and the pitch line velocity of the first [m/s]; None where it is not known."""

    loads: tuple[PinionLoad, ...]
    velocity: float | None

    @property
    def first(self) -> PinionLoad | None:
        """The case that becomes the test."""
        return self.loads[0] if self.loads else None


def operation_of(stage: GearStage, loads: tuple[PinionLoad, ...]) -> Operation:
    """Operation of a stage."""
    gear, speed = stage.pinion.gear, loads[0].speed if loads else None
    if gear.normal_module is None or gear.teeth is None or not speed:
        return Operation(loads, None)
    radius = 0.5 * gear.normal_module * gear.teeth / math.cos(gear.helix_angle or 0.0)
    return Operation(loads, radius * speed)


# ------------------------------------------------------------------ oil


def oil_tables(
    origins: Origins, unit: GearUnit, stage: GearStage, operation: Operation
) -> Iterator[CaseTable]:
    """Oil of the test gearbox, and the oil itself where it is no built-in one."""
    journals = any(bearing.kind == "journal" for seated in stage.gears for bearing in seated.bearings)
    velocity = operation.velocity
    dips = not journals and (velocity is None or velocity <= FASTEST_DIP)
    name, custom = _oil(origins, unit.lubricant)
    temperature = _oil_temperature(origins, operation, "sump_temperature" if dips else "inlet_temperature")
    if dips:
        known = "" if velocity is None else f"; here {velocity:.3g} m/s"
        reason = f"gears dip up to a pitch line velocity of {FASTEST_DIP:g} m/s{known}"
        kind = Entry("lubrication", '"dip"', "assumed", f"{reason}; or jet", markable=False)
        level = assumed("level", '"0 mm"', "oil up to the shaft axes, as in an FZG rig")
        yield CaseTable("gearboxes.test.oil", (kind, name, level, temperature))
    else:
        why = "plain bearings need fed oil" if journals else f"above {FASTEST_DIP:g} m/s at the pitch line"
        kind = Entry("lubrication", '"jet"', "assumed", f"oil is injected, {why}", markable=False)
        yield CaseTable("gearboxes.test.oil", (kind, name, temperature))
    if custom is not None:
        yield custom


def _oil(origins: Origins, oil: UnitLubricant | None) -> tuple[Entry, CaseTable | None]:
    """The key of the oil, and its table where it is no built-in one."""
    example, remedy = '"FVA 3A"', "built-in oil, or a table of its own under oils with two viscosities"
    if oil is None:
        return needed("oil", example, remedy), None
    cold, warm = oil.viscosity_40, oil.viscosity_100
    if built_in := _built_in(oil):
        return origins.stated("oil", quoted(built_in), "lubricant.designation"), None
    if cold is None or warm is None or not FEWEST < warm < cold < MOST:
        shown = oil.designation or oil.name or "the lubricant"
        return needed("oil", example, f"viscosities of {shown} are missing: {remedy}"), None
    entries = [
        origins.stated("title", quoted(oil.designation or oil.name or "oil"), "lubricant.designation"),
        origins.stated("kinematic_viscosity_40", quantity(1e6 * cold, "mm2/s"), "lubricant.viscosity_40"),
        origins.stated("kinematic_viscosity_100", quantity(1e6 * warm, "mm2/s"), "lubricant.viscosity_100"),
    ]
    for key, value, unit, field, usual, low, high, why in (
        ("density_15", oil.density_15, "kg/m3", "density_15", 870, 850, 1000, "mineral oil"),
        ("heat_capacity", oil.heat_capacity, "J/(kg K)", "heat_capacity", 2000, 1850, 2150, "mineral oil, warm"),
        ("conductivity", oil.conductivity, "W/(m K)", "conductivity", 0.132, 0.12, 0.15, "mineral oil at 40 degC"),
    ):  # fmt: skip
        if value is not None:
            entries.append(origins.stated(key, quantity(value, unit), f"lubricant.{field}"))
        else:
            entries.append(assumed(key, f'"{usual} {unit}"', why, f'"{low} {unit}"', f'"{high} {unit}"'))
    return origins.stated("oil", '"imported"', "lubricant.designation"), CaseTable(
        "oils.imported", tuple(entries)
    )


def _built_in(oil: UnitLubricant) -> str:
    """Name of the built-in oil with this designation and the viscosities that the file states, else empty."""
    from rigdesign.properties.oil import OILS

    found = OILS.get((oil.designation or oil.name).strip())
    if found is None:
        return ""
    for stated, temperature in ((oil.viscosity_40, 313.15), (oil.viscosity_100, 373.15)):
        if stated is not None and abs(stated / found.kinematic_viscosity(temperature) - 1.0) > ALIKE:
            return ""
    return found.name


def _oil_temperature(origins: Origins, operation: Operation, key: str) -> Entry:
    case = operation.first.case if operation.first is not None else None
    if case is None or case.lubricant_temperature is None:
        return assumed(key, '"80 degC"', "usual oil of gearboxes in operation", '"60 degC"', '"90 degC"')
    value = quantity(case.lubricant_temperature - ZERO_CELSIUS, "degC")
    return origins.stated(key, value, *_targets(case.id, "lubricant_temperature"))


def _targets(case: str | None, place: str) -> tuple[str, ...]:
    """Places of a value of an operating case: in the case itself, then in the components."""
    own = () if case is None else (f"operating_cases[{case}].{place}",)
    return (*own, f"operating_cases.{place}")


# ------------------------------------------------------------------ schedule


def schedule_tables(origins: Origins, unit: GearUnit, operation: Operation) -> Iterator[CaseTable]:
    """The load case with the most torque as the test; the others in comments."""
    load = operation.first
    speed, torque = (load.speed, load.torque) if load is not None else (None, None)
    entries = []
    if load is not None and speed and load.speed_of is not None:
        place = _first(origins, _targets(load.case.id, f"speeds[{load.speed_of}]"))
        entries.append(
            origins.stated("test_speed", quantity(speed / RPM, "rpm"), *place, note="at the pinion")
        )
    else:
        entries.append(needed("test_speed", '"1500 rpm"', "speed of the pinion"))
    if load is not None and torque:
        places = [
            target
            for number in load.loads
            for target in _first(
                origins,
                (
                    *_targets(load.case.id, f"loads[{number}].torque"),
                    *_targets(load.case.id, f"loads[{number}].power"),
                ),
            )
        ]
        entries.append(
            origins.stated(
                "test_torque", quantity(torque, "N m"), *places, note="at the pinion, without losses"
            )
        )
    else:
        why = f"; {load.undetermined}" if load is not None and load.undetermined else ""
        entries.append(needed("test_torque", '"300 N m"', f"torque of the pinion{why}"))
    remarks = ["the test, counted at the pinion"]
    if len(operation.loads) > 1:
        remarks[0] += ": the load case with the most torque; the others of the file:"
        remarks += [_remark(other) for other in operation.loads[1:]]
    yield CaseTable("schedule", tuple(entries), tuple(remarks))
    yield from _plan(origins, unit, load)


def _plan(origins: Origins, unit: GearUnit, load: PinionLoad | None) -> Iterator[CaseTable]:
    """Time of the test: that of its load case."""
    case = None if load is None else load.case
    if case is None:
        return
    time, targets = case.duration, _targets(case.id, "duration")
    if time is None and unit.operating_time is not None:
        time = unit.operating_time * (1.0 if case.time_share is None else case.time_share)
        targets = (*targets, *_targets(case.id, "time_share"))
    if time:
        yield CaseTable("test_plan", (origins.stated("time", quantity(time / 3600.0, "h"), *targets),))


def _first(origins: Origins, targets: tuple[str, ...]) -> tuple[str, ...]:
    """The first place that the file states."""
    return next(((target,) for target in targets if origins.knows(target)), targets[:1])


def _remark(load: PinionLoad) -> str:
    torque = "no torque" if load.torque is None else f"{load.torque:.5g} N m"
    speed = "no speed" if load.speed is None else f"{load.speed / RPM:.5g} rpm"
    share = "" if load.case.time_share is None else f", {100.0 * load.case.time_share:.3g} % of the time"
    warm = load.case.lubricant_temperature
    oil = "" if warm is None else f", oil {warm - ZERO_CELSIUS:.3g} degC"
    return f"  load case {load.case.id}: {torque}, {speed}{share}{oil}"
