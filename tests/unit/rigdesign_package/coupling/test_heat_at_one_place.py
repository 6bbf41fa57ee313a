"""Heat at one place: a leak into one side, a draught on one wall, friction of one bearing."""

from functools import cache

import pytest

from rigdesign.base.errors import CaseError
from rigdesign.coupling.loop import solve_point
from rigdesign.coupling.temperatures import side_excess
from rigdesign.rig.oil_supply import bearing_feed, gear_feed
from tests.builders.twisting import twisting_rig
from tests.builders.warm_prototype import Changes, Settled, base, case_with, lost, open_share, settled
from thermal.conduction.steady import CLOSURE

pytestmark = pytest.mark.whole_run

BOX = "gearboxes.test"
LEAK, FRONT = f"{BOX}.oil_paths.leak_warm_cold", f"{BOX}.oil_paths.leak_front_share"
WALLS = f"{BOX}.housing.surface_film_factors"
OUTLET = "bearing_oil_outlet"


def excess(share: float, front: float, surface: str, fluid: str = OUTLET) -> float:
    rig = twisting_rig(case_with(((LEAK, share), (FRONT, front))))
    return side_excess(rig, "test", base()[1].last.coupling_state, surface, fluid)


def wall(surface: str, *changes: tuple[str, object]) -> float:
    """Mean temperature of a surface [K]."""
    rig, last = settled(*changes)
    return rig.conduction["test"].elements.surfaces[surface].mean(last.fields["test"].temperature)


@pytest.mark.parametrize("front", [0.0, 0.3, 0.8, 1.0])
def test_the_oil_of_both_sides_mixes_to_that_of_the_drain(front: float) -> None:
    """Two bearings and their part of the leak on each side: the heats of both sides are that of the whole."""
    share = 0.08
    state = base()[1].last.coupling_state
    rig = twisting_rig(case_with(((LEAK, share),)))
    leak = share * gear_feed(rig, "test", 0.0).capacity_rate
    each = bearing_feed(rig, "test", 0.0).capacity_rate
    flows = {"front": 2.0 * each + front * leak, "rear": 2.0 * each + (1.0 - front) * leak}
    sides = {side: excess(share, front, f"cold_wall_{side}") for side in flows}
    assert sum(flows[side] * sides[side] for side in flows) == pytest.approx(0.0, abs=1e-9)
    assert (sides["front"] - sides["rear"]) * (front - 0.5) > 0.0
    if front == 1.0:
        mixed, warm = state.oil_outlet["test.bearing_oil"], state.oil_outlet["test.gear_oil"]
        alone = mixed + leak / (4.0 * each) * (mixed - warm)
        assert sides["rear"] == pytest.approx(alone - mixed)


def test_an_even_leak_other_fluids_and_other_surfaces_have_no_side() -> None:
    assert excess(0.08, 0.5, "cold_wall_front") == 0.0
    assert excess(0.0, 1.0, "cold_wall_front") == 0.0
    assert excess(0.08, 1.0, "chamber_wall") == 0.0
    assert excess(0.08, 1.0, "cold_wall_front", "gear_oil_outlet") == 0.0
    assert excess(0.08, 1.0, "cold_wall_front", "bearing_oil_mean") == pytest.approx(
        0.5 * excess(0.08, 1.0, "cold_wall_front")
    )


def test_a_leak_into_the_front_warms_the_front() -> None:
    changes: Changes = ((LEAK, 0.05), (FRONT, 1.0))
    front, rear = (wall(f"outer_cold_{side}", *changes) for side in ("front", "rear"))
    even = [wall(f"outer_cold_{side}", (LEAK, 0.05)) for side in ("front", "rear")]
    assert front - even[0] > 0.5 and rear - even[1] < -0.5
    rig, last = settled(*changes)
    assert last.fields["test"].solution.balance.closure <= CLOSURE
    assert open_share(rig, last) < 2e-3


@cache
def blown() -> Settled:
    """The shipped rig with three times the film on its front."""
    rig, steady = base()
    made = twisting_rig(case_with(((WALLS, {"outer_cold_front": 3.0}),))).with_models(rig.models)
    start = steady.last.coupling_state
    return made, solve_point(made, steady.point, start=start, before=steady.last).last


def film_to_air(state: Settled, surface: str) -> tuple[float, float]:
    """Coefficient [W/(m2 K)], and wall above the room [K]."""
    rows = state[1].fields["test"].solution.balance.rows
    row = next(row for row in rows if (row.surface, row.kind) == (surface, "air"))
    return row.coefficient.value, row.mean_temperature - state[0].case.ambient.temperature


def test_a_draught_cools_the_wall_it_blows_on() -> None:
    front, rear = (
        film_to_air(blown(), surface)[1] - film_to_air(settled(), surface)[1]
        for surface in ("outer_cold_front", "outer_cold_rear")
    )
    assert front < -2.0 and 0.2 * front < rear < 0.0
    assert open_share(*blown()) < 2e-3


def test_the_factor_of_a_wall_multiplies_its_law_alone() -> None:
    """Niemann/Winter: the coefficient goes with 10 + 0.07 dT."""
    for surface, factor in (("outer_cold_front", 3.0), ("outer_cold_rear", 1.0), ("outer_warm", 1.0)):
        (now, rise), (was, before) = film_to_air(blown(), surface), film_to_air(settled(), surface)
        assert now / was == pytest.approx(factor * (10.0 + 0.07 * rise) / (10.0 + 0.07 * before), rel=1e-3)


def test_a_factor_needs_a_surface_in_room_air() -> None:
    for surface in ("chamber_wall", "outer_left"):
        with pytest.raises(CaseError, match=f"{surface}.*room air"):
            case_with(((WALLS, {surface: 2.0}),))


def test_friction_of_one_bearing_is_its_own() -> None:
    tight = (f"{BOX}.bearings.wheel_rear.friction_factor", 2.0)

    def power(name: str, *changes: tuple[str, object]) -> float:
        return next(
            placed.loss.power for placed in settled(*changes)[1].losses if placed.name == f"test.{name}"
        )

    assert power("wheel_rear", tight) > 1.4 * power("wheel_rear")
    for other in ("wheel_front", "pinion_front", "pinion_rear"):
        assert power(other, tight) == pytest.approx(power(other), rel=0.02)
    both = (f"{BOX}.loss_factors.bearing", 2.0)
    assert (
        lost(settled(both)[1], "bearing") > lost(settled(tight)[1], "bearing") > lost(settled()[1], "bearing")
    )
    assert open_share(*settled(tight)) < 2e-3
