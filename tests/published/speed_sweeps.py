"""K_V over speed of the prototype as P2 simulated it, and variants that show what the curve depends on."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.damped_modes import elastic_loop_modes
from dynamics.rotor.linear_system import DrivetrainOverSpeed, SpeedBands
from dynamics.rotor.static_loop import LoopLoad
from dynamics.rotor.torsional_modes import LoopMode
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.mesh_laws import ContactDiscretisation, MeshDissipation, mesh_law
from dynamics.tooth.pair_gap import tip_separation
from dynamics.vibration.modal_model import DEFAULT_CUTOFF
from dynamics.vibration.response_curve import Method
from dynamics.vibration.speed_sweep import SweepSettings, periodic_response
from rigdesign.case.drivetrain import MeshStiffness
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.loop_system import running_state
from rigdesign.coupling.mesh_models import MeshModel, laws_of, mesh_microgeometry, mesh_models
from rigdesign.coupling.preloaded_loop import signed_torque
from rigdesign.coupling.state import OperatingPoint
from rigdesign.rig.model import Rig
from tests.published.prototype import RPM, TEST_TORQUE, Prototype

Array = NDArray[np.float64]
TOP_SPEED = 12000.0
FINE = np.concatenate([np.arange(750.0, 5000.0, 25.0), np.arange(5000.0, TOP_SPEED + 1.0, 250.0)])
"""Speeds of the test pinion [rpm] for curves whose peaks are read."""
COARSE = np.concatenate([np.arange(750.0, 5000.0, 50.0), np.arange(5000.0, TOP_SPEED + 1.0, 500.0)])
"""Speeds for variants."""
ROUGH = np.concatenate([np.arange(800.0, 5000.0, 150.0), np.arange(5000.0, TOP_SPEED + 1.0, 1000.0)])
"""Speeds for a variant whose harmonic balance is slow."""
SUBCRITICAL, MAIN, SUPERCRITICAL = (750.0, 2500.0), (2500.0, 3400.0), (4500.0, TOP_SPEED)
"""Ranges of P2's comparison with ISO 6336-1 [rpm]: main resonance at N = 0.85 to 1.15."""
BOTH: tuple[Method, ...] = ("harmonic_balance", "time_integration")


@dataclass(frozen=True, kw_only=True)
class SpeedSweep:
    """Periodic response over speed; index 0 test mesh, 1 reference mesh.

    speed : (n,) of the test pinion [rpm]
    factor, half : (n, 2) K_V as max/mean (P2, Formula 1) and as 1 + half the peak-to-peak value / mean [-]
    mean : (n, 2) torque at the pinion [N m]; drive : (n,) motor torque [N m]
    missing : speeds at which no periodic response was found [rpm]
    """

    speed: Array
    factor: Array
    half: Array
    mean: Array
    drive: Array
    missing: tuple[float, ...] = ()

    def left_out(self, limits: tuple[float, float]) -> str:
        """What a highest value within these speeds does not know of; empty if every speed has its response."""
        inside = [f"{speed:.0f}" for speed in self.missing if limits[0] <= speed <= limits[1]]
        return (
            f" ({len(inside)} speeds without a periodic response: {', '.join(inside)} rpm)" if inside else ""
        )

    def highest(self, mesh: int, limits: tuple[float, float]) -> tuple[float, float]:
        """(K_V, speed [rpm]) of the highest K_V of a mesh within a range of speeds."""
        inside = np.flatnonzero((self.speed >= limits[0]) & (self.speed <= limits[1]))
        at = inside[int(np.argmax(self.factor[inside, mesh]))]
        return float(self.factor[at, mesh]), float(self.speed[at])

    def amplitude(self, mesh: int, limits: tuple[float, float]) -> tuple[float, float]:
        """Largest (max - mean, max - min) of the torque of a mesh within a range of speeds [N m]."""
        inside = (self.speed >= limits[0]) & (self.speed <= limits[1])
        above = (self.factor[inside, mesh] - 1.0) * self.mean[inside, mesh]
        whole = 2.0 * (self.half[inside, mesh] - 1.0) * self.mean[inside, mesh]
        return float(above.max()), float(whole.max())

    def peaks(self, mesh: int, prominence: float = 0.01) -> Array:
        """Speeds [rpm] of the local maxima of K_V that stand out by ``prominence``."""
        from scipy.signal import find_peaks

        places, _ = find_peaks(self.factor[:, mesh], prominence=prominence)
        return self.speed[places]


def simulation_models(prototype: Prototype, stiffness: MeshStiffness | None = None) -> tuple[MeshModel, ...]:
    """Meshes of P2's simulation: as drawn, 12,000 rpm, 180 N m; ``stiffness`` as in ``mesh_models``."""
    rig, point = _point(prototype)
    return mesh_models(rig, point, initial_state(rig, point), stiffness)


def simulation_laws(prototype: Prototype, stiffness: MeshStiffness | None = None) -> list[MeshLaw]:
    """The laws of these meshes."""
    return [model.law for model in simulation_models(prototype, stiffness)]


def laws_of_both_halves(prototype: Prototype) -> list[MeshLaw]:
    """The same with both halves of the double-helical gears, each under half of the torque."""
    point = _loaded(TOP_SPEED)
    return laws_of(mesh_models(prototype.both_halves, point, initial_state(prototype.both_halves, point)))


def _point(prototype: Prototype) -> tuple[Rig, OperatingPoint]:
    return prototype.simulated, _loaded(TOP_SPEED)


def speed_sweep(
    prototype: Prototype,
    laws: Sequence[MeshLaw],
    speeds: Array,
    methods: tuple[Method, ...] = BOTH,
    drivetrain: DrivetrainOverSpeed | None = None,
) -> SpeedSweep:
    """Periodic response of P2's rig over ``speeds`` [rpm] at 180 N m, without the speeds that find none.

    drivetrain : in place of the one whose shafts only twist
    """
    rig, point = _point(prototype)
    system = drivetrain or rig.system
    assert system is not None
    curve = periodic_response(
        system,
        laws,
        speeds * RPM,
        LoopLoad(torque=signed_torque(rig, point)),
        settings=SweepSettings(methods=methods),
    )
    points = curve.points
    return SpeedSweep(
        speed=np.round(curve.speeds / RPM, 6),
        factor=np.array([p.dynamic_factor for p in points]),
        half=np.array([p.dynamic_factor_half_peak_to_peak for p in points]),
        mean=np.array([p.mean for p in points]),
        drive=np.array([p.drive_torque for p in points]),
        missing=tuple(speed / RPM for speed, _ in curve.failed),
    )


def bending_loop(rig: Rig) -> DrivetrainOverSpeed:
    """Drivetrain of a rig with shafts that bend in bearings of stated stiffness, gyroscopic moments by speed."""
    edges = np.geomspace(500.0, TOP_SPEED, 9)
    middles = np.sqrt(edges[1:] * edges[:-1])
    start = initial_state(rig, _loaded(TOP_SPEED))
    return SpeedBands(
        limits=tuple(rig.pinion_speed(float(edge) * RPM) for edge in edges[1:-1]),
        systems=tuple(
            rig.elastic.seen.system(running_state(rig, _loaded(float(speed)), start, {})) for speed in middles
        ),
    )


def loop_modes_at(rig: Rig, speed: float, laws: Sequence[MeshLaw]) -> tuple[LoopMode, ...]:
    """Modes of the same closed loop at a speed [rpm]."""
    point = _loaded(speed)
    state = running_state(rig, point, initial_state(rig, point), {})
    return elastic_loop_modes(rig.elastic.seen, state, laws, DEFAULT_CUTOFF)


def _loaded(speed: float) -> OperatingPoint:
    """P2's torque at a speed [rpm]."""
    return OperatingPoint(stage="P2", speed=speed * RPM, torque=TEST_TORQUE)


def corner_gaps(models: Sequence[MeshModel], factor: float) -> list[MeshLaw]:
    """The laws with the gap at the tip corners beyond the active path times a factor."""
    laws = []
    for model in models:
        law = model.law
        path: Array = law.path_start + law.path_step * np.arange(law.gap.shape[1], dtype=np.float64)
        laws.append(law._replace(gap=law.gap + (factor - 1.0) * tip_separation(model.pair, path)))
    return laws


def damped(laws: Sequence[MeshLaw], damping: float) -> list[MeshLaw]:
    """The laws with another mesh damping [N s/m]."""
    return [law._replace(damping=damping) for law in laws]


def closing(laws: Sequence[MeshLaw]) -> list[MeshLaw]:
    """The laws with their dampers on the closing rate of the contacts."""
    return [law._replace(damping_acts_on="contact_closing_rate") for law in laws]


def reshaped(
    prototype: Prototype,
    models: Sequence[MeshModel],
    *,
    crowned: bool = True,
    engagement: Literal["corner", "path"] = "corner",
) -> list[MeshLaw]:
    """The laws without crowning, or with pairs that carry on the active path only."""
    rig = prototype.simulated
    laws = []
    for model in models:
        first, second = mesh_microgeometry(rig, model.name, model.pair)
        if not crowned:
            first, second = (replace(m, profile_crowning=0.0, lead_crowning=0.0) for m in (first, second))
        laws.append(
            mesh_law(
                model.pair,
                model.stiffness,
                micro=(first, second),
                dissipation=MeshDissipation(
                    damping=model.law.damping,
                    damping_acts_on=model.law.damping_acts_on,
                    friction=model.law.friction,
                ),
                discretisation=ContactDiscretisation(
                    n_slices=len(model.law.slice_shift), engagement=engagement
                ),
            )
        )
    return laws


def smooth(law: MeshLaw) -> MeshLaw:
    """The same mesh without excitation: one pair of the mean stiffness at every angle, no friction."""
    return law._replace(
        path_start=0.0,
        path_step=law.base_pitch / 4,
        stiffness=np.full((1, 5), law.mean_stiffness),
        gap=np.zeros((1, 5)),
        slice_shift=np.zeros(1),
        slice_face=np.zeros(1),
        deviation_1=np.zeros((1, 5)),
        deviation_2=np.zeros((1, 5)),
        back_deviation_1=None,
        back_deviation_2=None,
        friction=0.0,
    )
