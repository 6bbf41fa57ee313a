"""Solves journal bearings with ROSS and writes ``ross.json``; ROSS is no dependency of the tests.

    python tests/reference/journal/run_ross.py

Needs ROSS with `FixedGeometryBearing` (its engine of version 2.4) in the environment that runs it.
"""

import json
import math
from pathlib import Path

import numpy as np
from ross.bearings.fixed_geometry import FixedGeometryBearing
from ross.units import Q_

VERSION = "ROSS 2.4 (petrobras/ross, commit 631a249a)"
DIAMETER, CLEARANCE, VISCOSITY, RPM = 0.1, 1e-4, 0.02, 3000.0
GROOVES = {"pivot": [90.0, 270.0], "arc": [160.0, 160.0]}
"""Shells above and below, load on the middle of the lower one."""

CASES = [(0.5, s) for s in (1.656, 0.917, 0.580, 0.379, 0.244)] + [
    (1.0, s) for s in (0.991, 0.635, 0.235, 0.159, 0.108)
]
"""(L/D, S) of Lund and Thomsen."""
ARCS = [(0.5, 0.5636, 56.56), (0.75, 0.10692, 42.436), (1.0, 0.63189, 73.856)]
"""(L/D, S, attitude [deg]) of one arc of 270 degrees that starts at the widest gap of that attitude."""


def solved(ratio: float, sommerfeld: float, pivot: list[float], arc: list[float]) -> dict[str, object]:
    """One bearing under a load in -y that turns from x to y; coefficients in Lund and Thomsen's axes and scale."""
    length, omega = ratio * DIAMETER, RPM * math.pi / 30.0
    load = VISCOSITY * RPM / 60.0 * length * DIAMETER * (0.5 * DIAMETER / CLEARANCE) ** 2 / sommerfeld
    lubricant = {
        "liquid_viscosity1": VISCOSITY, "temperature1": 313.15,
        "liquid_viscosity2": VISCOSITY, "temperature2": 373.15,
        "liquid_density": 860.0, "liquid_specific_heat": 1951.0, "liquid_thermal_conductivity": 0.13,
    }  # fmt: skip
    none = [0.0] * len(pivot)
    bearing = FixedGeometryBearing(
        n=0,
        frequency=Q_([RPM], "RPM"),
        journal_diameter=DIAMETER,
        radial_clearance=CLEARANCE,
        pad_thickness=0.02,
        pivot_angle=Q_(pivot, "deg"),
        pad_arc=Q_(arc, "deg"),
        pad_axial_length=[length] * len(pivot),
        preload=none,
        offset=[0.5] * len(pivot),
        lubricant=lubricant,
        oil_supply_temperature=Q_(40.0, "degC"),
        oil_flow_v=Q_(20.0, "l/min"),
        fys_load=-load,
        thermal_type=None,
        total_ex_film=240 if len(pivot) == 1 else 160,
        total_ez_film=40,
    )

    def turned(letter: str, scale: float) -> list[list[float]]:
        """x along the load (-y of ROSS), y where rotation carries the journal (x of ROSS)."""
        (xx,), (xy,), (yx,), (yy,) = (getattr(bearing, letter + both) for both in ("xx", "xy", "yx", "yy"))
        return (np.array([[yy, -yx], [-xy, xx]]) * scale).round(6).tolist()

    out = bearing._results.outputs[0]
    return {
        "width_ratio": ratio,
        "S": sommerfeld,
        "eccentricity": round(float(out["eccentricity"][0]), 6),
        "attitude_deg": round(math.degrees(out["attitude"][0]), 4),
        "stiffness": turned("k", CLEARANCE / load),
        "damping": turned("c", CLEARANCE * omega / load),
    }


def main() -> None:
    """Solve all and write."""
    found = {
        "version": VERSION,
        "two_axial_grooves": [solved(*case, **GROOVES) for case in CASES],
        "widest_gap": [solved(ratio, s, [225.0 + attitude], [270.0]) for ratio, s, attitude in ARCS],
    }
    Path(__file__).with_name("ross.json").write_text(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
