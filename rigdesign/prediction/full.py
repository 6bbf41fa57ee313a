"""What the sensors of a rig would read: the solve of a check at single operating points."""

from collections.abc import Iterable, Sequence

import numpy as np
from threadpoolctl import threadpool_limits

from rigdesign.base.errors import UsageError
from rigdesign.base.fidelity import Fidelity
from rigdesign.case.model import Case
from rigdesign.coupling.iteration import IterationResult
from rigdesign.coupling.loop import solve_point
from rigdesign.prediction.model import (
    OWN_MODEL,
    STANDING_QUANTITIES,
    Channel,
    OperatingCondition,
    Prediction,
    PredictionModel,
    features_of,
)
from rigdesign.prediction.operating import modelled_rig, operating_point, rig_at
from rigdesign.prediction.readings import readings
from rigdesign.prediction.resonance_speeds import ModesAt, resonance_speed
from rigdesign.prediction.static_tests import standing_modes, standing_value
from rigdesign.rig.model import Rig
from rigdesign.run.mesh_refinement import looping_rig, on_mesh
from rigdesign.run.solver_errors import solver_errors
from thermal.fe.kernels import one_thread


def predict_full(
    case: Case,
    settings: Sequence[OperatingCondition],
    channels: Sequence[Channel],
    fidelity: Fidelity,
    circuit: PredictionModel = OWN_MODEL,
) -> Prediction:
    """What the channels would read by the full thermal model; see `rigdesign.prediction.predict.predict`."""
    check_names(settings, channels)
    with solver_errors(case), threadpool_limits(limits=1), one_thread():
        rig = modelled_rig(case, fidelity, circuit)
        values = list(_at_points(rig, settings, channels)) + standing_values(rig, channels)
    return Prediction(features=features_of(settings, channels), values=np.array(values, dtype=np.float64))


def _at_points(rig: Rig, settings: Sequence[OperatingCondition], channels: Sequence[Channel]) -> list[float]:
    reads = readings(rig, channels)
    looping = looping_rig(rig)
    before: IterationResult | None = None
    values: list[float] = []
    for setting in settings if reads else ():
        here = rig_at(looping, setting)
        start = None if before is None else before.coupling_state
        result = solve_point(here, operating_point(setting), start=start)
        before = result.last
        if looping is not rig:
            here, source = rig_at(rig, setting), here
            result = on_mesh(here, result, source)
        for _, read in reads:
            values += read(here, result.last)
    return values


def standing_values(rig: Rig, channels: Iterable[Channel], modes_of: ModesAt = standing_modes) -> list[float]:
    """Numbers of the channels of the rig at rest, in their order; modes_of : finds its modes, as `standing_modes`."""
    standing = [channel for channel in channels if channel.quantity in STANDING_QUANTITIES]
    if not standing:
        return []
    oscillating = any(channel.quantity == "natural_frequency" for channel in standing)
    modes = modes_of(rig, None) if oscillating else ()
    return [
        resonance_speed(rig, channel, modes_of)
        if channel.quantity == "resonance_speed"
        else standing_value(rig, channel, modes)
        for channel in standing
    ]


def check_names(settings: Sequence[OperatingCondition], channels: Sequence[Channel]) -> None:
    """Check that settings and channels differ by name (UsageError)."""
    for kind, names in (("settings", [s.name for s in settings]), ("channels", [c.name for c in channels])):
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise UsageError(f"two {kind} are called {twice[0]!r}; give each a name of its own")
