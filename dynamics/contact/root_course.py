"""Stress in the root fillets of a tooth over its way through the mesh, by its own force and those of its neighbours."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from dynamics.contact.compliance import InterpolatedCompliance
from dynamics.contact.mesh_cycle import MeshCycle

Array = NDArray[np.float64]


class RootNumbers(Protocol):
    """Stress at the fillets per force on a tooth; see `dynamics.influence.numbers.InfluenceNumbers`."""

    @property
    def stress(self) -> Mapping[tuple[int, int], Array]:
        """(tooth offset, side) -> (n_r n_f, n_p n_f) stress at tooth k per force on tooth 0 [Pa/N]."""

    @property
    def face(self) -> Array:
        """(n_f,) positions over the face [m]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class RootCourse:
    """Stress of one tooth across the fillet, plane stress in its free surface.

    path : (n_path,) path position of the tooth's own pair at mid-face, growing [m]; it comes in and goes out far beyond
        the path, while its neighbours carry
    face : (n_f,) from mid-face [m]; stress : (n_path, n_r, n_f) at the points of the fillet [Pa]
    """

    path: Array
    face: Array
    stress: Array

    def within(self, points: NDArray[np.bool_]) -> "RootCourse":
        """The same at some points of the fillet (n_r,)."""
        return replace(self, stress=self.stress[:, points])

    def turned(self) -> "RootCourse":
        """The same with the face counted from its other end."""
        return replace(self, face=-self.face[::-1], stress=self.stress[:, :, ::-1])

    @property
    def highest(self) -> float:
        """Largest tension [Pa]."""
        return float(self.stress.max())

    @property
    def highest_at(self) -> tuple[int, int, int]:
        """Where it is: numbers of path position, point of the fillet and face position."""
        first, point, face = np.unravel_index(int(self.stress.argmax()), self.stress.shape)
        return int(first), int(point), int(face)

    @property
    def stress_ratio(self) -> float:
        """R: lowest over highest stress at the place of the highest [-]; what the body holds at rest is not in it."""
        _, point, face = self.highest_at
        course = self.stress[:, point, face]
        return float(course.min() / course.max())


def root_course(
    cycle: MeshCycle,
    numbers: RootNumbers,
    compliance: InterpolatedCompliance,
    gear: Literal[0, 1],
    side: Literal[1, -1] = 1,
) -> RootCourse:
    """Stress over a mesh cycle, put together over all tooth pairs.

    numbers, compliance : of the pinion (0) or wheel (1), on the same grid
    side : 1 the fillet under the loaded flank, -1 the other
    """
    points = cycle.points
    n, n_pairs, _ = cycle.force.shape
    n_f = len(numbers.face)
    spread = np.stack([_spread(cycle, compliance, gear, pair) for pair in range(n_pairs)])
    sense = -1 if gear == 0 else 1
    stress = np.zeros((n_pairs, n, *_shape(numbers, n_f)))
    for own in range(n_pairs):
        for loaded in range(n_pairs):
            # pinion teeth of later pairs stand behind the loaded flank, wheel teeth before it
            offset = sense * int(points.pairs[own] - points.pairs[loaded])
            block = numbers.stress.get((offset, side))
            if block is not None:
                stress[own] += (spread[loaded] @ block.T).reshape(n, -1, n_f)
    path = (points.position - points.pair.base_pitch * points.pairs[:, None])[::-1].ravel()
    return RootCourse(path=path, face=numbers.face, stress=stress[::-1].reshape(len(path), -1, n_f))


def _shape(numbers: RootNumbers, n_f: int) -> tuple[int, int]:
    return len(numbers.stress[0, 1]) // n_f, n_f


def _spread(cycle: MeshCycle, compliance: InterpolatedCompliance, gear: int, pair: int) -> Array:
    """Forces of a tooth pair on the grid of the influence numbers (n_positions, n_p n_f) [N]."""
    roll = cycle.points.place.roll[gear][:, pair]
    face = np.broadcast_to(cycle.points.grid.position, roll.shape)
    shapes = compliance.shapes(roll.ravel(), face.ravel()).reshape(*roll.shape, -1)
    return np.asarray(np.einsum("kz,kzg->kg", cycle.force[:, pair], shapes))
