"""Heat of motor, drive, transmission gearbox and couplings, and the room that takes it."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from rigdesign.base.errors import CaseError
from rigdesign.rig_heat.component import (
    ROOM,
    ComponentHeat,
    CouplingRotor,
    EfficiencyLoss,
    HeatSplit,
    LossMap,
    Machine,
    Room,
    drive_train_heat,
    heat_by_sink,
    room_balance,
)

ZERO = 273.15
GRID = LossMap(
    speeds=np.array([0.0, 100.0, 300.0]),
    torques=np.array([0.0, 50.0]),
    losses=np.array([[0.0, 200.0], [100.0, 400.0], [500.0, 1000.0]]),
)


def test_efficiency_loses_of_its_output() -> None:
    assert EfficiencyLoss(efficiency=0.8).power(100.0, 40.0) == pytest.approx(1000.0)
    assert EfficiencyLoss(efficiency=0.8).power(-100.0, 40.0) == pytest.approx(1000.0)


def test_map_is_bilinear_and_exact_at_its_points() -> None:
    for row, speed in enumerate(GRID.speeds):
        for column, torque in enumerate(GRID.torques):
            assert GRID.power(speed, torque) == pytest.approx(GRID.losses[row, column])
    assert GRID.power(200.0, 25.0) == pytest.approx((100.0 + 400.0 + 500.0 + 1000.0) / 4.0)
    assert GRID.power(50.0, 10.0) == pytest.approx(0.8 * 50.0 + 0.2 * 300.0)


def test_map_from_columns_in_any_order() -> None:
    points = [(s, t, GRID.power(s, t)) for t in GRID.torques for s in reversed(GRID.speeds)]
    found = LossMap.from_columns(*zip(*points, strict=True))
    np.testing.assert_array_equal(found.losses, GRID.losses)
    with pytest.raises(CaseError, match="must occur once, occurs 0 times"):
        LossMap.from_columns(*zip(*points[:-1], strict=True))
    with pytest.raises(CaseError, match="must occur once, occurs 2 times"):
        LossMap.from_columns(*zip(*points, points[0], strict=True))


@pytest.mark.parametrize(
    ("build", "words"),
    [
        (lambda: EfficiencyLoss(efficiency=1.1), "efficiency = 1.1: must lie within 0 to 1"),
        (lambda: EfficiencyLoss(efficiency=0.0), "above 0"),
        (
            lambda: GRID.power(301.0, 10.0),
            "loss_map.speeds = 2874.34 rpm: must lie within the map, 0 rpm to 2864.79 rpm",
        ),
        (lambda: GRID.power(100.0, 60.0), "it is not extrapolated"),
        (
            lambda: LossMap(
                speeds=np.array([2.0, 1.0]), torques=np.array([0.0, 1.0]), losses=np.zeros((2, 2))
            ),
            "loss_map.speeds = 2 values: must rise",
        ),
        (
            lambda: LossMap(
                speeds=np.array([0.0, 1.0]), torques=np.array([0.0, 1.0]), losses=np.zeros((2, 3))
            ),
            "loss_map.losses = 2 x 3: must be 2 x 2",
        ),
        (
            lambda: LossMap(
                speeds=np.array([0.0, 1.0]), torques=np.array([0.0, 1.0]), losses=np.full((2, 2), -1.0)
            ),
            "must be finite and not negative",
        ),
        (lambda: LossMap.from_columns([1.0], [1.0, 2.0], [3.0]), "must be as many"),
        (lambda: HeatSplit(coolant_share=1.5), "coolant_share = 1.5"),
        (
            lambda: CouplingRotor(name="coupling", radius=0.05, length=0.02, hub_radius=0.06),
            "coupling.radius = 0.05 m",
        ),
        (lambda: drive_train_heat(0.0, 1.0, []), "drive.speed"),
        (lambda: Room(air_flow=0.0, supply_temperature=293.15), "give the heat a way out"),
    ],
)
def test_refuses_what_cannot_be(build: Callable[[], object], words: str) -> None:
    with pytest.raises(CaseError) as raised:
        build()
    assert words in str(raised.value)


def test_drive_train_adds_up_to_the_mains() -> None:
    """20 kW at 628 rad/s; gearbox 0.97 stepping up from 157 rad/s, motor by map, converter 0.97."""
    losses = LossMap(
        speeds=np.array([0.0, 200.0]),
        torques=np.array([0.0, 200.0]),
        losses=np.array([[0.0, 400.0], [600.0, 1800.0]]),
    )
    machines = (
        Machine(name="transmission", loss=EfficiencyLoss(efficiency=0.97), speed_ratio=0.25,
                split=HeatSplit(coolant="cold oil", coolant_share=0.9)),
        Machine(name="motor", loss=losses, split=HeatSplit(coolant="water", coolant_share=1.0)),
        Machine(name="converter", loss=EfficiencyLoss(efficiency=0.97)),
    )  # fmt: skip
    found = drive_train_heat(628.0, 20e3, machines)
    transmission, motor, converter = (each.power for each in found.components)
    after = 20e3 / 0.97
    assert transmission == pytest.approx(after - 20e3)
    assert motor == pytest.approx(losses.power(157.0, after / 157.0))
    assert found.input_power == pytest.approx((after + motor) / 0.97)
    assert found.input_power == pytest.approx(20e3 + transmission + motor + converter)
    sinks = heat_by_sink(found.components)
    assert sinks == pytest.approx(
        {ROOM: 0.1 * transmission + converter, "cold oil": 0.9 * transmission, "water": motor}
    )
    assert math.fsum(sinks.values()) == pytest.approx(found.input_power - 20e3)


def test_coupling_windage_by_hand() -> None:
    """R 80 mm, 50 mm long, 12,000 rpm, air of 20 degC (1.204 kg/m3, 18.2 uPa s): turbulent disc and cylinder.

    Re = 1.204 * 1256.6 * 0.08^2 / 18.2e-6 = 5.32e5; both faces C_M near 0.146 Re^-0.2 = 0.01045 less the laminar
    middle; the rim 1 / sqrt(C) = -0.6 + 4.07 lg(Re sqrt(C)) gives C = 0.0031.
    """
    found = CouplingRotor(name="test", radius=0.08, length=0.05).heat(12000 * math.pi / 30, ZERO + 20.0)
    speed, density = 12000 * math.pi / 30, 1.204
    reynolds = density * speed * 0.08**2 / 18.2e-6
    turbulent = 0.146 * reynolds**-0.2
    step = 0.146 * 3e5**-0.2 - 3.87 / math.sqrt(3e5)
    disc = 0.5 * density * speed**3 * 0.08**5 * (turbulent - step * (3e5 / reynolds) ** 2.5)
    drag = 0.003
    for _ in range(60):
        drag = (-0.6 + 4.07 * math.log10(reynolds * math.sqrt(drag))) ** -2
    rim = math.pi * drag * density * speed**3 * 0.08**4 * 0.05
    assert found.power == pytest.approx(disc + rim, rel=5e-3)
    assert 25.0 < found.power < 100.0


def test_windage_stands_at_rest_and_a_hub_takes_its_faces() -> None:
    whole = CouplingRotor(name="c", radius=0.08, length=0.05)
    assert whole.heat(0.0, 300.0).power == 0.0
    covered = CouplingRotor(name="c", radius=0.08, length=0.05, hub_radius=0.06)
    assert covered.heat(800.0, 300.0).power < whole.heat(800.0, 300.0).power


def test_room_by_hand() -> None:
    """4.264 kW, 1500 m3/h of 20 degC (1.204 kg/m3, 1006 J/(kg K)), walls 100 W/K to 10 degC."""
    room = Room(
        air_flow=1500.0 / 3600.0, supply_temperature=ZERO + 20.0, wall_conductance=100.0,
        outside_temperature=ZERO + 10.0, temperature_limit=ZERO + 30.0,
    )  # fmt: skip
    rate = 1.204 * 1006.0 * 1500.0 / 3600.0
    found = room_balance(room, {"housing": 3000.0, "motor": 1264.0})
    assert found.temperature - ZERO == pytest.approx(
        (4264.0 + rate * 20.0 + 1000.0) / (rate + 100.0), abs=0.01
    )
    assert found.by_air + found.by_walls == pytest.approx(found.heat, rel=1e-12)
    assert found.warnings == ()
    assert found.needed_air_flow is not None
    assert found.needed_air_flow == pytest.approx(2264.0 / (1.204 * 1006.0 * 10.0), rel=2e-3)


def test_needed_air_flow_holds_the_limit() -> None:
    given = {"air_flow": 0.1, "supply_temperature": ZERO + 20.0, "temperature_limit": ZERO + 35.0}
    hot = room_balance(Room(**given), {"rig": 6e3})  # type: ignore[arg-type]
    assert len(hot.warnings) == 1
    assert hot.warnings[0].startswith("room: temperature = 69.")
    assert "above 35 degC; ventilate with 11" in hot.warnings[0]
    better = room_balance(Room(**{**given, "air_flow": hot.needed_air_flow}), {"rig": 6e3})  # type: ignore[arg-type]
    assert better.temperature == pytest.approx(ZERO + 35.0)
    warm = Room(air_flow=1.0, supply_temperature=ZERO + 40.0, temperature_limit=ZERO + 35.0)
    assert "supply colder air than 40 degC" in room_balance(warm, {"rig": 1.0}).warnings[0]
    sealed = Room(air_flow=0.0, supply_temperature=ZERO, wall_conductance=50.0, temperature_limit=ZERO + 35.0)
    assert room_balance(sealed, {"rig": 100.0}).needed_air_flow == 0.0


def test_heat_without_a_coolant_goes_to_the_room() -> None:
    heat = ComponentHeat(name="belt", power=120.0, split=HeatSplit(), source="test")
    assert heat_by_sink([heat]) == {ROOM: 120.0}
