"""Dip lubrication: closed film laws against their equations, teeth against Michaelis, the FZG box by all laws."""

import math

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid, solve_bvp, trapezoid

from dynamics.losses.churning import LAWS, compare_churning
from dynamics.losses.immersion import immersion, tooth_space_flow
from dynamics.standards.iso_ts_6336_22_2018 import theta_M
from rigdesign.properties.oil import FVA_3
from tests.builders.fzg_bath import LOW_VOLUME, bath, stage
from thermal.films.bath import dipped_face_film, dipped_rim_film
from thermal.films.flank import FilmOil, ToothRing

SUMP = 363.15
FVA_3_FILM = FilmOil(
    conductivity=FVA_3.conductivity,
    density=FVA_3.density,
    heat_capacity=FVA_3.heat_capacity,
    kinematic_viscosity=FVA_3.kinematic_viscosity,
)


def _von_karman() -> tuple[np.ndarray, np.ndarray]:
    """Axial velocity of the fluid over a disc, H(zeta) <= 0; Cochran: F'(0) = 0.5102."""
    zeta = np.linspace(0.0, 15.0, 301)

    def slopes(_: np.ndarray, s: np.ndarray) -> np.ndarray:
        f, df, g, dg, h = s
        return np.vstack((df, f**2 - g**2 + h * df, dg, 2.0 * f * g + h * dg, -2.0 * f))

    def ends(left: np.ndarray, right: np.ndarray) -> np.ndarray:
        return np.array([left[0], left[2] - 1.0, left[4], right[0], right[2]])

    start = np.vstack((
        0.5 * zeta * np.exp(-zeta), 0.5 * np.exp(-zeta), np.exp(-zeta), -np.exp(-zeta), -0.88 * (1 - np.exp(-zeta)),
    ))  # fmt: skip
    found = solve_bvp(slopes, ends, zeta, start, tol=1e-8, max_nodes=20000)
    assert found.success
    assert found.y[1, 0] == pytest.approx(0.5102, abs=2e-4)
    fine = np.linspace(0.0, 15.0, 60001)
    return fine, found.sol(fine)[4]


@pytest.mark.parametrize("prandtl", [10.0, 100.0, 200.0, 1000.0])
def test_dipped_face_against_the_energy_equation(prandtl: float) -> None:
    """theta'' = Pr H theta' over a disc of one temperature: Nu/Re^0.5 = 1 / integral of exp(Pr integral of H)."""
    zeta, axial = _von_karman()
    inner = np.exp(prandtl * cumulative_trapezoid(axial, zeta, initial=0.0))
    exact = 1.0 / trapezoid(inner, zeta)
    oil = FilmOil(
        conductivity=lambda _: 0.13,
        density=lambda _: 840.0,
        heat_capacity=lambda _: 2000.0,
        kinematic_viscosity=lambda _: prandtl * 0.13 / (840.0 * 2000.0),
    )
    viscosity = prandtl * 0.13 / (840.0 * 2000.0)
    film = dipped_face_film(200.0, 30e-3, 1.0, oil)(350.0, SUMP)
    assert film.value / (0.13 * math.sqrt(200.0 / viscosity)) == pytest.approx(exact, rel=0.01)


def test_teeth_flooded_by_the_bath_against_michaelis() -> None:
    """Load stage 10 at 2250 rpm, mesh loss 985 W, half to each gear and out through its flanks alone."""
    loss, excess = 985.0, []
    for running in stage(pinion_speed=2250.0 * math.pi / 30.0):
        gear = running.gear
        area = 2.0 * gear.teeth * gear.tooth_height * gear.face_width / math.cos(math.radians(20.0))
        ring = ToothRing(
            root_radius=gear.root_radius, tip_radius=gear.tip_radius, flank_area=area, tooth_thickness=7e-3,
            conductivity=45.0,
        )  # fmt: skip
        speed = abs(running.speed)
        law = dipped_rim_film(
            ring, speed, immersion(gear, bath()).depth, tooth_space_flow(gear, bath(), speed), FVA_3_FILM
        )
        excess.append(0.5 * loss / (law(SUMP + 36.0, SUMP).value * area))
    michaelis = theta_M(0.0, 1e-3 * loss, 91.5 * 14.0, "dip")
    assert sum(excess) / 2.0 == pytest.approx(michaelis, rel=0.1)


@pytest.mark.parametrize(
    ("face_width", "level", "expected"),
    [
        (14e-3, 0.0, (38.1, 38.0, 240.6)),
        (14e-3, -20e-3, (16.2, 23.3, 77.4)),
        (20e-3, 0.0, (48.6, 63.5, 264.8)),
        (20e-3, -20e-3, (21.5, 43.7, 90.0)),
    ],
)
def test_fzg_box_by_all_laws(face_width: float, level: float, expected: tuple[float, ...]) -> None:
    """Both gears [W] at 2170 rpm, FVA 3A at 90 degC, l_h 100 mm: the spread of the laws, no measurement."""
    volume = bath().volume if level == 0.0 else LOW_VOLUME
    found = compare_churning(stage(face_width), bath(level, volume))
    assert [found.powers[law] for law in LAWS] == pytest.approx(list(expected), rel=0.01)
    assert max(found.powers.values()) / min(found.powers.values()) > 4.0
