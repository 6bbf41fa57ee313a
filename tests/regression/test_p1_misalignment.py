"""P1's own fit of f_Hbeta = -10 um from the stress at its gauges, recovered from recordings in which it is hidden.

The recordings are made by the model of the shipped case, which has f_Hbeta = -10 um, with gauge factors off by 1 %,
gauges 0.2 mm off their places and noise; the case that they are held against has f_Hbeta = 0.

Slow: influence numbers and the library of the rig take some minutes. Run with
`python -m pytest -m slow tests/regression/test_p1_misalignment.py`.
"""

import numpy as np
import pytest

from rigdesign.case import load_case
from rigdesign.diagnosis.catalogue import effects_of
from rigdesign.diagnosis.decision.cross_validation import Problem
from rigdesign.diagnosis.decision.defaults import DEFAULT
from rigdesign.diagnosis.decision.naming import Names, from_evidence
from rigdesign.diagnosis.decision.workflow import diagnose
from rigdesign.diagnosis.library.build import build_library
from rigdesign.diagnosis.residual.residual_problem import compare
from rigdesign.diagnosis.run import mesh_orders, stated_settings, teeth_a_turn
from rigdesign.measurement import features, load_measurement
from rigdesign.rig.model import build_rig
from tests.builders.root_gauges import (
    CASE,
    GAUGES,
    Chain,
    conditions,
    curves,
    without_misalignment,
    write_recordings,
)

POINTS = tuple((100.0, torque) for torque in (100.0, 140.0, 189.0, 240.0, 336.0, 483.0))
"""The torques of P1's contact patterns and of its stresses and some between, quasi-static."""
PLACE = "gearboxes.test.gears.pinion.strain_gauges"
TRUE = 10e-6
"""Of the pinion as the case counts it, positive where the rear end is relieved; P1 writes -10 um [m]."""
NAME = "misalignment:test.main"

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def diagnosed(tmp_path_factory):
    rng = np.random.default_rng(21)
    scale = {name: 1.0 + 0.01 * rng.standard_normal() for name in GAUGES}
    stated = load_case(CASE)
    gauges = stated.gearboxes["test"].gears["pinion"].strain_gauges
    moved = {
        f"{PLACE}.{name}.face_position": f"{1e3 * gauges[name].face_position + 0.2 * rng.standard_normal():.4f} mm"
        for name in GAUGES
    }
    points = conditions(POINTS)
    strains = curves(stated.with_values(moved), points)
    case = without_misalignment()
    folder = write_recordings(
        tmp_path_factory.mktemp("recordings"), build_rig(case, "quick"), points, strains, Chain(scale=scale)
    )
    measurement = load_measurement(folder, case)
    data = features(measurement)
    # dynamics and heat hardly show in quasi-static strain: the effects over the face and of the gauges are run
    effects = tuple(effect for effect in effects_of(case) if effect.family.strain)
    channels = tuple(entry.channel for entry in data.channels.values())
    library = build_library(case, data.settings, channels, effects)
    residuals = compare(
        data, library, effects, stated_settings(measurement), mesh_orders(case), teeth_a_turn(case)
    )
    problem = Problem(residuals=residuals, baseline=None, seed=measurement.hash, repeated=False)
    return diagnose(problem), residuals, effects


def test_the_hidden_slope_is_found_within_its_interval(diagnosed) -> None:
    found, residuals, effects = diagnosed
    names = Names(effects, residuals.errors)
    own = next(one for one in found.evaluations[0].evidence if one.hypothesis.name == NAME)
    size = from_evidence(names, own, DEFAULT.signature_error)
    [(low, high)] = size.ends
    assert low <= TRUE <= high
    assert abs(size.values[0] - TRUE) < 2.5e-6


def test_nothing_else_is_named(diagnosed) -> None:
    """10 um lie within three standard deviations of a healthy rig: a size with an interval, no missing effect."""
    found, _, _ = diagnosed
    assert set(found.named) <= {NAME}
    assert found.decision.verdict in ("within_noise", "too_small", "suspected", "named")
