"""The time integration is compiled once: what is compiled ahead serves shafts that twist and shafts that bend."""

import numpy as np

from dynamics.kernels.time_integration import _integrate, compiled
from dynamics.rotor.static_loop import LoopLoad
from dynamics.vibration.initial_state import wound_state
from dynamics.vibration.march_inputs import MarchSettings
from dynamics.vibration.time_integration import TimeMarch, compile_time_integration
from tests.builders.rig import prototype_laws
from tests.unit.dynamics_package.rotor.test_seen_system import films, seen


def test_bending_shafts_take_what_was_compiled_ahead() -> None:
    compile_time_integration()
    assert compiled()
    before = set(_integrate.signatures)
    system, laws = seen().system(films(600.0)), prototype_laws()
    start, drive, _ = wound_state(system, laws, 600.0, LoopLoad(torque=180.0))
    march = TimeMarch(system, laws, start, MarchSettings(step=1.0 / 160e3, substeps=4))
    march.advance(np.tile([drive, start.twist, 0.0, 0.0], (2, 1)))
    assert march.unconverged == 0
    assert set(_integrate.signatures) == before
