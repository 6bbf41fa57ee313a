"""Orders of torque and angle with shafts that bend: the limit of locked bending, other readings, other solvers."""

import numpy as np
import pytest

from dynamics.vibration.response_curve import section_torques
from rigdesign.base.errors import UsageError
from rigdesign.coupling.loop_system import twist_rows_of
from rigdesign.coupling.preloaded_loop import periodic_laws, respond, shifted_laws
from rigdesign.prediction.full import like
from rigdesign.prediction.model import Channel
from rigdesign.prediction.order_motion import shaft_orders
from rigdesign.prediction.static_tests import standing_modes, standing_value
from tests.builders.order import changed, channels, settled
from tests.builders.order_errors import order_errors

PINION = "gearboxes__test__gears__pinion__flank__"
WHEEL = "gearboxes__test__gears__wheel__flank__"
RUN_OUT = {PINION + "run_out": "20 um", WHEEL + "run_out": "20 um", WHEEL + "run_out_phase": "1 rad"}
TORQUES = {
    "drivetrain__motor__ripple": [{"order": 6.0, "torque": "1 N m", "phase": "0.4 rad"}],
    "drivetrain__couplings__pinion_side__excitation": [{"order": 2.0, "torque": "5 N m"}],
}
JUMPS = {PINION + "single_pitch": [f"{(-1) ** tooth * (tooth % 5)} um" for tooth in range(28)]}
WEAK = {PINION + "weak_tooth": {"tooth": 3, "stiffness": 0.8}}
NO_FRICTION = {f"gearboxes__{box}__loss_factors__mesh": 1e-6 for box in ("test", "reference")}
ORDERS = (0.0, 1.0, 2.0, 6.0, 27.0, 28.0, 29.0, 56.0)


def found(case, orders=ORDERS, **options):
    return shaft_orders(*case.arguments, channels(*orders), **options)


@pytest.mark.parametrize("rpm", [700.0, 2900.0])
def test_locked_bending_gives_the_orders_of_shafts_that_only_twist(rpm):
    case = changed("loop_1to1", **RUN_OUT, **TORQUES)
    twisting, locked = (found(settled(case, rpm, 200.0, shafts)) for shafts in ("torsional", "locked"))
    largest = {name: max(abs(v) for (own, _), v in twisting.items() if own == name) for name, _ in twisting}
    for (name, order), value in twisting.items():
        assert locked[name, order] == pytest.approx(value, rel=1e-6, abs=1e-9 * largest[name])


def test_locked_bending_gives_the_natural_frequencies_of_shafts_that_only_twist():
    case = changed("loop_1to1")
    twisting, locked = (settled(case, 2900.0, 200.0, shafts).rig for shafts in ("torsional", "locked"))
    known = {mode.name: mode.frequency for mode in standing_modes(twisting)}
    same = {mode.name: mode.frequency for mode in standing_modes(locked)}
    assert same.keys() == known.keys()
    assert [same[name] for name in known] == pytest.approx(list(known.values()), rel=1e-6)


@pytest.mark.parametrize(
    ("name", "rpm", "torque"), [("loop_1to1", 2900.0, 200.0), ("loop_hunting", 1800.0, 150.0)]
)
def test_mesh_orders_are_those_that_the_check_reads_of_its_periodic_response(name, rpm, torque):
    """Section torques go over time samples and the whole spectrum of the mesh torques, not over loads by order."""
    case = settled(changed(name), rpm, torque, "elastic")
    rig, loop = case.arguments
    response = respond(rig, loop)
    laws = periodic_laws(rig, shifted_laws(rig, loop.models, loop.bracing))
    rows = twist_rows_of(rig, loop.point.speed)
    torques = section_torques(loop.system, laws, rows).over_period(response, case.drags)
    teeth = laws[0].teeth_1
    read = found(case, (0.0, float(teeth), 2.0 * teeth))
    for i, section in enumerate(rows.sections):
        if section.kind != "coupling":
            continue
        spectrum = np.fft.rfft(torques[i]) / torques.shape[1]
        place = {"wheel_side": "wheel side", "pinion_side": "pinion side"}[section.part]
        scale = abs(spectrum[0])
        assert read[place, 0.0].real == pytest.approx(spectrum[0].real, abs=1e-3 * scale)
        for k in (1, 2):
            assert abs(read[place, float(k * teeth)]) == pytest.approx(
                2.0 * abs(spectrum[k]), rel=1e-3, abs=1e-5 * scale
            )


@pytest.mark.parametrize(
    ("values", "rpm", "shafts", "sides"),
    [
        (RUN_OUT, 1500.0, (1.0, 28.0), (27.0, 29.0)),
        (JUMPS, 2900.0, (1.0, 2.0, 3.0, 28.0), (27.0, 29.0)),
        (WEAK, 2900.0, (1.0, 2.0, 3.0, 28.0), (27.0, 29.0)),
    ],
)
def test_orders_are_those_of_the_harmonic_balance_over_the_hunting_cycle(values, rpm, shafts, sides):
    """What the check solves, with every tooth of its own; the linear response is a first guess of sidebands only."""
    first, corrected = order_errors(
        "loop_1to1", values, rpm, 200.0, (*shafts, *sides), march=False, shafts="elastic"
    )
    for order in shafts:
        assert corrected[order] < 5e-3
        assert first[order] < 0.2
    for order in sides:
        assert corrected[order] < 3e-2


def test_torques_of_motor_and_coupling_are_those_of_the_harmonic_balance():
    orders = (2.0, 6.0, 28.0)
    [first] = order_errors(
        "loop_1to1", TORQUES, 2500.0, 200.0, orders, march=False, steps=(0,), shafts="elastic"
    )
    assert max(first.values()) < 5e-3


def test_shaft_orders_are_those_of_the_march_in_time():
    """The march knows of no orders. Mesh orders are not held to it: it has the friction of the flanks push the shafts
    sideways, which the harmonic balance leaves out, here 28 % of the first mesh order."""
    orders = (1.0, 2.0, 3.0)
    _, corrected = order_errors("loop_1to1", JUMPS, 2900.0, 200.0, orders, march=True, shafts="elastic")
    assert max(corrected.values()) < 5e-3


def test_mesh_order_without_friction_is_nearly_that_of_the_march_in_time():
    _, corrected = order_errors(
        "loop_1to1", JUMPS | NO_FRICTION, 2900.0, 200.0, (1.0, 28.0), march=True, shafts="elastic"
    )
    assert corrected[1.0] < 5e-3
    assert corrected[28.0] < 5e-2


def test_modes_of_shafts_that_bend_keep_torsional_numbers_and_have_names():
    case = changed("loop_1to1")
    twisting, bending = (settled(case, 2900.0, 200.0, shafts).rig for shafts in ("torsional", "elastic"))
    known, modes = standing_modes(twisting), standing_modes(bending)
    names = [mode.name for mode in modes]
    assert len(set(names)) == len(names)
    assert [mode.frequency for mode in modes] == sorted(mode.frequency for mode in modes)
    torsional = [mode for mode in modes if mode.name.startswith("torsional ")]
    assert [mode.name for mode in torsional] == [mode.name for mode in known]
    for own, other in zip(torsional[:5], known):
        assert own.frequency == pytest.approx(other.frequency, rel=0.05)
        assert own.likeness > 0.8

    def value(place):
        return standing_value(bending, Channel(name="x", quantity="natural_frequency", place=place), modes)

    assert value("2") == value("torsional 2") == torsional[1].frequency
    # a bar of 26 mm and half a metre between the shafts of two gearboxes: below all torsional modes
    assert value("lateral test_wheel 1") < value("1")
    with pytest.raises(UsageError, match="other modes are lateral"):
        value("lateral test_wheel 999")


def test_a_changed_case_keeps_the_shafts_that_it_leaves_alone():
    rig = settled(changed("loop_1to1"), 2900.0, 200.0, "elastic").rig
    stiff = {"drivetrain__couplings__wheel_side__torsional_stiffness": "3e6 N m/rad"}
    assert like(rig, changed("loop_1to1", **RUN_OUT)).elastic is rig.elastic
    assert like(rig, changed("loop_1to1", **stiff)).elastic is not rig.elastic
