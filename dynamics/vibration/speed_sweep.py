"""Periodic response of the loop over speed, by harmonic balance where it may be trusted, else in time.

Harmonic balance is used where its harmonics reach 1.5 times the highest oscillating mode that the propagator
keeps. It follows the stable branches over the speeds (``dynamics.vibration.harmonic_branches``): a walk in the order
given, round turning points by arclength, and back for a second stable response. Where no mesh-periodic response lasts,
``dynamics.vibration.steady_motion`` marches in time and says what the motion is: steady, subharmonic,
quasi-periodic or chaotic.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError, DynamicsNotConverged
from dynamics.rotor.linear_system import DrivetrainOverSpeed
from dynamics.rotor.static_loop import LoopLoad, port_model
from dynamics.tooth.law import MeshLaw
from dynamics.vibration.harmonic_balance import BalanceProblem, HarmonicSolution
from dynamics.vibration.harmonic_branches import BranchSearch, HarmonicStates
from dynamics.vibration.initial_state import pinion_ratios
from dynamics.vibration.modal_model import DEFAULT_CUTOFF
from dynamics.vibration.response_curve import CurvePoint, Method, ResponseCurve, point_in_time, point_of
from dynamics.vibration.speed_continuation import LEAST_HARMONICS, HarmonicWalk, mesh_cells
from dynamics.vibration.steady_motion import Period, TimeIntegration, TimeSettings

Array = NDArray[np.float64]
DragTorques = Mapping[str, float] | Callable[[float], Mapping[str, float]] | None


LONG_SEARCH, SHORT_SEARCH = 2.0, 0.5
"""Simulated time in which a steady state is sought at most [s]; the short one where none of the asked period exists."""


@dataclass(frozen=True, kw_only=True)
class SweepSettings:
    """Numerics of a periodic response over speed.

    period : one mesh, one revolution of the pinion of the control mesh, or until the same teeth meet in all meshes
    cutoff : highest mode that counts [Hz]; harmonics must reach 1.5 times the highest mode below it
    tolerance : of the harmonic balance, error of the approach over its mean [-]
    methods : what may be used, tried in this order at every speed
    branches : trace branches round their turning points and look for a second stable response; without it the harmonic
        balance walks from speed to speed, both ways, and keeps what is stable
    harmonics : of the common mesh period at least, whatever the highest mode asks for
    start : state of a loop that differs little at the first speed, from which the walk begins; left out, it begins
        with the loop that rotates slowly
    """

    period: Period = "mesh"
    cutoff: float = DEFAULT_CUTOFF
    tolerance: float = 1e-5
    methods: Sequence[Method] = ("harmonic_balance", "time_integration")
    branches: bool = True
    harmonics: int = LEAST_HARMONICS
    start: HarmonicSolution | None = None


DEFAULT_SWEEP = SweepSettings()


def periodic_response(
    drivetrain: DrivetrainOverSpeed,
    laws: Sequence[MeshLaw],
    speeds: Sequence[float] | Array,
    load: LoopLoad,
    drag_torques: DragTorques = None,
    settings: SweepSettings = DEFAULT_SWEEP,
) -> ResponseCurve:
    """Steady state over speed with contact loss, both meshes coupled.

    Parameters
    ----------
    drivetrain : without its meshes, the same matrices at all speeds (a ``LinearSystem``) or by ``SpeedBands``
    laws : of the meshes, in the order of ``mesh_ports``
    speeds : mean speeds of the pinion of the first mesh [rad/s], > 0, in the order in which they are walked
    load : mean torque at the pinion of a mesh, along which the bracing twist is solved, or the twist that is held
    drag_torques : torque by name of ``system.drag_loads`` [N m], or a function of the speed that gives it
    settings : period, modes that count, tolerance and methods

    Returns
    -------
    ResponseCurve
        With a reason for every speed without a point; no speed raises because it did not converge.

    Raises
    ------
    DynamicsInputError
        If a speed is not positive, time integration is to control another mesh than the first, or the mesh
        frequencies have no common period.
    """
    if any(not speed > 0.0 for speed in speeds):
        raise DynamicsInputError(
            f"speeds: {min(speeds)} rad/s: must be above 0; leave standstill to the static state"
        )
    if "time_integration" in settings.methods and load.control_mesh != 0:
        raise DynamicsInputError(
            f"control_mesh = {load.control_mesh}: time integration controls mesh 0; use harmonic balance alone"
        )
    given = [float(speed) for speed in speeds]
    loops = _Loops(drivetrain, laws, load, settings)
    states = HarmonicStates(reasons=dict.fromkeys(range(len(given)), ""))
    if given and "harmonic_balance" in settings.methods:
        states = _by_harmonics(loops, given, drag_torques)
    points = {i: point_of(loops.problem(given[i]).model, state) for i, state in states.solved.items()}
    other = {i: point_of(loops.problem(given[i]).model, state) for i, state in states.other.items()}
    reasons = states.reasons
    if "time_integration" in settings.methods:
        for i, reason in reasons.items():
            drags = drag_torques(given[i]) if callable(drag_torques) else drag_torques
            try:
                longest = SHORT_SEARCH if i in states.not_mesh_periodic else LONG_SEARCH
                points[i] = _in_time(loops, given[i], drags, longest)
            except DynamicsNotConverged as also:
                reasons[i] = "; ".join(filter(None, (reason, str(also))))
    return ResponseCurve(
        points=tuple(points[i] for i in sorted(points)),
        failed=tuple((given[i], reasons[i]) for i in range(len(given)) if i not in points),
        other_branch=tuple(other[i] for i in sorted(other)),
        unstable=tuple(given[i] for i in sorted(states.unstable) if i not in points),
    )


def refined_response(
    solve: Callable[[Sequence[float]], ResponseCurve],
    speeds: Sequence[float] | Array,
    *,
    bend: float = 0.02,
    rounds: int = 3,
) -> ResponseCurve:
    """Response over rising speeds with points put in wherever the curve bends, so that no peak is cut off.

    At every speed at which the half peak-to-peak over the mean torque of a mesh leaves the straight line
    between its neighbours by more than ``bend`` [-], both intervals are halved, and again up to ``rounds`` times.

    Parameters
    ----------
    solve : response at given rising speeds [rad/s], e.g. `periodic_response` with all else fixed
    speeds : first grid [rad/s], rising
    bend : least distance from the straight line that calls for a further point [-]
    rounds : halvings at most
    """
    curve = solve([float(speed) for speed in speeds])
    points = {point.speed: point for point in curve.points}
    failed = dict(curve.failed)
    other = {point.speed: point for point in curve.other_branch}
    unstable = set(curve.unstable)
    for _ in range(rounds):
        wanted = sorted(_between(sorted(points.values(), key=lambda point: point.speed), bend) - set(failed))
        if not wanted:
            break
        more = solve(wanted)
        points |= {point.speed: point for point in more.points}
        failed |= dict(more.failed)
        other |= {point.speed: point for point in more.other_branch}
        unstable |= set(more.unstable)
    return ResponseCurve(
        points=tuple(points[speed] for speed in sorted(points)),
        failed=tuple(sorted(failed.items())),
        other_branch=tuple(other[speed] for speed in sorted(other)),
        unstable=tuple(sorted(unstable)),
    )


def _between(points: Sequence[CurvePoint], bend: float) -> set[float]:
    """Middles of the intervals on both sides of every bend."""
    if len(points) < 3:
        return set()
    speed = np.array([point.speed for point in points])
    share = np.array([point.dynamic_factor_half_peak_to_peak for point in points]).T
    ahead = (speed[1:-1] - speed[:-2]) / (speed[2:] - speed[:-2])
    straight = share[:, :-2] * (1.0 - ahead) + share[:, 2:] * ahead
    bends = np.flatnonzero((np.abs(share[:, 1:-1] - straight) > bend).any(axis=0)) + 1
    return {float(0.5 * (speed[i] + speed[i + 1])) for b in bends for i in (b - 1, b)}


class _Loops:
    """The loop at each speed band: what harmonic balance and time integration solve, made once each."""

    def __init__(
        self,
        drivetrain: DrivetrainOverSpeed,
        laws: Sequence[MeshLaw],
        load: LoopLoad,
        settings: SweepSettings,
    ) -> None:
        self.drivetrain, self.laws, self.load, self.settings = drivetrain, laws, load, settings
        self._problems: dict[int, BalanceProblem] = {}
        self._solvers: dict[tuple[int, float], TimeIntegration] = {}

    def problem(self, speed: float) -> BalanceProblem:
        """Harmonic balance at a speed of the first pinion [rad/s]."""
        system = self.drivetrain.at(speed)
        if id(system) not in self._problems:
            ratios = pinion_ratios(system, self.laws)
            self._problems[id(system)] = BalanceProblem(
                model=port_model(system, self.laws),
                form=system.form,
                load=self.load,
                periodic_loads=system.periodic_loads,
                ratios=ratios / ratios[system.drive_dof] if system.periodic_loads else None,
            )
        return self._problems[id(system)]

    def solver(self, speed: float, longest: float) -> TimeIntegration:
        """Time integration at a speed of the first pinion [rad/s] for ``longest`` [s] at most."""
        system = self.drivetrain.at(speed)
        if (id(system), longest) not in self._solvers:
            settings = TimeSettings(
                period=self.settings.period, cutoff=self.settings.cutoff, longest_time=longest
            )
            self._solvers[id(system), longest] = TimeIntegration(system, self.laws, settings)
        return self._solvers[id(system), longest]


def _by_harmonics(loops: _Loops, speeds: Sequence[float], drags: DragTorques) -> HarmonicStates:
    """States by index on stable branches, see `BranchSearch`."""
    settings = loops.settings
    walk = HarmonicWalk(
        loops.problem(speeds[0]), settings.period, settings.cutoff, settings.tolerance, settings.harmonics
    )
    ratio = float(walk.problem.model.ratios[0])
    search = BranchSearch(
        walk,
        lambda speed: loops.problem(speed * ratio),
        lambda speed: drags(speed * ratio) if callable(drags) else drags,
        np.array(speeds) / ratio,
        _with_twist(settings.start, loops.load),
    )
    return search.run() if settings.branches else search.on_one_branch()


def _with_twist(start: HarmonicSolution | None, load: LoopLoad) -> HarmonicSolution | None:
    """A start with the twist that is held: Newton steps leave it as it is."""
    return start if start is None or load.twist is None else replace(start, twist=load.twist)


def _in_time(loops: _Loops, speed: float, drags: Mapping[str, float] | None, longest: float) -> CurvePoint:
    """The response to which a march comes; over one mesh it may be subharmonic, or not repeat at all, and says so."""
    solver = loops.solver(speed, longest)
    result = solver.periodic(speed, loops.load, drags)
    model = loops.problem(speed).model
    cells = mesh_cells(model, loops.settings.period, loops.load.control_mesh)[0]
    if loops.settings.period == "mesh":
        return point_in_time(model, result, cells * round(result.period * speed / solver.turns))
    if not result.steady:
        raise DynamicsNotConverged("; ".join(result.warnings))
    return point_in_time(model, result, cells)
