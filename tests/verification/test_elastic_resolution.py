"""Elements of the shafts, modes, slices and speed bands of the elastic rig: K_V no longer moves with more of them.

On the prototype with films at 180 N m, analytic teeth, at eleven speeds over the peaks of both meshes. Measured,
largest change of K_V of either mesh against what the rules give (elements of 9.9 mm, modes of the shafts to 25 kHz and
static shapes of their ports above, harmonics to 50 kHz, 34 slices of the helical face, bands a quarter wide):

| elements | 19.8 mm 9.6e-3, 4.95 mm 2.9e-3 |
| modes up to | 50 kHz 1.6e-3, 100 kHz and harmonics to 75 kHz 1.7e-3, 10 kHz 2.1e-2, 5 kHz 3.8e-2 |
| slices of helical / spur faces | 24 / 5 3.5e-3, 48 / 9 1.3e-3, 96 / 33 1.7e-3 |
| speed bands | half as many 2.9e-3, twice 1.4e-3, four times 1.4e-3 |

Steps of the time run, K_V at a constant speed against 32 internal steps a sample of 40 kHz (8 are the default):

| 1950 rpm, peak of the test mesh | 4 6.4e-4, 8 1.6e-4, 16 2.8e-5 |
| 2575 rpm, peak of the reference mesh | 4 3.2e-4, 8 8.7e-5, 16 1.5e-5 |
| 12,000 rpm | 4 6.9e-5, 8 3.9e-5, 16 1.4e-5 |
"""

from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray

from dynamics.rotor.linear_system import LinearSystem, SpeedBands
from dynamics.rotor.static_loop import LoopLoad
from dynamics.tooth.law import MeshLaw
from dynamics.vibration.initial_state import wound_state
from dynamics.vibration.march_inputs import DriveLoads, MarchSettings
from dynamics.vibration.speed_sweep import SweepSettings, periodic_response
from dynamics.vibration.time_integration import TimeMarch
from rigdesign.case import load_case
from rigdesign.coupling.bearing_loads import solve_bearings
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.loop_system import loop_system
from rigdesign.coupling.mesh_models import laws_of, mesh_models
from rigdesign.coupling.preloaded_loop import signed_torque
from rigdesign.coupling.time_run import held_points
from rigdesign.rig.model import Rig, RigParts, build_rig
from tests.builders.paths import CASES

Array = NDArray[np.float64]
pytestmark = pytest.mark.slow
RPM = np.pi / 30.0
SPEEDS = np.array([950.0, 1250.0, 1500.0, 1750.0, 1950.0, 2450.0, 2600.0, 2950.0, 4700.0, 8500.0, 12000.0])
BANDS = 12
"""Of the curve: as wide as those of a run, a factor of 1.25."""


@cache
def rig(**numerics: object) -> Rig:
    case = load_case(CASES / "uhcf_prototype")
    for key, value in numerics.items():
        case = case.with_value(f"numerics.{key}", value)
    return replace(build_rig(case, "quick"), shaft_model="elastic")


def factors(own: Rig, cutoff: float | None = None, bands: int = BANDS) -> Array:
    """K_V (n_speeds, n_meshes) of the cold rig at the torque of its test, bearings by the speed of each band."""
    point = held_points(own)[-1]
    state = initial_state(own, point)
    laws = laws_of(mesh_models(own, point, state))
    edges = np.geomspace(SPEEDS[0], SPEEDS[-1], bands + 1) * RPM
    systems = []
    for first, last in pairwise(edges):
        at = replace(point, speed=float(np.sqrt(first * last)))
        systems.append(loop_system(own, at, state, solve_bearings(own, at, state)))
    curve = periodic_response(
        SpeedBands(limits=tuple(own.pinion_speed(float(e)) for e in edges[1:-1]), systems=tuple(systems)),
        laws,
        SPEEDS * RPM,
        LoopLoad(torque=signed_torque(own, point)),
        settings=SweepSettings(cutoff=cutoff or own.highest_mode, methods=("harmonic_balance",)),
    )
    assert not curve.failed
    return np.array([found.dynamic_factor for found in curve.points])


@cache
def ruled() -> Array:
    """With what the rules give."""
    return factors(rig())


def change(finer: Array) -> float:
    return float(np.abs(ruled() / finer - 1.0).max())


def test_the_response_has_peaks_that_could_move() -> None:
    assert (np.ptp(ruled(), axis=0) > 0.05).all()


def test_elements_half_as_long_move_no_factor_by_a_per_cent() -> None:
    shortest = min(shaft.element_length for shaft in rig().drivetrain.shafts)
    finer = factors(rig(shaft_element_length=f"{500.0 * shortest:.6g} mm"))
    assert change(finer) < 0.01


def test_more_modes_move_no_factor_by_a_per_cent() -> None:
    finer = rig()
    elastic = replace(finer.elastic, cutoff=2.0 * finer.elastic.cutoff)
    other = replace(finer, parts=RigParts(elastic=elastic))
    assert elastic.reduced.size > rig().elastic.reduced.size
    assert change(factors(other, cutoff=1.5 * finer.highest_mode)) < 0.01


def test_fewer_modes_than_ruled_do() -> None:
    """The rule is no luxury: modes to 10 kHz alone miss by 2 %."""
    fewer = rig()
    other = replace(fewer, parts=RigParts(elastic=replace(fewer.elastic, cutoff=1e4)))
    assert other.elastic.reduced.size < rig().elastic.reduced.size
    assert change(factors(other, cutoff=2.5e4)) > 0.01


def test_more_slices_move_no_factor_by_a_per_cent() -> None:
    assert change(factors(rig(slices_helical=96, slices_spur=33))) < 0.01


@pytest.mark.parametrize("bands", [2 * BANDS])
def test_narrower_speed_bands_move_no_factor_by_a_per_cent(bands: int) -> None:
    assert change(factors(rig(), bands=bands)) < 0.01


@cache
def steady(rpm: float) -> tuple[LinearSystem, tuple[MeshLaw, ...]]:
    """Of the ruled rig at a speed."""
    own = rig()
    point = replace(held_points(own)[-1], speed=rpm * RPM)
    state = initial_state(own, point)
    laws = tuple(laws_of(mesh_models(own, point, state)))
    return loop_system(own, point, state, solve_bearings(own, point, state)), laws


@cache
def marched(rpm: float, substeps: int) -> Array:
    """K_V (n_meshes,) of a march at a constant speed: highest over mean force of the internal steps of 50 ms."""
    own, (system, laws) = rig(), steady(rpm)
    rate, torque = own.case.numerics.sample_rate, signed_torque(own, held_points(own)[-1])
    wound = wound_state(system, laws, own.pinion_speed(rpm * RPM), LoopLoad(torque=torque))
    march = TimeMarch(
        system, laws, wound.state,
        MarchSettings(step=1.0 / rate / substeps, substeps=substeps, accounts=False, record_all=False),
        DriveLoads(drive_torque=wound.drive_torque),
    )  # fmt: skip
    given = np.tile([wound.drive_torque, wound.state.twist, 0.0, 0.0], (round(0.05 * rate), 1))
    for _ in range(4):
        force = np.abs(march.advance(given).force)
    return np.asarray(force.max(axis=1) / force.mean(axis=1))


@pytest.mark.parametrize("rpm", [1950.0, 2575.0, 12000.0])
def test_shorter_steps_move_no_factor_of_the_time_run_by_a_per_cent(rpm: float) -> None:
    for substeps in (4, 8, 16, 32):
        print(rpm, substeps, marched(rpm, substeps), marched(rpm, substeps) / marched(rpm, 32) - 1.0)
    default = rig().case.numerics.internal_steps
    assert np.abs(marched(rpm, default) / marched(rpm, 32) - 1.0).max() < 0.01
