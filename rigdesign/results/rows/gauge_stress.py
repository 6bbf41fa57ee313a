"""Root stress at a strain gauge as a row of the result."""

from typing import Any

import numpy as np

from rigdesign.results.gauge_stress import GaugeStress
from rigdesign.results.units import MPA

MM, MICRO, MILLI = 1e3, 1e6, 1e3


def gauge_stress_row(found: GaugeStress) -> dict[str, Any]:
    """Place, peak with strain and bridge output there, curve over the rolling angle of the gear."""
    point, curve = found.point, found.curve
    bridge, placed = point.bridge, point.placement
    highest = int(curve.stress.argmax())
    return {
        "name": found.name,
        "gear": found.gear,
        "tooth": found.tooth,
        "fillet": "front" if found.front else "back",
        "face_position_mm": MM * placed.face_position,
        "fillet_position_mm": MM * placed.fillet_position,
        "grid_mm": [MM * bridge.gauge.grid_length, MM * bridge.gauge.grid_width],
        "stress_state": point.surface.state,
        "peak_MPa": MPA * curve.peak,
        "peak_at_deg": float(np.degrees(curve.peak_angle)),
        "lowest_MPa": MPA * curve.lowest,
        "strain_um_m": MICRO * float(point.surface.strain(curve.peak)),
        "bridge": {
            "kind": bridge.kind,
            "supply_V": bridge.supply_voltage,
            "output_mV_V": MILLI * float(found.output[highest]),
            "output_mV": MILLI * float(found.output[highest]) * bridge.supply_voltage,
        },
        "rolling_angle_deg": np.degrees(curve.angle).tolist(),
        "stress_MPa": (MPA * curve.stress).tolist(),
    }
