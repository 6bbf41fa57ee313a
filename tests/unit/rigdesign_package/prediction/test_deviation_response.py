"""Linear answer of the loop to unequal teeth: its parts beside differences, symmetries and limits."""

import numpy as np
import pytest

from dynamics.tooth.mesh_force import evaluate_mesh, pack_meshes
from dynamics.vibration.deviation_response import DeviationResponse, OrderTorque, _Mixing
from dynamics.vibration.hill_system import Motion, excitation, pair_sensitivity, tooth_pattern
from rigdesign.base.errors import UsageError
from rigdesign.prediction.model import Channel
from rigdesign.prediction.order_motion import ExactMotion, PointOrders, ideal_response, shaft_orders
from rigdesign.prediction.static_tests import standing_modes, standing_value
from tests.builders.order import changed, channels, settled
from tests.builders.undamped_shafts import undamped_shafts

PINION = "gearboxes__test__gears__pinion__flank__"
WHEEL = "gearboxes__test__gears__wheel__flank__"


@pytest.fixture(scope="module")
def healthy():
    case = settled(changed("loop_1to1"), 1500.0, 200.0)
    return case, ideal_response(*case.arguments)


def linear(torque=200.0, rpm=1500.0, orders=(1.0, 2.0, 27.0, 28.0, 29.0), steps=0, **values):
    case = settled(changed("loop_1to1", **values), rpm, torque)
    return shaft_orders(*case.arguments, channels(*orders), steps=steps)


@pytest.mark.parametrize("mesh", [0, 1])
def test_sensitivities_are_slopes_of_the_mesh_torques(healthy, mesh):
    case, base = healthy
    law = case.models[mesh].law
    wave = base.wave
    motion = Motion(wave.angle[mesh], wave.approach[mesh], wave.omega_1[mesh], wave.omega_2[mesh])
    sign = 1.0 if base.flank[mesh] > 0.0 else -1.0
    found = pair_sensitivity(law, pack_meshes([law]), motion, back=sign < 0.0)
    assert pair_sensitivity(law, pack_meshes([law]), motion, back=sign > 0.0) is None
    assert found is not None
    # all gaps wider by the same is an approach that much shorter
    uniform = np.array(
        [np.asarray(part.sum(axis=1)).reshape(found.pairs, -1).sum(axis=0) for part in found.gap]
    )
    reaction = evaluate_mesh(law, *motion)
    scale = np.abs(reaction.torque_1_per_approach).max()
    assert uniform[0] == pytest.approx(-sign * reaction.torque_1_per_approach, abs=2e-3 * scale)
    assert uniform[1] == pytest.approx(-sign * reaction.torque_2_per_approach, abs=2e-3 * scale)
    # unequal teeth: a small deviation and a small change of stiffness of every tooth
    rng = np.random.default_rng(4)
    shape = np.linspace(-1.0, 1.0, law.stiffness.shape[1])
    deviation = rng.normal(size=(28, 1)) * 1e-10 + rng.normal(size=(28, 1)) * 1e-10 * shape
    softer = 1.0 + 1e-6 * rng.normal(size=28)
    other = rng.normal(size=(28, 1)) * 1e-10 * shape
    front, back = (deviation, other) if sign > 0.0 else (other, deviation)
    whole = law._replace(deviation_2=front, back_deviation_2=back, scale_2=softer / softer.mean())
    pattern = tooth_pattern(deviation, softer, 28, np.arange(28))
    first = law.tooth_offset_2 + (sign < 0.0)
    linear_part = excitation(found, law, pattern, first).sum(axis=1).real
    mean = law._replace(
        gap=law.gap + deviation.mean(axis=0), deviation_2=0.0 * deviation, scale_2=1.0 + 0.0 * softer,
        scale_1=np.array([1.0]), deviation_1=np.full_like(law.deviation_1, 1e-30),
    )  # fmt: skip
    before, after = evaluate_mesh(mean, *motion), evaluate_mesh(whole, *motion)
    for output in range(2):
        difference = after[output] - before[output]
        assert linear_part[output] == pytest.approx(difference, abs=1e-2 * np.abs(difference).max())


def test_alike_teeth_have_mesh_orders_only(healthy):
    case, base = healthy
    found = shaft_orders(*case.arguments, channels(0.0, 1.0, 27.5, 28.0, 56.0), base=base)
    for name in ("wheel side", "pinion side"):
        assert found[name, 1.0] == found[name, 27.5] == 0.0
        assert abs(found[name, 28.0]) > 0.1 > 0.0
    assert found["turn", 0.0] == 0.0
    # pinion line and wheel line carry the torque in opposite sense
    assert found["wheel side", 0.0].real == pytest.approx(200.0, rel=0.01)
    assert found["pinion side", 0.0].real == pytest.approx(-200.0, rel=0.01)


def test_first_order_is_linear_and_turns_with_the_phase():
    one = linear(**{PINION + "run_out": "4 um"})
    twice = linear(**{PINION + "run_out": "8 um"})
    turned = linear(**{PINION + "run_out": "4 um", PINION + "run_out_phase": "0.7 rad"})
    for name in ("wheel side", "pinion side", "turn"):
        for order in (1.0, 27.0, 29.0):
            assert twice[name, order] == pytest.approx(2.0 * one[name, order], rel=1e-6)
        assert turned[name, 1.0] == pytest.approx(one[name, 1.0] * np.exp(-0.7j), rel=2e-3)
        assert one[name, 2.0] == pytest.approx(0.0, abs=1e-9 * abs(one[name, 1.0]))


def test_run_out_of_a_pair_cancels_where_both_lead_together():
    """1:1: teeth of pinion and wheel that stand out at the same time add, half a turn apart they cancel."""
    alone = linear(**{PINION + "run_out": "10 um"})["wheel side", 1.0]
    both = {PINION + "run_out": "10 um", WHEEL + "run_out": "10 um"}
    add = linear(**both)["wheel side", 1.0]
    cancel = linear(**both, **{WHEEL + "run_out_phase": "180 deg"})["wheel side", 1.0]
    assert abs(add) == pytest.approx(2.0 * abs(alone), rel=0.02)
    assert abs(cancel) < 0.02 * abs(alone)


def test_corrections_vanish_with_the_deviation():
    for size, limit in ((0.002, 2e-4), (2.0, 2e-2)):
        value = {PINION + "single_pitch": [f"{size * (-1) ** tooth} um" for tooth in range(28)]}
        first, whole = (linear(orders=(14.0, 42.0), steps=steps, **value) for steps in (0, 30))
        assert abs(first["wheel side", 14.0] - whole["wheel side", 14.0]) < limit * abs(
            first["wheel side", 14.0]
        )


def test_counting_at_the_wheel_counts_its_turns():
    """Shafts without damping of their own, which a case states at the mesh frequency of what counts."""
    value = {PINION + "run_out": "10 um"} | undamped_shafts(changed("loop_hunting"))
    pinion = settled(changed("loop_hunting", **value), 1000.0, 150.0)
    ratio = 16.0 / 25.0
    wheel = settled(
        changed("loop_hunting", **value, drivetrain__torque_at="test.wheel"), 640.0, 150.0 / ratio
    )
    at_pinion = shaft_orders(*pinion.arguments, channels(0.0, 1.0, 16.0))
    at_wheel = shaft_orders(*wheel.arguments, channels(0.0, 1.0 / ratio, 25.0))
    for own, other in ((0.0, 0.0), (1.0, 1.0 / ratio), (16.0, 25.0)):
        for name in ("wheel side", "pinion side"):
            assert at_wheel[name, other] == pytest.approx(at_pinion[name, own], rel=1e-4)


def test_a_harmonic_torque_stirs_its_own_class_of_orders(healthy):
    case, base = healthy
    system = case.rig.system
    response = DeviationResponse(system, [m.law for m in case.models], base, twist_held=True)
    dof = int(response.loop.bodies[0])
    row = np.zeros(len(system.dofs))
    row[dof] = 1.0
    torque = OrderTorque(load=row, order=2.0, amplitude=2.0 + 1.0j)
    own, side, mirrored, foreign = response.loads([2.0, 30.0, 26.0, 3.0], [torque])
    assert (
        np.abs(own.torque).max() > 10.0 * max(np.abs(side.torque).max(), np.abs(mirrored.torque).max()) > 0.0
    )
    assert not np.any(foreign.torque)
    [twice] = response.loads([30.0], [OrderTorque(load=2.0 * row, order=2.0, amplitude=torque.amplitude)])
    assert twice.torque == pytest.approx(2.0 * side.torque, rel=1e-9)


def test_one_point_answers_many_channels_alike(healthy):
    case, base = healthy
    point = PointOrders(*case.arguments, base=base)
    together = shaft_orders(*case.arguments, channels(0.0, 28.0), base=base)
    for channel in channels(0.0, 28.0):
        for order, value in point.read(channel).items():
            assert together[channel.name, order] == pytest.approx(value, rel=1e-12)


def test_impossible_channels_are_refused(healthy):
    case, base = healthy

    def read(**entries):
        shaft_orders(*case.arguments, [Channel(name="x", **entries)], base=base)

    with pytest.raises(UsageError, match="no coupling; there are"):
        read(quantity="torque", place="clutch", orders=(1.0,))
    with pytest.raises(UsageError, match="no shaft; there are"):
        read(quantity="angle", place="clutch", orders=(1.0,))
    with pytest.raises(ValueError, match="must not be negative"):
        read(quantity="torque", place="wheel_side", orders=(-1.0,))
    with pytest.raises(ValueError, match="ask for less"):
        read(quantity="torque", place="wheel_side", orders=(28.0 * 70,))
    assert shaft_orders(*case.arguments, [Channel(name="p", quantity="motor_power")], base=base) == {}


def test_deviations_do_not_move_the_braced_torque():
    sound = settled(changed("loop_1to1"), 1500.0, 100.0).setting
    uneven = {PINION + "run_out": "60 um", WHEEL + "single_pitch": [f"{9 * (-1) ** t} um" for t in range(28)]}
    assert settled(changed("loop_1to1", **uneven), 1500.0, 100.0).setting.twist == pytest.approx(
        sound.twist, rel=1e-9
    )


def test_rig_at_rest():
    case = settled(changed("loop_1to1"), 1500.0, 200.0)
    rig = case.rig
    modes = [mode.frequency for mode in standing_modes(rig)]
    assert modes == sorted(modes) and modes[0] > 100.0

    def value(quantity, place, of=rig):
        return standing_value(of, Channel(name="x", quantity=quantity, place=place))

    assert value("natural_frequency", "2") == modes[1]
    assert value("backlash", "test.main") == rig.pairs["test.main"].transverse_backlash > 0.0
    stiff = changed("loop_1to1", drivetrain__couplings__wheel_side__torsional_stiffness="3e6 N m/rad")
    stiffer = settled(stiff, 1500.0, 200.0).rig
    assert value("natural_frequency", "3", stiffer) > 1.01 * modes[2]
    for quantity, place in (("natural_frequency", "0"), ("natural_frequency", "99"), ("backlash", "x.y")):
        with pytest.raises(UsageError):
            value(quantity, place)
    with pytest.raises(UsageError, match="not measured on the rig at rest"):
        value("torque", "wheel_side")
    assert set(case.drags) <= set(rig.system.drag_loads)


def test_loads_of_a_motion_are_its_fourier_series():
    """5 + 3 cos(2 phi + 0.3) N m over two turns: a mean, one order, nothing at the others and between them."""
    phi = 0.4 + np.linspace(0.0, 4.0 * np.pi, 64, endpoint=False)
    torque = 5.0 + 3.0 * np.cos(2.0 * phi + 0.3)
    motion = ExactMotion(
        speed=100.0, turns=2.0, phi=phi, dofs=np.array([7]), size=9, torque=torque[None], twist=0.0, drive=0.0
    )
    expected = {0.0: 5.0, 0.5: 0.0, 1.9: 0.0, 2.0: 3.0 * np.exp(0.3j), 3.0: 0.0}
    for order, value in expected.items():
        loads = motion.loads(order)
        assert loads.omega == order * 100.0
        assert loads.torque[7] == pytest.approx(value, abs=1e-12)
        assert not np.any(np.delete(loads.torque, 7))


def test_mixing_solves_a_linear_iteration_in_one_step_more_than_it_has_unknowns():
    """x = A x + b, whose plain steps run away: the answers of n + 1 motions hold the solution."""
    n = 4
    rng = np.random.default_rng(2)
    matrix = np.diag([-2.0, 0.5, 1.5, -0.3]) + 0.1 * rng.normal(size=(n, n))
    right = rng.normal(size=n)
    solution = np.linalg.solve(np.eye(n) - matrix, right)
    mixing, motion = _Mixing(), np.zeros((1, n))
    for _ in range(n + 1):
        motion = mixing.next(motion, motion @ matrix.T + right)
    assert motion[0] == pytest.approx(solution, rel=1e-6)
