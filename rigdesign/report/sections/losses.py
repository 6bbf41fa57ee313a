"""Losses by stage and place, oil and its circuits, heat of the whole rig."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from rigdesign.report import views
from rigdesign.report.sections.section import Draw, ReportSection, Values
from rigdesign.results.housing import (
    CircuitBalance,
    CircuitDevice,
    CircuitLine,
    CoolingBalance,
    RigHeat,
    RoomTemperature,
    Sink,
)
from rigdesign.results.quantity import row
from rigdesign.results.result import RunResult
from rigdesign.results.units import KW

if TYPE_CHECKING:
    from markupsafe import Markup

COLUMNS: Mapping[Sink, str] = {
    "room": "to the room [W]",
    "oil": "into the oil [W]",
    "water": "cooling water [W]",
    "stored": "stored [W]",
    "no_heat": "no heat [W]",
}
ALWAYS = ("room", "oil")
SOMETIMES = ("stored", "circulation", "tanks", "streams", "volumes", "machines")
"""Terms of the heat balance of a rig that not every rig has."""


def _losses(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.figures import heat as figures

    stage = views.main_stage(result)
    oil_stage = _oil_stage(result, stage)
    by_stage = None
    if result.losses:
        by_stage = draw(figures.losses_by_stage_figure(result.losses), "Power loss by stage and kind")
    return {
        "losses_by_stage": by_stage,
        "rig_flow": _rig_flow(result, oil_stage, draw),
        "flow_stage": oil_stage,
        "balances": _balances(result.cooler),
        "volumes": any(balance.volumes is not None for balance in result.cooler[:1]),
        "streams": any(balance.streams is not None for balance in result.cooler[:1]),
        "oil_rows": [oil for oil in result.oil if oil.stage == oil_stage],
    }


def _balances(balances: Sequence[CoolingBalance]) -> list[dict[str, Any]]:
    """Rows of the heat balance, with the terms that the rig has."""
    terms = [name for name in SOMETIMES if any(getattr(balance, name) is not None for balance in balances)]
    return [
        row(
            balance,
            "stage",
            "losses",
            "pump",
            "heater",
            "cooler",
            "room",
            *terms,
            "not_heat",
            "imbalance",
            "flow",
        )
        for balance in balances
    ]


def _details(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.figures import heat as figures

    stage = views.main_stage(result)
    oil_stage = _oil_stage(result, stage)
    shown: Values = {"losses_by_place": None, "oil": None, "main_stage": stage}
    if result.losses:
        shown["losses_by_place"] = draw(
            figures.losses_by_place_figure(result.losses, stage), f"Power loss by place at stage {stage}"
        )
    if result.oil:
        shown["oil"] = draw(
            figures.oil_figure(result.oil, oil_stage), f"Oil inlet and outlet at stage {oil_stage}"
        )
    return shown


def _oil_stage(result: RunResult, stage: str) -> str:
    """The stage with the most heat, or the first that has oil rows."""
    stages = [oil.stage for oil in result.oil]
    return stage if stage in stages else next(iter(stages), "")


def _rig_flow(result: RunResult, stage: str, draw: Draw) -> "Markup | None":
    """Heat of the rig at its main held stage."""
    from rigdesign.report.figures.flow import rig_flow_figure

    balance = next((balance for balance in result.cooler if balance.stage == stage), None)
    if balance is None:
        return None
    losses = [loss for loss in result.losses if loss.stage == stage]
    figure = rig_flow_figure(losses, [oil for oil in result.oil if oil.stage == stage], balance)
    if figure is None:
        return None
    return draw(figure, f"Heat of the rig from losses to cooler and room at stage {stage}")


LOSSES = ReportSection(id="losses", title="Losses and oil", template="losses.html.j2", values=_losses)
LOSS_DETAILS = ReportSection(
    id="loss_details", title="Losses and oil in detail", template="loss_details.html.j2", values=_details,
    applies=lambda result: bool(result.losses or result.oil), place="appendix",
)  # fmt: skip


def _tables(result: RunResult, draw: Draw) -> Values:
    circuits = result.oil_circuits
    return {
        "tanks": [_tank(circuit) for circuit in circuits],
        "lines": [_line(circuit, line) for circuit in circuits for line in circuit.lines],
        "devices": [_device(circuit, device) for circuit in circuits for device in circuit.devices],
    }


def _tank(circuit: CircuitBalance) -> dict[str, Any]:
    return {
        "circuit": _words(circuit.circuit),
        **row(circuit, "stage", "tank", "flow"),
        **{
            f"{key}_kW": KW * getattr(circuit, key)
            for key in ("heater", "cooler", "pump", "machines", "room")
        },
    }


def _line(circuit: CircuitBalance, line: CircuitLine) -> dict[str, Any]:
    return {
        "circuit": _words(circuit.circuit),
        "line": _words(line.line),
        "stage": circuit.stage,
        **row(line, "flow", "setpoint", "supply"),
        "held": line.holds,
        **row(line, "drain", "back"),
        "heat_of_the_consumers_kW": KW * line.heat,
    }


def _device(circuit: CircuitBalance, device: CircuitDevice) -> dict[str, Any]:
    most = device.capability
    return {
        "circuit": _words(circuit.circuit),
        "device": _words(device.device),
        "stage": circuit.stage,
        "power_kW": KW * device.power,
        "needed_for_its_setpoint_kW": KW * device.needed,
        "most_kW": KW * most,
        "used": f"{100.0 * device.needed / most:.0f} %" if most else None,
    }


def _words(name: str) -> str:
    return name.replace("_", " ")


OIL_CIRCUITS = ReportSection(
    id="oil_circuits", title="Oil circuits", template="oil_circuits.html.j2", values=_tables,
    applies=lambda result: bool(result.oil_circuits),
)  # fmt: skip


def _heat(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.figures.heat import rig_heat_figure

    stages = result.rig_heat
    main = next((heat for heat in stages if heat.stage == views.main_stage(result)), stages[-1])
    used = [
        sink for sink in COLUMNS if sink in ALWAYS or any(source.sinks.get(sink) for source in main.sources)
    ]
    return {
        "main": main,
        "figure": draw(rig_heat_figure(main), f"Heat of the whole rig by source and sink at stage {main.stage}"),
        "heads": ["heat [W]", *(COLUMNS[sink] for sink in used)],
        "sources": [
            (source, [source.power, *(source.sinks.get(sink, 0.0) for sink in used)]) for source in main.sources
        ],
        "sums": [sum(source.power for source in main.sources), *(main.into(sink) for sink in used)],
        "powers": [_powers(heat) for heat in stages],
        "rooms": [_room(heat.stage, heat.room) for heat in stages if heat.room is not None],
    }  # fmt: skip


def _powers(heat: RigHeat) -> dict[str, Any]:
    return {
        "stage": heat.stage,
        "at_the_rig_kW": KW * heat.drive_power,
        "from_the_mains_kW": KW * heat.mains_power,
        "with_pumps_and_heaters_kW": KW * heat.input_power,
        "to_the_room_kW": KW * heat.into("room"),
        "into_the_oil_kW": KW * heat.into("oil"),
        "cooling_water_kW": KW * heat.into("water"),
        **row(heat, "imbalance"),
    }


def _room(stage: str, room: RoomTemperature) -> dict[str, Any]:
    return {
        "stage": stage,
        "heat_kW": KW * room.heat,
        "by_air_kW": KW * room.by_air,
        "by_walls_kW": KW * room.by_walls,
        **row(room, "temperature", "limit", "air_flow", "needed_air_flow"),
    }


RIG_HEAT = ReportSection(
    id="rig_heat", title="Heat of the rig", template="rig_heat.html.j2", values=_heat,
    applies=lambda result: bool(result.rig_heat),
)  # fmt: skip
