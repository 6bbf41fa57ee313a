"""Stress in both root fillets of one tooth over a turn of its gear, through all meshes that the gear is in."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import pi
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Fillet = Literal["leading", "trailing"]
"""Under the flank that faces the rotation, or under the other."""
OTHER: Mapping[Fillet, Fillet] = {"leading": "trailing", "trailing": "leading"}
PASS_POINTS = 241
"""Points of a turn on the way through one mesh."""


@dataclass(frozen=True, kw_only=True, eq=False)
class ToothPass:
    """A tooth on its way through one mesh.

    angle : (n,) rotation of the gear, growing [rad]
    loaded : which flank carries
    leading, trailing : (n, n_r, n_f) stress at the points of the fillet under the flank that faces the rotation, and
        of that under the other flank [Pa]
    """

    angle: Array
    loaded: Fillet
    leading: Array
    trailing: Array

    @property
    def window(self) -> Array:
        """Rotations of the pass and the free ones before and after it [rad]."""
        inside = np.linspace(self.angle[0], self.angle[-1], PASS_POINTS)
        step = inside[1] - inside[0]
        return np.concatenate(([inside[0] - step], inside, [inside[-1] + step]))

    def of(self, fillet: Fillet) -> Array:
        """Stress of one fillet."""
        return self.leading if fillet == "leading" else self.trailing

    def at(self, fillet: Fillet, place: tuple[int, int], angle: Array) -> Array:
        """Stress at one point of a fillet over rotations of the same turn or others, shape of ``angle``; 0 outside."""
        table = self.of(fillet)
        turned = self.angle[0] + np.mod(angle - self.angle[0], 2.0 * pi)
        return np.asarray(np.interp(turned, self.angle, table[:, place[0], place[1]], left=0.0, right=0.0))


@dataclass(frozen=True, kw_only=True, eq=False)
class ToothTurn:
    """Stress of one tooth over a turn at the most stressed point of each fillet.

    Where no mesh loads a flank its fillet is shown at the point of the other, which it compresses.

    angle : (n,) rotation of the gear, growing within [0, 2 pi] [rad]; leading, trailing : (n,) [Pa]
    """

    angle: Array
    leading: Array
    trailing: Array


def tooth_turn(passes: Sequence[ToothPass]) -> ToothTurn:
    """Put the ways through the meshes of a gear together; rotations are counted from one common zero.

    Raises ValueError without any.
    """
    if not passes:
        raise ValueError("a turn needs at least one way through a mesh; leave out gears that carry no load")
    windows = [one.window for one in passes]
    angle = np.unique(np.concatenate([[0.0, 2.0 * pi], *(np.mod(window, 2.0 * pi) for window in windows)]))

    loaded = {one.loaded for one in passes}
    places = {fillet: _most_stressed([one.of(fillet) for one in passes]) for fillet in loaded}

    def over_turn(fillet: Fillet) -> Array:
        place = places[fillet if fillet in loaded else OTHER[fillet]]
        return np.asarray(sum(one.at(fillet, place, angle) for one in passes))

    return ToothTurn(angle=angle, leading=over_turn("leading"), trailing=over_turn("trailing"))


def _most_stressed(tables: Sequence[Array]) -> tuple[int, int]:
    """Point of the fillet and face position of the highest tension in some passes through one fillet."""
    most = max(tables, key=lambda table: float(table.max()))
    _, point, face = np.unravel_index(int(most.argmax()), most.shape)
    return int(point), int(face)


def pitches_apart(coarse: float, fine: float, pitch: float) -> float:
    """Rotation between two meshes: ``fine`` up to whole pitches, as near as can be to ``coarse`` [rad].

    coarse : by the places of the axes; fine : by the teeth; pitch : angle of a tooth
    """
    off = (fine - coarse) / pitch
    return coarse + pitch * (off - round(off))
