"""Journal bearing under a load vector: axes, sense of rotation, limits, contact, refusals."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError
from dynamics.kernels.journal import HIGHEST_ECCENTRICITY
from dynamics.rotor.bearing import (
    BearingError,
    BearingOperation,
    BearingState,
    LateralCoefficients,
    LateralOperation,
    OilSupply,
    constant_coefficients,
    load_axes,
)
from dynamics.rotor.journal import (
    JournalBearing,
    JournalState,
    RunningFilm,
    coefficient_table,
    journal_lateral,
)

FILM = RunningFilm(diameter=40e-3, width=30e-3, diametral_clearance=80e-6, viscosity=8e-3, omega=1257.0)
FORCE = (1200.0, -1600.0)
LIMIT = FILM.force_scale * FILM.table.characteristic.sommerfeld(HIGHEST_ECCENTRICITY)
"""Load that the film carries at its thinnest [N]."""


def at(force: tuple[float, float] = FORCE, film: RunningFilm = FILM, **more: Any) -> LateralCoefficients:
    return journal_lateral(film, LateralOperation(force=force, **more))


def turned(vector: tuple[float, float], angle: float) -> tuple[float, float]:
    cosine, sine = math.cos(angle), math.sin(angle)
    return cosine * vector[0] - sine * vector[1], sine * vector[0] + cosine * vector[1]


def turn(angle: float) -> NDArray[np.float64]:
    return np.array([turned((1.0, 0.0), angle), turned((0.0, 1.0), angle)]).T


def state(load: float, rpm: float, **more: Any) -> JournalState:
    bearing = JournalBearing(diameter=40e-3, width=30e-3, diametral_clearance=80e-6, **more)
    oil = OilSupply(
        inlet_temperature=313.15, flow=2.0 / 6e4, viscosity=lambda t: 0.02 * math.exp(-0.03 * (t - 313.15)),
        density=975.0, heat_capacity=1950.0,
    )  # fmt: skip
    return bearing.operating_state(BearingOperation(load=load, speed=rpm * math.pi / 30.0, oil=oil))


def test_a_state_knows_its_own_coefficients() -> None:
    """Eccentricity and attitude of the state are the static position; viscosity and speed are its own."""
    running: BearingState = state(2000.0, 12000.0)
    assert isinstance(running, JournalState)
    found = running.lateral_coefficients(LateralOperation(force=FORCE))
    assert found.regime == "hydrodynamic" == running.regime
    assert found.eccentricity == pytest.approx(running.eccentricity, rel=1e-6)
    towards = math.atan2(found.position[1], found.position[0]) - math.atan2(FORCE[1], FORCE[0])
    assert math.hypot(*found.position) == pytest.approx(running.eccentricity * 40e-6, rel=1e-6)
    assert towards == pytest.approx(running.attitude_angle, rel=1e-6)
    assert running.film == replace(FILM, viscosity=running.viscosity, omega=running.omega)


def test_another_load_than_that_of_the_state_moves_the_journal_in_the_same_oil() -> None:
    running = state(2000.0, 12000.0)
    more = running.lateral_coefficients(LateralOperation(force=(2400.0, -3200.0)))
    assert more.eccentricity is not None and more.eccentricity > running.eccentricity + 0.1


def test_scale_is_that_of_the_load_over_the_clearance() -> None:
    """K c / W of the table at the same Sommerfeld number, along the load and across it; C with omega."""
    load = math.hypot(*FORCE)
    sommerfeld = load * 2e-3**2 / (30e-3 * 40e-3 * 8e-3 * 1257.0)
    table = coefficient_table(0.75)
    eps = table.characteristic.eccentricity(sommerfeld)
    dimensionless = table.at(eps).turned(table.characteristic.attitude_angle(eps))
    along = math.atan2(FORCE[1], FORCE[0])
    found = at()
    in_load_axes = turn(-along) @ found.stiffness @ turn(along)
    assert in_load_axes * 40e-6 / load == pytest.approx(dimensionless.stiffness / sommerfeld, rel=1e-9)
    damping = turn(-along) @ found.damping @ turn(along)
    assert damping * 40e-6 * 1257.0 / load == pytest.approx(dimensionless.damping / sommerfeld, rel=1e-9)
    assert found.damping[0, 1] == pytest.approx(found.damping[1, 0], rel=1e-6)


@pytest.mark.parametrize("angle", [0.7, math.pi / 2.0, -2.0])
@pytest.mark.parametrize("film", [FILM, replace(FILM, omega=2.0), replace(FILM, omega=0.0)])
def test_axes_turn_with_the_load(angle: float, film: RunningFilm) -> None:
    first, second = at(film=film), at(turned(FORCE, angle), film)
    about = turn(angle)
    scale = np.abs(first.stiffness).max()
    assert second.stiffness == pytest.approx(about @ first.stiffness @ about.T, abs=1e-9 * scale)
    assert second.damping == pytest.approx(about @ first.damping @ about.T, rel=1e-6, abs=1e-3)
    assert second.position == pytest.approx(about @ first.position, abs=1e-15)


def test_turning_the_other_way_is_the_mirror_image() -> None:
    """Seen in a mirror along the load: cross coupling changes its sign in the axes of the load, nothing else does."""
    first, second = at((0.0, -2000.0)), at((0.0, -2000.0), sense=-1)
    signs = np.array([[1.0, -1.0], [-1.0, 1.0]])
    assert second.stiffness == pytest.approx(signs * first.stiffness, rel=1e-9)
    assert second.damping == pytest.approx(signs * first.damping, rel=1e-9)
    assert second.position == pytest.approx(first.position * [-1.0, 1.0], rel=1e-9)


def test_rotation_carries_the_loaded_journal_along() -> None:
    """Turning about +x, from y to z: a journal pressed down (-z) leaves to +y; pushed to y it is driven to z."""
    found = at((0.0, -2000.0))
    assert found.position[0] > 0.0 > found.position[1]
    light = at((0.0, -20.0))
    assert light.stiffness[1, 0] < 0.0 < light.stiffness[0, 1]


def test_position_follows_the_load_by_the_stiffness() -> None:
    """d(force) = K d(position) along the line of centres; across it the places of feed would turn with the load."""
    step = 1e-3
    low, mid, high = (at((FORCE[0] * f, FORCE[1] * f)) for f in (1.0 - step, 1.0, 1.0 + step))
    moved = np.linalg.norm(high.position) - np.linalg.norm(low.position)
    towards = mid.position / np.linalg.norm(mid.position)
    turning = (high.position - low.position) - moved * towards
    along = mid.stiffness @ (moved * towards)
    across = np.linalg.norm(turning) / np.linalg.norm(mid.position) * math.hypot(*FORCE)
    assert np.linalg.norm(2.0 * step * np.array(FORCE) - along) == pytest.approx(across, rel=0.02)


def test_no_load_is_skew_stiffness_and_equal_damping() -> None:
    found = at((0.0, 0.0))
    assert found.position == pytest.approx([0.0, 0.0])
    assert (
        found.stiffness[0, 1] == -found.stiffness[1, 0] == pytest.approx(0.5 * 1257.0 * found.damping[0, 0])
    )
    assert np.diag(found.stiffness) == pytest.approx([0.0, 0.0])
    assert found.damping == pytest.approx(found.damping[0, 0] * np.eye(2))
    assert at((0.0, 0.0), sense=-1).stiffness[0, 1] == -found.stiffness[0, 1]


def test_no_load_is_the_mean_of_vanishing_loads() -> None:
    none, little = at((0.0, 0.0)), at((1e-3, 0.0))
    assert np.trace(little.damping) == pytest.approx(np.trace(none.damping), rel=1e-4)
    skew = little.stiffness[0, 1] - little.stiffness[1, 0]
    assert skew == pytest.approx(2.0 * none.stiffness[0, 1], rel=1e-4)


def test_centred_full_film_bounds_the_unloaded_one() -> None:
    """Uncavitated film round the whole gap: c = 12 pi (1 - tanh(B/D) / (B/D)) / 2 by separation; the half film, led to
    ambient pressure at its feed, has somewhat less than half of it."""
    ratio = 0.75
    whole = 0.5 * 12.0 * math.pi * (1.0 - math.tanh(ratio) / ratio)
    assert 0.8 * 0.5 * whole < at((0.0, 0.0)).damping[0, 0] / FILM.damping_scale < 0.5 * whole


def test_mixed_friction_begins_where_the_film_ends() -> None:
    """Continuous in load: the asperities begin with nothing."""
    film, mixed = (at((LIMIT * f, 0.0)) for f in (1.0 - 1e-9, 1.0 + 1e-9))
    assert (film.regime, mixed.regime) == ("hydrodynamic", "mixed")
    assert mixed.stiffness == pytest.approx(film.stiffness, rel=1e-5, abs=1e-5 * film.stiffness.max())
    assert mixed.damping == pytest.approx(film.damping, rel=1e-5)
    assert mixed.position == pytest.approx(film.position, rel=1e-6)


def test_mixed_friction_ends_in_standstill() -> None:
    """Continuous in speed: at last the asperities carry all and the film damps by being squeezed out."""
    still, creeping = (at(film=replace(FILM, omega=omega)) for omega in (0.0, 1e-6))
    assert (still.regime, creeping.regime) == ("standstill", "mixed")
    assert creeping.stiffness == pytest.approx(still.stiffness, rel=1e-4, abs=1e-4 * still.stiffness.max())
    assert creeping.damping == pytest.approx(still.damping, rel=1e-4)
    assert creeping.position == pytest.approx(still.position, rel=1e-4)


def test_standstill_is_contact_along_the_load() -> None:
    """W / (0.01 c) along the load, W / c across it, no cross coupling; it lies on the bore."""
    found = at((0.0, -2000.0), replace(FILM, omega=0.0))
    assert np.diag(found.stiffness) == pytest.approx([2000.0 / 40e-6, 2000.0 / 0.4e-6])
    assert found.stiffness[0, 1] == pytest.approx(0.0, abs=1.0)
    assert found.position == pytest.approx([0.0, -40e-6], abs=1e-12)
    assert found.eccentricity == pytest.approx(1.0)
    assert np.all(np.linalg.eigvalsh(found.damping) > 0.0)


def test_mixed_friction_balances_the_load() -> None:
    """Film at its thinnest and contact against the line of centres together carry the load vector."""
    slow = replace(FILM, omega=3.0)
    limit = LIMIT * 3.0 / 1257.0
    found = at((2000.0, 0.0), slow)
    assert found.regime == "mixed" and limit < 2000.0
    attitude = math.atan2(found.position[1], found.position[0])
    thinnest = slow.table.characteristic.attitude_angle(HIGHEST_ECCENTRICITY)
    along = -np.array([math.cos(attitude), math.sin(attitude)])
    of_film = limit * turn(-thinnest) @ along
    contact = 2000.0 * math.cos(attitude) - limit * math.cos(thinnest)
    assert of_film + contact * along == pytest.approx([-2000.0, 0.0], abs=1e-6)


def test_contact_damps_by_the_structure() -> None:
    plain, damped = (at(film=replace(FILM, omega=0.0), structural_damping=s) for s in (0.0, 1e-5))
    assert damped.damping - plain.damping == pytest.approx(1e-5 * plain.stiffness, rel=1e-6, abs=1e-3)


def test_grooves_across_the_load_are_softer_against_it() -> None:
    """The feed belongs to the bearing: another eccentricity, another film."""
    plain, grooved = state(2000.0, 12000.0), state(2000.0, 12000.0, feed="two_axial_grooves")
    assert grooved.eccentricity > plain.eccentricity
    assert grooved.film.feed == "two_axial_grooves"
    assert grooved.side_flow != plain.side_flow
    with pytest.raises(BearingError, match="feed = 'one_hole'"):
        JournalBearing(diameter=40e-3, width=30e-3, diametral_clearance=80e-6, feed="one_hole")  # type: ignore[arg-type]


def test_nothing_holds_an_unloaded_journal_at_standstill() -> None:
    with pytest.raises(BearingError, match=r"standstill.*weight"):
        at((0.0, 0.0), replace(FILM, omega=0.0))
    with pytest.raises(DynamicsInputError, match=r"0\.1 to 2"):
        at(film=replace(FILM, width=1e-3))


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"force": (math.nan, 0.0)}, "force"),
        ({"axial_force": math.inf}, "axial_force"),
        ({"sense": 0}, "sense"),
        ({"structural_damping": -1e-5}, "structural_damping"),
    ],
)
def test_impossible_operation(changes: dict[str, Any], word: str) -> None:
    with pytest.raises(BearingError, match=word):
        LateralOperation(**{"force": FORCE} | changes)


def test_a_film_holds_nothing_axially_and_against_tilting() -> None:
    found = at()
    assert found.node_stiffness[1:3, 1:3] == pytest.approx(found.stiffness)
    assert np.count_nonzero(found.node_stiffness) == np.count_nonzero(found.node_damping) == 4
    assert found.axial_stiffness == 0.0
    assert found.tilting_stiffness == pytest.approx(np.zeros((2, 2)))


def test_constant_coefficients_of_p2() -> None:
    found = constant_coefficients(1e8, 4e4, (1000.0, -500.0))
    assert found.stiffness == pytest.approx(1e8 * np.eye(2))
    assert found.damping == pytest.approx(4e4 * np.eye(2))
    assert found.position == pytest.approx([1e-5, -5e-6])
    assert found.eccentricity is None
    with pytest.raises(DynamicsInputError, match="stiffness = 0"):
        constant_coefficients(0.0, 4e4)


def test_axes_of_a_load() -> None:
    assert load_axes((0.0, -5.0), 1) == pytest.approx(np.array([[0.0, 1.0], [-1.0, 0.0]]))
    assert load_axes((0.0, -5.0), -1) == pytest.approx(np.array([[0.0, -1.0], [-1.0, 0.0]]))
    assert load_axes((0.0, 0.0), 1) == pytest.approx(np.eye(2))


def test_a_kind_without_stiffness_says_so() -> None:
    running = state(2000.0, 12000.0)
    common = {name: getattr(running, name) for name in BearingState.__dataclass_fields__}
    with pytest.raises(BearingError, match="constant coefficients"):
        BearingState(**common).lateral_coefficients(LateralOperation(force=FORCE))
