"""Compliance of the flanks of one gear between points on its teeth, without the local Hertzian approach."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from math import atan, cos, pi, sin
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from dynamics.errors import DynamicsInputError
from dynamics.gear.pair import GearPair
from dynamics.tooth.corner import ContactPlace, TipEnd

Array = NDArray[np.float64]


Integers = NDArray[np.int64]

LEAST_SPLINE = 4
"""Positions over the face from which on it is interpolated by cubic splines."""
RECIPROCITY = 1e-6
"""Largest difference of two influence numbers that reciprocity makes equal, relative to the largest [-]."""


class FlankCompliance(Protocol):
    """What the contact asks of one gear.

    Teeth are numbered the way the loaded flank faces: tooth 1 is the next one that its normal points to.
    """

    @property
    def tip_roll(self) -> float:
        """Roll length at the end of the flank, at the tip edge [m]."""

    def matrix(self, roll: Array, face: Array, tooth: Integers) -> Array:
        """Return (n, n) displacement of point i along its flank normal per newton of normal force on point j [m/N].

        roll : (n,) roll lengths [m], held at the ends of the flank; face : (n,) from mid-face [m]; tooth : (n,)
        """

    def depth(self, roll: Array) -> Array:
        """Depth under the flank, along its normal in space, to which the local approach counts, like ``roll`` [m].

        The transverse distance to the tooth axis over cos(beta_b)
        """

    def excess(self, roll: Array) -> Array:
        """Addition of the tooth to the logarithm of the local approach of a half space, like ``roll`` [-]."""

    @property
    def edge_counted(self) -> bool:
        """Whether `excess` holds what the tip edge nearby adds."""


class InfluenceNumbers(Protocol):
    """Influence numbers of one gear; see `InterpolatedCompliance`."""

    @property
    def profile(self) -> Array:
        """Roll lengths (n_p,) of the grid, growing [m]."""

    @property
    def face(self) -> Array:
        """Positions (n_f,) of the grid from mid-face, growing [m]."""

    @property
    def deflection(self) -> Mapping[int, Array]:
        """Tooth offset k -> (n_p n_f, n_p n_f), face running faster: displacement of tooth k (rows) per force on
        tooth 0 (columns) [m/N]."""

    @property
    def axis_depth(self) -> Array:
        """(n_p,) transverse distance along the normal from flank to tooth axis [m]."""

    @property
    def local_excess(self) -> Array:
        """(n_p,) what the tooth adds to the logarithm of the local approach of a half space [-]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class InterpolatedCompliance:
    """Compliance between any points from influence numbers on a grid: W G W^T, cubic in roll and face.

    profile : (n_p,) roll lengths, growing, at least four [m]
    face : (n_f,) positions from mid-face, growing [m]
    deflection : tooth offset k -> (n_p n_f, n_p n_f), face running faster: displacement of tooth k (rows) per force on
        tooth 0 (columns) [m/N]; without 1 and -1 the teeth do not know of each other
    axis_depth : (n_p,) depth to which the local approach counts [m]
    local_excess : (n_p,) addition of the tooth to its logarithm [-]
    beyond : displacement of all teeth further away per force, the share of the body [m/N]
    edge_counted : the tip edge is in ``local_excess``, as finite elements have it

    The shape functions of load and displacement are the same, so that the matrix is symmetric and positive where the
    influence numbers are. Raises DynamicsInputError for arrays that do not fit each other or break reciprocity.
    """

    profile: Array
    face: Array
    deflection: Mapping[int, Array]
    axis_depth: Array
    local_excess: Array
    beyond: float = 0.0
    edge_counted: bool = True

    def __post_init__(self) -> None:
        n_p, n_f = len(self.profile), len(self.face)
        shapes = (self.axis_depth.shape, self.local_excess.shape)
        if n_p < 4 or shapes != ((n_p,), (n_p,)) or 0 not in self.deflection:
            raise DynamicsInputError(
                f"influence numbers: {n_p} profile positions, axis_depth and local_excess {shapes} and offsets "
                f"{sorted(self.deflection)} given; four positions, one depth and excess each and offset 0 are needed"
            )
        for name, grid in (("profile", self.profile), ("face", self.face)):
            if not np.all(np.diff(grid) > 0.0):
                raise DynamicsInputError(f"influence numbers: {name} must grow; sort the grid")
        scale = float(np.abs(self.deflection[0]).max())
        for offset, block in self.deflection.items():
            mirror = self.deflection.get(-offset)
            if block.shape != (n_p * n_f, n_p * n_f) or not np.all(np.isfinite(block)):
                raise DynamicsInputError(
                    f"influence numbers of offset {offset} have shape {block.shape}, expected {(n_p * n_f,) * 2} and "
                    "finite numbers"
                )
            error = np.inf if mirror is None else float(np.abs(block - mirror.T).max()) / scale
            if error > RECIPROCITY:
                raise DynamicsInputError(
                    f"influence numbers of offsets {offset} and {-offset} differ by {error:.1e} of the largest, limit "
                    f"{RECIPROCITY:.0e}: deflection[k] must be deflection[-k] transposed (reciprocity); build them anew"
                )

    @classmethod
    def of(
        cls, numbers: InfluenceNumbers, slant: float = 0.0, beyond: float = 0.0
    ) -> "InterpolatedCompliance":
        """Compliance from influence numbers; slant : base helix angle, by which depths in space are longer [rad]."""
        return cls(
            profile=numbers.profile,
            face=numbers.face,
            deflection=numbers.deflection,
            axis_depth=numbers.axis_depth / cos(slant),
            local_excess=numbers.local_excess,
            beyond=beyond,
        )

    @property
    def tip_roll(self) -> float:
        """Roll length of the last profile position [m]."""
        return float(self.profile[-1])

    @cached_property
    def _profile_shapes(self) -> CubicSpline:
        """The (n_p,) cardinal splines over the roll length."""
        return CubicSpline(self.profile, np.eye(len(self.profile)))

    @cached_property
    def _depth(self) -> CubicSpline:
        return CubicSpline(self.profile, self.axis_depth)

    @cached_property
    def _symmetric(self) -> dict[int, Array]:
        return {
            offset: 0.5 * (block + self.deflection[-offset].T) for offset, block in self.deflection.items()
        }

    def shapes(self, roll: Array, face: Array) -> Array:
        """Return W, (n, n_p n_f): share of every grid point in points at ``roll`` and ``face`` (n,) [m]."""
        along = self._profile_shapes(np.clip(roll, self.profile[0], self.profile[-1]))
        across = self._across(face)
        return np.asarray((along[:, :, None] * across[:, None, :]).reshape(len(roll), -1))

    @cached_property
    def _face_shapes(self) -> CubicSpline:
        """Splines over the face, one for each position: of a force there its parts under the hats of the positions.

        Displacements are means under hats as well. Splines that keep these means have an error of fourth order in the
        distance of the positions; the hats themselves would spread every force over two of them.
        """
        face, n = self.face, len(self.face)
        spline = CubicSpline(face, np.eye(n))
        nodes, weights = np.polynomial.legendre.leggauss(3)
        share, steps = 0.5 * (1.0 + nodes), np.diff(face)
        values = spline(face[:-1, None] + steps[:, None] * share)
        parts = 0.5 * steps[:, None] * weights
        means = np.zeros((n, n))
        means[:-1] += np.einsum("ck,ckn->cn", parts * (1.0 - share), values)
        means[1:] += np.einsum("ck,ckn->cn", parts * share, values)
        return CubicSpline(face, np.linalg.inv(means / means.sum(axis=1, keepdims=True)))

    def _across(self, face: Array) -> Array:
        """(n, n_f) parts of a force at ``face`` (n,) under the hats; fewer than four of them stay hats."""
        inside = np.clip(face, self.face[0], self.face[-1])
        if len(self.face) >= LEAST_SPLINE:
            return np.asarray(self._face_shapes(inside))
        return np.stack([np.interp(inside, self.face, hat) for hat in np.eye(len(self.face))], axis=1)

    def matrix(self, roll: Array, face: Array, tooth: Integers) -> Array:
        """Compliance (n, n) between points, see `FlankCompliance` [m/N]."""
        shapes = self.shapes(roll, face)
        result = np.full((len(roll), len(roll)), self.beyond)
        ends = np.flatnonzero(np.diff(tooth, prepend=tooth[:1] - 1, append=tooth[-1:] + 1)).tolist()
        runs = [(int(tooth[first]), slice(first, last)) for first, last in pairwise(ends)]
        for i, (loaded, columns) in enumerate(runs):
            bent = shapes[columns].T
            for moved, rows in runs[i:]:
                numbers = self._symmetric.get(moved - loaded)
                if numbers is not None:
                    result[rows, columns] = shapes[rows] @ (numbers @ bent)
                    result[columns, rows] = result[rows, columns].T
        return result

    def depth(self, roll: Array) -> Array:
        """Depth to which the local approach counts, shape of ``roll`` [m]."""
        return np.asarray(self._depth(np.clip(roll, self.profile[0], self.profile[-1])))

    def excess(self, roll: Array) -> Array:
        """Addition to the logarithm of the local approach, shape of ``roll`` [-]."""
        return np.asarray(np.interp(roll, self.profile, self.local_excess))


# Local approach of two flanks pressed together along a line, and the pressure there.
#
# In the half space: Weber's logarithmic form to the depth of the tooth axes (Weber and Banaschek, VDI 1953; Johnson,
# Contact Mechanics, 5.6). A tip edge near the contact makes the body softer: beyond the distance to the edge the stress
# spreads in the wedge between flank and tip instead of a half space. Its displacement grows with the logarithm as well,
# by a factor on the half space's that follows from Michell's wedge under a force at its apex (Timoshenko and Goodier,
# Theory of Elasticity, section 38; 3.36 for a right angle, 1 for a flat). Both logarithms are joined at the distance to
# the edge, at half of the contact half-width if the edge is nearer than that; a finite-element wedge confirms both in
# ``tests/verification/test_contact_local_approach.py``. That the effect is large close to an edge: Wang, Guo, Wong and
# Zhang, Tribology Int. 114 (2017) 358.

LEAST_EDGE = 0.02
"""Radius of an edge called sharp, in normal modules: burrs taken off (assumed)."""


@dataclass(frozen=True, kw_only=True)
class EdgeModel:
    """How tip edges act on the local approach.

    softer : the wedge between flank and tip is softer than a half space, where the compliance does not count it
    least_radius : of an edge without rounding [m]; None: 0.02 normal modules
    """

    softer: bool = True
    least_radius: float | None = None

    def __post_init__(self) -> None:
        if self.least_radius is not None and not self.least_radius > 0.0:
            raise DynamicsInputError(
                f"least_radius = {self.least_radius} m of a sharp edge must be positive; leave it out for 0.02 modules"
            )


SOFT_EDGES = EdgeModel()


def wedge_factor(angle: float) -> float:
    """Displacement of a wedge against that of the half space under the same force at its apex, normal to one face [-].

    angle : between the faces [rad], above 0. Ratio of the factors of the logarithm of the distance, plane strain.
    """
    half, lean = 0.5 * angle, 0.5 * (pi - angle)
    along, across = half + sin(half) * cos(half), half - sin(half) * cos(half)
    return 0.5 * pi * (cos(lean) ** 2 / along + sin(lean) ** 2 / across)


@dataclass(frozen=True, kw_only=True, eq=False)
class LocalContact:
    """Local approach h(F) = F (a - c ln F) of contact points, and what the pressure follows from.

    law : (n, 2) a and c with F in N [m/N]
    radius : (n,) relative radius of curvature [m]
    length : (n,) of the contact line that each point stands for [m]
    modulus : (1 - nu1^2)/E1 + (1 - nu2^2)/E2 [1/Pa]
    """

    law: Array
    radius: Array
    length: Array
    modulus: float

    def half_width(self, force: Array) -> Array:
        """Half width of the contact (n,) under normal forces (n,) [m]."""
        load = np.maximum(force, 0.0) / self.length
        return np.asarray(np.sqrt(4.0 * load * self.radius * self.modulus / pi))

    def pressure(self, force: Array) -> Array:
        """Largest Hertzian pressure (n,) under normal forces (n,) [Pa]."""
        load = np.maximum(force, 0.0) / self.length
        return np.asarray(np.sqrt(load / (pi * self.radius * self.modulus)))


def elastic_moduli(pair: GearPair) -> tuple[float, float]:
    """(1 - nu^2)/E of pinion and wheel [1/Pa]."""
    first, second = ((1.0 - nu**2) / e for nu, e in zip(pair.poisson_ratios, pair.youngs_moduli, strict=True))
    return first, second


@dataclass(frozen=True, kw_only=True, eq=False)
class LocalModel:
    """Local approach of a pair: its flanks, edges and the line load at which the width of the contact is taken.

    gears : compliance of pinion and wheel, for the depth of their teeth
    tips : ends of both flanks
    line_load : mean force per length of contact [N/m]
    """

    pair: GearPair
    gears: tuple[FlankCompliance, FlankCompliance]
    tips: tuple[TipEnd, TipEnd]
    edges: EdgeModel
    line_load: float

    def at(self, place: ContactPlace, width: Array) -> LocalContact:
        """Local contact of points (n,) that stand for face widths ``width`` (n,) [m]."""
        moduli = elastic_moduli(self.pair)
        total = sum(moduli)
        length = width / cos(self.pair.base_helix_angle)
        radius = self._radius(place)
        reference = np.sqrt(4.0 * self.line_load * radius * total / pi)
        bracket = np.zeros_like(radius)
        for index in (0, 1):
            nu, depth = self.pair.poisson_ratios[index], self.gears[index].depth(place.roll[index])
            half_space = np.log(pi * depth**2 / (radius * total)) - nu / (1.0 - nu)
            tooth = self.gears[index].excess(place.roll[index]) + self._edge(index, place, depth, reference)
            bracket += moduli[index] * (half_space + tooth)
        law = np.stack([(bracket + total * np.log(length)) / (pi * length), total / (pi * length)], axis=-1)
        return LocalContact(law=law, radius=radius, length=length, modulus=total)

    def _radius(self, place: ContactPlace) -> Array:
        """Relative radius of curvature (n,) in the normal section [m].

        At a corner it goes over from that of the flanks to that of the edge as the flank, carried on, would touch
        further from its end than a half-width.
        """
        slant = cos(self.pair.base_helix_angle)
        curvature = slant * (1.0 / place.roll[0] + 1.0 / place.roll[1] + place.bend)
        least = self.edges.least_radius or LEAST_EDGE * self.pair.normal_module
        wide = 4.0 * self.line_load * sum(elastic_moduli(self.pair)) / (pi * curvature)
        share = place.beyond**2 / (place.beyond**2 + wide)
        for index in (0, 1):
            at_corner = place.corner == 1 + index
            edge = 1.0 / max(self.tips[index].rounding, least) - slant / place.roll[index]
            curvature = curvature + np.where(at_corner, share * edge, 0.0)
        return np.asarray(1.0 / curvature)

    def _edge(self, index: int, place: ContactPlace, depth: Array, half_width: Array) -> Array:
        """Addition of the tip edge of gear ``index`` to the logarithm of the half space (n,) [-]."""
        if self.gears[index].edge_counted or not self.edges.softer:
            return np.zeros_like(depth)
        tip, base = self.tips[index], self.pair.base_radii[index]
        factor = wedge_factor(0.5 * pi + atan(tip.roll / base))
        along = np.maximum(tip.roll**2 - place.roll[index] ** 2, 0.0) / (2.0 * base) + tip.rounding
        distance = np.hypot(along, 0.5 * half_width)
        return np.asarray(2.0 * (factor - 1.0) * np.maximum(np.log(depth / distance), 0.0))
