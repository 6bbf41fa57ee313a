"""Mesh law of a gear pair from its geometry, the micro-geometry of its flanks and its stiffness."""

from dataclasses import dataclass
from math import ceil, pi, tan
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError
from dynamics.gear.pair import GearPair
from dynamics.mesh.law import DampedRate, MeshLaw
from dynamics.mesh.microgeometry import Microgeometry, check_microgeometry
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


IDEAL = (Microgeometry(), Microgeometry())
NOMINAL_POSITION = MeshPosition()
LOSSLESS = MeshDissipation()
DEFAULT_CONTACT = ContactDiscretisation()


def mesh_law(
    pair: GearPair,
    stiffness: PairStiffness,
    micro: tuple[Microgeometry, Microgeometry] = IDEAL,
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

    A pair that jams (negative backlash, see ``GearPair.warnings``) gets zero play. Gears of unequal thermal
    expansion keep the ratio of their tooth numbers; the difference of their base pitches becomes a gap along the
    path.

    Raises DynamicsInputError for arrays of another length than the tooth number or numbers below their limit.
    """
    for gear, teeth in zip(micro, pair.teeth, strict=True):
        check_microgeometry(gear, teeth)
    misalignment, phase = position.misalignment, position.phase
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
    gap = gap + path * pair.base_pitch_difference / pair.base_pitch
    gap = gap + misalignment * face[:, None]
    for index, gear in enumerate(micro):
        gap = gap + flank_modification(pair, gear, index, path, face)
    back_phase = pair.working_thicknesses[0] * pair.base_radii[0] / pair.working_radii[0] - phase
    deviations = [
        _deviations(pair, gear, index, path, (phase, back_phase), first)
        for gear, index, first in ((micro[0], 0, 0), (micro[1], 1, position.tooth_offset_2))
    ]
    scales = [np.array(gear.tooth_stiffness or (1.0,)) for gear in micro]
    return MeshLaw(
        base_radius_1=_law_radius(pair, 0),
        base_radius_2=_law_radius(pair, 1),
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
        phase=phase,
        back_phase=back_phase,
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


def flank_modification(pair: GearPair, gear: Microgeometry, index: int, path: Array, face: Array) -> Array:
    """Metal removed from the flank of gear ``index`` (0 pinion), shape (len(face), len(path)) [m].

    ``path`` [m] from the pitch point, ``face`` [m] from mid-face. Beyond the active path the value of its
    end stays, since it is the corner that touches there.
    """
    limits = pair.path
    inside = np.clip(path, limits.start, limits.end)
    profile = _along_profile(pair, index, path)
    removed = gear.profile_crowning * profile**2
    if gear.profile_slope:
        removed = removed - 0.5 * gear.profile_slope * profile
    if gear.tip_relief:
        to_tip = limits.end - inside if index == 0 else inside - limits.start
        share = np.maximum(1.0 - to_tip / gear.tip_relief_length, 0.0)
        removed = removed + gear.tip_relief * share**gear.tip_relief_exponent
    lead = 2.0 * face[:, None] / pair.face_widths[index]
    across = gear.lead_crowning * lead**2 + 0.5 * gear.helix_slope * lead
    return np.asarray(removed[None, :] + across + gear.profile_twist * lead * profile[None, :])


def _along_profile(pair: GearPair, index: int, path: Array) -> Array:
    """Place on the active profile of gear ``index`` for places on the path: -1 at its root, 1 at its tip."""
    limits = pair.path
    towards_tip = 1.0 if index == 0 else -1.0
    inside = np.clip(path, limits.start, limits.end)
    return np.asarray(towards_tip * (inside - 0.5 * (limits.start + limits.end)) / (0.5 * limits.length))


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


def _law_radius(pair: GearPair, index: int) -> float:
    """Base radius [m] with the mean base pitch, so that the radii keep the ratio of the tooth numbers."""
    return pair.base_pitch * pair.teeth[index] / (2.0 * pi)


def _deviations(
    pair: GearPair,
    gear: Microgeometry,
    index: int,
    path: Array,
    phases: tuple[float, float],
    first_tooth: int,
) -> tuple[Array, Array | None]:
    """Gap added by each tooth of gear ``index`` in front and on the back, (teeth, n_path) or (1, n_path) [m].

    phases : path position of pair 0 at rotation zero, front and back; first_tooth : the one in pair 0 in front

    None for the back where it has the same. On the lines of action n = (sin alpha_wt, +-cos alpha_wt), front and
    back, from the centre of the gear, an eccentricity that turns with the gear stands out by e cos(rotation - phase)
    in front and by -e cos(rotation - phase -+ 2 alpha_wt), pinion and wheel, on the back: together 2 sin alpha_wt
    times its part towards the other gear, by which it takes away from the backlash.
    """
    teeth = pair.teeth[index]
    if not gear.pitch_deviations and not gear.run_out and not gear.profile_slopes:
        return np.zeros((1, len(path))), None
    place = np.array(gear.pitch_deviations or (0.0,) * teeth)[:, None]
    tilt = 0.5 * np.array(gear.profile_slopes or (0.0,) * teeth)[:, None] * _along_profile(pair, index, path)
    tooth = (np.arange(teeth) - first_tooth)[:, None]
    per_turn = pair.base_pitch / (2.0 * pi)
    rotation = ((path - phases[0]) / per_turn + 2.0 * pi * tooth) / teeth
    front = -place - gear.run_out * np.cos(rotation - gear.run_out_phase) - tilt
    if not gear.pitch_deviations and not gear.run_out:
        return front, None
    pair_of_tooth = tooth - index  # a tooth of the wheel is on the back in the pair before
    rotation = ((phases[1] - path) / per_turn + 2.0 * pi * pair_of_tooth) / teeth
    later = gear.run_out_phase + (2.0 - 4.0 * index) * pair.working_pressure_angle
    return front, place + gear.run_out * np.cos(rotation - later) - tilt


def default_slices(
    pair: GearPair, micro: tuple[Microgeometry, Microgeometry], misalignment: float = 0.0
) -> int:
    """Slices over the face width after which K_V of a mesh changes by less than 1 % with more.

    Slices of a helical gear come into mesh one by one: their sum is the integral over the face by the midpoint rule
    along the path, whose steps excite the mesh unless they are short against a base pitch. A face whose gap varies
    needs some whatever its helix. One slice is exact for a spur gear flat over its face.
    """
    flat = misalignment == 0.0 and all(
        gear.lead_crowning == gear.helix_slope == gear.profile_twist == 0.0 for gear in micro
    )
    if pair.helix_angle == 0.0 and flat:
        return 1
    return max(LEAST_SLICES, ceil(SLICES_PER_BASE_PITCH * abs(pair.overlap_ratio) - 1e-9))
