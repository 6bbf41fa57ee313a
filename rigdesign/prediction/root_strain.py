"""What a root gauge reads at an operating point: the loaded contact under the mesh torque as it passes its tooth.

The stress of the quasi-static contact under the mean torque, on influence numbers and with the axes of the warm rig, is
multiplied at every angle by the torque of the mesh over its mean at the time at which the tooth of the gauge is there,
mean over the turns that the periodic response holds. Left out: that a dynamic load evens out face and pairs, deviations
of single teeth within the contact (a response over a turn has them in the torque, one over a mesh does not), friction
forces on the flank, centrifugal strain, and a second mesh of the same gear.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.response.response_curve import CurvePoint
from rigdesign.base.errors import UsageError
from rigdesign.coupling.iteration import IterationResult
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.mesh_models import MeshModel
from rigdesign.coupling.state import LEAST_TORQUE
from rigdesign.prediction.model import Channel
from rigdesign.records.contact_gap import held_flanks
from rigdesign.records.gauge_stress import stress_at
from rigdesign.records.loaded_contact import HeldContact, kept_contact
from rigdesign.rig.model import Rig
from rigdesign.rig.strain_gauges import RootGauge
from rigdesign.strain_gauge.curve_windows import curve_windows

Array = NDArray[np.float64]
Index = Literal[0, 1]
TURN = 2.0 * np.pi
POSITIONS = 192
"""Positions of the contact over a base pitch: three times those of a check, as differences of curves with steep edges
are read."""
SAMPLES = 2048
"""Samples of a turn on which a low-pass acts."""


@dataclass(frozen=True, kw_only=True)
class StrainCurve:
    """Indicated strain of a gauge over the way of its tooth through the mesh.

    angle : (n,) of its gear in the order of time, zero at the pitch point, increasing [rad]; strain : (n,) [-]
    """

    angle: Array
    strain: Array


def root_strain(rig: Rig, channel: Channel) -> Callable[[Rig, IterationResult], tuple[float, ...]]:
    """How a channel of a root gauge is read.

    Raises UsageError for a gauge that the rig does not have, and for a rig without drivetrain.
    """
    known = rig.strain_gauges
    if channel.place not in known:
        raise UsageError(
            f"channel {channel.name!r}: {channel.place!r} is no strain gauge of this case; it has "
            f"{', '.join(known) or 'none'}"
        )
    if rig.case.drivetrain is None:
        raise UsageError(
            f"channel {channel.name!r}: root_strain needs the drivetrain, which this case leaves out"
        )

    def read(here: Rig, done: IterationResult) -> tuple[float, ...]:
        gauge = here.strain_gauges[channel.place]
        curve = strain_curve(here, done, channel.place)
        box, gear = gauge.gear.split(".")
        pitch = TURN / here.case.gearboxes[box].gears[gear].teeth
        found = curve_windows(curve.angle, curve.strain, pitch)
        return tuple(found[window] for window in channel.windows)

    return read


def strain_curve(rig: Rig, done: IterationResult, place: str) -> StrainCurve:
    """Indicated strain of a gauge, ``gearbox.gear.gauge``, at an operating point.

    Raises UsageError for an operating point at which its mesh carries no torque.
    """
    gauge = rig.strain_gauges[place]
    number, index = _mesh_of(rig, gauge)
    response = done.response
    assert response is not None
    torque = abs(float(response.mean[number]))
    if torque < LEAST_TORQUE:
        raise UsageError(
            f"root strain at {place}: its mesh carries {torque:.3g} N m at {done.point.stage!r}, at least "
            f"{LEAST_TORQUE:g} N m are needed; leave the point or the gauge out"
        )
    contact = _contact(rig, done, number, torque)
    flank = contact.flanks.flank
    cold = contact.cold
    still = stress_at(gauge, contact.cycle, contact.gears[index], cold, index, flank)
    sense = -1.0 if index else 1.0
    path = sense * cold.base_radii[index] * still.angle
    stress = still.stress * torque_share(done.models[number], response, number, (gauge.tooth, index), path)
    # contact runs to the tip of the gear that drives, to the root of the driven one
    turned = sense * (1.0 if flank == "front" else -1.0)
    order = np.argsort(turned * still.angle)
    point = gauge.point
    strain = point.strain_factor * np.asarray(point.surface.strain(stress))[order]
    curve = StrainCurve(angle=(turned * still.angle)[order], strain=strain)
    return _lagged(curve, _response_time(rig, place) * _gear_speed(rig, done, gauge))


def torque_share(
    model: MeshModel, response: CurvePoint, mesh: int, tooth: tuple[int, Index], path: Array
) -> Array:
    """(n,) torque of a mesh over its mean while the pair of one tooth is at path positions (n,) [m].

    tooth : its number, on the pinion (0) or the wheel (1); mean over the times it passes in the period of the response
    """
    law = model.law
    number, index = tooth
    front = bool(response.flank[mesh] > 0)
    pair = number if index == 0 else number - law.tooth_offset_2 - (0 if front else 1)
    teeth = (law.teeth_1, law.teeth_2)[index]
    wave = response.wave
    angle, torque = wave.angle[mesh], np.abs(wave.torque[mesh])
    pitch = TURN / law.teeth_1
    step = float(angle[-1] - angle[0]) / (len(angle) - 1)
    period = pitch * round((float(angle[-1] - angle[0]) + step) / pitch)
    passes = max(1, round(period / (pitch * teeth)))
    pairs = pair + teeth * np.arange(passes)[:, None]
    along = (
        path + law.base_pitch * pairs - law.phase if front else law.back_phase - path + law.base_pitch * pairs
    )
    share = np.interp(along / law.base_radius_1, angle, torque, period=period)
    return np.asarray(share.mean(axis=0) / abs(float(response.mean[mesh])))


def _mesh_of(rig: Rig, gauge: RootGauge) -> tuple[int, Index]:
    """Number of the first mesh of the gear of a gauge, and whether it is its pinion (0) or wheel (1)."""
    box, gear = gauge.gear.split(".")
    own, side = rig.case.gearboxes[box].first_meshes()[gear]
    return rig.mesh_names.index(f"{box}.{own}"), 1 if side else 0


def _contact(rig: Rig, done: IterationResult, number: int, torque: float) -> HeldContact:
    """Loaded contact of a mesh under its mean torque, shared by all gauges that ask for it."""
    point = PointResult(point=done.point, last=done, setting=done.bracing, residuals=())
    flanks = held_flanks(rig, point, number)
    return kept_contact(
        HeldContact(
            cold=rig.pairs[rig.mesh_names[number]],
            flanks=flanks,
            force=torque / done.models[number].halves / flanks.pair.base_radii[0],
            influence=rig.tooth_influence,
            positions=POSITIONS,
        )
    )


def _response_time(rig: Rig, place: str) -> float:
    """Time constant of the measuring chain of a gauge [s]."""
    box, gear, own = place.split(".")
    return rig.case.gearboxes[box].gears[gear].strain_gauges[own].response_time


def _gear_speed(rig: Rig, done: IterationResult, gauge: RootGauge) -> float:
    """Speed of its gear [rad/s]."""
    box, gear = gauge.gear.split(".")
    return rig.shaft_speed(rig.case.gearboxes[box].gears[gear].shaft, done.point.speed)


def _lagged(curve: StrainCurve, lag: float) -> StrainCurve:
    """The curve through a first-order low-pass whose time constant is an angle of the gear [rad]."""
    if not lag:
        return curve
    first = 0.5 * float(curve.angle[0] + curve.angle[-1]) - 0.5 * TURN
    angle = first + TURN / SAMPLES * np.arange(SAMPLES, dtype=np.float64)
    strain = np.interp(angle, curve.angle, curve.strain, left=0.0, right=0.0)
    gain = 1.0 / (1.0 + 1j * lag * np.arange(SAMPLES // 2 + 1))
    passed = np.fft.irfft(np.fft.rfft(strain) * gain, SAMPLES)
    return StrainCurve(angle=np.asarray(angle, dtype=np.float64), strain=passed)
