"""Root stress of the teeth of a gear from the forces of a mesh law, by influence numbers.

The forces on the slices of all tooth pairs at many states, dynamic or not, give the stress at the fillets of one tooth
over its way through the mesh: its own force and those on both neighbours. The force of a slice acts evenly over its
width, where the teeth touch at that position of the path, a tip corner included.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import ceil, cos, pi, tan
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from dynamics.gear.pair import GearPair
from dynamics.tooth.compliance import InterpolatedCompliance
from dynamics.tooth.corner import contact_places, tip_ends
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.mesh_cycle import MeshCycle
from dynamics.tooth.mesh_force import ToothForces

Array = NDArray[np.float64]


# Stress in the root fillets of a tooth over its way through the mesh, by its own force and those of its neighbours.


class RootNumbers(Protocol):
    """Stress at the fillets per force on a tooth; see `dynamics.tooth.influence_numbers.InfluenceNumbers`."""

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
    for stressed in range(n_pairs):
        for loaded in range(n_pairs):
            # pinion teeth of later pairs stand behind the loaded flank, wheel teeth before it
            offset = sense * int(points.pairs[stressed] - points.pairs[loaded])
            block = numbers.stress.get((offset, side))
            if block is not None:
                stress[stressed] += (spread[loaded] @ block.T).reshape(n, -1, n_f)
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


Gear = Literal[0, 1]
Side = Literal[1, -1]
FACE_POINTS = 12
"""Least points over the face at which the slices act, where the influence numbers know the face."""
ROWS = 100_000
"""States and tooth pairs evaluated at a time."""


@dataclass(frozen=True, eq=False)
class PairForces:
    """Forces of consecutive tooth pairs at n states on the flank that carries.

    path : (n, n_pairs) path position at mid-face, falling by a base pitch from pair to pair [m]
    force : (n, n_pairs, n_slices) in the transverse line of action [N]
    """

    path: Array
    force: Array

    @classmethod
    def of(cls, forces: ToothForces, states: slice = slice(None), *, front: bool = True) -> "PairForces":
        """Forces on the front flanks or on the back flanks.

        The back flank of a gear is the front flank of the same gear turned end for end: pairs and slices in reverse.
        """
        if front:
            return cls(forces.path[states], forces.front[states])
        return cls(forces.back_path[states][:, ::-1], forces.back[states][:, ::-1, ::-1])


@dataclass(frozen=True, kw_only=True, eq=False)
class RootField:
    """Stress at one fillet of a tooth per transverse force on a slice of its own pair or a neighbouring one.

    start, step : path positions of the table [m]; shift : (n_slices,) lag of the slices on the path [m]
    table : column -> (n_slices, n_path, n_points) stress [Pa/N] at the tooth that many pairs after the loaded one
    face : (n_f,) of the points, from mid-face [m]; n_points = n_r n_f, points of the fillet times face positions
    base_pitch : [m]
    """

    start: float
    step: float
    shift: Array
    table: Mapping[int, Array]
    face: Array
    base_pitch: float

    def within(self, points: NDArray[np.bool_]) -> "RootField":
        """The same at some points of the fillet (n_r,)."""
        kept = np.repeat(points, len(self.face))
        return replace(self, table={k: block[:, :, kept] for k, block in self.table.items()})

    def at(self, points: NDArray[np.int64]) -> "RootField":
        """The same at one point of the fillet for every face position (n_f,), given by its number."""
        kept = points * len(self.face) + np.arange(len(self.face))
        return replace(self, table={k: block[:, :, kept] for k, block in self.table.items()})

    def course(self, forces: PairForces) -> RootCourse:
        """Stress of one tooth, put together from all tooth pairs at all states.

        The teeth before the first and after the last pair are followed too: their neighbours carry.
        """
        n, pairs, _ = forces.force.shape
        ends = self.base_pitch
        path = np.concatenate((forces.path[:, :1] + ends, forces.path, forces.path[:, -1:] - ends), axis=1)
        block = max(1, ROWS // (pairs * len(self.shift)))
        stress = np.concatenate(
            [
                self._of_teeth(PairForces(forces.path[k : k + block], forces.force[k : k + block]))
                for k in range(0, n, block)
            ]
        )
        order = np.argsort(path, axis=None, kind="stable")
        return RootCourse(
            path=path.ravel()[order],
            face=self.face,
            stress=stress.reshape(path.size, -1)[order].reshape(path.size, -1, len(self.face)),
        )

    def _of_teeth(self, forces: PairForces) -> Array:
        """Stress at the teeth of all pairs and one more at each end (n, n_pairs + 2, n_points) [Pa]."""
        n, pairs, _ = forces.force.shape
        some = next(iter(self.table.values()))
        stress = np.zeros((n, pairs + 2, some.shape[2]))
        rows, columns = np.nonzero(forces.force.any(axis=2))
        acting = forces.force[rows, columns]
        slices, n_path, n_points = some.shape
        place = (forces.path[rows, columns][:, None] - self.shift - self.start) / self.step
        low = np.clip(np.floor(place).astype(np.int64), 0, n_path - 2)
        share = np.clip(place - low, 0.0, 1.0)
        first = n_path * np.arange(slices) + low
        # entries of the table and their weights, those of a loaded pair in one row
        weights = np.stack([acting * (1.0 - share), acting * share], axis=-1)
        entries = np.stack([first, first + 1], axis=-1)
        starts = 2 * slices * np.arange(len(rows) + 1)
        acts = csr_array((weights.ravel(), entries.ravel(), starts), shape=(len(rows), slices * n_path))
        for after, block in self.table.items():
            # a pair is loaded once at a state: no row and column stands twice
            stress[rows, columns + 1 + after] += acts @ block.reshape(-1, n_points)
        return stress


def root_field(
    law: MeshLaw,
    pair: GearPair,
    numbers: RootNumbers,
    compliance: InterpolatedCompliance,
    gear: Gear,
    side: Side = 1,
) -> RootField:
    """Stress numbers of pinion (0) or wheel (1) for the slices of a mesh law.

    law : its path and slices; pair : warm; numbers, compliance : of the gear, on the same grid
    side : 1 the fillet under the loaded flank, -1 the other
    """
    n_slices, n_path = law.stiffness.shape
    path = law.path_start + law.path_step * np.arange(n_path)
    n_f = len(numbers.face)
    within = 1 if n_f == 1 else max(1, ceil(FACE_POINTS / n_slices))
    width = pair.face_width / n_slices
    inside = ((np.arange(within) + 0.5) / within - 0.5) * width
    lag = inside * tan(pair.base_helix_angle)
    place = contact_places(pair, path[:, None] - lag, tip_ends(pair))
    slant = cos(pair.base_helix_angle)
    per_force = pair.base_radii[1] / (slant * place.lever[1]) / within
    middles = ((np.arange(n_slices) + 0.5) / n_slices - 0.5) * pair.face_width
    # pinion teeth of later pairs stand behind the loaded flank, wheel teeth before it
    sense = -1 if gear == 0 else 1
    blocks = {sense * k: numbers.stress[k, side] for k in (-1, 0, 1) if (k, side) in numbers.stress}
    table = {after: np.empty((n_slices, n_path, len(block))) for after, block in blocks.items()}
    for i, middle in enumerate(middles):
        face = np.broadcast_to(middle + inside, place.roll[gear].shape)
        shapes = compliance.shapes(place.roll[gear].ravel(), face.ravel()).reshape(*face.shape, -1)
        spread = np.einsum("kj,kjg->kg", per_force, shapes)
        for after, block in blocks.items():
            table[after][i] = spread @ block.T
    return RootField(
        start=law.path_start,
        step=law.path_step,
        shift=law.slice_shift,
        table=table,
        face=numbers.face,
        base_pitch=law.base_pitch,
    )


# Stress in both root fillets of one tooth over a turn of its gear, through all meshes that the gear is in.

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
    windows = [tooth_pass.window for tooth_pass in passes]
    angle = np.unique(np.concatenate([[0.0, 2.0 * pi], *(np.mod(window, 2.0 * pi) for window in windows)]))

    loaded = {tooth_pass.loaded for tooth_pass in passes}
    places = {fillet: _most_stressed([tooth_pass.of(fillet) for tooth_pass in passes]) for fillet in loaded}

    def over_turn(fillet: Fillet) -> Array:
        place = places[fillet if fillet in loaded else OTHER[fillet]]
        return np.asarray(sum(tooth_pass.at(fillet, place, angle) for tooth_pass in passes))

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
