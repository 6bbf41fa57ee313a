"""Growth of a turning journal against the radial equation of a disc, solved by finite differences."""

import math
from functools import cache

import numpy as np
import pytest

from rigdesign.case import load_case
from rigdesign.coupling.expansion import hot_clearances
from rigdesign.rig.model import Rig, build_rig
from tests.builders.paths import CASES

PROTOTYPE = CASES / "uhcf_prototype"
SPEED = 12000.0 * math.pi / 30.0
DENSITY, MODULUS, POISSON = 7830.0, 206e9, 0.3
"""Steel: kg/m3, Pa, -."""


@cache
def rig() -> Rig:
    return build_rig(load_case(PROTOTYPE), "quick")


def rim_displacement(radius: float, omega: float, points: int = 400) -> float:
    """u(R) [m] of a solid disc in plane stress: u'' + u'/r - u/r2 = -(1 - nu2) rho w2 r / E, no stress at the rim."""
    r = np.linspace(0.0, radius, points)
    h = r[1]
    left = np.zeros((points, points))
    load = -(1.0 - POISSON**2) * DENSITY * omega**2 * r / MODULUS
    left[0, 0] = 1.0
    for i in range(1, points - 1):
        left[i, i - 1 : i + 2] = np.array([1.0, -2.0, 1.0]) / h**2 + np.array([-1.0, 0.0, 1.0]) / (
            2.0 * h * r[i]
        )
        left[i, i] -= 1.0 / r[i] ** 2
    left[-1, -3:] = np.array([1.0, -4.0, 3.0]) / (2.0 * h)
    left[-1, -1] += POISSON / radius
    load[[0, -1]] = 0.0
    return float(np.linalg.solve(left, load)[-1])


def test_a_turning_journal_takes_clearance_as_its_rim_moves() -> None:
    """0.17 um of 40 mm at 12,000 rpm: on the diameter, taken from the clearance."""
    entries = {name: entry for name, _, entry in rig().bearings()}
    found = hot_clearances(rig(), SPEED, {})
    assert set(found) == set(entries)
    for name, entry in entries.items():
        omega = rig().shaft_speed(entry.shaft, SPEED)
        steel = rig().materials[rig().case.drivetrain.shafts[entry.shaft].material]  # type: ignore[union-attr]
        assert (steel.density, steel.poisson_ratio) == (DENSITY, POISSON)
        taken = entry.diametral_clearance - found[name]
        moved = 2.0 * rim_displacement(0.5 * entry.diameter, omega) * MODULUS / steel.elastic_modulus
        assert taken == pytest.approx(moved, rel=1e-3)
        assert taken > 0.0
    assert hot_clearances(rig(), 0.0, {}) == {
        name: entry.diametral_clearance for name, entry in entries.items()
    }
