"""The reduced rig against all its freedoms, as the product reduces it: forced vibration at the mesh frequencies.

Prototype of its case with films: approach of both flanks under forces along their lines of action at the mesh
frequency and its second harmonic at three speeds, up to 20 kHz, which is what counts for the shafts
(`rigdesign.rig.resolution`). Full sparse matrices against modes to 25 kHz with static shapes of the ports, mesh springs
in both. Errors over the geometric mean of the own receptances. Measured: 3e-6 at 3.2 kHz, 2e-4 at 7.8 kHz, 1.6e-3 at 14
kHz, 2.1e-3 at 15.5 kHz; 0.5 at 28 kHz, beyond the modes.
"""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from dynamics.rotor.bearing_state import RowSpring
from rigdesign.case import load_case
from rigdesign.coupling.bearing_loads import solve_bearings
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.loop_system import running_state
from rigdesign.coupling.mesh_models import laws_of, mesh_models
from rigdesign.coupling.time_run import held_points
from rigdesign.rig.model import Rig, build_rig
from rigdesign.rig.resolution import HIGHEST_COUNTED
from tests.builders.paths import CASES
from tests.builders.reduction_error import ReductionError, reduction_error

RPM = np.pi / 30.0


@cache
def rig() -> Rig:
    return replace(build_rig(load_case(CASES / "uhcf_prototype"), "quick"), shaft_model="elastic")


@cache
def error(rpm: float) -> ReductionError:
    own = rig()
    point = replace(held_points(own)[-1], speed=rpm * RPM)
    state = initial_state(own, point)
    laws = laws_of(mesh_models(own, point, state))
    running = running_state(own, point, state, solve_bearings(own, point, state))
    elastic = own.elastic
    ports = list(elastic.port_rows.values())
    rows = [law.base_radius_1 * port[0] - law.base_radius_2 * port[1] for law, port in zip(laws, ports)]
    springs = tuple(RowSpring(row=row, stiffness=law.mean_stiffness) for row, law in zip(rows, laws))
    frequencies = own.pinion_speed(rpm * RPM) * laws[0].teeth_1 * np.array([1.0, 2.0])
    counted = frequencies[frequencies <= 2.0 * np.pi * HIGHEST_COUNTED]
    return reduction_error(elastic.reduced, replace(running, springs=springs), np.array(rows), counted)


@pytest.mark.parametrize("rpm", [1950.0, 4700.0, 8500.0])
def test_the_reduced_rig_vibrates_as_all_its_freedoms(rpm: float) -> None:
    found = error(rpm)
    print(
        rpm,
        found.frequencies / 2.0 / np.pi,
        found.largest,
        rig().elastic.model.size,
        rig().elastic.reduced.size,
    )
    assert rig().elastic.reduced.size < 0.6 * rig().elastic.model.size
    slow = found.frequencies < 2.0 * np.pi * 10e3
    assert found.largest[slow].max(initial=0.0) < 1e-3
    assert found.maximum < 5e-3
