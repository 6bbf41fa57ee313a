"""What is removed from the flanks of one gear, over roll length, face position and tooth.

Natural twist. A worm, hob or threaded wheel, touches the gear on the line through the pitch point along the common
normal of the flanks, which stands at the base helix angle to the transverse section (line of action of crossed
involute helical gears; Litvin and Fuentes, Gear Geometry and Applied Theory, 2nd ed., 16). On that line roll length xi
and face position z of the flank belong together, dz = tan(beta_b) dxi, so that the tool at one axial place finishes
no transverse section but a slanted trace. A tool that is fed deeper by C(z_t) / sin(alpha_t) for a lead crowning C
removes C(z_t) along its whole trace:

    removed(xi, z) = C(z -+ (xi - xi_m) tan(beta_b))

with xi_m the middle of the profile, where the crowning is that asked for, and the sign that of the helix on this
flank. For a parabola the part linear in both is a twist of the flank: its profile slope differs between the ends of
the face by S_alpha = 8 C_beta L_alpha tan(beta_b) / b, with opposite sign on the two flanks of a tooth. Derived here;
the curvature of the worm along the feed is neglected against that of the crowning.
"""

from dataclasses import dataclass
from math import cos, pi, sin, tan
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dynamics.errors import DynamicsInputError
from dynamics.gear.involute import GearGeometryError
from dynamics.gear.limits import NAMES
from dynamics.gear.microgeometry import Microgeometry, Topography, check_microgeometry
from dynamics.gear.pair_geometry import PairGeometry

Array = NDArray[np.float64]
Flank = Literal["front", "back"]


@dataclass(frozen=True, kw_only=True)
class TeethInMesh:
    """How the teeth of a pair are counted (``dynamics.tooth.law``).

    phase : path position of pair 0 at rotation zero, on the front flanks [m]
    tooth_offset_2 : wheel tooth that meets pinion tooth 0 in pair 0
    """

    phase: float = 0.0
    tooth_offset_2: int = 0


AT_PITCH_POINT = TeethInMesh()


@dataclass(frozen=True, kw_only=True)
class FlankField:
    """The flanks of gear ``index`` (0 pinion, 1 wheel) of a pair, with the profile that is active in it.

    The profile runs over the roll lengths of the active path, from the root to the tip: modifications over the profile
    are counted there. Beyond it the value of its end stays, since it is the corner that touches there.

    Raises DynamicsInputError for a micro-geometry that does not fit the gear.
    """

    pair: PairGeometry
    index: int
    micro: Microgeometry
    count: TeethInMesh = AT_PITCH_POINT

    def __post_init__(self) -> None:
        check_microgeometry(self.micro, self.teeth)

    @property
    def teeth(self) -> int:
        """Tooth number."""
        return self.pair.teeth[self.index]

    @property
    def base_radius(self) -> float:
        """With the mean base pitch of the pair, so that the radii keep the ratio of the tooth numbers [m]."""
        return self.pair.base_pitch * self.teeth / (2.0 * pi)

    @property
    def profile(self) -> tuple[float, float]:
        """Roll lengths of the ends of the active profile, root and tip [m]."""
        path = self.pair.path
        ends = self.roll(np.array([path.start, path.end]))
        return float(ends.min()), float(ends.max())

    def roll(self, path: ArrayLike) -> Array:
        """Roll length [m] of the flank point at a path position [m] of its own flank."""
        reach = self.pair.rolling_radii[self.index]
        return np.asarray(reach + np.asarray(path) if self.index == 0 else reach - np.asarray(path))

    def removed(self, roll: ArrayLike, face: ArrayLike, tooth: ArrayLike, flank: Flank = "front") -> Array:
        """Metal removed along the transverse line of action [m], the shapes of the arguments broadcast.

        roll : roll length [m]; face : position from mid-face [m]; tooth : number, counted over any turns; flank : of
        the tooth, each with roll length and face position of its own
        """
        return self.modification(roll, face, flank) + self.deviation(roll, face, tooth, flank)

    def modification(self, roll: ArrayLike, face: ArrayLike, flank: Flank = "front") -> Array:
        """What all teeth have in common [m]; arguments as in ``removed``."""
        _require_flank(flank)
        micro, place = self.micro, np.asarray(face, dtype=np.float64)
        root, tip = self.profile
        inside = np.clip(np.asarray(roll, dtype=np.float64), root, tip)
        along = self._along_profile(roll)
        removed = micro.profile_crowning * along**2 - 0.5 * micro.profile_slope * along
        removed = removed + _relief(
            micro.tip_relief, tip - inside, micro.tip_relief_length, micro.tip_relief_exponent
        )
        removed = removed + _relief(
            micro.root_relief, inside - root, micro.root_relief_length, micro.root_relief_exponent
        )
        width = self.pair.face_widths[self.index]
        lead = 2.0 * place / width
        across = self._lead_crowning(inside, place, flank) + 0.5 * micro.helix_slope * lead
        for end, amount in zip((-1.0, 1.0), micro.end_relief, strict=True):
            to_end = 0.5 * width - end * place
            across = across + _relief(amount, to_end, micro.end_relief_length, micro.end_relief_exponent)
        removed = removed + across + micro.profile_twist * lead * along
        if (measured := self._topography(flank)) is not None:
            removed = removed + measured.mean.at(inside / self._cold_scale, place, 0)
        return np.asarray(removed)

    def deviation(self, roll: ArrayLike, face: ArrayLike, tooth: ArrayLike, flank: Flank = "front") -> Array:
        """What one tooth has beyond all of them [m]; arguments as in ``removed``.

        On the lines of action n = (sin alpha_wt, +-cos alpha_wt), front and back, from the centre of the gear, an
        eccentricity that turns with the gear stands out by e cos(rotation - phase) in front and by
        -e cos(rotation - phase -+ 2 alpha_wt), pinion and wheel, on the back: together 2 sin alpha_wt times its part
        towards the other gear, by which it takes away from the backlash.
        """
        _require_flank(flank)
        micro, roll = self.micro, np.asarray(roll, dtype=np.float64)
        number = np.asarray(tooth, dtype=np.int64)
        index = number % self.teeth
        place = np.array(micro.pitch_deviations or (0.0,))[index if micro.pitch_deviations else 0]
        slopes = np.array(micro.profile_slopes or (0.0,))[index if micro.profile_slopes else 0]
        tilt = 0.5 * slopes * self._along_profile(roll)
        removed = (place if flank == "back" else -place) - tilt + self.turning_deviation(roll, number, flank)
        measured = self._topography(flank)
        if measured is not None and measured.teeth > 1:
            root, tip = self.profile
            angle, face = np.clip(roll, root, tip) / self._cold_scale, np.asarray(face, dtype=np.float64)
            removed = removed + measured.at(angle, face, index) - measured.mean.at(angle, face, 0)
        return np.asarray(removed)

    def turning_deviation(self, roll: ArrayLike, tooth: ArrayLike, flank: Flank = "front") -> Array:
        """What an eccentricity, which turns with the gear, has of `deviation` [m]; arguments as there."""
        number = np.asarray(tooth, dtype=np.int64)
        rotation = self._rotation(np.asarray(roll, dtype=np.float64), number, flank)
        standing = self.micro.run_out * np.cos(rotation - self.micro.run_out_phase)
        return np.asarray(standing if flank == "back" else -standing)

    @property
    def natural_twist(self) -> float:
        """S_alpha [m]: profile slope at z = b/2 less that at z = -b/2 that the lead crowning brings in front.

        With ``micro.manufacturing_twist`` = 1; the profile slope is positive where the tip stands out. The back flank
        has the opposite.
        """
        root, tip = self.profile
        slant = tan(self.pair.base_helix_angle) * (1.0 if self.index == 0 else -1.0)
        return 8.0 * self.micro.lead_crowning * (tip - root) * slant / self.pair.face_widths[self.index]

    @property
    def _cold_scale(self) -> float:
        """Roll length per roll angle of the gear as it is now [m]."""
        return self.pair.base_radii[self.index]

    def _topography(self, flank: Flank) -> Topography | None:
        return self.micro.topography if flank == "front" else self.micro.back_topography

    def _along_profile(self, roll: ArrayLike) -> Array:
        """Place on the active profile: -1 at its root, 1 at its tip."""
        root, tip = self.profile
        return np.asarray((np.clip(roll, root, tip) - 0.5 * (root + tip)) / (0.5 * (tip - root)))

    def _lead_crowning(self, inside: Array, face: Array, flank: Flank) -> Array:
        """Lead crowning at the axial place of the tool that finished the point [m]."""
        micro, width = self.micro, self.pair.face_widths[self.index]
        if micro.manufacturing_twist:
            slant = micro.manufacturing_twist * tan(self.pair.base_helix_angle)
            rising = 1.0 if (self.index == 0) == (flank == "front") else -1.0
            face = face - rising * slant * (inside - 0.5 * sum(self.profile))
        lead = 2.0 * face / width
        if micro.lead_crowning_form == "parabolic" or not micro.lead_crowning:
            return micro.lead_crowning * lead**2
        radius = (0.25 * width**2 + micro.lead_crowning**2) / (2.0 * micro.lead_crowning)
        return np.asarray(face**2 / (radius + np.sign(radius) * np.sqrt(radius**2 - face**2)))

    def _rotation(self, roll: Array, tooth: NDArray[np.int64], flank: Flank) -> Array:
        """Rotation of the gear from rotation zero at which a flank point of a tooth touches [rad]."""
        reach, pair = self.pair.rolling_radii[self.index], self.pair
        path = roll - reach if self.index == 0 else reach - roll
        per_turn = pair.base_pitch / (2.0 * pi)
        first = 0 if self.index == 0 else self.count.tooth_offset_2
        pair_number = tooth - first
        if flank == "front":
            return ((path - self.count.phase) / per_turn + 2.0 * pi * pair_number) / self.teeth
        pair_number = pair_number - self.index  # a tooth of the wheel is on the back in the pair before
        along = (back_phase(pair, self.count) - path) / per_turn
        later = (2.0 - 4.0 * self.index) * pair.working_pressure_angle
        return (along + 2.0 * pi * pair_number) / self.teeth - later


def back_phase(pair: PairGeometry, count: TeethInMesh = AT_PITCH_POINT) -> float:
    """Path position of pair 0 at rotation zero, on the back flanks [m]."""
    return pair.working_thicknesses[0] * pair.base_radii[0] / pair.working_radii[0] - count.phase


def require_whole_flanks(pair: PairGeometry) -> None:
    """Raise GearGeometryError for a pair with a pointed tooth, or one whose undercut takes part of the path.

    The flank field ends at the active profile: what touches beyond the end of an undercut flank is no involute.
    """
    lost, total = (
        (pair.path.start - pair.path.tip_start, pair.path.tip_end - pair.path.end),
        sum(pair.profile_shifts),
    )
    for name, gear, details, missing in zip(NAMES, pair.gears, pair.details, lost, strict=True):
        if not gear.tip_thickness > 0.0:
            raise GearGeometryError(
                f"{name}: tip thickness {1e3 * gear.tip_thickness:.4f} mm must be positive (pointed tooth); "
                "reduce profile shift or tip diameter"
            )
        if gear.undercut and missing > 0.0:
            least, thinned = gear.least_profile_shift, gear.generating_profile_shift - gear.profile_shift
            raise GearGeometryError(
                f"{name}: undercut takes {1e3 * missing:.3f} mm of the path of contact (limit 0 mm), its profile shift "
                f"{gear.profile_shift:.3f} is below x_min = {least:.3f}; raise its profile shift to "
                f"{least - thinned:.3f}, its thinning counted: its mate then has {total - least + thinned:.3f}, or "
                "more with a larger centre distance; or shorten the mating tip"
            )
        if details.protuberance and missing > 0.0:
            raise GearGeometryError(
                f"{name}: protuberance = {1e3 * details.protuberance:.3f} mm takes {1e3 * missing:.3f} mm of the path "
                "of contact (limit 0 mm); reduce it or shorten the mating tip"
            )


def _relief(amount: float, distance: Array, length: float, exponent: float) -> Array | float:
    """Relief [m] at a distance [m] from its edge."""
    if not amount:
        return 0.0
    return np.asarray(amount * np.maximum(1.0 - distance / length, 0.0) ** exponent)


def _require_flank(flank: Flank) -> None:
    if flank not in get_args(Flank):
        raise DynamicsInputError(f"flank = {flank!r} must be {' or '.join(get_args(Flank))}")


# Misalignment of two nominally parallel axes as a gap along the line of action.


@dataclass(frozen=True, kw_only=True)
class AxisMisalignment:
    """Angles between the axes of a pair [rad], over z of the common face width.

    inclination : in the common plane of the axes (in-plane deviation f_Sigma_delta per bearing span): positive where
        the axes part with growing z
    skew : out of that plane (f_Sigma_beta per bearing span): positive where the front flanks part with growing z

    A shift of the wheel by (radial, tangential) moves its flank along the line of action n = (sin alpha_wt,
    +-cos alpha_wt), front and back. Definitions and weights as in ISO/TR 10064-3 and ISO 1328-1 have them from memory
    of the documents; the weights follow from n.
    """

    inclination: float = 0.0
    skew: float = 0.0

    @classmethod
    def of_gap(cls, pair: PairGeometry, front: float, back: float) -> "AxisMisalignment":
        """Misalignment with these gaps per face width on the front and back flanks [rad]."""
        angle = pair.working_pressure_angle
        return cls(inclination=0.5 * (front + back) / sin(angle), skew=0.5 * (front - back) / cos(angle))

    def gap_slope(self, pair: PairGeometry) -> tuple[float, float]:
        """Gap along the line of action per face width [rad], front and back flanks."""
        angle = pair.working_pressure_angle
        in_plane, out_of_plane = self.inclination * sin(angle), self.skew * cos(angle)
        return in_plane + out_of_plane, in_plane - out_of_plane


PARALLEL = AxisMisalignment()
