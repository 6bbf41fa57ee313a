"""Responses that start next to the base point and share what it knows are those found from the beginning."""

from functools import partial

import numpy as np
import pytest

from dynamics.rotor import linear_system
from dynamics.rotor.linear_system import modal_form
from rigdesign.case.loader import load_case
from rigdesign.coupling import preloaded_loop as braced_loop
from rigdesign.diagnosis.catalogue import effects_of
from rigdesign.prediction import OWN_MODEL, Channel, OperatingCondition, memoisation
from rigdesign.prediction.order_motion import ideal_response, is_ideal
from rigdesign.prediction.predict import OscillatingPart, Predictor
from tests.builders.paths import CASES

CLOSE = 1e-4
"""Difference of two answers over the largest answer of a channel and order."""
NOISE = 1e-6
"""Share of the base of its channel below which an answer is rounding."""
SIZES = {
    "spline_stiffness": 0.4, "coupling_stiffness": -1.0, "mesh_stiffness": 0.4, "inertia": 1.0,
    "coupling_damping": 0.4, "bearing_loss": 0.4, "oil_viscosity": 0.4, "run_out": 0.01,
}  # fmt: skip
"""Share of the bound at which the first effect of a kind is run."""
RIGS = {
    "loop_1to1": (OperatingCondition(name="slow", speed=105.0, torque=350.0),),
    "loop_hunting": (OperatingCondition(name="slow", speed=105.0, torque=300.0),),
    "uhcf_prototype": (OperatingCondition(name="fast", speed=300.0, torque=150.0),),
}


def _channels(case):
    coupling, shaft = next(iter(case.drivetrain.couplings)), case.drivetrain.shafts
    first = next(iter(case.gearboxes))
    box, gear = case.drivetrain.torque_at.split(".")
    mesh = float(case.gearboxes[box].gears[gear].teeth)
    return (
        Channel(name="torque", quantity="torque", place=coupling, orders=(0.0, 1.0, mesh)),
        Channel(name="angle", quantity="angle", place=next(iter(shaft)), orders=(1.0, mesh)),
        Channel(name="oil", quantity="oil_outlet_temperature", place=f"{first}.gear_oil"),
        Channel(name="power", quantity="motor_power", place="motor"),
    )


def _answers(case, settings):
    """Effect -> change of the numbers, and their features and base."""
    predictor = Predictor(case, settings, _channels(case), circuit=OWN_MODEL)
    predictor.prepare()
    found = {}
    for kind, share in SIZES.items():
        effect = next((one for one in effects_of(case) if one.kind == kind), None)
        if effect is None:
            continue
        low, high = effect.parameters[0].bounds
        places = (share * high if share > 0.0 else -share * low, *[0.0] * (len(effect.parameters) - 1))
        run = predictor.oscillating if effect.oscillates else predictor.response
        found[effect.name] = run(effect.changes(case, places)) - predictor.base
    return predictor, found


def _from_the_beginning(patch):
    """No start, no linearised motion, no form of before; as exact."""
    respond, brace = memoisation.respond_at_any_speed, braced_loop.brace_initial
    exact = partial(braced_loop.SweepSettings, tolerance=braced_loop.NEAR_TOLERANCE)
    patch.setattr(braced_loop, "SweepSettings", exact)
    patch.setattr(memoisation, "respond_at_any_speed", lambda rig, circuit, near: respond(rig, circuit))
    patch.setattr(memoisation, "brace_initial", lambda *given: brace(*given[:5]))
    patch.setattr(linear_system, "known_modal_form", modal_form)
    patch.setattr(OscillatingPart, "_ideal_motion", _found_again)


def _found_again(part):
    rig, last = part._converged.problem.rig, part._converged.last
    return last.response if is_ideal(rig, last.loop) else ideal_response(rig, last.loop)


def _table(rig):
    """Effect -> largest difference of the two answers over the largest of a channel and order."""
    case, settings = load_case(CASES / rig), RIGS[rig]
    predictor, short = _answers(case, settings)
    with pytest.MonkeyPatch.context() as patch:
        _from_the_beginning(patch)
        _, long = _answers(case, settings)
    places, base = {}, {}
    for number, feature in enumerate(predictor.features):
        places.setdefault((feature.channel, feature.order), []).append(number)
        base[feature.channel] = max(base.get(feature.channel, 0.0), abs(predictor.base[number]))
    table = {}
    for name, wanted in long.items():
        sizes = {
            place: np.abs(wanted[rows]).max()
            for place, rows in places.items()
            if np.abs(wanted[rows]).max() > NOISE * base[place[0]]
        }
        if not sizes:
            continue
        table[name] = max(
            float(np.abs(short[name][places[place]] - wanted[places[place]]).max() / size)
            for place, size in sizes.items()
        )
        print(f"{rig:16s} {name:36s} {table[name]:.1e}")
    return table


@pytest.mark.parametrize(
    "rig",
    [
        "loop_1to1",
        pytest.param("loop_hunting", marks=pytest.mark.slow),
        pytest.param("uhcf_prototype", marks=pytest.mark.slow),
    ],
)
def test_short_cuts_answer_as_a_response_found_from_the_beginning(rig):
    table = _table(rig)
    assert len(table) >= 5
    assert max(table.values()) < CLOSE, table
