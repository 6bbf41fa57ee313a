"""Mesh law of a gear pair from its geometry, the micro-geometry of its flanks and its stiffness."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import ceil, cos, pi, tan
from typing import Literal, Self

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid

from dynamics.errors import DynamicsInputError
from dynamics.gear.flank import PARALLEL, AxisMisalignment, Flank, FlankField, TeethInMesh, back_phase
from dynamics.gear.microgeometry import Microgeometry
from dynamics.gear.pair import GearPair
from dynamics.gear.root_arc import ToothOutline, tooth_outline
from dynamics.tooth.law import DampedRate, MeshLaw
from dynamics.tooth.pair_gap import FLAWLESS, PairGap, flank_fields, path_reach, tip_separation

Array = NDArray[np.float64]


# Stiffness of one tooth pair over the path of contact: Weber and Banaschek's tooth, Hertzian flattening.

Body = Literal["half_plane", "ring"]

SAINSOT: dict[str, tuple[float, float, float, float, float, float]] = {
    "L": (-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045),
    "M": (60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086),
    "P": (-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236),
    "Q": (-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904),
}
"""A .. F of L*, M*, P*, Q* (Sainsot, Velex, Duverger, ASME J. Mech. Des. 126 (2004), table 1)."""
RING_RATIO_RANGE = (1.4, 7.0)
ROOT_ANGLE_RANGE = (0.01, 0.12)


@dataclass(frozen=True, kw_only=True, eq=False)
class PairStiffness:
    """Stiffness of one tooth pair in the transverse line of action per unit face width.

    path : (n,) positions from the pitch point, rising, from the start to the end of the active path [m]
    value : (n,) stiffness [N/m per m = N/m2]
    base_pitch : transverse base pitch [m]
    """

    path: Array
    value: Array
    base_pitch: float
    warnings: tuple[str, ...] = ()

    def at(self, path: Array) -> Array:
        """Stiffness at ``path`` positions [m]; held at its end values beyond the active path."""
        return np.interp(path, self.path, self.value)

    @property
    def mesh_mean(self) -> float:
        """Mean over a base pitch of the sum of all pairs, rigid unmodified flanks [N/m2]."""
        return float(np.trapezoid(self.value, self.path)) / self.base_pitch

    def scaled(self, factor: float) -> Self:
        """The same stiffness with every value times ``factor`` (0.8: usual ratio of measured to calculated)."""
        if not factor > 0.0:
            raise DynamicsInputError(
                f"stiffness factor = {factor} must be positive; 1 leaves the stiffness as it is"
            )
        return replace(self, value=self.value * factor)

    def scaled_to(self, c_gamma_alpha: float) -> Self:
        """The same stiffness with the mesh mean ``c_gamma_alpha`` [N/m2] (1 N/(mm um) = 1e9 N/m2)."""
        return self.scaled(c_gamma_alpha / self.mesh_mean)


def pair_stiffness(
    pair: GearPair, line_load: float, *, n_path: int = 121, body: Body = "half_plane"
) -> PairStiffness:
    """Single-pair stiffness over the active path.

    ``line_load`` [N/m] is the transverse force per face width that flattens the contact (usually F_bt / b).
    ``body="ring"`` replaces the half plane under each tooth by the elastic ring of Sainsot et al. on the bore
    of the gear; out of its fitted range the result carries warnings. Raises DynamicsInputError for a load <= 0 or a
    ring without bore.
    """
    path = np.linspace(pair.path.start, pair.path.end, n_path)
    return PairStiffness(
        path=path,
        value=single_pair_stiffness(pair, path, line_load, body=body),
        base_pitch=pair.base_pitch,
        warnings=_ring_warnings(pair) if body == "ring" else (),
    )


def single_pair_stiffness(
    pair: GearPair, path: Array, line_load: float, *, body: Body = "half_plane"
) -> Array:
    """Stiffness of one tooth pair at ``path`` positions [m], per unit face width [N/m2].

    Bending, shear and body after Weber and Banaschek (VDI report 1953), bending counted from the root
    circle, the body's lever from the 30 degree tangent section; flattening after Weber (logarithmic form).
    A helical pair is taken in the normal section of its virtual spur gears and turned into the transverse
    plane with cos(beta_b).
    """
    if not line_load > 0.0:
        raise DynamicsInputError(
            f"line load = {line_load} N/m must be positive; the flattening depends on it"
        )
    cos_base = cos(pair.base_helix_angle)
    roll_1 = (path + pair.rolling_radii[0]) / cos_base
    roll_2 = (pair.rolling_radii[1] - path) / cos_base
    if not (np.all(roll_1 > 0.0) and np.all(roll_2 > 0.0)):
        raise DynamicsInputError(
            f"path positions {path.min():.6f}..{path.max():.6f} m must lie between the base tangent points "
            f"{-pair.rolling_radii[0]:.6f} and {pair.rolling_radii[1]:.6f} m; stay near the active path"
        )
    moduli = [(1.0 - nu**2) / e for nu, e in zip(pair.poisson_ratios, pair.youngs_moduli, strict=True)]
    radius = roll_1 * roll_2 / (roll_1 + roll_2)
    half_width = np.sqrt(4.0 * line_load * radius * sum(moduli) / pi)
    compliance = np.zeros_like(path)
    for index, roll in enumerate((roll_1, roll_2)):
        nu = pair.poisson_ratios[index]
        tooth, gear_body, depth = tooth_compliance(pair, index, roll, body=body)
        compliance += tooth
        compliance += gear_body
        compliance += moduli[index] / pi * (2.0 * np.log(2.0 * depth / half_width) - nu / (1.0 - nu))
    return cos_base / compliance


def tooth_compliance(
    pair: GearPair, index: int, roll: Array, *, body: Body = "half_plane"
) -> tuple[Array, Array, Array]:
    """Deflection of a tooth of gear ``index`` (0 pinion) without flattening, of the body under it, depth of its axis.

    roll : (n,) roll lengths in the normal section of the virtual spur gear [m]

    Returns the displacements along the normal per load per contact length by tooth and by body, (n,) [m2/N], and the
    distance from the flank to the tooth axis along the normal (n,) [m].
    """
    outline, nu = tooth_outline(pair.gears[index]), pair.poisson_ratios[index]
    modulus = (1.0 - nu**2) / pair.youngs_moduli[index]
    angle = roll / outline.base_radius - _half_base_angle(pair, index)
    tooth = _tooth_compliance(outline, angle, nu, modulus)
    if body == "ring":
        gear_body = _ring_compliance(pair, index, outline, angle)
    else:
        gear_body = _half_plane_compliance(outline, angle, nu, modulus)
    return tooth, gear_body, roll - outline.base_radius * np.tan(angle)


def _half_base_angle(pair: GearPair, index: int) -> float:
    """Half the angle of a tooth of the virtual gear on its base circle [rad]."""
    gear = pair.gears[index]
    base = 0.5 * gear.normal_module * gear.virtual_teeth * cos(gear.pressure_angle)
    return gear.virtual_half_angle(base)


def _lever(outline: ToothOutline, angle: Array, foot: float) -> Array:
    """Height of the load's crossing with the tooth axis above ``foot`` [m], not below zero."""
    return np.maximum(outline.base_radius / np.cos(angle) - foot, 0.0)


def _tooth_compliance(outline: ToothOutline, angle: Array, nu: float, modulus: float) -> Array:
    """Bending, shear and compression of the tooth, times unit face width [m2/N]."""
    foot = float(outline.y[0])
    lever = _lever(outline, angle, foot)
    y = np.linspace(0.0, float(lever.max()), 2001)
    thickness = 2.0 * np.interp(y + foot, outline.y, outline.x)
    moments = [cumulative_trapezoid(y**power / thickness**3, y, initial=0) for power in (0, 1, 2)]
    sums = [np.interp(lever, y, moment) for moment in moments]
    bending = lever**2 * sums[0] - 2.0 * lever * sums[1] + sums[2]
    shear = np.interp(lever, y, cumulative_trapezoid(1.0 / thickness, y, initial=0))
    tangent = np.tan(angle) ** 2
    total = 12.0 * bending + (2.4 / (1.0 - nu) + tangent) * shear
    return np.asarray(np.cos(angle) ** 2 * modulus * total)


def _half_plane_compliance(outline: ToothOutline, angle: Array, nu: float, modulus: float) -> Array:
    """Deflection of the body as an elastic half plane, times unit face width [m2/N]."""
    slenderness = _lever(outline, angle, outline.root_height) / outline.root_chord
    tilt = 18.0 / pi * slenderness**2 + 2.0 * (1.0 - 2.0 * nu) / (1.0 - nu) * slenderness
    shift = 4.8 / pi * (1.0 + (1.0 - nu) / 2.4 * np.tan(angle) ** 2)
    return np.asarray(np.cos(angle) ** 2 * modulus * (tilt + shift))


def _ring_shape(pair: GearPair, index: int) -> tuple[float, float]:
    """Root-to-bore ratio h and half root angle theta_f (of the 30 degree section) of one gear [-, rad]."""
    bore = 0.5 * pair.bore_diameters[index]
    if not bore > 0.0:
        raise DynamicsInputError(
            f"bore of gear {index + 1} = {pair.bore_diameters[index]} m must be positive for the ring body; give "
            "the bore"
        )
    outline = tooth_outline(pair.gears[index])
    return pair.gears[index].root_radius / bore, 0.5 * outline.root_chord / outline.root_radius


def _ring_compliance(pair: GearPair, index: int, outline: ToothOutline, angle: Array) -> Array:
    """Deflection of an elastic ring on its bore (Sainsot et al. 2004, equation 11) [m2/N]."""
    h, theta = _ring_shape(pair, index)
    terms = {
        name: a / theta**2 + b * h**2 + c * h / theta + d / theta + e * h + f
        for name, (a, b, c, d, e, f) in SAINSOT.items()
    }
    slenderness = _lever(outline, angle, outline.root_radius) / (2.0 * outline.root_radius * theta)
    shape = terms["L"] * slenderness**2 + terms["M"] * slenderness
    shape += terms["P"] * (1.0 + terms["Q"] * np.tan(angle) ** 2)
    return np.asarray(np.cos(angle) ** 2 * shape / pair.youngs_moduli[index])


def _ring_warnings(pair: GearPair) -> tuple[str, ...]:
    warnings = []
    for index, name in enumerate(("pinion", "wheel")):
        h, theta = _ring_shape(pair, index)
        for symbol, value, (low, high) in (
            ("root radius / bore radius", h, RING_RATIO_RANGE),
            ("half root angle [rad]", theta, ROOT_ANGLE_RANGE),
        ):
            if not low <= value <= high:
                warnings.append(
                    f"{name}: {symbol} = {value:.4f} outside {low}..{high} of the ring formula "
                    "(Sainsot et al. 2004); use the half plane"
                )
    return tuple(warnings)


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
    axes : how far the axes are from parallel
    flank : that carries; the one table of gaps has the misalignment as these flanks see it
    """

    offset: float = 0.0
    axes: AxisMisalignment = PARALLEL
    flank: Flank = "front"
    phase: float = 0.0
    tooth_offset_2: int = 0

    def gap_slope(self, pair: GearPair) -> float:
        """Gap between the flanks that carry, per face width [rad], growing with z over the common width."""
        front, back = self.axes.gap_slope(pair)
        return front if self.flank == "front" else back


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


@dataclass(frozen=True, kw_only=True, eq=False)
class PairSprings:
    """Tooth pairs of a mesh as springs over the path, all teeth alike.

    path : (n_path,) uniform grid [m]; face : (n_slices,) middles of the slices from mid-face [m]
    stiffness, gap : (n_slices, n_path) of one pair in one slice [N/m], [m]
    mean_stiffness : of the mesh over one base pitch, shared bodies included [N/m]
    body_compliance : that all pairs share, in series with them [m/N]
    """

    path: Array
    face: Array
    stiffness: Array
    gap: Array
    mean_stiffness: float
    body_compliance: float = 0.0


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
    flanks: modifications and topography of the front flanks count on the back as well, and the misalignment of the
    flanks that carry on both.

    Raises DynamicsInputError for arrays of another length than the tooth number or numbers below their limit.
    """
    flanks = law_flanks(pair, micro, position)
    face, path = contact_grid(pair, micro, position, discretisation)
    n_slices, engagement = len(face), discretisation.engagement
    gap = (
        tip_separation(pair, path)
        if engagement == "corner"
        else _ramp(pair, path, _reach(pair, discretisation))
    )
    scales = [float(np.mean(gear.tooth_stiffness or (1.0,))) for gear in micro]
    springs = PairSprings(
        path=path,
        face=face,
        stiffness=np.tile(stiffness.at(path) * pair.face_width / n_slices, (n_slices, 1)),
        gap=gap + flanks.modifications(path, face[:, None]),
        mean_stiffness=stiffness.mesh_mean * pair.face_width * scales[0] * scales[1],
    )
    return law_of_springs(springs, flanks, position, dissipation)


def law_flanks(
    pair: GearPair, micro: tuple[Microgeometry, Microgeometry], position: MeshPosition = NOMINAL_POSITION
) -> PairGap:
    """Flanks of a pair as they stand to each other; front and back with the misalignment of those that carry.

    Raises DynamicsInputError for arrays of another length than the tooth number.
    """
    count = TeethInMesh(phase=position.phase, tooth_offset_2=position.tooth_offset_2)
    slope = position.gap_slope(pair)
    return PairGap(
        pair=pair,
        flanks=flank_fields(pair, micro, count),
        axes=AxisMisalignment.of_gap(pair, slope, slope),
    )


def contact_grid(
    pair: GearPair,
    micro: tuple[Microgeometry, Microgeometry],
    position: MeshPosition,
    discretisation: ContactDiscretisation,
) -> tuple[Array, Array]:
    """Middles of the slices from mid-face (n_slices,) and uniform places over the path (n_path,) [m]."""
    slices = discretisation.n_slices or default_slices(pair, micro, position.axes)
    face = ((np.arange(slices) + 0.5) / slices - 0.5) * pair.face_width
    first, last = _grid_ends(pair, _reach(pair, discretisation), discretisation.engagement)
    return face, np.linspace(first, last, discretisation.n_path)


def law_of_springs(
    springs: PairSprings, flanks: PairGap, position: MeshPosition, dissipation: MeshDissipation
) -> MeshLaw:
    """Mesh law of tooth pairs whose stiffness and gap are known, with the deviations of their teeth."""
    pair, path, face = flanks.pair, springs.path, springs.face
    count = flanks.flanks[0].count
    deviations = [_deviations(flank, path, face) for flank in flanks.flanks]
    scales = [np.array(flank.micro.tooth_stiffness or (1.0,)) for flank in flanks.flanks]
    return MeshLaw(
        base_radius_1=flanks.flanks[0].base_radius,
        base_radius_2=flanks.flanks[1].base_radius,
        base_pitch=pair.base_pitch,
        teeth_1=pair.teeth[0],
        teeth_2=pair.teeth[1],
        tooth_offset_2=position.tooth_offset_2,
        path_start=float(path[0]),
        path_step=float(path[-1] - path[0]) / (len(path) - 1),
        stiffness=springs.stiffness,
        gap=springs.gap,
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
        mean_stiffness=springs.mean_stiffness,
        friction=dissipation.friction,
        rolling_radius_1=pair.rolling_radii[0],
        rolling_radius_2=pair.rolling_radii[1],
        friction_reversal_speed=dissipation.friction_reversal_speed,
        back_deviation_1=deviations[0][1],
        back_deviation_2=deviations[1][1],
        body_compliance=springs.body_compliance,
        slice_face=face,
        turning_deviation=_turning_deviation(flanks.flanks, path),
    )


def alike_teeth(law: MeshLaw, pinion: bool = True, wheel: bool = True) -> MeshLaw:
    """The law with the teeth of pinion, wheel or both alike: the mean of their deviations and of their stiffness.

    What they have in common in front and on the back goes into the gap, half of the difference into the offset.
    """
    none, unit = np.zeros((1, law.stiffness.shape[1])), np.ones(1)
    if pinion:
        law = _with_means(law, law.deviation_1, law.back_deviation_1, law.scale_1)
        law = law._replace(deviation_1=none, back_deviation_1=None, scale_1=unit)
        law = _without_turning(law, slice(law.teeth_1))
    if wheel:
        law = _with_means(law, law.deviation_2, law.back_deviation_2, law.scale_2)
        law = law._replace(deviation_2=none, back_deviation_2=None, scale_2=unit)
        law = _without_turning(law, slice(law.teeth_1, None))
    return law


def _without_turning(law: MeshLaw, teeth: slice) -> MeshLaw:
    """The law with no deviations that turn with the gear of these teeth."""
    if law.turning_deviation is None:
        return law
    left = law.turning_deviation.copy()
    left[:, teeth] = 0.0
    return law._replace(turning_deviation=left if np.any(left) else None)


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

    It is that of the teeth, without what bodies shared by the pairs give.
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


def _reach(pair: GearPair, discretisation: ContactDiscretisation) -> float:
    """Tip separation at the ends of the grid [m]."""
    usual = min(max(0.15 * pair.normal_module, 1e-4), 3e-4)
    return usual if discretisation.reach is None else discretisation.reach


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
    measured = [t for t in (micro.topography, micro.back_topography) if t is not None and t.teeth > 1]
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


def _turning_deviation(flanks: Sequence[FlankField], path: Array) -> Array | None:
    """What run-outs of both gears have of the deviations (2, teeth_1 + teeth_2, n_path) [m]; None without them."""
    if not any(flank.micro.run_out for flank in flanks):
        return None
    sides: tuple[Literal["front", "back"], ...] = ("front", "back")
    return np.array(
        [
            np.concatenate(
                [f.turning_deviation(f.roll(path), np.arange(f.teeth)[:, None], side) for f in flanks]
            )
            for side in sides
        ]
    )


def default_slices(
    pair: GearPair, micro: tuple[Microgeometry, Microgeometry], axes: AxisMisalignment = PARALLEL
) -> int:
    """Slices over the face width after which K_V of a mesh changes by less than 1 % with more.

    Slices of a helical gear come into mesh one by one: their sum is the integral over the face by the midpoint rule
    along the path, whose steps excite the mesh unless they are short against a base pitch. A face whose gap varies
    needs some whatever its helix. One slice is exact for a spur gear flat over its face.
    """
    flat = axes == PARALLEL and all(gear.even_over_face for gear in micro)
    if pair.helix_angle == 0.0 and flat:
        return 1
    return max(LEAST_SLICES, ceil(SLICES_PER_BASE_PITCH * abs(pair.overlap_ratio) - 1e-9))
