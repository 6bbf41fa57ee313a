"""Films on the teeth: limits, ranges, bad input; the fin that stands on the rim."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import solve_banded

from rigdesign.properties.oil import MIL_PRF_23699
from thermal.films.flank import (
    FilmOil,
    ToothRing,
    Wetting,
    fin_efficiency,
    fling_off,
    heat_flung_off,
    jet_renewal,
    on_rim,
    tooth_excess,
)
from thermal.films.law import FilmError

OIL = FilmOil(
    conductivity=lambda _: 0.14,
    density=lambda _: 900.0,
    heat_capacity=lambda _: 2100.0,
    kinematic_viscosity=lambda _: 3e-6,
)
RING = ToothRing(
    root_radius=0.106, tip_radius=0.1175, flank_area=0.048, tooth_thickness=0.0085, conductivity=42.0
)
JET = Wetting(speed=1256.6, per_turn=1, flow=5e-4)
WALL, COLD = 480.0, 415.0


def value(wetting: Wetting, oil: FilmOil = OIL) -> float:
    return fling_off(RING, wetting, oil)(WALL, COLD).value


def test_thick_film_is_the_closed_form_of_blok() -> None:
    """sqrt(w)/(2 pi) sqrt(k rho c) (nu x/(a r))^(1/4) q over the height: 4/5 of the value at the tip."""
    oil = replace(OIL, kinematic_viscosity=lambda _: 3e-8)  # flung off long before the next wetting
    group = 3e-8 * RING.height / (0.14 / (900.0 * 2100.0) * 0.5 * (0.106 + 0.1175))
    tip = math.sqrt(1256.6) / (2.0 * math.pi) * math.sqrt(0.14 * 900.0 * 2100.0) * group**0.25 * 1.2267
    assert value(replace(JET, flow=1.0), oil) == pytest.approx(0.8 * tip, rel=2e-3)


def test_starved_film_leaves_with_the_temperature_of_the_flank() -> None:
    """So little oil warms through: h A = rho c Q."""
    starved = replace(JET, flow=1e-6)
    assert value(starved) * RING.flank_area == pytest.approx(900.0 * 2100.0 * 1e-6, rel=1e-3)
    renewed = jet_renewal(RING, starved, OIL)(WALL, COLD).value
    assert renewed * RING.flank_area == pytest.approx(900.0 * 2100.0 * 1e-6, rel=1e-3)


def test_speed_laws() -> None:
    """Flooded flanks cool with sqrt(w) at any speed: a turn and the time to be flung off shorten alike."""
    flooded = replace(JET, flow=1.0)
    assert value(replace(flooded, speed=4.0 * JET.speed)) == pytest.approx(2.0 * value(flooded), rel=1e-3)
    assert value(JET) < value(flooded)


def test_second_jet_less_than_doubles_the_film() -> None:
    """A film not yet flung off when the next one comes has taken less."""
    thick = replace(OIL, kinematic_viscosity=lambda _: 3e-5)
    twice = replace(JET, per_turn=2, flow=2.0 * JET.flow)
    assert value(twice) == pytest.approx(2.0 * value(JET), rel=0.02)
    assert math.sqrt(2.0) < value(twice, thick) / value(JET, thick) < 1.7


def test_no_film_beats_the_one_that_is_not_flung_off() -> None:
    for share in (0.3, 1.0):
        wetting = replace(JET, wetted_share=share)
        assert value(wetting) < jet_renewal(RING, wetting, OIL)(WALL, COLD).value


def test_dry_part_of_the_flank_counts_with_nothing() -> None:
    """Half the height wetted, flooded: half the area, films shorter by 2^(1/4)."""
    thin = replace(OIL, kinematic_viscosity=lambda _: 3e-8)
    whole, half = (value(replace(JET, flow=1.0, wetted_share=share), thin) for share in (1.0, 0.5))
    assert half == pytest.approx(whole * 0.5**1.25, rel=1e-3)


def test_properties_are_taken_half_way_to_the_wall() -> None:
    oil = MIL_PRF_23699
    film = FilmOil(
        conductivity=oil.conductivity,
        density=oil.density,
        heat_capacity=oil.heat_capacity,
        kinematic_viscosity=oil.kinematic_viscosity,
    )
    found = fling_off(RING, JET, film)(WALL, COLD)
    assert found.inputs["viscosity"] == oil.kinematic_viscosity(0.5 * (WALL + COLD))
    assert 2000.0 < found.value < 5000.0
    assert found.warnings == ()


def test_slow_gear_warns_and_a_standing_one_has_no_film() -> None:
    slow = fling_off(RING, replace(JET, speed=50.0), OIL)(WALL, COLD)
    assert "centrifugal acceleration" in slow.warnings[0] and "100" in slow.warnings[0]
    for law in (fling_off, jet_renewal):
        still = law(RING, replace(JET, speed=0.0), OIL)(WALL, COLD)
        assert still.value == 0.0 and still.warnings


def test_film_too_hot_for_its_oil_warns_and_stays_a_number() -> None:
    oil = replace(OIL, conductivity=lambda t: 0.15 * (1.0 - 8e-4 * (t - 313.15)), highest_temperature=470.0)
    for law in (fling_off, jet_renewal):
        hot = law(RING, JET, oil)(5000.0, COLD)
        assert hot.value > 0.0
        assert "temperature of the flank film = 2708 K is outside 233.15 to 470 K" in hot.warnings[0]
        assert hot.value == law(RING, JET, oil)(4000.0, COLD).value
        assert law(RING, JET, oil)(WALL, COLD).warnings == ()


def test_heat_flung_off_grows_to_its_end() -> None:
    times = [0.01 * i for i in range(500)]
    heats = [heat_flung_off(time) for time in times]
    assert heats == sorted(heats) and heats[0] == 0.0 and heats[-1] == 1.2267


def test_factor_scales_the_film() -> None:
    for law in (fling_off, jet_renewal):
        one, two = (law(RING, JET, OIL, factor)(WALL, COLD).value for factor in (1.0, 2.0))
        assert two == pytest.approx(2.0 * one, rel=1e-12)


def test_fin_on_the_rim_against_its_differential_equation() -> None:
    """k s/2 T'' = h T - P/A on 400 volumes: heat through the root and mean temperature."""
    film, heat, rim = 4000.0, 12e3, 40.0
    cells = 400
    step = RING.height / cells
    length = RING.flank_area / (2.0 * RING.height)  # of all roots
    conductance = RING.conductivity * RING.tooth_thickness * length / step
    loss = film * RING.flank_area / cells
    diagonal = np.full(cells, 2.0 * conductance + loss)
    diagonal[0] += conductance
    diagonal[-1] -= conductance
    band = np.zeros((3, cells))
    band[0, 1:] = band[2, :-1] = -conductance
    band[1] = diagonal
    sources = np.full(cells, heat / cells)
    sources[0] += 2.0 * conductance * rim
    solved = solve_banded((1, 1), band, sources)
    into_tooth = 2.0 * conductance * (rim - solved[0])
    eta = fin_efficiency(RING, film)
    assert eta * film * RING.flank_area * rim - eta * heat == pytest.approx(into_tooth, rel=1e-4)
    assert tooth_excess(RING, film, heat, rim) == pytest.approx(float(solved.mean()), rel=1e-4)


def test_film_on_the_rim_carries_what_the_teeth_carry() -> None:
    flank = fling_off(RING, JET, OIL)
    found = on_rim(flank, RING, 0.03)(WALL, COLD)
    alone = flank(WALL, COLD).value
    assert found.value == pytest.approx(alone * fin_efficiency(RING, alone) * 0.048 / 0.03, rel=1e-12)
    assert found.formula == "tooth_ring(fling_off)"
    assert found.inputs["flank_film"] == alone


def test_fin_limits() -> None:
    assert fin_efficiency(RING, 0.0) == 1.0
    strong = 1e8
    root = RING.height * math.sqrt(2.0 * strong / (RING.conductivity * RING.tooth_thickness))
    assert fin_efficiency(RING, strong) == pytest.approx(1.0 / root)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: replace(RING, tip_radius=0.1), "tip_radius = 0.1 m must be above root_radius"),
        (lambda: replace(RING, flank_area=0.0), "flank_area = 0.0 m2 must be greater than 0"),
        (lambda: replace(JET, per_turn=0), "per_turn = 0 must be at least 1"),
        (lambda: replace(JET, flow=-1.0), "flow = -1.0 m3/s must be greater than 0"),
        (lambda: replace(JET, speed=-1.0), "speed = -1.0 rad/s must not be negative"),
        (lambda: replace(JET, wetted_share=1.2), "wetted_share = 1.2 must be above 0 and at most 1"),
        (lambda: fling_off(RING, JET, OIL, 0.0), "factor of the flank film = 0.0"),
        (lambda: on_rim(fling_off(RING, JET, OIL), RING, 0.0), "area of the rim = 0.0 m2"),
        (lambda: tooth_excess(RING, 0.0, 1.0, 1.0), "film on the flanks = 0.0"),
    ],
)
def test_impossible_input_is_named(make, said: str) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(FilmError, match=said.replace("(", r"\(")):
        make()
