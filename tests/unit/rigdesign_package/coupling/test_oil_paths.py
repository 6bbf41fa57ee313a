"""Gear oil that takes another way: mixing by hand, heat kept, the walls see what is left for them."""

import math

import numpy as np
import pytest

from rigdesign.base.errors import CaseError
from rigdesign.case.surface_conditions import FlankFilm
from rigdesign.coupling.flank_heat import gear_flanks
from rigdesign.coupling.located_loss import PointLosses
from rigdesign.coupling.losses import rotating_losses
from rigdesign.coupling.oil import OilStream, heater_and_cooler, oil_streams
from rigdesign.properties.oil import FVA_3, MIL_PRF_23699, Portion, mixed
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import ChamberOil, gear_oil
from rigdesign.transient.oil import BEARING_OIL, GEAR_OIL, oil_conditions
from tests.builders.twisting import twisting_rig
from tests.builders.warm_prototype import base, case_with, lost, open_share, outlet, settled
from thermal.conditions.streams import StreamNetwork
from thermal.conduction.steady import solve_steady

pytestmark = pytest.mark.whole_run

BOX = "gearboxes.test"
LEAK, BYPASS, SHORT = (f"{BOX}.oil_paths.{key}" for key in ("leak_warm_cold", "bypass", "short_circuit"))
JETS = f"{BOX}.oil.blocked_jets"


def changed(*changes: tuple[str, object]) -> Rig:
    return twisting_rig(case_with(changes)).with_models(base()[0].models)


def streams(*changes: tuple[str, object]) -> dict[str, OilStream]:
    """Streams under the losses and heats of the shipped state."""
    last = base()[1].last
    found = oil_streams(
        changed(*changes), last.losses, last.coupling_state.bearing_heat, last.coupling_state.wall_heat, {}
    )
    return {stream.name: stream for stream in found}


def carried(rig: Rig, stream: OilStream, share: float = 1.0) -> float:
    """m c (T_out - T_in) of a share of the gear oil [W]."""
    oil = gear_oil(rig, "test")
    mean = 0.5 * (stream.inlet + stream.outlet)
    return (
        share
        * stream.flow
        * oil.density(stream.inlet)
        * oil.heat_capacity(mean)
        * (stream.outlet - stream.inlet)
    )


def test_streams_that_meet_keep_their_heat() -> None:
    cold = Portion(oil=FVA_3, inlet=313.15, flow=1e-4)
    hot = Portion(oil=MIL_PRF_23699, inlet=413.15, flow=5e-5).warmed(405.0)
    together = mixed((cold, hot), 500.0)
    assert 313.15 < together < 405.0
    assert cold.heat_at(together) + hot.heat_at(together) == pytest.approx(500.0 + hot.heat, rel=1e-9)
    alone = mixed((cold,), 500.0)
    assert cold.heat_at(alone) == pytest.approx(500.0)


def test_the_cold_cooler_takes_a_leak_from_the_warm_inlet_down_to_the_cold_one() -> None:
    """Oil of 140 degC that leaks ends in the tank of 40 degC, and as much cold oil makes it up: m c 100 K are cooled
    there and heated here, in addition to what the leak took up on its way."""
    plain, leaking = streams(), streams((LEAK, 0.1))
    gear, bearing = (leaking[f"test.{kind}"] for kind in ("gear_oil", "bearing_oil"))
    oil = gear_oil(base()[0], "test")
    mean = 0.5 * (gear.inlet + bearing.inlet)
    moved = 0.1 * gear.flow * oil.density(gear.inlet) * oil.heat_capacity(mean) * (gear.inlet - bearing.inlet)
    assert moved > 1000.0
    assert bearing.leaked == pytest.approx(moved, rel=1e-9)
    assert gear.leaked == -bearing.leaked
    powers = []
    for found in (plain, leaking):
        own = {name: np.array([found[name].to_tank]) for name in ("test.gear_oil", "test.bearing_oil")}
        powers.append([float(power[0]) for power in heater_and_cooler(base()[0].case, own)])
    (heater, cooler), (more_heater, more_cooler) = powers
    assert (more_cooler - more_heater) == pytest.approx(cooler - heater, rel=1e-9)
    taken_along = 0.1 * plain["test.gear_oil"].heat
    assert more_cooler - cooler == pytest.approx(moved + taken_along, rel=1e-6)


def test_a_leak_carries_warm_oil_to_the_bearings_and_heat_with_it() -> None:
    plain, leaking = streams(), streams((LEAK, 0.1))
    assert leaking["test.gear_oil"].outlet == plain["test.gear_oil"].outlet
    before, after = (s["test.bearing_oil"] for s in (plain, leaking))
    oil = base()[0].oils[base()[0].case.gearboxes["test"].bearing_oil.oil]
    own = after.flow * oil.density(after.inlet) * oil.heat_capacity(0.5 * (before.outlet + after.outlet))
    warm = gear_oil(base()[0], "test")
    gear = plain["test.gear_oil"]
    leaked = 0.1 * gear.flow * warm.density(gear.inlet)
    fall = leaked * warm.heat_capacity(0.5 * (gear.outlet + after.outlet)) * (gear.outlet - after.outlet)
    assert own * (after.outlet - before.outlet) == pytest.approx(fall, rel=1e-6)
    assert after.outlet - before.outlet > 2.0
    # what the oils carry in all stays, 10 % of that of the gears now comes back with the bearings
    heats = [
        math.fsum(s[f"test.{kind}"].heat for kind in ("gear_oil", "bearing_oil")) for s in (plain, leaking)
    ]
    assert heats[1] == pytest.approx(heats[0], rel=1e-12)
    assert leaking["test.gear_oil"].heat == pytest.approx(0.9 * gear.heat, rel=1e-9)


def test_a_bypass_hides_at_the_drain_and_shows_at_the_walls() -> None:
    plain, past = streams()["test.gear_oil"], streams((BYPASS, 0.25))["test.gear_oil"]
    assert past.outlet == pytest.approx(plain.outlet, abs=1e-9)
    assert past.heat == plain.heat
    oil = gear_oil(base()[0], "test")
    rises = [(s.chamber - s.inlet) * oil.heat_capacity(0.5 * (s.chamber + s.inlet)) for s in (plain, past)]
    assert rises[1] == pytest.approx(rises[0] / 0.75, rel=1e-9)
    assert past.chamber < plain.chamber - 1.0  # this oil is cooled by its walls


def test_a_short_circuit_takes_the_heat_of_the_meshes_past_the_walls() -> None:
    rig = changed((SHORT, 0.25))
    plain, short = streams()["test.gear_oil"], streams((SHORT, 0.25))["test.gear_oil"]
    assert short.outlet == pytest.approx(plain.outlet, abs=1e-9)
    last = base()[1].last
    walls = last.coupling_state.wall_heat["test.gear_oil"]
    losses = plain.heat - walls
    along = Portion(oil=gear_oil(rig, "test"), inlet=plain.inlet, flow=0.75 * plain.flow)
    assert along.heat_at(short.chamber) == pytest.approx(0.75 * losses + walls, rel=1e-9)


def test_a_measured_outlet_is_that_of_the_drain() -> None:
    measured = (f"{BOX}.oil.outlet_temperature", "135 degC")
    stream = streams(measured, (BYPASS, 0.2))["test.gear_oil"]
    assert stream.outlet == 408.15
    rise = stream.chamber - stream.inlet
    assert rise == pytest.approx((408.15 - stream.inlet) / 0.8, rel=0.01)
    assert streams(measured)["test.gear_oil"].chamber == 408.15


def test_ways_of_the_oil_close_the_balance_of_the_rig() -> None:
    rig, after = settled((LEAK, 0.1), (BYPASS, 0.2), (SHORT, 0.1))
    _, before = settled()
    assert open_share(rig, after) < 2e-3
    assert outlet(after, "test.bearing_oil") > outlet(before, "test.bearing_oil") + 2.0
    assert (
        after.coupling_state.oil_outlet["test.gear_oil"]
        < before.coupling_state.oil_outlet["test.gear_oil"] - 1.0
    )
    assert lost(after, "oil_acceleration") < 0.9 * lost(
        before, "oil_acceleration"
    )  # slower jets, less of them
    row = {stream.name: stream for stream in after.streams}["test.gear_oil"]
    assert carried(rig, row, 0.9) == pytest.approx(row.heat, rel=1e-3)


def test_blocked_jets_drive_the_others_faster() -> None:
    """m' u (u - v cos) with v/(1 - b): the momentum the jets bring is all that changes."""
    _, last = settled()
    jets = []
    for changes in ((), ((JETS, 0.5),)):
        losses = rotating_losses(
            changed(*changes), last.point, last.coupling_state, last.models, last.bearings
        )
        jets.append(
            next(p.loss for p in losses if p.name == "test.main" and p.loss.kind == "oil_acceleration")
        )
    assert jets[1].details["jet_speed"] == pytest.approx(2.0 * float(jets[0].details["jet_speed"]))
    assert jets[1].details["flow"] == jets[0].details["flow"]


def test_flanks_past_blocked_jets_stay_dry() -> None:
    """Half of the width wetted by twice the oil a metre: more than half of the film where the oil is scarce."""
    film = FlankFilm(surfaces=("gear_test_pinion_rim",), law="flank_film", correlation="fling_off")
    point = base()[1].point
    values = {}
    for share in (0.0, 0.5):
        for flow in ("5 l/min", "50 l/min"):
            rig = changed((JETS, share), (f"{BOX}.oil.flow", flow))
            flanks = gear_flanks(rig, "test", "pinion", point, film, ChamberOil(leaving=420.0))
            values[share, flow] = flanks.law(400.0, 390.0).value
    ratios = [values[0.5, flow] / values[0.0, flow] for flow in ("5 l/min", "50 l/min")]
    assert 0.5 <= ratios[1] <= ratios[0] < 1.0
    assert ratios[1] == pytest.approx(0.5, abs=0.05)


def test_the_course_over_time_ends_at_the_same_state() -> None:
    """The networks of the transient with leak, bypass and short circuit solve to the settled field."""
    rig, last = settled((LEAK, 0.1), (BYPASS, 0.2), (SHORT, 0.1))
    state = PointLosses(
        point=last.point, coupling_state=last.coupling_state, bearings=last.bearings, losses=last.losses
    )
    conditions = oil_conditions(rig, "test", state, oil=True)
    setup = rig.conduction["test"]
    networks = [c for c in conditions if isinstance(c, StreamNetwork)]
    assert [len([s for s in n.streams if s.kind == "leak"]) for n in networks] == [0, 1]
    solution = solve_steady(setup, conditions, last.fields["test"].temperature)
    for kind in (GEAR_OIL, BEARING_OIL):
        assert solution.volumes[kind] == pytest.approx(
            last.coupling_state.oil_outlet[f"test.{kind}"], abs=0.1
        )


@pytest.mark.parametrize(
    "changes, word",
    [
        (((LEAK, 0.95),), "leak_warm_cold"),
        (((BYPASS, -0.1),), "bypass"),
        (((JETS, 1.0),), "blocked_jets"),
        (((LEAK, 0.5), (BYPASS, 0.5)), "leaves no oil"),
    ],
)
def test_ways_of_the_oil_have_limits(changes: tuple[tuple[str, object], ...], word: str) -> None:
    with pytest.raises(CaseError, match=word):
        case_with(changes)


def test_blocked_jets_leave_part_of_a_given_flank_film_dry() -> None:
    """The film of the case holds where oil lands; where a jet is closed the flank has none."""
    films = [
        {r.surface: r.coefficient.value for r in last.fields["test"].solution.balance.rows if r.coefficient}
        for _, last in (settled(), settled((JETS, 0.4)))
    ]
    for surface in ("gear_test_pinion_rim", "gear_test_wheel_rim"):
        assert films[1][surface] == pytest.approx(0.6 * films[0][surface])
    other = "gear_test_pinion_side_front"
    assert films[1][other] == pytest.approx(films[0][other], rel=1e-2)
