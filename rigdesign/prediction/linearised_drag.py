"""A settled point whose loop changes in nothing but what brakes it: drags and the friction of its teeth.

Those move torques by a per cent or less, so that the answer of the periodic response to each of them, found once, adds
up. What leaves loop, bracing and flanks alone (losses, oil, flows, films) then needs no response of its own.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from dynamics.mesh.law import MeshLaw
from dynamics.response.speed_sweep import CurvePoint
from rigdesign.coupling.iteration import IterationParts
from rigdesign.coupling.loads import BracingState, MeshModel, signed_torque
from rigdesign.coupling.state import OperatingPoint
from rigdesign.prediction.model import ORDER_QUANTITIES, Channel
from rigdesign.prediction.readings import Reading, Settled
from rigdesign.rig.model import Rig
from thermal.fe.mesh import FloatArray

DRAG_STEP = 1.0
"""Drag from which an answer is taken [N m]."""
FRICTION_STEP = 0.4
"""Share of a friction coefficient from which its answer is taken, to both sides, with its curvature."""
SAME_BRACING = 1e-9
"""Relative difference of twists or shifts that are the same."""
LEAST_FRICTION = 0.01
"""Friction coefficient of which that share is taken at least."""

Cause = tuple[str, str]
"""``drag`` and a place of the drivetrain, or ``friction`` and a mesh."""


class LinearisedDrag:
    """Torques, losses and orders of a settled point under other drags and frictions.

    orders : channels of orders with their readings; slopes : answers by cause that are known
    already, (2, n) per size and per its square
    """

    def __init__(
        self,
        rig: Rig,
        settled: Settled,
        parts: IterationParts,
        reads: Sequence[tuple[Channel, Reading]],
        slopes: Mapping[Cause, FloatArray] | None = None,
    ) -> None:
        self.rig, self.settled, self._parts = rig, settled, parts
        self._orders = [reading for channel, reading in reads if channel.quantity in ORDER_QUANTITIES]
        self.slopes = dict(slopes or {})

    def causes(
        self,
        rig: Rig,
        point: OperatingPoint,
        models: Sequence[MeshModel],
        drags: Mapping[str, float],
        setting: BracingState,
    ) -> dict[Cause, float] | None:
        """By how much drags [N m] and frictions differ; None where more than they do."""
        last = self.settled.last
        if (
            rig.system is not self.rig.system
            or not _same_bracing(setting, self.settled.bracing)
            or rig.pinion_speed(point.speed) != self.rig.pinion_speed(last.point.speed)
            or signed_torque(rig, point) != signed_torque(self.rig, last.point)
            or not all(_alike(model.law, own.law) for model, own in zip(models, last.models))
        ):
            return None
        found: dict[Cause, float] = {}
        for place in {**last.drags, **drags}:
            found["drag", place] = drags.get(place, 0.0) - last.drags.get(place, 0.0)
        for model, own in zip(models, last.models):
            found["friction", model.name] = model.law.friction - own.law.friction
        return {cause: size for cause, size in found.items() if size != 0.0}

    def response(self, causes: Mapping[Cause, float]) -> CurvePoint:
        """The response with causes; its motion is that without."""
        base = self.settled.last.response
        assert base is not None
        if not causes:
            return base
        moved = self._moved(causes)
        n = base.mean.size
        return replace(
            base,
            mean=base.mean + moved[:n],
            friction_power=base.friction_power + moved[n : 2 * n],
            damping_power=base.damping_power + moved[2 * n : 3 * n],
            drive_torque=base.drive_torque + float(moved[3 * n]),
        )

    def orders(self, causes: Mapping[Cause, float]) -> FloatArray:
        """(n,) numbers of all channels of orders, behind each other."""
        return np.asarray((self._base + self._moved(causes))[self._first :])

    @cached_property
    def _base(self) -> FloatArray:
        return self._numbers(self.settled)

    @property
    def _first(self) -> int:
        """Place of the first number of orders, behind those of the response."""
        return 3 * len(self.settled.last.models) + 1

    def _moved(self, causes: Mapping[Cause, float]) -> FloatArray:
        moved = np.zeros(self._base.size)
        for cause, size in causes.items():
            if cause not in self.slopes:
                self.slopes[cause] = self._slope(*cause)
            slope, curvature = self.slopes[cause]
            moved += size * (slope + size * curvature)
        return moved

    def _slope(self, kind: str, place: str) -> FloatArray:
        """(2, n) answer to one newton metre of a drag or to a friction coefficient of one, and half its slope."""
        last = self.settled.last
        if kind == "drag":
            more = {**last.drags, place: last.drags.get(place, 0.0) + DRAG_STEP}
            slope = (self._solved(last.models, more) - self._base) / DRAG_STEP
            return np.stack([slope, np.zeros_like(slope)])
        number = [model.name for model in last.models].index(place)
        stated = last.models[number].law.friction
        step = FRICTION_STEP * max(stated, LEAST_FRICTION)
        sizes = np.array([-step if stated > step else 2.0 * step, step])
        moved = [
            self._solved(_rubbed(last.models, number, stated + size), last.drags) - self._base
            for size in sizes.tolist()
        ]
        return np.linalg.solve(np.stack([sizes, sizes**2], axis=1), np.array(moved))

    def _solved(self, models: tuple[MeshModel, ...], drags: Mapping[str, float]) -> FloatArray:
        last, bracing = self.settled.last, self.settled.bracing
        response = self._parts.response(self.rig, last.point, models, drags, bracing)
        done = replace(last, models=models, drags=drags, response=response)
        return self._numbers(Settled(last.point, done, bracing))

    def _numbers(self, settled: Settled) -> FloatArray:
        """Mean torques, losses, drive torque and orders."""
        response = settled.last.response
        assert response is not None
        read = [number for reading in self._orders for number in reading(self.rig, settled)]
        loop = (response.mean, response.friction_power, response.damping_power, [response.drive_torque])
        return np.concatenate([*loop, read])


def _rubbed(models: tuple[MeshModel, ...], number: int, friction: float) -> tuple[MeshModel, ...]:
    """Models with another friction coefficient in one law."""
    model = models[number]
    changed = replace(model, law=model.law._replace(friction=friction))
    return (*models[:number], changed, *models[number + 1 :])


def _same_bracing(setting: BracingState, own: BracingState | None) -> bool:
    """Whether two settings are the same but for rounding."""
    if own is None or setting.mode != own.mode:
        return False
    pairs = (setting.twist, own.twist), (setting.shift, own.shift)
    return all(abs(one - other) <= SAME_BRACING * abs(other) for one, other in pairs)


def _alike(law: MeshLaw, own: MeshLaw) -> bool:
    """Whether laws of a `Memory` differ in friction alone: arrays that are alike are the same ones."""
    return all(
        one is other or (not isinstance(one, np.ndarray) and one == other)
        for one, other in zip(law, own._replace(friction=law.friction))
    )
