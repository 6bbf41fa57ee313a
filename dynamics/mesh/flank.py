"""Mesh law of a gear pair from its geometry, the micro-geometry of its flanks and its stiffness."""

from dataclasses import dataclass
from math import ceil, tan
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError
from dynamics.flank.axes import AxisMisalignment
from dynamics.flank.field import FlankField, TeethInMesh, back_phase
from dynamics.flank.microgeometry import Microgeometry
from dynamics.gear.pair import GearPair
from dynamics.mesh.law import DampedRate, MeshLaw
from dynamics.mesh.pair_gap import FLAWLESS, PairGap, flank_fields
from dynamics.mesh.stiffness import PairStiffness
from dynamics.mesh.tip_contact import path_reach, tip_separation

Array = NDArray[np.float64]
Engagement = Literal["corner", "path"]

RAMP_LENGTH = 0.05
"""Length in base pitches over which pairs are let in without corner contact."""
SLICES_PER_BASE_PITCH = 8
"""Slices for every base pitch by which a helical face lags from end to end, the overlap ratio."""
LEAST_SLICES = 8
"""Slices over a face whose gap or place on the path varies."""
LEAST_DIGIT = 15
"""Decimals of the offset [m] of teeth made alike: the mean of run-outs and closed pitches is zero, not its rounding."""


@dataclass(frozen=True, kw_only=True)
class MeshPosition:
    """How the gears of a pair stand to each other.

    offset : approach of the rigid gears towards each other [m]; phase [m], tooth_offset_2 : as in ``MeshLaw``
    misalignment : gap per face width [rad], growing with z over the common width
    """

    offset: float = 0.0
    misalignment: float = 0.0
    phase: float = 0.0
    tooth_offset_2: int = 0


@dataclass(frozen=True, kw_only=True)
class MeshDissipation:
    """Damping and tooth friction of a mesh, as in ``MeshLaw``.

    damping : [N s/m]; damping_acts_on : rate that the damper follows
    friction : coefficient in the transverse plane [-]; friction_reversal_speed : sliding speed over which it
        changes sign [m/s]
    """

    damping: float = 0.0
    damping_acts_on: DampedRate = "relative_rotation"
    friction: float = 0.0
    friction_reversal_speed: float = 0.05


@dataclass(frozen=True, kw_only=True)
class ContactDiscretisation:
    """Grid of the contact over face width and path.

    n_slices : over the common face width; None: ``default_slices``
    n_path : points of the uniform grid over the path, active part and premature engagement
    reach : tip separation at the ends of the grid, the largest approach the law is good for [m]; None: 0.15 normal
        modules, at least 0.1 mm, at most 0.3 mm
    engagement : ``corner``: deflected teeth meet early at the tip corners; ``path``: pairs carry on the
        active path only, as the single-pair stiffness of the standards has it, let in over 5 % of a base pitch

    Raises DynamicsInputError for less than 1 slice or 16 points.
    """

    n_slices: int | None = None
    n_path: int = 241
    reach: float | None = None
    engagement: Engagement = "corner"

    def __post_init__(self) -> None:
        if (self.n_slices is not None and self.n_slices < 1) or self.n_path < 16:
            raise DynamicsInputError(
                f"n_slices = {self.n_slices} and n_path = {self.n_path} must be at least 1 and 16"
            )


NOMINAL_POSITION = MeshPosition()
LOSSLESS = MeshDissipation()
DEFAULT_CONTACT = ContactDiscretisation()


def mesh_law(
    pair: GearPair,
    stiffness: PairStiffness,
    micro: tuple[Microgeometry, Microgeometry] = FLAWLESS,
    *,
    position: MeshPosition = NOMINAL_POSITION,
    dissipation: MeshDissipation = LOSSLESS,
    discretisation: ContactDiscretisation = DEFAULT_CONTACT,
) -> MeshLaw:
    """Mesh law of ``pair`` with the micro-geometry of pinion and wheel.

    Parameters
    ----------
    stiffness : single-pair stiffness over the path; a slice of width db takes c'(s) db
    micro : of pinion and wheel
    position : how the gears stand to each other
    dissipation : damping and friction
    discretisation : grid over face width and path

    A pair that jams (negative backlash, see ``GearPair.warnings``) gets zero play. The one table of gaps serves both
    flanks: modifications and topography of the front flanks count on the back as well.

    Raises DynamicsInputError for arrays of another length than the tooth number or numbers below their limit.
    """
    misalignment = position.misalignment
    count = TeethInMesh(phase=position.phase, tooth_offset_2=position.tooth_offset_2)
    flanks = PairGap(
        pair=pair,
        flanks=flank_fields(pair, micro, count),
        axes=AxisMisalignment.of_gap(pair, misalignment, misalignment),
    )
    n_slices, n_path = discretisation.n_slices, discretisation.n_path
    engagement = discretisation.engagement
    slices = default_slices(pair, micro, misalignment) if n_slices is None else n_slices
    width = pair.face_width
    face = ((np.arange(slices) + 0.5) / slices - 0.5) * width
    wanted = (
        min(max(0.15 * pair.normal_module, 1e-4), 3e-4)
        if discretisation.reach is None
        else discretisation.reach
    )
    first, last = _grid_ends(pair, wanted, engagement)
    path = np.linspace(first, last, n_path)
    gap = tip_separation(pair, path) if engagement == "corner" else _ramp(pair, path, wanted)
    gap = gap + flanks.modifications(path, face[:, None])
    deviations = [_deviations(flank, path, face) for flank in flanks.flanks]
    scales = [np.array(gear.tooth_stiffness or (1.0,)) for gear in micro]
    return MeshLaw(
        base_radius_1=flanks.flanks[0].base_radius,
        base_radius_2=flanks.flanks[1].base_radius,
        base_pitch=pair.base_pitch,
        teeth_1=pair.teeth[0],
        teeth_2=pair.teeth[1],
        tooth_offset_2=position.tooth_offset_2,
        path_start=first,
        path_step=(last - first) / (n_path - 1),
        stiffness=np.tile(stiffness.at(path) * width / slices, (slices, 1)),
        gap=gap,
        slice_shift=face * tan(pair.base_helix_angle),
        deviation_1=deviations[0][0],
        deviation_2=deviations[1][0],
        scale_1=scales[0],
        scale_2=scales[1],
        backlash=max(pair.backlash_along_path, 0.0),
        offset=position.offset,
        phase=count.phase,
        back_phase=back_phase(pair, count),
        damping=dissipation.damping,
        damping_acts_on=dissipation.damping_acts_on,
        mean_stiffness=stiffness.mesh_mean * width * float(scales[0].mean() * scales[1].mean()),
        friction=dissipation.friction,
        rolling_radius_1=pair.rolling_radii[0],
        rolling_radius_2=pair.rolling_radii[1],
        friction_reversal_speed=dissipation.friction_reversal_speed,
        back_deviation_1=deviations[0][1],
        back_deviation_2=deviations[1][1],
    )


def alike_teeth(law: MeshLaw, pinion: bool = True, wheel: bool = True) -> MeshLaw:
    """The law with the teeth of pinion, wheel or both alike: the mean of their deviations and of their stiffness.

    What they have in common in front and on the back goes into the gap, half of the difference into the offset.
    """
    none, one = np.zeros((1, law.stiffness.shape[1])), np.ones(1)
    if pinion:
        law = _with_means(law, law.deviation_1, law.back_deviation_1, law.scale_1)
        law = law._replace(deviation_1=none, back_deviation_1=None, scale_1=one)
    if wheel:
        law = _with_means(law, law.deviation_2, law.back_deviation_2, law.scale_2)
        law = law._replace(deviation_2=none, back_deviation_2=None, scale_2=one)
    return law


def _with_means(law: MeshLaw, front: Array, back: Array | None, scale: Array) -> MeshLaw:
    """The law with the mean of the deviations in its gap and offset and that of the scales in its stiffness."""
    mean, ahead = front.mean(axis=0), 0.0
    if back is not None:
        behind = back.mean(axis=0)
        mean, ahead = 0.5 * (mean + behind), round(0.5 * float((behind - mean).mean()), LEAST_DIGIT)
    return law._replace(
        gap=law.gap + mean, offset=law.offset + ahead, stiffness=law.stiffness * float(scale.mean())
    )


def reach_beyond(law: MeshLaw, approach: Array) -> str:
    """What to say of an approach (n,) [m] beyond the tables of a mesh law; empty within them.

    Past the ends of the grid tooth pairs carry nothing: what the tips of deflected teeth would carry there is lost.
    """
    limit = float(np.minimum(law.gap[:, 0], law.gap[:, -1]).min())
    deepest = max(float(np.max(approach)), float(np.max(-approach)) - law.backlash)
    if deepest <= limit:
        return ""
    return (
        f"approach of the teeth = {1e6 * deepest:.0f} um, limit {1e6 * limit:.0f} um of the tables: early contact of "
        "further teeth is lost, the mesh is stiffer than computed; lower the torque or widen the reach of the law"
    )


def _grid_ends(pair: GearPair, reach: float, engagement: Engagement) -> tuple[float, float]:
    if engagement == "corner":
        return path_reach(pair, reach)
    margin = RAMP_LENGTH * pair.base_pitch
    return pair.path.start - margin, pair.path.end + margin


def _ramp(pair: GearPair, path: Array, reach: float) -> Array:
    """Gap [m] growing with the square of the distance to the active path, ``reach`` at the grid ends."""
    outside = np.maximum(np.maximum(pair.path.start - path, path - pair.path.end), 0.0)
    return np.asarray(reach * (outside / (RAMP_LENGTH * pair.base_pitch)) ** 2)


def _deviations(flank: FlankField, path: Array, face: Array) -> tuple[Array, Array | None]:
    """Gap added by each tooth of a gear in front and on the back, (teeth, n_path) or (1, n_path) [m].

    None for the back where it has the same. A topography of every tooth counts with its mean over the face.
    """
    micro = flank.micro
    measured = [own for own in (micro.topography, micro.back_topography) if own is not None and own.teeth > 1]
    moved = bool(micro.pitch_deviations) or bool(micro.run_out)
    if not moved and not micro.profile_slopes and not measured:
        return np.zeros((1, len(path))), None
    roll, tooth = flank.roll(path), np.arange(flank.teeth)[:, None]
    if measured:
        across = face[:, None, None]
        front, back = (flank.deviation(roll, across, tooth, side).mean(axis=0) for side in ("front", "back"))
        return front, back
    front = flank.deviation(roll, 0.0, tooth)
    return front, flank.deviation(roll, 0.0, tooth, "back") if moved else None


def default_slices(
    pair: GearPair, micro: tuple[Microgeometry, Microgeometry], misalignment: float = 0.0
) -> int:
    """Slices over the face width after which K_V of a mesh changes by less than 1 % with more.

    Slices of a helical gear come into mesh one by one: their sum is the integral over the face by the midpoint rule
    along the path, whose steps excite the mesh unless they are short against a base pitch. A face whose gap varies
    needs some whatever its helix. One slice is exact for a spur gear flat over its face.
    """
    flat = misalignment == 0.0 and all(gear.even_over_face for gear in micro)
    if pair.helix_angle == 0.0 and flat:
        return 1
    return max(LEAST_SLICES, ceil(SLICES_PER_BASE_PITCH * abs(pair.overlap_ratio) - 1e-9))
