"""Accelerations and shaft displacements by order: closed forms, the records of a check, and what they refuse."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from dynamics.rotor.bearing_state import RowSpring, RunningState, isotropic_bearing
from dynamics.rotor.damped_modes import Orbit, line_whirls, orbit, reduced_line_loads, whirl_at
from rigdesign.base.errors import UsageError
from rigdesign.coupling.loop import solve_point
from rigdesign.coupling.preloaded_loop import LoadedCircuit
from rigdesign.coupling.state import OperatingPoint
from rigdesign.postprocessing.vibration import lateral_vibration
from rigdesign.prediction.full import modelled_rig
from rigdesign.prediction.model import (
    OWN_MODEL,
    TORSIONAL,
    Channel,
    OperatingCondition,
    Quantity,
    measured_against,
)
from rigdesign.prediction.order_motion import Orders, shaft_orders
from rigdesign.prediction.predict import predict
from rigdesign.rig.model import Rig
from tests.builders.order import BracedCase, settled, shipped

RPM, TORQUE = 600.0, 200.0
SPEED = RPM * math.pi / 30.0
STIFF, SUPPORT, ACROSS = 1e8, 5e7, 0.7
UNBALANCE = 2e-3
SIDEWAYS = {"y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


def probe(
    name: str, quantity: Quantity, place: str, direction: tuple[float, float, float], **more: object
) -> Channel:
    return Channel(
        name=name,
        quantity=quantity,
        place=place,
        direction=direction,
        orders=(1.0,),
        **more,  # type: ignore[arg-type]
    )


def stated_bearings(supported: bool = False) -> dict[str, object]:
    """Every bearing a spring of one stiffness, under each a support if asked for."""
    values: dict[str, object] = {"drivetrain.bearing_coefficients": "stated", "drivetrain.balance_grade": 0.0}
    for name in shipped("loop_1to1").gearboxes:
        for bearing in shipped("loop_1to1").gearboxes[name].bearings:
            at = f"gearboxes.{name}.bearings.{bearing}."
            values[at + "radial_stiffness"] = f"{STIFF} N/m"
            if supported:
                values[at + "support_stiffness"] = f"{SUPPORT} N/m"
                values[at + "support_mass"] = "0.5 kg"
    return values


@cache
def unbalanced(supported: bool) -> BracedCase:
    """2 kg mm on a pinion shaft, in the plane of the front one of its two bearings; no coupling bends it."""
    plane = {"position": "0 mm", "unbalance": f"{UNBALANCE} kg m", "angle": f"{ACROSS} rad"}
    values = stated_bearings(supported) | {"drivetrain.shafts.test_pinion.unbalances": {"plane": plane}}
    for coupling in ("pinion_side", "wheel_side"):
        values[f"drivetrain.couplings.{coupling}.radial_stiffness"] = None
        values[f"drivetrain.couplings.{coupling}.angular_stiffness"] = None
    return settled(shipped("loop_1to1").with_values(values), RPM, TORQUE, "elastic")


def read_of(braced: BracedCase, channels: Sequence[Channel]) -> Orders:
    rig, loop = braced.arguments
    return shaft_orders(rig, loop, channels)


def free_direction(braced: BracedCase) -> tuple[float, float, float]:
    """Across the line of action of the test mesh, along which no tooth force acts."""
    row = braced.rig.elastic.port_rows[braced.models[0].name]
    radii = braced.models[0].pair.base_radii
    approach = radii[0] * row[0] - radii[1] * row[1]
    place = braced.rig.elastic.model.freedoms.on_shaft("test_pinion", 0.07)
    along = approach[place.base + 1 : place.base + 3]
    y, z = np.array([-along[1], along[0]]) / np.linalg.norm(along)
    return (0.0, float(y), float(z))


def test_unbalance_over_a_bearing_is_force_over_stiffness() -> None:
    """A shaft on two bearings is statically determinate: a force over one of them moves that one alone, by F / k, and
    across the line of action no tooth holds it. At 10 Hz, far below all modes: 1 %. The phase is that of the angle from
    +y in the sense of rotation."""
    braced = unbalanced(supported=False)
    direction = free_direction(braced)
    read = read_of(
        braced,
        [
            probe("front", "shaft_displacement", "test.pinion_front", direction),
            probe("rear", "shaft_displacement", "test.pinion_rear", direction),
            probe("on the shaft", "shaft_displacement", "test_pinion", direction, position=0.0),
            probe("acceleration", "acceleration", "test.pinion_front", direction),
        ],
    )
    sense = braced.rig.axes["test_pinion"].sense
    force = UNBALANCE * SPEED**2 * np.exp(1j * ACROSS)
    expected = (direction[1] - 1j * sense * direction[2]) * force / STIFF
    assert read["front", 1.0] == pytest.approx(expected, rel=0.01)
    assert abs(read["rear", 1.0]) < 0.01 * abs(expected)
    assert read["on the shaft", 1.0] == pytest.approx(read["front", 1.0], rel=1e-9)
    # without a support under the bearing it is the shaft that is read
    assert read["acceleration", 1.0] == pytest.approx(-(SPEED**2) * read["front", 1.0], rel=1e-9)


def test_accelerometer_sits_on_the_support_and_the_probe_in_it() -> None:
    braced = unbalanced(supported=True)
    direction = free_direction(braced)
    read = read_of(
        braced,
        [
            probe("probe", "shaft_displacement", "test.pinion_front", direction),
            probe("shaft", "shaft_displacement", "test_pinion", direction, position=0.0),
            probe("housing", "acceleration", "test.pinion_front", direction),
        ],
    )
    sense = braced.rig.axes["test_pinion"].sense
    force = (direction[1] - 1j * sense * direction[2]) * UNBALANCE * SPEED**2 * np.exp(1j * ACROSS)
    assert read["probe", 1.0] == pytest.approx(force / STIFF, rel=0.01)
    assert read["housing", 1.0] == pytest.approx(-(SPEED**2) * force / SUPPORT, rel=0.01)
    assert read["shaft", 1.0] == pytest.approx(force * (1.0 / STIFF + 1.0 / SUPPORT), rel=0.01)
    with pytest.raises(UsageError, match="stands still along"):
        read_of(braced, [probe("x", "acceleration", "test.pinion_front", (1.0, 0.0, 0.0))])


def orbits(braced: tuple[Rig, LoadedCircuit], bearings: Iterable[str]) -> dict[str, Orbit]:
    """Orbits at order 1 from probes along y and z."""
    rig, loop = braced
    channels = [
        probe(f"{bearing} {axis}", "shaft_displacement", bearing, direction)
        for bearing in bearings
        for axis, direction in SIDEWAYS.items()
    ]
    read = shaft_orders(rig, loop, channels)
    return {
        name: orbit(read[f"{name} y", 1.0], read[f"{name} z", 1.0], rig.axes[rig.bearing(name).shaft].sense)
        for name in bearings
    }


def test_orbit_is_that_of_the_whirl_with_springs_for_teeth() -> None:
    """The lateral records take the teeth for springs of their mean stiffness; off resonance 1 %."""
    braced = unbalanced(supported=False)
    rig = braced.rig
    springs = []
    for one in braced.models:
        pinion, wheel = rig.elastic.port_rows[one.name]
        row = one.pair.base_radii[0] * pinion - one.pair.base_radii[1] * wheel
        springs.append(RowSpring(row=row, stiffness=one.whole.mean_stiffness, damping=one.whole.damping))
    state = RunningState(
        speed=rig.drive_speed(SPEED),
        bearings={name: isotropic_bearing(STIFF) for name, _, _ in rig.bearings()},
        springs=tuple(springs),
    )
    whirls = line_whirls(rig.elastic.slow, state, reduced_line_loads(rig.elastic.slow))
    found = orbits(braced.arguments, ("test.pinion_front", "test.pinion_rear"))
    for name, own in found.items():
        (known,) = whirl_at(whirls, rig.elastic.slow.ports[name][:2], rig.axes["test_pinion"].sense).values()
        assert own.major == pytest.approx(known.major, rel=0.01)
        assert own.minor == pytest.approx(known.minor, rel=0.01, abs=0.01 * known.major)


@pytest.mark.slow
def test_orbit_is_that_of_the_records_of_a_check() -> None:
    """Journals in films, the whole record of a held stage: 2 %."""
    disc = {"position": "400 mm", "unbalance": "300 g mm"}
    case = shipped("loop_1to1").with_values(
        {"drivetrain.balance_grade": 0.0, "drivetrain.shafts.test_wheel.unbalances": {"disc": disc}}
    )
    rig = modelled_rig(case, "quick", OWN_MODEL)
    result = solve_point(rig, OperatingPoint(stage="held", speed=1500.0 * math.pi / 30.0, torque=TORQUE))
    record = lateral_vibration(rig, [result])
    assert record is not None
    (stage,) = record.of("held")
    found = orbits((rig, result.last.loop), ("test.wheel_front", "test.wheel_rear"))
    known = {whirl.bearing: whirl for whirl in stage.bearings}
    for name, own in found.items():
        assert own.major == pytest.approx(known[name].amplitude, rel=0.02)
        assert own.minor == pytest.approx(known[name].minor, rel=0.02, abs=0.02 * own.major)


def test_shafts_that_only_twist_have_no_lateral_motion() -> None:
    point = OperatingCondition(name="P", speed=SPEED, torque=TORQUE)
    channel = probe("a_front", "acceleration", "test.pinion_front", SIDEWAYS["y"])
    with pytest.raises(UsageError, match=r"'a_front': acceleration needs shafts that bend.*shaft_model"):
        predict(shipped("loop_1to1"), [point], [channel], circuit=TORSIONAL)
    assert measured_against([channel]) == OWN_MODEL
    torque = Channel(name="M", quantity="torque", place="wheel_side", orders=(1.0,))
    assert measured_against([torque]) == OWN_MODEL


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"direction": None}, "no direction"),
        ({"place": "test.nose"}, "'test.nose' is no bearing; there are test.pinion_front"),
        ({"quantity": "shaft_displacement", "place": "axle"}, "neither a bearing .* nor a shaft"),
        ({"quantity": "shaft_displacement", "place": "test_pinion"}, "no position on shaft .* 0 to 210 mm"),
        (
            {"quantity": "shaft_displacement", "place": "test_pinion", "position": 0.3},
            "position = 300 mm on shaft",
        ),
    ],
)
def test_places_that_cannot_be_read(wrong: dict[str, object], said: str) -> None:
    good = probe("a", "acceleration", "test.pinion_front", SIDEWAYS["z"])
    with pytest.raises(UsageError, match=said):
        read_of(unbalanced(supported=False), [replace(good, **wrong)])  # type: ignore[arg-type]
