"""What heats and cools the housings at any time of a phase: every operating point computed once."""

from collections.abc import Mapping, Sequence

from rigdesign.coupling.bearing_seats import WarmBearing, bearings_between
from rigdesign.coupling.loop import PointResult, governing_point
from rigdesign.coupling.point_losses import PointLosses
from rigdesign.coupling.stage_losses import stage_losses
from rigdesign.coupling.state import OperatingPoint
from rigdesign.rig.model import Rig
from rigdesign.transient.bearing_nodes import between
from rigdesign.transient.blend import blended
from rigdesign.transient.oil import oil_conditions
from rigdesign.transient.phases import Phase
from thermal.conduction.condition_checks import Condition
from thermal.transient.history import ThermalStage


class Heating:
    """Conditions of every housing over the phases; at held points those of the coupled run."""

    def __init__(self, rig: Rig, points: Sequence[PointResult]) -> None:
        self._rig = rig
        self._test = governing_point(points)
        self._states: dict[OperatingPoint, PointLosses] = {
            held.point: PointLosses(
                point=held.point,
                coupling_state=held.last.coupling_state,
                bearings=held.last.bearings,
                losses=held.last.losses,
            )
            for held in points
        }
        self._conditions: dict[tuple[str, OperatingPoint, bool], tuple[Condition, ...]] = {}

    def at(self, name: str, point: OperatingPoint, *, oil: bool) -> tuple[Condition, ...]:
        """Conditions of the housing of gearbox ``name`` at an operating point."""
        key = name, point, oil
        if key not in self._conditions:
            self._conditions[key] = oil_conditions(self._rig, name, self.state(point), oil=oil)
        return self._conditions[key]

    def state(self, point: OperatingPoint) -> PointLosses:
        """What heats the rig at an operating point."""
        if point not in self._states:
            heats = self._rig.case.losses.mesh_damping_heats_oil
            self._states[point] = stage_losses(self._rig, point, self._test, dynamic=heats)
        return self._states[point]

    def seated_bearings(
        self, name: str, phase: Phase, time: float, seats: Mapping[str, float]
    ) -> dict[str, WarmBearing]:
        """Bearings of gearbox ``name`` that conduct heat to their seats, ``time`` [s] into a phase.

        seats : their temperatures [K], by ``gearbox.bearing.seat``
        """
        before, after, share = phase.between(time)
        first, second = (self.state(knot.point).bearings for knot in (before, after))
        stars = {
            full: between(old.star, new.star, share, oil=phase.oil)
            for full, old in first.items()
            if (new := second[full]).star is not None and old.star is not None and full.split(".")[0] == name
        }
        return bearings_between(stars, seats)

    def stage(self, name: str, phase: Phase) -> ThermalStage:
        """A phase as the heat model of gearbox ``name`` takes it."""
        if len(phase.knots) == 1:
            fixed = self.at(name, phase.knots[0].point, oil=phase.oil)
            return ThermalStage(name=phase.name, duration=phase.duration, conditions=fixed)

        def conditions(time: float) -> Sequence[Condition]:
            before, after, share = phase.between(time)
            first, second = (self.at(name, knot.point, oil=phase.oil) for knot in (before, after))
            return blended(first, second, share)

        return ThermalStage(name=phase.name, duration=phase.duration, conditions=conditions)
