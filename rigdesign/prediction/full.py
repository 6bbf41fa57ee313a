"""What the sensors of a rig would read: the solve of a check at single operating points."""

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
from threadpoolctl import threadpool_limits

from rigdesign.base.errors import UsageError
from rigdesign.base.fidelity import Fidelity
from rigdesign.base.part_name import MeshName, OilStreamName
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.model import Case
from rigdesign.coupling.iteration import IterationResult
from rigdesign.coupling.loop import solve_point
from rigdesign.coupling.state import OperatingPoint
from rigdesign.prediction.model import (
    OWN_MODEL,
    STANDING_QUANTITIES,
    Channel,
    OperatingCondition,
    Prediction,
    PredictionModel,
    features_of,
)
from rigdesign.prediction.readings import readings
from rigdesign.prediction.static_tests import ModesAt, resonance_speed, standing_modes, standing_value
from rigdesign.rig.model import Rig, RigParts, build_rig
from rigdesign.rig.reuse import (
    same_housings,
    with_all_of,
    with_circuit_of,
    with_elastic_of,
    with_housings_of,
)
from rigdesign.run.mesh_convergence import looping_rig, on_mesh
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


# The rig as it was set at one operating point, and with a changed case: what a change leaves alone is shared.
#
# A case is validated once when it is loaded. A setting replaces numbers of it that were measured, so it is put into
# a copy of the tree without validating the rest of the case again.

STREAMS = {"gear_oil": "oil", "bearing_oil": "bearing_oil"}
"""Name of an oil stream -> key of the gearbox that feeds it."""


def operating_point(setting: OperatingCondition) -> OperatingPoint:
    """Speed and torque of a setting; its name stands where a stage of the schedule would."""
    return OperatingPoint(stage=setting.name, speed=setting.speed, torque=setting.torque)


def rig_at(rig: Rig, setting: OperatingCondition) -> Rig:
    """The rig with inlet temperatures, flows, room and tooth offsets of a setting; meshes and matrices shared.

    Raises
    ------
    UsageError
        A stream or mesh that the rig does not have, a value no oil or room can have.
    """
    case = case_at(rig.case, setting)
    if case is rig.case:
        return rig
    return with_all_of(replace(rig, case=case, parts=RigParts()), rig)


def case_at(case: Case, setting: OperatingCondition) -> Case:
    """The case with the numbers of a setting; see `rig_at`."""
    boxes = dict(case.gearboxes)
    for stream, value in setting.inlet_temperature.items():
        _check(f"inlet temperature of {stream}", value, 200.0, 700.0, "K")
        _feed(boxes, stream, "inlet_temperature", value)
    for stream, value in setting.flow.items():
        _check(f"flow of {stream}", value, 1e-9, 1.0, "m3/s")
        _feed(boxes, stream, "flow", value)
    for mesh, teeth in setting.tooth_offset.items():
        _turn(boxes, mesh, teeth)
    update: dict[str, object] = {}
    if setting.inlet_temperature:
        # what was measured at the inlets stands in place of what the circuits would give
        update["oil_circuits"] = {}
    if setting.inlet_temperature or setting.flow or setting.tooth_offset:
        update["gearboxes"] = boxes
    if setting.ambient_temperature is not None:
        _check("ambient temperature", setting.ambient_temperature, 200.0, 400.0, "K")
        update["ambient"] = case.ambient.model_copy(update={"temperature": setting.ambient_temperature})
    return case.model_copy(update=update) if update else case


def modelled_rig(case: Case, fidelity: Fidelity, model: PredictionModel) -> Rig:
    """The rig that channels are predicted with; without the unbalance that a balance grade leaves, whose angles are
    unknown.

    Raises
    ------
    CaseError, ValueError
        As `build_rig`.
    """
    rig = build_rig(case, fidelity)
    power = case.drivetrain
    if power is None:
        return rig
    analytic = fidelity == "quick" and power.mesh_stiffness == "influence_numbers"
    return replace(
        rig,
        shaft_model=model.shafts or power.shaft_model,
        mesh_stiffness=model.teeth or ("iso_6336_scaled" if analytic else power.mesh_stiffness),
        residual_unbalance=False,
    )


def like(stated: Rig, case: Case) -> Rig:
    """The rig of another ``case`` with whatever of the stated rig the other case leaves as it is.

    Raises
    ------
    ValueError
        As `build_rig`.
    """
    if case is stated.case:
        return stated
    rig = replace(
        build_rig(case, stated.fidelity),
        shaft_model=stated.shaft_model,
        mesh_stiffness=stated.mesh_stiffness,
        tooth_influence=stated.tooth_influence,
        residual_unbalance=stated.residual_unbalance,
    )
    if same_housings(rig, stated):
        rig = with_housings_of(rig, stated)
    if rig.drivetrain == stated.drivetrain:
        rig = with_circuit_of(rig, stated)
    if rig.shaft_model == "elastic":
        rig = with_elastic_of(rig, stated)
    return rig


def _feed(boxes: dict[str, Gearbox], stream: str, key: str, value: float) -> None:
    """Put a number into the oil feed of a stream; the inlet temperature of a sump is that of its oil."""
    name, kind = OilStreamName.read(stream).both
    if name not in boxes or kind not in STREAMS:
        known = ", ".join(f"{box}.{kind}" for box in boxes for kind in STREAMS)
        raise UsageError(f"setting names oil stream {stream!r}, which the case does not have; it has {known}")
    entry = getattr(boxes[name], STREAMS[kind])
    field = entry.temperature_key if key == "inlet_temperature" else key
    if field not in type(entry).model_fields:
        said = f"{entry.lubrication} lubrication and none in the case; remove it"
        raise UsageError(f"setting names {key.replace('_', ' ')} of {stream}, which has {said}")
    boxes[name] = boxes[name].model_copy(update={STREAMS[kind]: entry.model_copy(update={field: value})})


def _turn(boxes: dict[str, Gearbox], mesh: str, teeth: int) -> None:
    """Put the wheel of a mesh on further by whole teeth."""
    name, own = MeshName.read(mesh).both
    if name not in boxes or own not in boxes[name].meshes:
        known = ", ".join(f"{box}.{own}" for box, entry in boxes.items() for own in entry.meshes)
        raise UsageError(f"setting turns mesh {mesh!r}, which the case does not have; it has {known}")
    meshes = dict(boxes[name].meshes)
    stated = getattr(meshes[own], "tooth_offset", None)
    if stated is None:
        raise UsageError(f"setting turns mesh {mesh!r}, but meshes of this case have no tooth offset")
    offset = stated + teeth
    meshes[own] = meshes[own].model_copy(update={"tooth_offset": offset})
    boxes[name] = boxes[name].model_copy(update={"meshes": meshes})


def _check(what: str, value: float, low: float, high: float, unit: str) -> None:
    if not low <= value <= high:
        raise UsageError(
            f"{what} is {value:g} {unit}, outside {low:g} to {high:g} {unit}; settings are in SI units and kelvin"
        )
