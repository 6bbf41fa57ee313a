"""Bridges: closed forms of makers' sheets, leads, thermal output, exact inverse, circuits that do not exist."""

import math

import numpy as np
import pytest

from rigdesign.base.errors import CaseError, MeasurementError
from rigdesign.strain_gauge.gauge import ARMS, WIRES, Bridge, StrainGauge, ThermalOutput
from rigdesign.strain_gauge.measuring_point import SurfaceStress
from tests.builders.strain_gauge import STEEL, bridge, gauge, measuring_point

STRAINS = np.linspace(-3000e-6, 3000e-6, 61)
CIRCUITS = [(kind, wires) for kind, counts in WIRES.items() for wires in counts]
THERMAL = ThermalOutput(coefficients=(-31.8e-6, 2.77e-6, -6.55e-8, 3.28e-10))


@pytest.mark.parametrize(("kind", "wires"), CIRCUITS)
def test_strain_and_voltage_are_exactly_inverse(kind: str, wires: int) -> None:
    warm = gauge(thermal_output=THERMAL, gauge_factor_slope=1e-4)
    one = bridge(kind=kind, gauge=warm, wires=wires, lead_resistance=3.0)
    temperature = np.linspace(290.0, 360.0, len(STRAINS))
    back = one.strain(one.ratio(STRAINS, temperature), temperature)
    assert np.abs(back - STRAINS).max() < 2e-15
    assert np.abs(one.strain(one.ratio(STRAINS)) - STRAINS).max() < 2e-15


def test_passive_resistor_that_does_not_quite_match_is_inverse_too() -> None:
    one = bridge(completion_resistance=121.0)
    assert float(one.ratio(0.0)) == pytest.approx(
        -1.0 / 2 / 241.0, rel=1e-12
    )  # (120 - 121) / (2 (120 + 121))
    assert np.abs(one.strain(one.ratio(STRAINS)) - STRAINS).max() < 2e-15


@pytest.mark.parametrize(
    ("kind", "arms", "inverse"),
    [
        ("quarter", None, lambda u, k, nu: 4 * u / (k * (1 - 2 * u))),
        ("half_passive", None, lambda u, k, nu: 4 * u / (k * (1 - 2 * u))),
        ("half", None, lambda u, k, nu: 2 * u / k),
        ("half", (1.0, -0.3), lambda u, k, nu: 4 * u / (k * ((1 + nu) + 2 * u * (nu - 1)))),
        ("full", None, lambda u, k, nu: u / k),
        ("full", (1.0, -0.3, 1.0, -0.3), lambda u, k, nu: 2 * u / (k * ((nu + 1) + u * (nu - 1)))),
    ],
)
def test_strain_equations_of_instrument_makers(kind: str, arms: object, inverse: object) -> None:
    """Keysight BenchVue, strain equations, and NI's of the half type I and full type III, with u = -V_r."""
    one = bridge(kind=kind, arms=arms)
    ratio = one.ratio(STRAINS)
    assert inverse(ratio, 2.0, 0.3) == pytest.approx(STRAINS, rel=1e-12, abs=1e-18)


def test_quarter_bridge_at_1000_microstrain() -> None:
    """NI: about 0.5 mV/V; 4 bridge factors 1, 2, 1 + nu, 4; nonlinearity about -k eps / 2."""
    assert float(bridge(kind="quarter").ratio(1e-3)) == pytest.approx(0.5e-3 / 1.001, rel=1e-12)
    assert bridge(kind="quarter").nonlinearity(1e-3) == pytest.approx(-2e-3 / (2 + 2e-3), rel=1e-9)
    assert bridge(kind="half").nonlinearity(1e-3) == pytest.approx(0.0, abs=1e-12)
    factors = [bridge(kind=kind).bridge_factor for kind in ARMS]
    assert factors == [1.0, 1.0, 2.0, 4.0]
    assert bridge(kind="half", arms=(1.0, -0.3)).bridge_factor == pytest.approx(1.3)


@pytest.mark.parametrize(
    ("kind", "wires", "share"),
    [
        ("quarter", 3, 1 / (1 + 2 / 120)),
        ("half_passive", 3, 1 / (1 + 2 / 120)),
        ("quarter", 2, 1 / (1 + 2 / 120) ** 2),  # about 1 / (1 + 2 R_L / R)
        ("half", 3, 1 / (1 + 2 / 120)),
        ("half", 5, 1.0),
        ("full", 4, 120 / (120 + 2 * 2)),
        ("full", 6, 1.0),
    ],
)
def test_leads_of_two_ohm_take_their_share(kind: str, wires: int, share: float) -> None:
    one = bridge(kind=kind, wires=wires, lead_resistance=2.0)
    whole = 0.25 * one.bridge_factor * one.gauge.gauge_factor
    assert one.sensitivity == pytest.approx(share * whole, rel=1e-12)


def test_contacts_of_the_slip_ring_shift_the_zero_of_two_wires_only() -> None:
    """Why P1 leads three lines of each gauge through its slip ring."""
    for kind, wires in (("quarter", 3), ("half_passive", 3)):
        assert float(bridge(kind=kind, wires=wires, lead_resistance=0.5).ratio(0.0)) == 0.0
    shifted = bridge(kind="quarter", wires=2, lead_resistance=0.5)
    strain = 4.0 * float(shifted.ratio(0.0)) / (shifted.bridge_factor * shifted.gauge.gauge_factor)
    assert strain == pytest.approx(2 * 0.5 / 120 / 2, rel=0.01)


def test_thermal_output_enters_one_gauge_and_cancels_between_two() -> None:
    warm = gauge(thermal_output=THERMAL)
    t = 80.0
    expected = -31.8e-6 + 2.77e-6 * t - 6.55e-8 * t**2 + 3.28e-10 * t**3
    assert float(warm.thermal_strain(273.15 + t)) == pytest.approx(expected, rel=1e-12)
    one = bridge(kind="quarter", gauge=warm)
    assert float(one.strain(one.ratio(0.0, 353.15))) == pytest.approx(expected, rel=1e-9)
    two = bridge(kind="half", gauge=warm)
    assert float(two.ratio(0.0, 353.15)) == 0.0


def test_thermal_output_stated_at_another_gauge_factor_and_expansion() -> None:
    sheet = ThermalOutput(coefficients=(10e-6,), gauge_factor=2.0, expansion_mismatch=1e-6)
    assert float(sheet.strain(293.15 + 30.0, 2.1)) == pytest.approx(10e-6 * 2.0 / 2.1 + 30e-6)


def test_transverse_sensitivity_is_nil_in_the_stress_state_of_calibration() -> None:
    """K_t drops out where r = -0.285 (TN-509); in plane strain k reads K_t too little or too much."""
    one = gauge(transverse_sensitivity=0.01)
    assert one.indicated(-0.285) == pytest.approx(1.0, rel=1e-12)
    assert one.indicated(0.0) == pytest.approx(1.0 / (1.0 - 0.285 * 0.01), rel=1e-12)


def test_misaligned_gauge_reads_by_mohrs_circle() -> None:
    angle = math.radians(10.0)
    expected = 0.5 * (1 - 0.3) + 0.5 * (1 + 0.3) * math.cos(2 * angle)
    assert gauge().indicated(-0.3, angle) == pytest.approx(expected, rel=1e-12)


def test_hooke() -> None:
    assert STEEL.modulus == 206e9
    wide = SurfaceStress(youngs_modulus=206e9, poisson_ratio=0.3, state="plane_strain")
    assert wide.modulus / 206e9 == pytest.approx(1 / 0.91, rel=1e-12)  # + 9.9 %
    for ratio, modulus in ((-0.3, STEEL.modulus), (0.0, wide.modulus)):
        stated = SurfaceStress(
            youngs_modulus=206e9, poisson_ratio=0.3, state="biaxial", transverse_ratio=ratio
        )
        assert stated.modulus == pytest.approx(modulus, rel=1e-12)
    assert float(wide.strain(wide.stress(1e-3))) == 1e-3


def test_p1_figures() -> None:
    """P1 prints no k; at k = 2 its 125 N/mm² are 607 µm/m and 0.30 mV/V. Five gauges take 15 slip-ring channels."""
    assert float(STEEL.strain(125e6)) == pytest.approx(606.8e-6, rel=1e-4)
    assert 1e3 * float(measuring_point().ratio(125e6)) == pytest.approx(0.3032, rel=1e-3)
    assert 5 * bridge().lines == 15


def test_stress_and_bridge_output_are_inverse_with_everything_on() -> None:
    chained = gauge(thermal_output=THERMAL, transverse_sensitivity=0.012, gauge_factor_slope=1e-4)
    point = measuring_point(bridge=bridge(gauge=chained, lead_resistance=1.5, completion_resistance=120.3))
    stress = np.linspace(-200e6, 600e6, 81)
    assert np.abs(point.stress(point.ratio(stress, 350.0), temperature=350.0) - stress).max() < 1e-3
    zero = float(point.ratio(0.0, 350.0)) + 37e-6
    measured = point.ratio(stress, 350.0) + 37e-6
    assert np.abs(point.stress(measured, zero, 350.0) - stress).max() < 1e-3


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"supply_voltage": 0.0}, "supply_voltage = 0 V: must be above 0 V"),
        ({"supply_voltage": -5.0}, "supply_voltage = -5 V"),
        ({"completion_resistance": 350.0}, "completion_resistance = 350 ohm: must match the 120 ohm"),
        ({"kind": "full", "completion_resistance": 120.0}, "a full bridge has none"),
        ({"kind": "quarter", "arms": (1.0, -1.0)}, "2 active arms: more than the 1 of a quarter bridge"),
        ({"kind": "half", "arms": (1.0,)}, "1 active arms: fewer than the 2"),
        ({"kind": "half", "arms": (1.0, 1.0)}, "the arms cancel"),
        ({"kind": "half", "arms": (1.0, -2.0)}, "must lie within -1 to 1"),
        ({"kind": "third"}, "kind = third: no such bridge; write one of quarter"),
        ({"kind": "quarter", "wires": 6}, "wires = 6: a quarter bridge has 2 or 3"),
        ({"lead_resistance": -1.0}, "lead_resistance = -1 ohm: must be at least 0"),
        ({"lead_resistance": 90.0}, "must be at most 50% of the 120 ohm"),
    ],
)
def test_impossible_bridge(changes: dict[str, object], said: str) -> None:
    with pytest.raises(CaseError) as error:
        bridge(**changes)
    assert said in str(error.value)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"gauge_factor": 0.0}, "gauge_factor = 0: must be above 0; write that of its data sheet"),
        ({"gauge_factor": -2.0}, "gauge_factor = -2"),
        ({"resistance": math.nan}, "resistance = nan ohm"),
        ({"transverse_sensitivity": 0.5}, "must lie within -0.2 to 0.2"),
    ],
)
def test_impossible_gauge(changes: dict[str, object], said: str) -> None:
    with pytest.raises(CaseError) as error:
        StrainGauge(**{"grid_length": 1e-3, "grid_width": 1e-3, **changes})
    assert said in str(error.value)


@pytest.mark.parametrize("given", [{"coefficients": ()}, {"coefficients": (1e-6,), "gauge_factor": 0.0}])
def test_impossible_thermal_output(given: dict[str, object]) -> None:
    with pytest.raises(CaseError, match="thermal_output"):
        ThermalOutput(**given)


@pytest.mark.parametrize("kind", list(ARMS))
def test_volts_read_as_millivolts_are_no_strain(kind: str) -> None:
    one: Bridge = bridge(kind=kind)
    with pytest.raises(MeasurementError) as error:
        one.strain(np.array([0.1e-3, 300e-3]))
    assert "voltage_ratio = 300 mV/V: 1 samples beyond a strain of 5%; look at the unit" in str(error.value)


def test_missing_sample_stays_missing() -> None:
    strain = bridge().strain(np.array([0.5e-3, math.nan]))
    assert np.isnan(strain[1]) and np.isfinite(strain[0])
