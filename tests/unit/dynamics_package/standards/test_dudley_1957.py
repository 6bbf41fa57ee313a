"""Stresses of splines by hand."""

import math

import pytest

from dynamics.errors import DynamicsInputError
from dynamics.standards.dudley_1957 import S_1, S_2, S_3, S_c, S_s_shaft, S_s_teeth, S_t, Spline

INCH, PSI = 0.0254, 6894.757293
TORQUE = 200.0
SPLINE = Spline(N=24, D=0.048, phi=math.radians(30.0), F_e=0.025, h=0.0018)
"""W 50 x 2 x 24: pitch diameter 48 mm, 25 mm long."""


def test_stresses_of_a_spline_by_hand() -> None:
    """200 N m on 24 mm: 8333.3 N on the pitch circle. Flanks: 24 x 25 x 1.8 = 1080 mm2, 7.716 MPa. Teeth: thickness
    pi 48/48 = 3.14159 mm, twelve of 25 mm carry: 942.48 mm2, 8.842 MPa. Shaft of 45 mm: 16 T/(pi d^3) = 11.178 MPa."""
    assert S_c(SPLINE, TORQUE) == pytest.approx(8333.333 / 1080e-6, rel=1e-6)
    assert S_c(SPLINE, TORQUE) == pytest.approx(7.716e6, rel=1e-4)
    assert S_s_teeth(SPLINE, TORQUE) == pytest.approx(8.842e6, rel=1e-4)
    assert S_s_shaft(TORQUE, 0.045) == pytest.approx(11.178e6, rel=1e-4)
    assert S_s_shaft(TORQUE, 0.045, 0.0225) == pytest.approx(11.178e6 / (1.0 - 1.0 / 16.0), rel=1e-4)


def test_the_factor_of_load_distribution_acts_on_teeth_and_flanks() -> None:
    tilted = Spline(N=24, D=0.048, phi=math.radians(30.0), F_e=0.025, h=0.0018, K_m=1.5)
    for stress in (S_c, S_s_teeth):
        assert stress(tilted, TORQUE) == pytest.approx(1.5 * stress(SPLINE, TORQUE))
    assert S_t(10.0, 3.0, 1.5) == 18.0


def test_the_hub_bursts_by_tooth_forces_rotation_and_bending() -> None:
    """Radial force of all teeth 2 T tan(30)/D = 4811.3 N as a pressure on the pitch cylinder, p = F/(pi D b), in a thin
    ring of 10 mm: p D/(2 t) = 3.063 MPa. Lewis: two tooth forces of T/(12 x 24 mm) over b Y pitch/pi."""
    pressure = 4811.252 / (math.pi * 0.048 * 0.025)
    assert S_1(SPLINE, TORQUE, 0.010) == pytest.approx(pressure * 0.048 / 0.020, rel=1e-6)
    force = TORQUE / (12 * 0.024)
    assert S_3(SPLINE, TORQUE) == pytest.approx(force / (0.025 * 1.5 * 0.048 / 24), rel=1e-9)


def test_rotation_has_the_printed_factors_for_steel() -> None:
    """1.656e-6 n^2 (D_oi^2 + 0.212 D_ri^2) psi with inches and rpm: nu 0.3, a density of three
    digits, 0.283 lb/in3, good for 0.2 %."""
    n, outside, root = 12000.0, 4.0, 2.0
    printed = 1.656e-6 * n**2 * (outside**2 + 0.212 * root**2) * PSI
    found = S_2(n * math.pi / 30.0, 0.283 * 27679.9, 0.3, outside * INCH, root * INCH)
    assert found == pytest.approx(printed, rel=2e-3)


@pytest.mark.parametrize(
    ("values", "named"), [({"h": 0.0}, "h = 0"), ({"K_m": 0.9}, "K_m = 0.9"), ({"phi": 2.0}, "phi = 2")]
)
def test_a_spline_that_cannot_be_is_named(values: dict[str, float], named: str) -> None:
    with pytest.raises(DynamicsInputError, match=named):
        Spline(**{"N": 24, "D": 0.048, "phi": 0.5, "F_e": 0.025, "h": 0.002, **values})  # type: ignore[arg-type]
    with pytest.raises(DynamicsInputError, match="bore must be inside"):
        S_s_shaft(1.0, 0.04, 0.05)
    with pytest.raises(DynamicsInputError, match="wall of the hub t_w = -1 mm"):
        S_1(SPLINE, 1.0, -0.001)
