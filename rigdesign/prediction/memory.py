"""Parts of a pass that remember: bearing films, meshes and responses whose inputs were met before.

A remembered part is the same numbers, only not computed twice. Films are known by all numbers that enter them.
Meshes and responses follow so many keys of a case that they are known by the whole case but for the films of its
housings: a change that only touches those finds them again.
"""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from dynamics.journal_bearing import BearingState, solve_bearing
from dynamics.response_curve import CurvePoint
from rigdesign.bearing_films import solve_bearings
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.model import Case, Origin
from rigdesign.loads import MeshModel, Setting, mesh_models, respond
from rigdesign.passes import Parts
from rigdesign.rig.model import Rig
from rigdesign.state import Feedback, OperatingPoint

MOST_FILMS = 4000
MOST_STATES = 400
"""Entries kept; all are forgotten when one more comes."""
_NOWHERE = Origin(path=Path(), tree={}, marks=())
"""In place of file and marks, which say where a value is from and not what it is."""
_TOKEN = "prediction_token"
"""Under which a rig knows the number of its case without the films of its housings."""

ARROWS = ("gear_temperature", "centre_distance", "oil_outlet", "mesh_torque", "tooth_growth")
"""Arrows of the loop that a mesh may follow; the others are of bearings and oil."""


class Memory:
    """What passes of one rig and its variants found out."""

    def __init__(self) -> None:
        self._cases: list[Case] = []
        self._films: dict[Any, BearingState] = {}
        self._meshes: dict[Any, tuple[MeshModel, ...]] = {}
        self._responses: dict[Any, tuple[tuple[MeshModel, ...], CurvePoint]] = {}

    @property
    def parts(self) -> Parts:
        """The parts of a pass that remember."""
        return Parts(models=self.models, bearings=self.bearings, response=self.response)

    def bearings(self, rig: Rig, point: OperatingPoint, feedback: Feedback) -> dict[str, BearingState]:
        """As `solve_bearings`."""
        return solve_bearings(rig, point, feedback, self._film)

    def _film(self, *given: Any, **named: Any) -> BearingState:
        key = (given, tuple(named.items()))
        if key not in self._films:
            if len(self._films) >= MOST_FILMS:
                self._films.clear()
            self._films[key] = solve_bearing(*given, **named)
        return self._films[key]

    def models(self, rig: Rig, point: OperatingPoint, feedback: Feedback) -> tuple[MeshModel, ...]:
        """As `mesh_models`."""
        arrows = tuple(tuple(getattr(feedback, name).items()) for name in ARROWS)
        key = (self._token(rig), point, arrows)
        if key not in self._meshes:
            if len(self._meshes) >= MOST_STATES:
                self._meshes.clear()
            self._meshes[key] = mesh_models(rig, point, feedback)
        return self._meshes[key]

    def response(
        self,
        rig: Rig,
        point: OperatingPoint,
        models: tuple[MeshModel, ...],
        drags: Mapping[str, float],
        setting: Setting,
    ) -> CurvePoint:
        """As `respond`."""
        key = (self._token(rig), point, id(models), tuple(drags.items()), setting)
        if key not in self._responses:
            if len(self._responses) >= MOST_STATES:
                self._responses.clear()
            self._responses[key] = models, respond(rig, point, models, drags, setting)
        return self._responses[key][1]

    def _token(self, rig: Rig) -> int:
        """Number of the case of a rig, the same for cases that differ in films of housings only."""
        if _TOKEN not in rig.__dict__:
            bare = _bare(rig.case)
            if bare not in self._cases:
                self._cases.append(bare)
            rig.__dict__[_TOKEN] = self._cases.index(bare)
        return int(rig.__dict__[_TOKEN])


def _bare(case: Case) -> Case:
    """The case without the films of its housings."""
    boxes = {name: _without_films(box) for name, box in case.gearboxes.items()}
    bare = case.model_copy(update={"gearboxes": boxes})
    bare._origin = _NOWHERE
    return bare


def _without_films(box: Gearbox) -> Gearbox:
    if box.housing is None:
        return box
    return box.model_copy(update={"housing": box.housing.model_copy(update={"boundary": {}})})


def balanced(response: CurvePoint, rig: Rig, speed: float, braked: float) -> CurvePoint:
    """A response whose motor pays for ``braked`` [W] more: the loop itself hardly feels a drag."""
    return replace(response, drive_torque=response.drive_torque + braked / rig.drive_speed(speed))
