"""Campbell diagram as a row of the result."""

from typing import Any

from rigdesign.results.campbell import CampbellRecord
from rigdesign.results.units import RPM


def campbell_row(record: CampbellRecord) -> dict[str, Any]:
    """Modes over speed, orders and crossings."""
    return {
        "speed_rpm": [speed * RPM for speed in record.speeds],
        "modes": [
            {
                "mode": mode.number,
                "shape": mode.name,
                "driven_by": mode.driven_by,
                "frequency_Hz": list(mode.frequency),
                "damping_ratio": list(mode.damping_ratio),
                "logarithmic_decrement": list(mode.logarithmic_decrement),
                "whirl": list(mode.whirl),
                "gain": dict(mode.gain),
            }
            for mode in record.modes
        ],
        "orders": [
            {
                "kind": order.kind,
                "of": list(order.of),
                "harmonic": order.harmonic,
                "per_turn": order.cycles,
            }
            for order in record.orders
        ],
        "crossings": [
            {
                "mode": crossing.mode,
                "kind": crossing.kind,
                "of": list(crossing.of),
                "harmonic": crossing.harmonic,
                "speed_rpm": crossing.speed * RPM,
                "frequency_Hz": crossing.frequency,
                "damping_ratio": crossing.damping_ratio,
                "gain": crossing.gain,
            }
            for crossing in record.crossings
        ],
        "modes_left_out": record.left_out,
    }
