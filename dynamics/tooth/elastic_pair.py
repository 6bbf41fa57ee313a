"""Mesh law of a gear pair from the influence numbers of its gears.

The law knows tooth pairs as springs in parallel, slice by slice, on gear bodies that all of them share. Its tables
are those of the loaded contact (`loaded_mesh`) about a mean load:

- body_compliance c_b: what the force on one tooth pair moves another, mean over all pairs that stand on the path
  together, over a mesh cycle, under an even load;
- stiffness: the displacement of a slice under the loads of all slices, less c_b times their force, plus the tangent of
  the local approach at the mean line load. The loads are those of the law itself, found in a few corrections from an
  even one, so that a short contact line of a helical gear is held by the free rest of its teeth. The tangent is what
  small motions about the load feel (within 1 % of the loaded contact for spur gears, 2 % for helical ones); the part of
  the approach that it leaves out, 1 um, goes into the gap. The secant, which takes the approach from zero load, is 2 to
  4 % softer under motion;
- gap: where the modified flanks touch (`touching`), beyond the path from the tip corner inwards.

What single teeth deviate stays with the law.
"""

from dataclasses import dataclass
from functools import cached_property
from math import ceil, cos
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError
from dynamics.gear.microgeometry import Microgeometry
from dynamics.gear.pair import GearPair
from dynamics.tooth.compliance import SOFT_EDGES, InterpolatedCompliance, LocalModel
from dynamics.tooth.corner import ContactPlace, Profiles, contact_places, settled, tip_ends
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.mesh_force import StaticCycle, static_cycle
from dynamics.tooth.mesh_laws import (
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
from dynamics.tooth.pair_gap import FLAWLESS, PairGap
from dynamics.tooth.points import ContactPoints, FaceGrid, contact_points, modified_gap

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
    lines: "ContactLines | None" = None,
) -> MeshLaw:
    """Mesh law of a pair from its influence numbers; other arguments as in `dynamics.tooth.mesh_laws.mesh_law`.

    lines : of the cold pair, where its law is asked for at many temperatures; None: of this pair

    Raises DynamicsInputError for an engagement other than ``corner``, or numbers that leave a pair no compliance of
    its own.
    """
    flanks = law_flanks(elastic.pair, micro, position)
    grid = _Grid(flanks, *contact_grid(elastic.pair, micro, position, discretisation))
    if lines is None:
        lines = contact_lines(elastic.pair, elastic.gears, micro, position, discretisation)
    force, line_load = lines.even, elastic.force / (grid.width * len(grid.face))
    body = lines.body
    for _ in range(LOAD_STEPS):
        springs = _springs(elastic, grid, lines.slice_compliance(force, body, grid.path), body, line_load)
        law = law_of_springs(springs, flanks, position, dissipation)
        cycle = static_cycle(_alike(law), elastic.force, CYCLE, lines.start)
        force, line_load = lines.loaded(cycle), cycle.mean_slice_force / grid.width
    scale = float(law.scale_1.mean() * law.scale_2.mean())
    of_teeth = (1.0 / float(cycle.tangent_stiffness.mean()) - body) / scale
    return law._replace(mean_stiffness=1.0 / (of_teeth + body))


def contact_lines(
    pair: GearPair,
    gears: tuple[InterpolatedCompliance, InterpolatedCompliance],
    micro: tuple[Microgeometry, Microgeometry] = FLAWLESS,
    position: MeshPosition = NOMINAL_POSITION,
    discretisation: ContactDiscretisation = DEFAULT_CONTACT,
) -> "ContactLines":
    """What the influence numbers of a pair say of its tooth pairs at all positions; arguments as in `influence_law`."""
    if discretisation.engagement != "corner":
        raise DynamicsInputError(
            f'engagement = "{discretisation.engagement}" must be "corner": influence numbers know the path beyond its '
            "ends; leave it out"
        )
    flanks = law_flanks(pair, micro, position)
    return ContactLines(_Grid(flanks, *contact_grid(pair, micro, position, discretisation)), gears)


@dataclass(frozen=True, eq=False)
class _Grid:
    """Flanks of a pair, and the grid of their law: middles of the slices (n_slices,), places (n_path,) [m]."""

    flanks: PairGap
    face: Array
    path: Array

    @property
    def width(self) -> float:
        """Width of a slice [m]."""
        return self.flanks.pair.face_width / len(self.face)

    @cached_property
    def touching(self) -> tuple[ContactPlace, Array]:
        """Where the modified flanks touch (n_slices, n_path), and the metal removed of them there [m]."""
        pair, shape = self.flanks.pair, (len(self.face), len(self.path))
        path, face = np.broadcast_to(self.path, shape), np.broadcast_to(self.face[:, None], shape)
        number, tips, gap = np.zeros(shape, np.int64), tip_ends(pair), modified_gap(self.flanks)

        def removed(rolls: tuple[Array, Array]) -> Array:
            return gap(number, face, path, rolls)

        return settled(Profiles(pair=pair, place=contact_places(pair, path, tips), tips=tips), removed)


class ContactLines:
    """All tooth pairs of a mesh cycle in slices, and what forces on the slices do to them.

    Arrays (CYCLE, n_pairs, n_slices); forces and displacements in the transverse line of action.
    even : the same force on all slices on the path, none beyond it; start : first position of pair 0 [m]
    """

    def __init__(self, grid: _Grid, gears: tuple[InterpolatedCompliance, InterpolatedCompliance]) -> None:
        pair, slices = grid.flanks.pair, len(grid.face)
        alike = all(len(gear.face) == 1 for gear in gears)
        within = 1 if alike else max(1, ceil(FACE_POINTS / slices))
        n = within * slices
        middles = ((np.arange(n) + 0.5) / n - 0.5) * pair.face_width
        points = contact_points(
            pair,
            FaceGrid(position=middles, width=np.full(n, pair.face_width / n)),
            gap=modified_gap(grid.flanks),
            n_positions=CYCLE,
            reach=float(contact_places(pair, grid.path[[0, -1]]).gap.max()),
        )
        self.start, self.pitch, self.pairs = float(points.position[0]), pair.base_pitch, points.pairs
        shape = (CYCLE, len(points.pairs), slices)
        self.path = points.path.reshape(*shape, within).mean(axis=3)
        opening = contact_places(pair, self.path).gap
        self.even = np.where(opening <= ALIKE, 1.0, 0.0)
        if not np.any(self.even.any(axis=2).sum(axis=1) > 1):
            raise DynamicsInputError(
                f"contact ratio = {pair.transverse_contact_ratio:.3f} of the pair: no two tooth pairs stand on the "
                "path together, and the influence numbers have no body to share; write "
                'drivetrain.mesh_stiffness = "iso_6336_scaled"'
            )
        # displacement of every slice by every other, and of those of one pair by each other
        self.all = np.stack([_sliced(gears, points, k, within) for k in range(CYCLE)])
        blocks = self.all.reshape(CYCLE, *shape[1:], *shape[1:])
        self.of_pair = np.einsum("kpipj->kpij", blocks).copy()
        self.no_later = opening[:, :, None, :] <= opening[:, :, :, None] + ALIKE

    @cached_property
    def body(self) -> float:
        """Compliance that the pairs share: displacement of one by another, mean over all that are on the path [m/N]."""
        force = self.even
        moved = (force * (self._by_all(force) - self._by_pair(force))).sum()
        of_pairs = force.sum(axis=2)
        return float(moved / (of_pairs.sum(axis=1) ** 2 - (of_pairs**2).sum(axis=1)).sum())

    def slice_compliance(self, force: Array, body: float, path: Array) -> Array:
        """Compliance of a slice (n_slices, n_path) under these forces, less the shared body [m/N].

        Where it carries next to nothing it is that under the least force, on all slices of its pair that open no later.
        """
        least = LEAST_SHARE * float((force**2).sum() / force.sum())
        others = self._by_all(force) - self._by_pair(force)
        of_pairs = force.sum(axis=2, keepdims=True)
        others = others - body * (of_pairs.sum(axis=1, keepdims=True) - of_pairs)
        raised = np.maximum(force[:, :, None, :], least * self.no_later)
        acting = np.einsum("kpii->kpi", raised)
        compliance = (((self.of_pair - body) * raised).sum(axis=3) + others * force / acting) / acting
        slices = compliance.shape[2]
        result = np.empty((slices, len(path)))
        for i in range(slices):
            order = np.argsort(self.path[:, :, i], axis=None)
            result[i] = np.interp(path, self.path[:, :, i].ravel()[order], compliance[:, :, i].ravel()[order])
        return result

    def loaded(self, cycle: StaticCycle) -> Array:
        """Forces of a cycle of the law at the same positions [N]."""
        place = self.start + self.pitch * (np.arange(CYCLE)[:, None] / CYCLE - self.pairs)
        column = np.rint((cycle.path[:, :1] - place) / self.pitch).astype(np.int64)
        listed = (column >= 0) & (column < cycle.path.shape[1])
        force = cycle.slice_force[np.arange(CYCLE)[:, None], np.where(listed, column, 0)]
        return np.where(listed[:, :, None], force, 0.0)

    def _by_all(self, force: Array) -> Array:
        """Displacement of every slice by all forces [m]."""
        return np.asarray((self.all @ force.reshape(CYCLE, -1, 1)).reshape(force.shape))

    def _by_pair(self, force: Array) -> Array:
        """Displacement of every slice by the forces on its own pair [m]."""
        return np.asarray((self.of_pair @ force[..., None])[..., 0])


def _sliced(
    gears: tuple[InterpolatedCompliance, InterpolatedCompliance], points: ContactPoints, k: int, within: int
) -> Array:
    """Displacement of slices by forces spread over slices at position k, along the transverse line of action [m/N]."""
    shape = points.path.shape[1:]
    number, face = np.repeat(points.pairs, shape[1]), np.tile(points.grid.position, shape[0])
    first, second = (roll[k].ravel() for roll in points.place.roll)
    matrix = gears[0].matrix(first, face, -number) + gears[1].matrix(second, face, number)
    weight = 1.0 / points.weight[k].ravel()
    n = number.size // within
    spread = (weight[:, None] * matrix * weight).reshape(n, within, n, within)
    return np.asarray(spread.mean(axis=(1, 3)))


def _springs(elastic: ElasticPair, grid: _Grid, tooth: Array, body: float, line_load: float) -> PairSprings:
    """Springs of slices with their compliance (n_slices, n_path) [m/N] at a mean transverse load per face [N/m]."""
    pair, place, removed = elastic.pair, *grid.touching
    slant = cos(pair.base_helix_angle)
    model = LocalModel(
        pair=pair, gears=elastic.gears, tips=tip_ends(pair), edges=SOFT_EDGES, line_load=line_load
    )
    local = model.at(place, np.full(tooth.shape, grid.width))
    weight = slant * place.lever[1] / pair.base_radii[1]
    normal = line_load * grid.width / weight
    a, c = local.law[..., 0], local.law[..., 1]
    secant = a - c * np.log(normal)
    tangent = elastic.linearisation == "tangent"
    compliance = tooth + (secant - c if tangent else secant) / weight**2
    if not np.all(compliance > 0.0):
        raise DynamicsInputError(
            f"influence numbers: the shared body takes {body:.3g} m/N, more than a tooth pair gives in all; "
            "build them anew"
        )
    return PairSprings(
        path=grid.path,
        face=grid.face,
        stiffness=1.0 / compliance,
        gap=place.gap + removed + (c * normal / weight if tangent else 0.0),
        # refined by the loaded cycle; here of one pair
        mean_stiffness=1.0 / (body + float((1.0 / (1.0 / compliance).sum(axis=0)).mean())),
        body_compliance=body,
    )


def _alike(law: MeshLaw) -> MeshLaw:
    """The law without what single teeth deviate."""
    none, unit = np.zeros((1, law.stiffness.shape[1])), np.ones(1)
    return law._replace(
        deviation_1=none, deviation_2=none, back_deviation_1=None, back_deviation_2=None, scale_1=unit, scale_2=unit,
        damping=0.0, friction=0.0,
    )  # fmt: skip
