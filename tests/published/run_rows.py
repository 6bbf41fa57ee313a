"""Rows that need a full run of the prototype: heat, losses, clearances, and power that must close.

P2's heat numbers belong to the main rig, so that the prototype owes them nothing; they stand here for the
size.
"""

from collections.abc import Iterator
from math import pi
from statistics import fmean

from rigdesign.base.units import ZERO_CELSIUS
from rigdesign.results.result import RunResult
from tests.published.rows import Gate, PublishedQuantity, ValidationRow, Window, compare

CLOSURE = 1e-8
"""Greatest gap of a heat balance relative to the heat turned over."""
BEARING_LOSS = 0.0007 * (12000.0 * pi / 30.0) ** 2
"""Loss of one journal bearing at 12,000 rpm by the torsional damping of P2's Table 1 [W]."""
POWER_BALANCE = 1e-3
"""Share of the losses by which the drive power may differ."""
BEARING_KINDS = ("bearing", "journal_bearing")


def run_rows(result: RunResult) -> Iterator[ValidationRow]:
    """Rows of one run of the shipped prototype."""
    yield from _heat(result)
    yield from _losses(result)
    yield from _drive(result)
    yield from _seal_gaps(result)


def _heat(result: RunResult) -> Iterator[ValidationRow]:
    for thermal in result.thermal:
        place = f"{thermal.gearbox} gearbox, {thermal.stage}"
        yield compare(
            PublishedQuantity(
                id=f"run-closure-{thermal.gearbox}-{thermal.stage}",
                text=f"open heat balance, {place}",
                source="heat balance by named surface",
                printed="closed",
                unit="1",
            ),
            thermal.closure_relative,
            "verification",
            Window(0.0, CLOSURE),
            assumptions=f"{thermal.nodes} nodes, fidelity {result.fidelity}; every surface by its own law, "
            "prescribed temperatures by their reactions",
        )
        yield compare(
            PublishedQuantity(
                id=f"run-Tmax-{thermal.gearbox}-{thermal.stage}",
                text=f"highest temperature, {place}",
                source="P2, Figure 12 (main rig)",
                printed="178.59 for the main rig",
                unit="degC",
            ),
            thermal.max_temperature - ZERO_CELSIUS,
            "predicted",
            assumptions=f"prototype at {thermal.max_temperature_body}; housing assumed, sinks of the "
            "bearings at film temperature instead of 40 degC",
        )
        yield compare(
            PublishedQuantity(
                id=f"run-room-{thermal.gearbox}-{thermal.stage}",
                text=f"heat to the room, {place}",
                source="P2, Figure 12 (main rig)",
                printed="4264 for the main rig",
                unit="W",
            ),
            thermal.room_heat,
            "predicted",
            assumptions="prototype; housing and clamping field assumed",
        )


def _losses(result: RunResult) -> Iterator[ValidationRow]:
    stage = result.losses[-1].stage if not result.thermal else result.thermal[-1].stage
    for row in result.losses:
        if row.stage == stage and row.kind == "mesh" and row.place.startswith("test"):
            yield compare(
                PublishedQuantity(
                    id=f"run-loss-{row.place}",
                    text=f"loss of mesh {row.place}, {stage}",
                    source="P2, structure of the thermal model (main rig)",
                    value=500.0,
                    unit="W",
                ),
                row.power,
                "predicted",
                free_parameters=2,
                assumptions="500 W is what P2 puts into the FE model of the main rig, for 80 kW "
                "dissipated by the meshes; depends on the split of the profile shifts and on the friction "
                "coefficient",
            )
    bearings = [row.power for row in result.losses if row.stage == stage and row.kind in BEARING_KINDS]
    if bearings:
        yield compare(
            PublishedQuantity(
                id="run-loss-bearing",
                text=f"mean loss of a journal bearing, {stage}",
                source="P2, Table 1",
                value=BEARING_LOSS,
                printed=f"{BEARING_LOSS:.0f}, from 0.0007 N m s/rad",
                unit="W",
            ),
            sum(bearings) / len(bearings),
            "predicted",
            free_parameters=4,
            assumptions=f"{len(bearings)} bearings of assumed size, clearance and oil, film by ISO 7902; P2 "
            "took its damping from the loss at the operating point",
        )


def _drive(result: RunResult) -> Iterator[ValidationRow]:
    if result.dynamics is None or not result.dynamics.torque_balance:
        return
    balance = result.dynamics.torque_balance[-1]
    yield compare(
        PublishedQuantity(
            id="run-drive",
            text=f"drive torque of the coupled case, {balance.stage}",
            source="P2, dynamic simulation",
            value=9.0,
            unit="N m",
        ),
        balance.drive_torque,
        "predicted",
        free_parameters=4,
        assumptions="windage, oil jets and computed bearing films included, which P2's simulation leaves out",
    )
    yield compare(
        PublishedQuantity(
            id="V12-power",
            text=f"drive power against the sum of all losses, {balance.stage}",
            source="energy balance",
            value=balance.losses,
            unit="W",
        ),
        balance.drive_power,
        "verification",
        Gate(POWER_BALANCE),
        assumptions="motor torque of the periodic response times speed against meshes, mesh damping, "
        "bearings, seals, windage and jets, each by its own law; what splines and couplings lose is the "
        "difference",
    )


def _seal_gaps(result: RunResult) -> Iterator[ValidationRow]:
    for expansion in result.expansion:
        gaps = [float(seal["hot_mean_mm"]) for seal in expansion.seal_gaps]
        if gaps:
            least = min(float(seal["hot_min_mm"]) for seal in expansion.seal_gaps)
            yield compare(
                PublishedQuantity(
                    id=f"run-seal-gap-{expansion.gearbox}-{expansion.stage}",
                    text=f"mean hot seal gap, {expansion.gearbox} gearbox, {expansion.stage}",
                    source="P2, text (main rig)",
                    value=0.6,
                    printed="still 0.6",
                    unit="mm",
                ),
                fmean(gaps),
                "predicted",
                free_parameters=1,
                assumptions=f"prototype with the cold gap of the main rig; P2 prints one digit and one gap; ours is "
                f"{least:.2f} mm at its narrowest",
            )
