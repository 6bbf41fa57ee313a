"""Every arrow of the coupling loop: cut it, and a named result moves as a hand calculation says.

An arrow is a field of `CouplingState`; `solve_point(..., freeze={arrow})` keeps it at its cold value while the rest
of the loop settles. Each test derives sign and amount by hand from what the arrow carries, and asks for at least
twenty times the tolerance of the loop: 1 K, 10 um, 2 % of the torque.

Backlash acts on torques only where the bracing is held (torque control hides it), so these tests hold the twist
of the shipped rig. Its test bearings get half of their oil and the reference mesh a tenth, so that film and
mesh viscosity feel the heat clearly; nothing in the hand values depends on that choice.
"""

import math
from dataclasses import fields, replace
from functools import cache
from pathlib import Path

import pytest

from dynamics.rotor.rolling_state import RollingState
from dynamics.tooth.friction import ToothPath
from dynamics.vibration.response_curve import CurvePoint
from rigdesign.base.errors import NotConvergedError
from rigdesign.case import Case, load_case
from rigdesign.coupling.alignment import coupled_ends, coupling_places
from rigdesign.coupling.bearing_loads import bearing_loads
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.loop import PointResult, solve_point
from rigdesign.coupling.loop_system import bearing_coefficients, mesh_placements
from rigdesign.coupling.mesh_models import MeshModel, mesh_models
from rigdesign.coupling.preloaded_loop import LoadedCircuit, respond
from rigdesign.coupling.state import CouplingState
from rigdesign.coupling.time_run import held_points
from rigdesign.postprocessing.dynamics import bracing_drift
from rigdesign.postprocessing.housing import stage_balance
from rigdesign.rig.model import Rig, RigParts, build_rig
from tests.builders.oil_circuit import plant_case

CASE = "cases/uhcf_prototype"
TEMPERATURE, LENGTH, TORQUE = 0.05, 0.5e-6, 1e-3
"""Tolerances of the loop: K, m, relative."""
CLEAR = 20.0
"""A cut arrow must move its result by this many tolerances."""
ENDS = ("front", "rear")
ARROWS = frozenset(field.name for field in fields(CouplingState))


def shipped() -> Case:
    return load_case(CASE)


@cache
def held_rig() -> Rig:
    case = (
        shipped()
        .with_value("drivetrain.bracing.mode", "twist_held")
        .with_value("gearboxes.test.bearing_oil.flow", "1 l/min")
        .with_value("gearboxes.reference.oil.flow", "0.5 l/min")
    )
    return build_rig(case, "quick")


@cache
def warm() -> PointResult:
    """The whole loop."""
    return solve_point(held_rig(), held_points(held_rig())[-1])


@cache
def cut(arrow: str) -> PointResult:
    """The loop without one arrow, started where the whole loop settled."""
    point = held_points(held_rig())[-1]
    return solve_point(held_rig(), point, freeze=frozenset({arrow}), start=warm().last.coupling_state)


@cache
def controlled() -> tuple[Rig, PointResult]:
    """The shipped rig with its torque control."""
    rig = build_rig(shipped(), "quick")
    return rig, solve_point(rig, held_points(rig)[-1])


def moved_torque(arrow: str) -> float:
    """Mean torque of the test mesh with the arrow less the one without [N m]."""
    return float(warm().last.response.mean[0] - cut(arrow).last.response.mean[0])  # type: ignore[union-attr]


def drift_by_backlash(arrow: str) -> float:
    """Torque change of the held loop by the backlash that the arrow takes from both meshes [N m].

    Teeth grow on both flanks, so half of the lost backlash j along the line of action winds up the loop:
    with base radius r_b it turns by j / (2 r_b), and the loop answers with its stiffness k,
    dT = k (j_test / r_b,test + j_reference / r_b,reference) / 2.
    """
    stiffness = bracing_drift(held_rig(), warm()).initial.loop_stiffness
    turn = sum(
        0.5 * (without.pair.backlash_along_path - whole.pair.backlash_along_path) / whole.pair.base_radii[0]
        for whole, without in zip(warm().last.models, cut(arrow).last.models)
    )
    return stiffness * turn


def test_every_arrow_of_the_loop_has_its_test() -> None:
    tested = {name for name in ARROWS if any(f"test_{name}" in test for test in globals())}
    assert tested == ARROWS


def test_gear_temperature_takes_up_backlash() -> None:
    """A gear that grows by e = alpha dT shows at the fixed radius r_w what was at r_w (1 - e) before.

    The tooth there, s(r) = r (s_0 / r_0 + 2 inv alpha_0 - 2 inv alpha(r)) with r d(inv alpha)/dr = tan alpha, is
    thicker by 2 r_w tan(alpha_wt) e. Both gears together: dj_t = -2 tan(alpha_wt) sum(r_w alpha dT).
    """
    coupling_state, room = warm().last.coupling_state, held_rig().case.ambient.temperature
    whole, without = warm().last.models[0].pair, cut("gear_temperature").last.models[0].pair
    expanded = sum(
        radius * 11.5e-6 * (coupling_state.gear_temperature[name] - room)
        for radius, name in zip(without.working_radii, ("test.pinion", "test.wheel"))
    )
    apart = warm().last.coupling_state.centre_distance["test.main"] - without.centre_distance
    by_hand = 2.0 * math.tan(without.working_pressure_angle) * (apart - expanded)
    moved = whole.transverse_backlash - without.transverse_backlash
    assert moved == pytest.approx(by_hand, rel=0.02)
    assert moved < -CLEAR * LENGTH


def test_gear_temperature_winds_up_a_held_loop() -> None:
    moved = moved_torque("gear_temperature")
    assert moved == pytest.approx(drift_by_backlash("gear_temperature"), rel=0.05)
    assert moved > CLEAR * TORQUE * 180.0


def test_centre_distance_opens_the_backlash() -> None:
    """Axes that move apart by da open 2 tan(alpha_wt) da: each flank leaves the line of centres by da tan."""
    whole, without = warm().last.models[0].pair, cut("centre_distance").last.models[0].pair
    steel = held_rig().materials["case_hardened_steel"].expansion_coefficient
    after, before = warm().last.coupling_state, cut("centre_distance").last.coupling_state
    expanded = sum(
        radius * steel * (after.gear_temperature[name] - before.gear_temperature[name])
        for radius, name in zip(without.working_radii, ("test.pinion", "test.wheel"))
    )
    change = whole.centre_distance - without.centre_distance
    by_hand = 2.0 * math.tan(without.working_pressure_angle) * (change - expanded)
    moved = whole.transverse_backlash - without.transverse_backlash
    assert change > CLEAR * LENGTH
    assert moved == pytest.approx(by_hand, rel=0.02)
    assert moved > CLEAR * LENGTH


def test_centre_distance_slackens_a_held_loop() -> None:
    moved = moved_torque("centre_distance")
    assert moved == pytest.approx(drift_by_backlash("centre_distance"), rel=0.05)
    assert moved < -CLEAR * TORQUE * 180.0


def heat_capacity_flow(stream: str, flow: float) -> float:
    """rho c Q [W/K] of a flow [m3/s] at the inlet temperature."""
    box = held_rig().case.gearboxes["test"]
    inlet = (box.oil if stream == "gear_oil" else box.bearing_oil).inlet_temperature
    oil = held_rig().oils["MIL-PRF-23699"]
    return oil.density(inlet) * oil.heat_capacity(inlet) * flow


BEARINGS = ("test.pinion_front", "test.pinion_rear", "test.wheel_front", "test.wheel_rear")


def petroff_with_heat_balance(
    name: str, clearance: float, eccentricity: float, heat: float
) -> tuple[float, float]:
    """Drag [N m] and film temperature [K] of a journal by hand.

    M = 2 pi eta omega B R^3 / (c sqrt(1 - eps^2)) with the radial clearance c and the viscosity at
    T = T_in + (M omega + H) / (2 rho c_p Q), repeated until it stands (Petroff 1883; ISO 7902-1, 5.6).
    """
    rig, state = held_rig(), warm().last.bearings[name]
    oil, box = rig.oils["MIL-PRF-23699"], rig.case.gearboxes["test"]
    capacity = heat_capacity_flow("bearing_oil", box.bearing_oil.flow)
    temperature, drag = box.bearing_oil.inlet_temperature, 0.0
    for _ in range(60):
        viscosity = oil.dynamic_viscosity(temperature)
        drag = 2.0 * math.pi * viscosity * state.omega * 0.030 * 0.020**3 / (0.5 * clearance)
        drag /= math.sqrt(1.0 - eccentricity**2)
        target = box.bearing_oil.inlet_temperature + 0.5 * (drag * state.omega + heat) / capacity
        temperature += 0.5 * (target - temperature)
    return drag, temperature


def test_bearing_clearance_lowers_the_drag() -> None:
    """Petroff: the drag falls as 1/c; a cooler film takes back a third of that, the eccentricity a little."""
    name = "test.pinion_front"
    drags = []
    for result in (warm(), cut("bearing_clearance")):
        coupling_state, state = result.last.coupling_state, result.last.bearings[name]
        drags.append(
            petroff_with_heat_balance(
                name,
                coupling_state.bearing_clearance[name],
                state.eccentricity,
                coupling_state.bearing_heat[name],
            )[0]
        )
    by_hand = drags[0] / drags[1] - 1.0
    before = cut("bearing_clearance").last.bearings[name].drag_torque
    moved = warm().last.bearings[name].drag_torque / before - 1.0
    opened = warm().last.coupling_state.bearing_clearance[name] - 80e-6
    assert opened > CLEAR * LENGTH
    assert moved == pytest.approx(by_hand, rel=0.15)
    assert moved < -CLEAR * TORQUE


@pytest.mark.parametrize("name", BEARINGS)
def test_bearing_heat_warms_its_film(name: str) -> None:
    """H from shaft and shell would warm the film by H / (2 rho c Q); thinner oil drags less and takes back a part.

    With b = -d ln(eta)/dT and the friction power P: dT = H / (2 rho c Q) / (1 + b P / (2 rho c Q)).
    """
    rig, whole, without = held_rig(), warm().last, cut("bearing_heat").last
    viscosity = rig.oils["MIL-PRF-23699"].dynamic_viscosity
    low, high = without.bearings[name].film_temperature, whole.bearings[name].film_temperature
    slope = math.log(viscosity(low) / viscosity(low + 1.0))
    capacity = 2.0 * heat_capacity_flow("bearing_oil", rig.case.gearboxes["test"].bearing_oil.flow)
    power = without.bearings[name].power
    by_hand = whole.coupling_state.bearing_heat[name] / capacity / (1.0 + slope * power / capacity)
    assert high - low == pytest.approx(by_hand, rel=0.10)
    assert high - low > CLEAR * TEMPERATURE


def test_wall_heat_cools_the_gear_oil() -> None:
    """The cold sections take H from the 140 degC oil: its outlet falls by H / (rho c Q)."""
    whole, without = warm().last, cut("wall_heat").last
    after = {stream.name: stream for stream in whole.streams}["test.gear_oil"]
    before = {stream.name: stream for stream in without.streams}["test.gear_oil"]
    by_hand = whole.coupling_state.wall_heat["test.gear_oil"] / heat_capacity_flow("gear_oil", after.flow)
    assert after.outlet - before.outlet == pytest.approx(by_hand, rel=0.03)
    assert after.outlet - before.outlet < -CLEAR * TEMPERATURE


def test_oil_outlet_moves_the_wall_between_both_oils() -> None:
    """A plate of 15 mm between two films of h = 300 W/(m2 K) with fluids that move by g and b.

    In series 1/h + t/k + 1/h the side of the cold oil follows its fluid by (1/h + t/k) / (2/h + t/k). The rim of
    the plate depends on the outer walls, which follow less: the mean of the plate stays up to a tenth below.
    """
    whole, without = warm().last, cut("oil_outlet").last
    outlet, inlet = whole.coupling_state.oil_outlet, without.coupling_state.oil_outlet
    gear = 0.5 * (outlet["test.gear_oil"] - inlet["test.gear_oil"])
    bearing = outlet["test.bearing_oil"] - inlet["test.bearing_oil"]
    film, plate = 1.0 / 300.0, 0.015 / 50.0
    near = (film + plate) / (2.0 * film + plate)
    rows = [
        {row.surface: row.mean_temperature for row in result.fields["test"].solution.balance.rows}
        for result in (whole, without)
    ]
    for surface, by_hand in (
        ("partition_cold_front", near * bearing + (1.0 - near) * gear),
        ("partition_warm_front", (1.0 - near) * bearing + near * gear),
    ):
        moved = rows[0][surface] - rows[1][surface]
        assert moved == pytest.approx(by_hand, rel=0.10)
        assert moved > CLEAR * TEMPERATURE


def test_oil_outlet_thins_the_tooth_film() -> None:
    """ISO/TR 14179-2: mu falls with eta^-0.05, taken at the mean of inlet and outlet."""
    viscosity = held_rig().oils["MIL-PRF-23699"].dynamic_viscosity
    inlet = held_rig().case.gearboxes["reference"].oil.inlet_temperature
    outlet = warm().last.coupling_state.oil_outlet["reference.gear_oil"]
    by_hand = (viscosity(0.5 * (inlet + outlet)) / viscosity(inlet)) ** -0.05
    moved = warm().last.models[1].friction.value / cut("oil_outlet").last.models[1].friction.value
    assert moved == pytest.approx(by_hand, rel=1e-3)
    assert moved - 1.0 > CLEAR * TORQUE


def test_mesh_torque_loads_the_reference_bearings() -> None:
    """The tooth force T / r_b on the front bearing by the lever rule; the weight does not change."""
    whole, without = warm().last, cut("mesh_torque").last
    # the wheel drives here: the torque at the pinion is negative
    change = (
        without.coupling_state.mesh_torque["reference.main"]
        - whole.coupling_state.mesh_torque["reference.main"]
    )
    lever = (277.93 - 159.97) / (277.93 - 32.03)
    by_hand = lever * change / whole.models[1].pair.base_radii[0]
    name = "reference.pinion_front"
    moved = whole.bearings[name].load - without.bearings[name].load
    assert change > 0.0
    assert moved == pytest.approx(by_hand, rel=0.02)
    assert moved > CLEAR * TORQUE * without.bearings[name].load


HELICAL = """
extends = "{base}"
name = "single_helical"
title = "Single-helical test gears, shafts located at opposite ends"

[drivetrain.bracing]
mode = "twist_held"

[gearboxes.test.meshes.main]
normal_module = "0.94 mm"
helix_angle = "18 deg"
remove = ["contact_ratio", "tip_cut"]

[gearboxes.test.bearings.pinion_front]
locating = true
axial_play = "0.5 mm"

[gearboxes.test.bearings.pinion_rear]
remove = ["axial_play"]
locating = false
"""


def test_axial_expansion_winds_up_a_helical_loop(tmp_path: Path) -> None:
    """Shafts that grow from opposite ends carry their gears past each other by s.

    The flanks approach by s tan(beta_b), tan(beta_b) = tan(beta) cos(alpha_t); the loop turns by that over r_b
    and answers with its stiffness. s itself stays below what both shafts would grow freely, pinion from the
    front and wheel from the rear bearing, since the housing between the bearings grows along.
    """
    file = tmp_path / "helical.toml"
    file.write_text(HELICAL.format(base=(Path(CASE) / "case.toml").resolve().as_posix()), encoding="utf-8")
    rig = build_rig(load_case(file), "quick")
    point = held_points(rig)[-1]
    whole = solve_point(rig, point)
    without = solve_point(rig, point, freeze=frozenset({"axial_expansion"}), start=whole.last.coupling_state)
    travel = whole.last.coupling_state.axial_expansion["test.main"]
    free = 11.5e-6 * sum(
        reach * (whole.last.coupling_state.gear_temperature[gear] - rig.case.ambient.temperature)
        for reach, gear in ((0.11234, "test.pinion"), (0.12786, "test.wheel"))
    )
    helix = math.radians(18.0)
    transverse = math.atan(math.tan(math.radians(20.0)) / math.cos(helix))
    approach = travel * math.tan(helix) * math.cos(transverse)
    stiffness = bracing_drift(rig, whole).initial.loop_stiffness
    models = zip(whole.last.models, without.last.models)
    slack = [0.5 * (b.pair.backlash_along_path - a.pair.backlash_along_path) for a, b in models]
    turn = (approach + slack[0]) / whole.last.models[0].pair.base_radii[0]
    assert whole.last.response is not None and without.last.response is not None
    moved = float(whole.last.response.mean[0] - without.last.response.mean[0])
    assert CLEAR * LENGTH < travel < free
    assert moved == pytest.approx(stiffness * turn, rel=0.05)
    assert moved > CLEAR * TORQUE * 180.0


def variant(tmp_path: Path, text: str) -> Rig:
    base = (Path(CASE) / "case.toml").resolve().as_posix()
    file = tmp_path / "variant.toml"
    file.write_text(f'extends = "{base}"\nname = "variant"\n{text}', encoding="utf-8")
    return build_rig(load_case(file), "quick")


def mean_to_sink(mesh_heat: float, bore: float, width: float, films: list[tuple[float, float]]) -> float:
    """Rise of the mean of a gear [K] over its oil by a heat at its rim, lumped.

    films : (h, area) of rim and sides in parallel; beside them the way into the shaft: the disc from its mean
    radius to the bore, ln(r_m / r_i) / (2 pi k b), then the shaft as two endless fins of sqrt(h P k A) each.
    """
    conductivity, shaft_film = 42.0, 120.0
    section, girth = 0.25 * math.pi * bore**2, math.pi * bore
    fins = 2.0 * math.sqrt(shaft_film * girth * conductivity * section)
    outer = 0.0495
    middle = 2.0 / 3.0 * (outer**3 - (0.5 * bore) ** 3) / (outer**2 - (0.5 * bore) ** 2)
    disc = math.log(2.0 * middle / bore) / (2.0 * math.pi * conductivity * width)
    outward = sum(film * area for film, area in films)
    return mesh_heat / (outward + 1.0 / (1.0 / fins + disc))


@pytest.mark.parametrize(("gear", "bore", "width"), [("pinion", 0.04192, 0.007), ("wheel", 0.05754, 0.015)])
def test_mesh_loss_heats_the_gears(gear: str, bore: float, width: float) -> None:
    """Without the mesh loss each gear loses half of its 50 % share of it; the oil round it cools along."""
    base, zero = controlled()[1], without_mesh_loss()
    loss = next(row for row in base.last.losses if row.name == "test.main" and row.loss.kind == "mesh")
    rows = base.last.fields["test"].solution.balance.rows
    films = [
        (row.coefficient.value, row.area)
        for row in rows
        if row.surface.startswith(f"gear_test_{gear}_") and row.coefficient is not None
    ]
    oil = 0.5 * (
        base.last.coupling_state.oil_outlet["test.gear_oil"]
        - zero.last.coupling_state.oil_outlet["test.gear_oil"]
    )
    by_hand = oil + mean_to_sink(0.5 * 0.5 * loss.loss.power, bore, width, films)
    name = f"test.{gear}"
    moved = base.last.coupling_state.gear_temperature[name] - zero.last.coupling_state.gear_temperature[name]
    assert len(films) == 3
    assert moved == pytest.approx(by_hand, rel=0.15)
    assert moved > CLEAR * TEMPERATURE


@cache
def without_mesh_loss() -> PointResult:
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        rig = variant(
            Path(folder),
            '[losses.given.none]\ngearbox = "test"\nkind = "mesh"\npart = "main"\npower = "0 W"\n',
        )
    _, base = controlled()
    return solve_point(rig, base.point, start=base.last.coupling_state)


def test_one_friction_coefficient_for_torque_and_heat() -> None:
    """The mesh law and the loss hold the same number, mu / cos(beta_b) of the transverse section."""
    _, base = controlled()
    for model in base.last.models:
        loss = next(row for row in base.last.losses if row.name == model.name and row.loss.kind == "mesh")
        assert loss.loss.details["friction_coefficient"] == model.friction.value
        assert model.law.friction == ToothPath.of_pair(model.pair).transverse_friction(model.friction.value)


def test_friction_brakes_the_motor_as_much_as_it_heats(tmp_path: Path) -> None:
    """A coefficient of 0.08: sliding losses grow as mu, and the motor feels their growth, dT omega = dP."""
    rig, base = controlled()
    rough = variant(
        tmp_path,
        '[losses.friction]\nlaw = "constant"\ncoefficient = 0.08\n',
    )
    point = solve_point(rough, base.point, start=base.last.coupling_state)
    assert base.last.response is not None and point.last.response is not None
    for index, model in enumerate(base.last.models):
        ratio = point.last.response.friction_power[index] / base.last.response.friction_power[index]
        assert ratio == pytest.approx(0.08 / model.friction.value, rel=0.05)
    speed = rig.drive_speed(base.point.speed)
    lost = [math.fsum(row.loss.power for row in result.last.losses) for result in (base, point)]
    driven = point.last.response.drive_torque - base.last.response.drive_torque
    assert driven * speed == pytest.approx(lost[1] - lost[0], rel=0.01)
    assert driven > CLEAR * TORQUE * base.last.response.drive_torque


def test_iterations_converge_to_the_tolerances() -> None:
    """The first pass moves by more than 100 K, the last by less than the tolerance.

    Growth follows only once temperatures stand, which moves them once more: over five passes, such a step
    included, the change falls at least to a third.
    """
    for residuals in (controlled()[1].residuals, warm().residuals):
        first, last = residuals[0], residuals[-1]
        assert first.temperature > 100.0 and first.length > 10e-6 and first.torque > 0.01
        assert last.temperature <= TEMPERATURE
        assert last.length <= LENGTH
        assert last.torque <= TORQUE
        assert len(residuals) <= 20
        steps = [residual.temperature for residual in residuals]
        assert all(later < earlier / 3.0 for earlier, later in zip(steps, steps[5:]))


def test_too_few_iterations_show_their_residuals() -> None:
    rig = build_rig(shipped().with_value("numerics.coupling_passes", 1), "quick")
    with pytest.raises(
        NotConvergedError, match=r"did not converge in 1 iterations.*iteration 1: [\d.]+ K, [\d.]+ um"
    ) as caught:
        solve_point(rig, held_points(rig)[-1])
    assert caught.value.exit_code == 3
    assert "numerics.coupling_passes" in str(caught.value)


@cache
def on_roller_bearings() -> tuple[Rig, PointResult]:
    """The FZG rig: roller bearings that conduct to shaft and housing."""
    rig = build_rig(load_case("cases/fzg"), "quick")
    return rig, solve_point(rig, held_points(rig)[-1])


def test_seat_temperature_cools_a_rolling_bearing() -> None:
    """T = (P + G_s T_s + G_h T_h + C T_oil)/(G_s + G_h + C): seats left at room temperature take more heat away."""
    rig, whole = on_roller_bearings()
    frozen = frozenset({"seat_temperature"})
    without = solve_point(rig, whole.point, freeze=frozen, start=whole.last.coupling_state)
    name = "test.pinion_front"
    found = []
    for result in (whole, without):
        state, bearing = result.last.coupling_state, result.last.bearings[name]
        assert isinstance(bearing, RollingState)
        shaft, housing = (state.seat_temperature[f"{name}.{seat}"] for seat in ("shaft", "housing"))
        conductances = bearing.shaft_conductance, bearing.housing_conductance, bearing.capacity_rate
        carried = math.fsum(
            g * t for g, t in zip(conductances, (shaft, housing, state.oil_outlet["test.gear_oil"]))
        )
        by_hand = (bearing.power + carried) / math.fsum(conductances)
        assert bearing.film_temperature == pytest.approx(by_hand, abs=TEMPERATURE)
        found.append(bearing.film_temperature)
    assert found[0] - found[1] > CLEAR * TEMPERATURE


def test_oil_supply_feeds_what_the_heater_can_hold(tmp_path: Path) -> None:
    """A heater that is 1.4 kW short: supply and outlet of the warm oil stay together, far below the setpoint."""
    rig = build_rig(load_case(plant_case(tmp_path)), "quick")
    whole = solve_point(rig, held_points(rig)[-1])
    state = whole.last.coupling_state
    without = solve_point(rig, whole.point, freeze=frozenset({"oil_supply"}), start=state)
    stream, fed = (
        next(s for s in result.last.streams if s.name == "test.gear_oil") for result in (whole, without)
    )
    assert fed.inlet == pytest.approx(413.15)
    assert fed.inlet - stream.inlet > CLEAR * TEMPERATURE
    moved = (fed.outlet - stream.outlet) / (fed.inlet - stream.inlet)
    assert 0.5 < moved < 1.0


def test_unknown_arrow_is_refused() -> None:
    point = held_points(held_rig())[-1]
    cold = initial_state(held_rig(), point)
    with pytest.raises(KeyError, match="no such arrow: wall_haet"):
        cold.freeze(frozenset({"wall_haet"}), cold)


def test_all_heat_goes_to_cooler_or_room() -> None:
    """Losses + heaters = cooler + room, but for the heats of the last pass that its oil has not seen.

    Every field balances, so what is left is the difference between the heat a pass used and the heat it found:
    at most rho c Q times the temperature residual for a stream, twice that for a film (T = T_in + H / 2 rho c Q).
    """
    rig, base = controlled()
    balance = stage_balance(rig, base.last).cooling
    streams = math.fsum(heat_capacity_flow(s.name.split(".")[1], s.flow) for s in base.last.streams[:2])
    films = 4.0 * heat_capacity_flow("bearing_oil", rig.case.gearboxes["test"].bearing_oil.flow)
    bound = base.residuals[-1].temperature * (streams + 2.0 * films)
    assert abs(balance.imbalance) <= bound
    assert bound < 3e-3 * balance.losses


def test_motor_pays_all_losses() -> None:
    """Drive power less losses is what splines, couplings and shafts damp: positive and small."""
    rig, base = controlled()
    assert base.last.response is not None
    power = base.last.response.drive_torque * rig.drive_speed(base.point.speed)
    lost = math.fsum(row.loss.power for row in base.last.losses)
    assert 0.0 <= power - lost < 0.03 * power


@cache
def elastic() -> tuple[Rig, PointResult]:
    """The held loop on shafts that bend, journals with 160 um of clearance."""
    case = held_rig().case.with_value("gearboxes.*.bearings.*.diametral_clearance", "160 um")
    rig = replace(build_rig(case, "quick"), shaft_model="elastic")
    return rig, solve_point(rig, held_points(rig)[-1])


def loaded(
    rig: Rig, result: PointResult, **changed: dict[str, float]
) -> tuple[CurvePoint, tuple[MeshModel, ...]]:
    """Response of the held loop at its warm state with some of its fields changed, and its meshes."""
    last = result.last
    state = replace(last.coupling_state, **changed)
    models = mesh_models(rig, result.point, state)
    assert result.setting is not None and last.system is not None
    return respond(rig, LoadedCircuit(result.point, models, last.drags, result.setting, last.system)), models


def test_flank_approach_winds_up_a_held_loop() -> None:
    """Journals that bring the flanks of the test mesh together by s turn the loop by s / r_b against its stiffness."""
    rig, result = elastic()
    known = result.last.coupling_state.flank_approach
    moved = known | {"test.main": known["test.main"] + 10e-6}
    change = loaded(rig, result, flank_approach=moved)[0].mean[0] - loaded(rig, result)[0].mean[0]
    stiffness = bracing_drift(rig, result).warm.loop_stiffness
    assert change == pytest.approx(stiffness * 10e-6 / rig.pairs["test.main"].base_radii[0], rel=0.03)


def test_centre_distance_is_that_of_the_journals_on_rigid_shafts() -> None:
    """Shafts a thousand times as stiff carry the middle of the journals to the gears: by the lever rule.

    All of the way along the centre line goes into the centre distance; as shipped, bending adds to it.
    """
    rig, result = elastic()
    last = result.last
    shafts = tuple(replace(s, shear_modulus=1e3 * s.shear_modulus) for s in rig.drivetrain.shafts)
    stiff = replace(rig, parts=RigParts(drivetrain=replace(rig.drivetrain, shafts=shafts)))
    bent = mesh_placements(rig, result.point, last.coupling_state, last.bearings)["test.main"]
    found = mesh_placements(stiff, result.point, last.coupling_state, last.bearings)["test.main"]
    places = bearing_coefficients(rig, last.coupling_state, last.bearings)
    parts = {part.name: part.position for part in (*rig.drivetrain.gears, *rig.drivetrain.bearings)}
    centre = {}
    for gear in ("pinion", "wheel"):
        front, rear = f"test.{gear}_front", f"test.{gear}_rear"
        share = (parts[f"test.{gear}"] - parts[front]) / (parts[rear] - parts[front])
        centre[gear] = (1.0 - share) * places[front].position + share * places[rear].position
    by_hand = float(centre["wheel"][0] - centre["pinion"][0])
    assert by_hand > CLEAR * LENGTH
    assert found.apart == pytest.approx(by_hand, rel=0.01)
    assert bent.apart > found.apart + CLEAR * LENGTH
    warm_housing = float(last.expansion["test"].centre_distance["test.main"])
    assert last.coupling_state.centre_distance["test.main"] - warm_housing == pytest.approx(
        bent.apart, abs=LENGTH
    )


def test_axis_tilt_opens_the_flanks_over_the_face() -> None:
    """Axes out of parallel by an angle open the gap by it times sin or cos of the pressure angle over the width."""
    rig, result = elastic()
    pair = result.last.models[0].pair
    tilt = dict.fromkeys(result.last.coupling_state.axis_tilt, 0.0)
    for angle, weight in (("inclination", math.sin), ("skew", math.cos)):
        models = [
            loaded(rig, result, axis_tilt=tilt | {f"test.main.{angle}": size})[1][0] for size in (0.0, 400e-6)
        ]
        opened = models[1].law.gap - models[0].law.gap
        middle = opened[:, opened.shape[1] // 2]
        slices = len(models[0].law.slice_shift)
        by_hand = 400e-6 * weight(pair.working_pressure_angle) * pair.face_width * (1.0 - 1.0 / slices)
        assert abs(middle[-1] - middle[0]) == pytest.approx(by_hand, rel=0.02)


def test_coupling_offset_of_the_warm_housing_loads_the_bearings() -> None:
    """Both bearings of a shaft carry the force of the coupling: its radial stiffness times the offset, less what the
    shafts give way."""
    rig, result = elastic()
    state = result.last.coupling_state
    (place,) = (one for one in coupling_places(rig) if one.name == "pinion_side")
    axes = {name: shape.deformed.axes for name, shape in result.last.expansion.items()}
    warm = coupled_ends(place, axes).offset
    offset = [state.coupling_offset[f"pinion_side.{way}"] for way in ("lateral", "vertical")]
    assert offset == pytest.approx(warm, abs=LENGTH)
    assert offset[1] > CLEAR * LENGTH
    without = bearing_loads(rig, replace(state, coupling_offset=dict.fromkeys(state.coupling_offset, 0.0)))
    loads = bearing_loads(rig, state)
    both = sum(loads[f"test.pinion_{end}"].force[1] - without[f"test.pinion_{end}"].force[1] for end in ENDS)
    assert rig.case.drivetrain is not None
    stiffness = rig.case.drivetrain.couplings["pinion_side"].radial_stiffness
    assert stiffness is not None
    # an axis that its housing lifts is drawn down by the coupling
    assert both == pytest.approx(-stiffness * offset[1], rel=0.05)


def test_coupling_angle_of_the_warm_housing_bends_the_shaft() -> None:
    """A couple on the shaft: its bearings take the moment over their distance, and no force in all."""
    rig, result = elastic()
    state = result.last.coupling_state
    turned = {
        key: value + 1e-3 * (key == "pinion_side.vertical") for key, value in state.coupling_angle.items()
    }
    loads, without = bearing_loads(rig, replace(state, coupling_angle=turned)), bearing_loads(rig, state)
    change = [loads[f"test.pinion_{end}"].force[1] - without[f"test.pinion_{end}"].force[1] for end in ENDS]
    assert rig.case.drivetrain is not None
    coupling = rig.case.drivetrain.couplings["pinion_side"]
    bearings = rig.case.gearboxes["test"].bearings
    front, rear = (bearings[f"pinion_{end}"].position for end in ENDS)
    assert front is not None and rear is not None and coupling.angular_stiffness is not None
    assert abs(change[1] - change[0]) / 2.0 * (rear - front) == pytest.approx(
        1e-3 * coupling.angular_stiffness, rel=0.05
    )
    assert abs(sum(change)) < 0.05 * max(map(abs, change))
