"""Mesh law of a gear pair from the influence numbers of its gears.

The law knows tooth pairs as springs in parallel, slice by slice, on gear bodies that all of them share. Its tables
come from the loaded contact (`loaded_mesh`) under an even line load:

- body_compliance c_b: what the force on one tooth pair moves another, mean over all pairs that stand on the path
  together, over a mesh cycle;
- stiffness: the displacement of a slice under the even load on all pairs, less c_b times their force, plus the tangent
  of the local approach at the mean line load of the loaded pairs. The tangent is what small motions about the load
  feel; the part of the approach that it leaves out, 1 um at most, goes into the gap. The secant takes the approach
  from zero load instead: it is 3 % softer under motion and shares 0.01 of the force differently;
- gap: where the modified flanks touch (`touching`), beyond the path from the tip corner inwards.

Slices of a helical gear carry where their place on the path has come into contact, so that a short contact line is
held by the free rest of its teeth. What single teeth deviate stays with the law.
"""

from dataclasses import dataclass
from math import ceil, cos
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.contact.compliance import InterpolatedCompliance
from dynamics.contact.corner import contact_places, sharp_tips
from dynamics.contact.face import FaceGrid
from dynamics.contact.flank_gap import modified_gap
from dynamics.contact.local_approach import SOFT_EDGES, LocalModel
from dynamics.contact.points import ContactPoints, contact_points
from dynamics.contact.touching import Profiles, settled
from dynamics.errors import DynamicsInputError
from dynamics.flank.microgeometry import Microgeometry
from dynamics.gear.pair import GearPair
from dynamics.mesh.flank import (
    DEFAULT_CONTACT,
    LOSSLESS,
    NOMINAL_POSITION,
    ContactDiscretisation,
    MeshDissipation,
    MeshPosition,
    PairSprings,
    contact_grid,
    law_flanks,
    law_of_springs,
)
from dynamics.mesh.law import MeshLaw
from dynamics.mesh.pair_gap import FLAWLESS, PairGap
from dynamics.mesh.static_cycle import StaticCycle, static_cycle

Array = NDArray[np.float64]
Linearisation = Literal["tangent", "secant"]

CYCLE = 32
"""Positions of a mesh cycle at which the influence numbers are asked."""
FACE_POINTS = 12
"""Least points over the face at which an even load acts, several in a slice where there are few slices."""
LOAD_STEPS = 3
"""Laws of which each gives the loads for the next."""
LEAST_SHARE = 0.3
"""Least force of a slice at which it is looked at, as a share of the mean."""
ALIKE = 1e-9
"""Separation by which a point counts as in contact with one that has come in [m]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class ElasticPair:
    """A gear pair with the influence numbers of both gears.

    gears : compliance of pinion and wheel
    force : transverse mesh force at which the local approach is taken [N]
    linearisation : of the local approach
    """

    pair: GearPair
    gears: tuple[InterpolatedCompliance, InterpolatedCompliance]
    force: float
    linearisation: Linearisation = "tangent"

    def __post_init__(self) -> None:
        if not (self.force > 0.0 and np.isfinite(self.force)):
            raise DynamicsInputError(
                f"mesh force = {self.force} N must be positive; the local approach depends on it"
            )


def influence_law(
    elastic: ElasticPair,
    micro: tuple[Microgeometry, Microgeometry] = FLAWLESS,
    *,
    position: MeshPosition = NOMINAL_POSITION,
    dissipation: MeshDissipation = LOSSLESS,
    discretisation: ContactDiscretisation = DEFAULT_CONTACT,
) -> MeshLaw:
    """Mesh law of a pair from its influence numbers; other arguments as in `dynamics.mesh.flank.mesh_law`.

    Raises DynamicsInputError for an engagement other than ``corner``, or numbers that leave a pair no compliance of
    its own.
    """
    if discretisation.engagement != "corner":
        raise DynamicsInputError(
            f'engagement = "{discretisation.engagement}" must be "corner": influence numbers know the path beyond its '
            "ends; leave it out"
        )
    flanks = law_flanks(elastic.pair, micro, position)
    grid = _Grid(flanks, *contact_grid(elastic.pair, micro, position, discretisation))
    lines = _ContactLines(elastic, grid)
    force, line_load = lines.even, elastic.force / (grid.width * len(grid.face))
    for _ in range(LOAD_STEPS):
        body = lines.body(force)
        springs = _springs(elastic, grid, lines.own(force, body), body, line_load)
        law = law_of_springs(springs, flanks, position, dissipation)
        cycle = static_cycle(_alike(law), elastic.force, CYCLE, lines.start)
        force, line_load = lines.loaded(cycle), cycle.mean_slice_force / grid.width
    return law._replace(mean_stiffness=float(cycle.tangent_stiffness.mean()))


@dataclass(frozen=True, kw_only=False, eq=False)
class _Grid:
    """Flanks of a pair, and the grid of their law: middles of the slices (n_slices,), places (n_path,) [m]."""

    flanks: PairGap
    face: Array
    path: Array

    @property
    def width(self) -> float:
        """Width of a slice [m]."""
        return self.flanks.pair.face_width / len(self.face)


class _ContactLines:
    """All tooth pairs of a mesh cycle in slices, and what forces on the slices do to them.

    Arrays (CYCLE, n_pairs, n_slices); forces and displacements in the transverse line of action.
    even : the same force on all slices on the path, none beyond it; start : first position of pair 0 [m]
    """

    def __init__(self, elastic: ElasticPair, grid: _Grid) -> None:
        pair, slices = elastic.pair, len(grid.face)
        alike = all(len(gear.face) == 1 for gear in elastic.gears)
        within = 1 if alike else max(1, ceil(FACE_POINTS / slices))
        n = within * slices
        middles = ((np.arange(n) + 0.5) / n - 0.5) * pair.face_width
        reach = float(contact_places(pair, grid.path[[0, -1]]).gap.max())
        points = contact_points(
            pair,
            FaceGrid(position=middles, width=np.full(n, pair.face_width / n)),
            gap=modified_gap(grid.flanks),
            n_positions=CYCLE,
            reach=reach,
        )
        self.start, self.pitch = float(points.position[0]), pair.base_pitch
        self.grid, self.pairs = grid, points.pairs
        self.shape = (CYCLE, len(points.pairs), slices)
        self.path = points.path.reshape(*self.shape, within).mean(axis=3)
        self.opening = contact_places(pair, self.path).gap
        self.even = np.where(self.opening <= ALIKE, 1.0, 0.0)
        self.number = np.repeat(np.arange(len(points.pairs)), slices)
        self.matrices = [_sliced(elastic, points, k, within) for k in range(CYCLE)]
        if not np.any(self.even.any(axis=2).sum(axis=1) > 1):
            raise DynamicsInputError(
                f"contact ratio = {pair.transverse_contact_ratio:.3f} of the pair: no two tooth pairs stand on the "
                "path together, and the influence numbers have no body to share; use the analytic mesh law"
            )

    def body(self, force: Array) -> float:
        """Compliance that the pairs share: displacement of one by another, mean weighted by both forces [m/N]."""
        other = self.number[:, None] != self.number
        moved, forces = 0.0, 0.0
        for matrix, of_cycle in zip(self.matrices, force.reshape(CYCLE, -1), strict=True):
            product = np.outer(of_cycle, of_cycle) * other
            moved += float((product * matrix).sum())
            forces += float(product.sum())
        return moved / forces

    def own(self, force: Array, body: float) -> Array:
        """Compliance of a slice (n_slices, n_path) under these forces, less the shared body [m/N].

        Where it carries next to nothing it is that under the least force, on all slices of its pair that open no later.
        """
        least = LEAST_SHARE * float((force**2).sum() / force.sum())
        same = self.number[:, None] == self.number
        found = np.empty((CYCLE, self.number.size))
        for k, matrix in enumerate(self.matrices):
            acting, opening = force[k].ravel(), self.opening[k].ravel()
            raised = np.maximum(acting, np.where(opening <= opening[:, None] + ALIKE, least, 0.0))
            beyond = matrix - body
            own = np.diagonal(raised)
            by_others = np.where(same, 0.0, beyond) @ acting
            found[k] = ((np.where(same, beyond, 0.0) * raised).sum(axis=1) + by_others * acting / own) / own
        values, places = found.reshape(self.shape), self.path
        result = np.empty((self.shape[2], len(self.grid.path)))
        for i in range(self.shape[2]):
            order = np.argsort(places[:, :, i], axis=None)
            result[i] = np.interp(
                self.grid.path, places[:, :, i].ravel()[order], values[:, :, i].ravel()[order]
            )
        return result

    def loaded(self, cycle: StaticCycle) -> Array:
        """Forces of a cycle of the law at the same positions [N]."""
        place = self.start + self.pitch * (np.arange(CYCLE)[:, None] / CYCLE - self.pairs)
        column = np.rint((cycle.path[:, :1] - place) / self.pitch).astype(np.int64)
        listed = (column >= 0) & (column < cycle.path.shape[1])
        force = cycle.slice_force[np.arange(CYCLE)[:, None], np.where(listed, column, 0)]
        return np.where(listed[:, :, None], force, 0.0)


def _sliced(elastic: ElasticPair, points: ContactPoints, k: int, within: int) -> Array:
    """Displacement of slices by forces spread over slices at position k, along the transverse line of action [m/N]."""
    shape = points.path.shape[1:]
    number, face = np.repeat(points.pairs, shape[1]), np.tile(points.grid.position, shape[0])
    first, second = (roll[k].ravel() for roll in points.place.roll)
    matrix = elastic.gears[0].matrix(first, face, -number) + elastic.gears[1].matrix(second, face, number)
    weight = 1.0 / points.weight[k].ravel()
    n = number.size // within
    spread = (weight[:, None] * matrix * weight).reshape(n, within, n, within)
    return np.asarray(spread.mean(axis=(1, 3)))


def _springs(elastic: ElasticPair, grid: _Grid, tooth: Array, body: float, line_load: float) -> PairSprings:
    """Springs of slices with their compliance (n_slices, n_path) [m/N] at a mean transverse load per face [N/m]."""
    pair, face, path, shape = elastic.pair, grid.face, grid.path, tooth.shape
    places, across = np.broadcast_to(path, shape), np.broadcast_to(face[:, None], shape)
    number, tips = np.zeros(shape, np.int64), sharp_tips(pair)
    removed_at = modified_gap(grid.flanks)

    def removed(rolls: tuple[Array, Array]) -> Array:
        return removed_at(number, across, places, rolls)

    profiles = Profiles(pair=pair, place=contact_places(pair, places, tips), tips=tips)
    place, removed_there = settled(profiles, removed)
    slant = cos(pair.base_helix_angle)
    model = LocalModel(pair=pair, gears=elastic.gears, tips=tips, edges=SOFT_EDGES, line_load=line_load)
    local = model.at(place, np.full(shape, grid.width))
    weight = slant * place.lever[1] / pair.base_radii[1]
    normal = line_load * grid.width / weight
    a, c = local.law[..., 0], local.law[..., 1]
    secant = a - c * np.log(normal)
    tangent = elastic.linearisation == "tangent"
    own = tooth + (secant - c if tangent else secant) / weight**2
    if not np.all(own > 0.0):
        raise DynamicsInputError(
            f"influence numbers: the shared body takes {body:.3g} m/N, more than a tooth pair gives in all; "
            "build them anew"
        )
    return PairSprings(
        path=path,
        face=face,
        stiffness=1.0 / own,
        gap=place.gap + removed_there + (c * normal / weight if tangent else 0.0),
        # refined by the loaded cycle; here of one pair
        mean_stiffness=1.0 / (body + float((1.0 / (1.0 / own).sum(axis=0)).mean())),
        body_compliance=body,
    )


def _alike(law: MeshLaw) -> MeshLaw:
    """The law without what single teeth deviate."""
    none, one = np.zeros((1, law.stiffness.shape[1])), np.ones(1)
    return law._replace(
        deviation_1=none, deviation_2=none, back_deviation_1=None, back_deviation_2=None, scale_1=one, scale_2=one,
        damping=0.0, friction=0.0,
    )  # fmt: skip
