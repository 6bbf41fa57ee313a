"""Torques during the run-down of a stop, through the resonances of the loop, from the periodic responses over speed.

A resonance that is passed has less time to rise than one that is held: its periodic response is the upper bound where
the loop is linear. The bracing keeps its twist, so that the torque of the loop stays; what the brake adds stands
between motor and meshes.
"""

from collections.abc import Sequence

from dynamics.vibration.response_curve import CurvePoint
from rigdesign.coupling.preloaded_loop import signed_torque
from rigdesign.coupling.state import OperatingPoint
from rigdesign.postprocessing.curves import curve_at, dense, loop_states, response_solver, torque_key
from rigdesign.postprocessing.dynamics import DynamicRun
from rigdesign.postprocessing.run_torques import LoopOverSpeed, torques_over_speed
from rigdesign.results.loads import Load, PassingPeak
from rigdesign.results.units import RPM
from rigdesign.results.vibration import PlaceKind, TorqueOverSpeed
from rigdesign.rig.model import Rig

PEAK_QUANTITIES: dict[PlaceKind, Load] = {
    "coupling": "coupling torque", "shaft": "shaft torque", "spline": "seat torque", "mesh": "mesh torque"
}  # fmt: skip


def passing_peaks(
    rig: Rig, run: DynamicRun, stop: OperatingPoint
) -> tuple[tuple[PassingPeak, ...], tuple[str, ...]]:
    """Largest torque of every place below the speed of a stop under its torque, and what is left out, in words."""
    torque = torque_key(signed_torque(rig, stop))
    known, failed = _responses(rig, run, torque, stop.speed)
    if not known:
        return (), (
            "torques during run-down are not known: no periodic response was found below the speed of the event",
        )
    ends = known[0].speed, known[-1].speed
    solve = response_solver(rig, run.test.last, torque, ends) if dense(rig) else None
    share = torque / signed_torque(rig, run.test.point)
    loop = LoopOverSpeed(rig, run.test.last, loop_states(rig, run.test, stop.speed, share))
    points, curves = torques_over_speed(loop, known, solve)
    low, high = (speed / rig.pinion_speed(1.0) * RPM for speed in ends)
    notes = [
        f"torques during run-down are those of periodic responses from {high:.0f} to {low:.0f} rpm, without brake "
        "torque; bearing forces and lower speeds are not computed"
    ]
    if solve is None:
        notes.append(f"resonances between its {len(points)} speeds are not captured")
    if failed:
        notes.append(f"{failed} speeds during run-down have no periodic response")
    found = [_peak(rig, curve, points) for curve in curves if curve.place.kind in PEAK_QUANTITIES]
    order = list(PEAK_QUANTITIES.values())
    return tuple(sorted(found, key=lambda peak: order.index(peak.quantity))), tuple(notes)


def _responses(rig: Rig, run: DynamicRun, torque: float, speed: float) -> tuple[list[CurvePoint], int]:
    """Points up to a stated speed, rising, and how many speeds failed; solved where no curve has this torque."""
    known = {torque_key(at): curve for at, curve in run.curves.named.values()}
    curve = known.get(torque)
    if curve is None:
        curve = curve_at(rig, run.test.last, torque, (min(rig.case.numerics.curve_speed_start, speed), speed))
    top = rig.pinion_speed(speed) * (1.0 + 1e-9)
    points = sorted((point for point in curve.points if point.speed <= top), key=lambda point: point.speed)
    return points, sum(missed <= top for missed, _ in curve.failed)


def _peak(rig: Rig, curve: TorqueOverSpeed, points: Sequence[CurvePoint]) -> PassingPeak:
    at = max(range(len(points)), key=lambda i: curve.swings[i].peak)
    place, peak = curve.place, curve.swings[at].peak
    meshes = {rig.mesh_labels[name]: name for name in rig.mesh_names}
    part = meshes[place.part] if place.kind == "mesh" else place.part
    return PassingPeak(
        place=place.name if place.kind == "shaft" else part,
        part=part,
        quantity=PEAK_QUANTITIES[place.kind],
        peak=peak,
        speed=points[at].speed / rig.pinion_speed(1.0),
        shear_stress=curve.shear_per_torque * peak if place.kind == "shaft" else None,
    )
