"""Rolling bearings in the coupling loop: one node between shaft, housing and oil, and what loads it."""

import math
from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from dynamics.rotor.bearing import BearingOperation, HeatStar, OilSupply
from dynamics.rotor.rolling import RollingBearing, SeatConductances, shaft_path
from dynamics.rotor.rolling_catalogue import catalogue_bearing
from rigdesign import load_case
from rigdesign.base.part_name import BearingName
from rigdesign.case import Case
from rigdesign.case.rolling_bearing import BearingSeats
from rigdesign.coupling.bearing_loads import axial_force, bearing_loads, shaft_loads, solve_bearings
from rigdesign.coupling.bearing_seats import conductances
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.located_loss import PointLosses
from rigdesign.coupling.loop_system import running_state
from rigdesign.coupling.losses import rotating_losses
from rigdesign.coupling.mesh_models import mesh_models
from rigdesign.coupling.oil import oil_streams
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.coupling.temperatures import (
    boundary_conditions,
    heat_into_films,
    heat_into_oil,
    seat_temperatures,
    solve_housing,
    sump_temperatures,
)
from rigdesign.coupling.time_run import held_points
from rigdesign.rig.model import Rig, build_rig
from rigdesign.transient.oil import oil_conditions
from tests.builders.rolling_rig import FED, GREASE, SPLASH, rolling_case
from tests.builders.shaft_weight import weight_on_bearing
from tests.builders.static_deflection import static_deflection
from thermal.conditions.boundary import Film
from thermal.conduction.steady import solve_steady

OIL = OilSupply(
    inlet_temperature=353.15, flow=2e-6, viscosity=lambda _: 0.02, density=850.0, heat_capacity=2000.0
)


def test_one_bearing_against_a_network_by_hand() -> None:
    """G_s = 2, G_h = 4, C = 3.4 W/K between 95, 85 and 80 degC: T = (P + 2*95 + 4*85 + 3.4*80) / 9.4."""
    bearing = RollingBearing(data=catalogue_bearing("NU 208"), seats=SeatConductances(shaft=2.0, housing=4.0))
    state = bearing.operating_state(
        BearingOperation(
            load=4000.0, speed=150.0, oil=OIL, shaft_temperature=368.15, housing_temperature=358.15
        )
    )
    by_hand = (state.power + 2.0 * 95.0 + 4.0 * 85.0 + 3.4 * 80.0) / 9.4
    assert state.film_temperature - 273.15 == pytest.approx(by_hand, abs=1e-6)
    star = state.star
    assert star is not None and star.heat == pytest.approx(state.power, rel=1e-9)
    assert star.node(368.15, 358.15) == pytest.approx(state.film_temperature, abs=1e-9)


def test_star_and_triangle_carry_the_same() -> None:
    """Into the shaft: G_s (T - T_s) of the star = exchange + film + source of the triangle, written out."""
    star = HeatStar(shaft=2.0, housing=4.0, oil=3.4, oil_temperature=353.15, heat=40.0)
    shaft, housing = 368.15, 358.15
    exchange = 2.0 * 4.0 / 9.4 * (housing - shaft)
    film = 2.0 * 3.4 / 9.4 * (353.15 - shaft)
    assert 2.0 * (star.node(shaft, housing) - shaft) == pytest.approx(
        exchange + film + 40.0 * 2.0 / 9.4, rel=1e-12
    )


@cache
def _solved(oil: str) -> tuple[Rig, PointLosses]:
    """The test gearbox at the held stage, its bearings at the seats that the field gives."""
    with TemporaryDirectory() as folder:
        rig = build_rig(load_case(rolling_case(Path(folder), test_oil=oil)), "quick")
    point = held_points(rig)[0]
    state = initial_state(rig, point)
    state = replace(state, seat_temperature=dict.fromkeys(state.seat_temperature, 363.15))
    models = mesh_models(rig, point, state)
    for _ in range(2):
        losses = _losses(rig, point, state, models)
        field = solve_housing(rig, "test", losses)
        state = replace(state, seat_temperature=seat_temperatures(rig, {"test": field}))
    return rig, _losses(rig, point, state, models)


def _losses(rig: Rig, point: OperatingPoint, state: CouplingState, models: object) -> PointLosses:
    bearings = solve_bearings(rig, point, state)
    losses = rotating_losses(rig, point, state, models, bearings)  # type: ignore[arg-type]
    return PointLosses(point=point, coupling_state=state, bearings=bearings, losses=tuple(losses))


@pytest.mark.parametrize(("oil", "passing"), [(SPLASH, True), (GREASE, False), (FED, True)])
def test_the_field_closes_and_takes_what_the_bearings_give(oil: str, passing: bool) -> None:
    rig, losses = _solved(oil)
    field = solve_housing(rig, "test", losses)
    assert abs(field.solution.balance.closure) < 1e-6
    seats, rows = seat_temperatures(rig, {"test": field}), field.solution.balance.rows
    for part in ("pinion_front", "wheel_rear"):
        full = BearingName("test", part)
        star = losses.bearings[full].star
        assert star is not None and (star.oil > 0.0) == passing
        shaft, housing = seats[f"{full}.shaft"], seats[f"{full}.housing"]
        node = star.node(shaft, housing)
        assert node == pytest.approx(losses.bearings[full].film_temperature, abs=0.02)
        for (seat, conductance), wall in zip(conductances(rig, full, star), (shaft, housing), strict=True):
            kinds = (f"bearing_film:{part}", "bearing_seats", "bearing_loss")
            taken = math.fsum(row.power for row in rows if row.surface == seat.surface and row.kind in kinds)
            assert taken == pytest.approx(conductance * (node - wall), abs=1e-3)
    # what the bodies do not take, the oil does: all heat of the gearbox is in its streams
    heat, films = heat_into_oil(field), heat_into_films(field)
    none = {f"{name}.{kind}": 0.0 for name in rig.case.gearboxes for kind in ("gear_oil", "bearing_oil")}
    films = dict.fromkeys(losses.bearings, 0.0) | films
    sumps = sump_temperatures(rig, {"test": field})
    streams = oil_streams(rig, losses.losses, films, none | heat, sumps)
    into_oil = math.fsum(stream.heat for stream in streams if stream.name.startswith("test."))
    given = math.fsum(p.loss.power + p.pumped for p in losses.losses if p.gearbox == "test")
    away = math.fsum(row.power for row in rows if row.kind in ("air", "radiation"))
    assert into_oil == pytest.approx(given + away, rel=1e-6)


@pytest.mark.parametrize("oil", [SPLASH, FED])
def test_over_time_a_held_stage_is_the_steady_one_and_without_oil_the_seats_take_all(oil: str) -> None:
    rig, losses = _solved(oil)
    steady = solve_steady(rig.conduction["test"], oil_conditions(rig, "test", losses, oil=True))
    for part in ("pinion_front", "wheel_rear"):
        full = f"test.{part}"
        node = steady.volumes[f"bearing_film:{part}"]
        assert node == pytest.approx(losses.bearings[full].film_temperature, abs=0.3)
    if oil == FED:
        return  # no surface of this housing is wetted by the oil of the bearings once it is gone
    dry = solve_steady(rig.conduction["test"], oil_conditions(rig, "test", losses, oil=False))
    rows = [row for row in dry.balance.rows if row.kind == "bearing_film:pinion_front" and row.area > 0.0]
    assert math.fsum(row.power for row in rows) == pytest.approx(
        losses.bearings["test.pinion_front"].power, rel=1e-4
    )
    assert not [row for row in dry.balance.rows if row.kind in ("bearing_seats", "bearing_loss")]


def test_seats_feel_the_oil_as_a_circuit_feeds_it() -> None:
    """A supply 10 K above what the case states: the films of the seats must have it as the bearing has."""
    rig, losses = _solved(FED)
    supply = {"test.bearing_oil": losses.bearings["test.pinion_front"].star.oil_temperature + 10.0}  # type: ignore[union-attr]
    state = replace(losses.coupling_state, oil_supply=supply)
    warm = _losses(rig, losses.point, state, mesh_models(rig, losses.point, state))
    conditions = boundary_conditions(rig, "test", warm, radiation_included=True)
    fed = {
        c.fluid_temperature for c in conditions if isinstance(c, Film) and c.kind.startswith("bearing_film:")
    }
    assert fed == set(supply.values())


def test_fits_and_temperatures_make_the_operating_clearance(tmp_path: Path) -> None:
    """CN 20 to 45 um; 9 um on a solid shaft widen the raceway by d/F of it; 10 K of the shaft add 30 mm alpha 10 K."""
    entry = load_case(rolling_case(tmp_path)).gearboxes["test"].bearings["pinion_front"]
    cold = BearingSeats(
        bore_less_journal=0.0, spin=0.0, shaft=293.15, bearing=293.15, housing=293.15,
        shaft_expansion=11.5e-6, housing_expansion=11.5e-6,
    )  # fmt: skip
    assert entry.drawn_clearance == pytest.approx(32.5e-6)
    assert (entry.shaft_diameter, entry.housing_bore) == (0.03, 0.09)
    share = 0.03 / catalogue_bearing("NU 406").elements.inner_raceway
    assert entry.running_clearance(cold) == pytest.approx(32.5e-6 - 9e-6 * share, rel=1e-6)
    warm = entry.running_clearance(replace(cold, shaft=303.15))
    ring = 10.0 * shaft_path(catalogue_bearing("NU 406")).ring_share  # the inner ring follows its seat
    grown = 9e-6 + 0.03 * (11.5e-6 * 10.0 - 12.5e-6 * ring)
    raceway = 12.5e-6 * ring * 0.03 / share
    assert warm == pytest.approx(32.5e-6 - grown * share - raceway, rel=1e-6)


def test_axial_force_goes_to_the_locating_bearing_and_tilts_the_shaft(tmp_path: Path) -> None:
    """15 degrees: F_a = T / r tan(beta), on NJ 406; over 139 mm between the bearings F_a r_w loads both."""
    path = rolling_case(tmp_path, dip=False, test_oil=FED, slave_oil=FED)
    path.write_text(
        path.read_text().replace(
            'normal_module = "4.5 mm"', 'normal_module = "4.35 mm", helix_angle = "15 deg"'
        )
    )
    rig = build_rig(load_case(path), "quick")
    state = initial_state(rig, held_points(rig)[0])
    loads = bearing_loads(rig, state)
    pair, torque = rig.pairs["test.main"], state.mesh_torque["test.main"]
    axial = torque / pair.gears[0].reference_radius * math.tan(math.radians(15.0))
    assert loads["test.pinion_rear"].axial == pytest.approx(axial, rel=1e-9)
    assert loads["test.pinion_front"].axial == 0.0
    assert rig.drivetrain is not None
    weight = weight_on_bearing(rig, "test.pinion_front", rig.drivetrain.gear("test.pinion").mass)
    force = 0.5 * torque / pair.base_radii[0]
    alpha = pair.working_pressure_angle
    by_hand = math.hypot(
        force * math.cos(alpha) + weight, force * math.sin(alpha) + axial * pair.working_radii[0] / 0.139
    )
    assert loads["test.pinion_front"].radial == pytest.approx(by_hand, rel=1e-9)


@pytest.mark.parametrize(
    ("ends", "induced"),
    [
        (("30206", "30306"), (1.0 / 3.2, 1.0 / 3.8)),  # F_r / (2 Y)
        (("7206 B", "6306"), (1.14, 0.0)),  # a deep groove ball bearing induces nothing and holds the shaft
    ],
)
def test_bearings_that_press_each_other_share_the_axial_force_of_the_gears(
    tmp_path: Path, ends: tuple[str, str], induced: tuple[float, float]
) -> None:
    others = dict(zip(("test.pinion_front", "test.pinion_rear"), ends, strict=True))
    path = rolling_case(tmp_path, dip=False, test_oil=FED, slave_oil=FED, others=others)
    path.write_text(
        path.read_text().replace(
            'normal_module = "4.5 mm"', 'normal_module = "4.35 mm", helix_angle = "15 deg"'
        )
    )
    rig = build_rig(load_case(path), "quick")
    state = initial_state(rig, held_points(rig)[0])
    front, rear = (bearing_loads(rig, state)[name] for name in others)
    gears = axial_force(shaft_loads(rig, "test", "test_pinion", state))
    own = [share * load.radial for share, load in zip(induced, (front, rear), strict=True)]
    assert gears > 0.0 and rear.axial - front.axial == pytest.approx(gears)
    assert rear.axial == pytest.approx(
        max(own[1], own[0] + gears)
    )  # it locates the shaft: the gears press it
    assert front.axial == pytest.approx(max(own[0], own[1] - gears))
    assert solve_bearings(rig, held_points(rig)[0], state)["test.pinion_rear"].power > 0.0


def test_a_sump_that_finds_its_temperature_takes_what_the_bearings_leave_in_the_oil(tmp_path: Path) -> None:
    path = rolling_case(tmp_path)
    path.write_text(path.read_text().replace(', sump_temperature = "90 degC"', "", 1))
    rig = build_rig(load_case(path), "quick")
    point = held_points(rig)[0]
    state = initial_state(rig, point)
    losses = _losses(rig, point, state, mesh_models(rig, point, state))
    field = solve_housing(rig, "test", losses)
    none = {f"{name}.{kind}": 0.0 for name in rig.case.gearboxes for kind in ("gear_oil", "bearing_oil")}
    films = heat_into_films(field)
    assert any(abs(heat) > 1.0 for heat in films.values())
    sumps = sump_temperatures(rig, {"test": field})
    streams = oil_streams(rig, losses.losses, films, none | heat_into_oil(field), sumps)
    assert next(s.heat for s in streams if s.name == "test.gear_oil") == pytest.approx(0.0, abs=1e-3)


def tapered(tmp_path: Path, arrangement: str) -> Case:
    """Single-helical gears on tapered roller bearings of a stated arrangement."""
    path = rolling_case(
        tmp_path,
        dip=False,
        test_oil=FED,
        slave_oil=FED,
        others={"test.pinion_front": "30206", "test.pinion_rear": "30306"},
    )
    text = path.read_text().replace(
        'normal_module = "4.5 mm"', 'normal_module = "4.35 mm", helix_angle = "15 deg"'
    )
    path.write_text(text)
    return load_case(path).with_value("gearboxes.test.bearings.pinion_front.arrangement", arrangement)


@pytest.mark.parametrize("arrangement", ["back_to_back", "face_to_face"])
@pytest.mark.parametrize("hand", ["right", "left"])
def test_hand_and_arrangement_say_which_tapered_bearing_the_gears_press(
    tmp_path: Path, arrangement: str, hand: str
) -> None:
    """Forces of the shaft on both bearings and of the gears balance along x; back to back the shaft pulls the front
    bearing rearwards."""
    case = tapered(tmp_path, arrangement).with_value("gearboxes.test.gears.pinion.helix_hand", hand)
    rig = build_rig(case, "quick")
    state = initial_state(rig, held_points(rig)[0])
    loads = bearing_loads(rig, state)
    front, rear = loads["test.pinion_front"], loads["test.pinion_rear"]
    pushed = sum(load.axial for load in shaft_loads(rig, "test", "test_pinion", state))
    assert abs(pushed) > 100.0
    assert front.axial_sense * front.axial + rear.axial_sense * rear.axial == pytest.approx(pushed)
    outwards = 1.0 if arrangement == "back_to_back" else -1.0
    assert (front.axial_sense, rear.axial_sense) == (outwards, -outwards)
    for load, share in ((front, 1.0 / 3.2), (rear, 1.0 / 3.8)):
        assert load.axial >= share * load.radial * (1.0 - 1e-9)


def test_tapered_bearings_hold_their_shaft_axially_by_their_rollers(tmp_path: Path) -> None:
    """The axial stiffness of the shaft is that of both rows: one newton moves it by 1 / (k_front + k_rear), where
    turning it out of the way is locked; a spring of its own is left to the other shafts."""
    case = tapered(tmp_path, "face_to_face")
    rig = replace(build_rig(case, "quick"), shaft_model="elastic")
    point = held_points(rig)[0]
    state = initial_state(rig, point)
    bearings = solve_bearings(rig, point, state)
    located = {location.bearing for location in rig.elastic.rig.axial_locations}
    pair = {"test.pinion_front", "test.pinion_rear"}
    assert rig.elastic.pressed == pair and located.isdisjoint(pair)
    running = running_state(rig, point, state, bearings)
    stiffness = {name: running.bearings[name].padded()[0] for name in pair}
    assert all(
        matrix[2, 2] > 1e7 and abs(matrix[2, 0]) + abs(matrix[2, 1]) > 1e6 for matrix in stiffness.values()
    )
    model = rig.elastic.model
    axial = model.row("test.pinion_front", "u_x")
    bent = static_deflection(model, running, axial).deflection
    stiff = sum(matrix[2, :] @ (model.ports[name] @ bent) for name, matrix in stiffness.items())
    assert stiff == pytest.approx(1.0, rel=1e-6)
    assert (
        1.0 / sum(m[2, 2] for m in stiffness.values())
        < axial @ bent
        < 4.0 / sum(m[2, 2] for m in stiffness.values())
    )
