"""What stands in the oil and room heats that P2 prints for the main rig: arithmetic, no model of the rig.

P2 prints 390 kW of the whole rig, absorbed by 733 l/min in three circuits (warm, 140 degC: mesh of the test gearbox;
cold: gears of reference and transmission gearbox; cold, 40 degC: all bearings), 80 kW by the mesh and about 28 kW by
the bearings of the test gearbox, and 4.2 kW from it to the room in addition to the 390 kW. It prints no oil, no flow
of a single circuit and no pump.
"""

from collections.abc import Iterator

from rigdesign.base.units import ZERO_CELSIUS
from rigdesign.oil_circuit.circuit import Pump
from rigdesign.properties.oil import MIL_PRF_23699
from tests.published.rows import PublishedQuantity, ValidationRow, compare

TOTAL, MESH, BEARINGS, ROOM = 390e3, 80e3, 28e3, 4.2e3
"""Printed heats [W]."""
FLOW = 733e-3 / 60.0
"""Of all circuits [m3/s]."""
WARM, COLD, RETURN = ZERO_CELSIUS + 140.0, ZERO_CELSIUS + 40.0, ZERO_CELSIUS + 160.0
SOURCE = "P2, text on the oil supply"
EFFICIENCY, PRESSURE = 0.8, 1e6


def capacity_rate(inlet: float, outlet: float, flow: float) -> float:
    """Heat that warms a flow [m3/s] of the aviation oil by one kelvin between two temperatures [W/K]."""
    oil = MIL_PRF_23699
    return oil.density(inlet) * oil.heat_capacity(0.5 * (inlet + outlet)) * flow


def warm_flow() -> float:
    """Flow [m3/s] that carries the heat of the mesh from 140 to 160 degC."""
    return MESH / (capacity_rate(WARM, RETURN, 1.0) * (RETURN - WARM))


def oil_balance_rows() -> Iterator[ValidationRow]:
    """Every printed heat with what stands in it."""
    warm = warm_flow()
    cold_rise = (TOTAL - MESH) / capacity_rate(COLD, COLD + 16.0, FLOW - warm)
    pumps = Pump(flow=FLOW, pressure=PRESSURE, efficiency=EFFICIENCY).heat_into_oil
    yield _row(
        "warm-flow", "flow of the warm circuit", None, 6e4 * warm, "l/min",
        f"carries the 80 kW of the mesh at P2's 20 K; {6e4 * (FLOW - warm):.0f} l/min of the 733 are left for the "
        f"other 310 kW at {cold_rise:.1f} K",
    )  # fmt: skip
    yield _row(
        "test-gearbox", "share of the test gearbox in the 390 kW", None, (MESH + BEARINGS) / TOTAL, "",
        "80 kW mesh and 28 kW bearings; 282 kW are left for reference and transmission gearbox, gears and bearings",
    )  # fmt: skip
    yield _row(
        "room", "heat to the room over the heat of the oil", None, ROOM / TOTAL, "",
        "4.2 kW of the test gearbox stand beside the 390 kW, not in them; other gearboxes, motor, drive, tanks and "
        "pipes are in neither",
    )  # fmt: skip
    yield _row(
        "pumps", "heat of pumps that P2 does not name", None, pumps, "W",
        f"733 l/min at {1e-5 * PRESSURE:.0f} bar and {EFFICIENCY:g}, assumed: heat the coolers carry on top of 390 kW",
    )  # fmt: skip


def _row(
    name: str, text: str, printed: float | None, computed: float, unit: str, assumptions: str
) -> ValidationRow:
    words = "not printed" if printed is None else None
    quantity = PublishedQuantity(
        id=f"P2-oil-{name}", text=f"main rig, {text}", source=SOURCE, value=printed, printed=words, unit=unit
    )
    return compare(quantity, computed, "arithmetic", assumptions=assumptions)
