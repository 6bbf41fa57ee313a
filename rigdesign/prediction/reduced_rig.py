"""A rig with reduced housings at its operating conditions: the model behind a `Predictor`."""

from collections.abc import Mapping, Sequence
from itertools import islice

import numpy as np

from rigdesign.base.fidelity import Fidelity
from rigdesign.case.model import Case
from rigdesign.coupling.acceleration import PlainRelaxation
from rigdesign.coupling.convergence import CaseTolerances
from rigdesign.coupling.fixed_point import iterations
from rigdesign.coupling.initial_state import initial_state
from rigdesign.coupling.iteration import PointProblem
from rigdesign.coupling.state import CouplingState
from rigdesign.prediction.condition_steps import distance, furthest_apart
from rigdesign.prediction.converged_point import ConvergedPoint, converge_point
from rigdesign.prediction.full import standing_values
from rigdesign.prediction.housings import HousingNumbers, ReducedHousings
from rigdesign.prediction.memoisation import Memoisation
from rigdesign.prediction.model import Channel, OperatingCondition, PredictionModel
from rigdesign.prediction.operating import modelled_rig, operating_point, rig_at
from rigdesign.prediction.places import Weights, place_weights
from rigdesign.prediction.readings import readings
from rigdesign.prediction.slow_response import AT_ANY_SPEED
from rigdesign.rig.model import Rig
from thermal.conduction.condition_checks import Condition
from thermal.fe.mesh import FloatArray

STATES = 2
"""Operating conditions whose boundary conditions the reduced basis is made from."""
STATE_ITERATIONS = 2
"""Iterations of the full model after which those boundary conditions are taken."""


class ReducedRig:
    """A rig at fixed operating conditions and channels, its housings in the reduced thermal model.

    housings : numbers of the reduced housings, where they are known

    Attributes
    ----------
    stated : the rig of the case as it stands; rigs : it at every operating condition
    reads : readings of the channels that are read at operating points
    """

    def __init__(
        self,
        case: Case,
        conditions: Sequence[OperatingCondition],
        channels: Sequence[Channel],
        circuit: PredictionModel,
        fidelity: Fidelity,
        housings: Mapping[str, HousingNumbers] | None = None,
    ) -> None:
        self.conditions, self.channels = conditions, channels
        self.stated = modelled_rig(case, fidelity, circuit)
        self.reads = readings(self.stated, channels)
        if housings is None:
            self.housings = ReducedHousings(self.stated, self._boundary_conditions(), self._sensors())
        else:
            self.housings = ReducedHousings.of_numbers(self.stated, housings)
        self.memoisation = Memoisation()
        self._parts = self.housings.parts(self.memoisation.parts)
        self._initial: dict[str, CouplingState] = {}
        self.rigs = [rig_at(self.stated, condition) for condition in conditions]

    def converged_base(self, starts: Sequence[CouplingState] = ()) -> list[ConvergedPoint]:
        """All operating points of the stated rig, each from the nearest one that has converged.

        starts : their coupling states, where they are known
        """
        points: list[ConvergedPoint] = []
        for index, condition in enumerate(self.conditions):
            problem = self.problem(self.rigs[index], condition)
            if starts:
                points.append(converge_point(problem, start=starts[index]))
                continue
            near = min(range(index), key=lambda i: distance(self.conditions[i], condition), default=None)
            points.append(converge_point(problem, None if near is None else points[near]))
        self.memoisation.start_from(point.last for point in points)
        self._initial |= {point.last.point.stage: point.problem.initial for point in points}
        return points

    def problem(self, rig: Rig, condition: OperatingCondition) -> PointProblem:
        """The coupled problem of a rig at an operating condition it is already set to."""
        return PointProblem.braced(rig, operating_point(condition), self._parts)

    def changed_problem(self, rig: Rig, condition: OperatingCondition) -> PointProblem:
        """The coupled problem of a changed rig at an operating condition; its bracing is looked up where it was met.

        Its initial state is that of the stated rig where nothing is braced in it.
        """
        here, point = rig_at(rig, condition), operating_point(condition)
        power = rig.case.drivetrain
        held = power is not None and power.bracing.mode != "torque_controlled"
        known = None if held else self._initial.get(condition.name)
        initial = known or initial_state(here, point, self.memoisation.bearings)
        return PointProblem(
            rig=here,
            point=point,
            initial=initial,
            bracing=self.memoisation.bracing(here, point, initial),
            parts=self._parts,
        )

    def values(self, rig: Rig, rigs: Sequence[Rig], points: Sequence[ConvergedPoint]) -> FloatArray:
        """(n_features,) numbers of converged points of ``rigs``; standing quantities of ``rig``."""
        numbers: list[float] = []
        for here, point in zip(rigs, points, strict=True):
            for _, read in self.reads:
                numbers += read(here, point.last)
        return np.array([*numbers, *self.standing_values(rig)])

    def standing_values(self, rig: Rig) -> list[float]:
        """Numbers of the channels of a rig at rest, in their order."""
        return standing_values(rig, self.channels, self.memoisation.standing_modes)

    def _sensors(self) -> dict[str, list[Weights]]:
        """Temperature channels by gearbox."""
        found: dict[str, list[Weights]] = {}
        for channel in self.channels:
            if channel.quantity == "temperature":
                name, weights = place_weights(self.stated, channel.place, channel.at)
                found.setdefault(name, []).append(weights)
        return found

    def _boundary_conditions(self) -> dict[str, list[Sequence[Condition]]]:
        """Those of every housing near the operating points that lie furthest apart."""
        found: dict[str, list[Sequence[Condition]]] = {name: [] for name in self.stated.models}
        for condition in furthest_apart(self.conditions, STATES) if found else ():
            rig = rig_at(self.stated, condition)
            problem = PointProblem.braced(rig, operating_point(condition), AT_ANY_SPEED)
            steps = iterations(problem, PlainRelaxation(), CaseTolerances(rig.case.numerics), problem.initial)
            *_, last = islice(steps, STATE_ITERATIONS)
            for name, field in last.done.fields.items():
                found[name].append(field.conditions)
        return found
