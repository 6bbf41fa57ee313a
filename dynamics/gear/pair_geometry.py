"""Geometry of a cylindrical gear pair at reference or operating temperature (ISO 21771:2007)."""

from dataclasses import dataclass, replace
from functools import cached_property
from math import acos, cos, pi, radians, tan
from typing import Literal, Self, TypedDict, Unpack

from scipy.optimize import brentq

from dynamics.gear.cylindrical_gear import CylindricalGear, Rack
from dynamics.gear.involute import GearGeometryError, involute, shift_sum
from dynamics.gear.tooth_form import PLAIN, FlankEnds, GearDetails, ToothForm

# Where two gears touch: path of contact, shift sum and tip cut for a centre distance (ISO 21771).

TipCut = Literal["both", "wheel", "pinion"]


@dataclass(frozen=True, kw_only=True)
class PathOfContact:
    """Points on the transverse line of action, measured from the pitch point, growing to the pinion tip [m].

    ``start`` (A) and ``end`` (E) bound the active path; both may lie on one side of the pitch point.
    ``tip_start`` and ``tip_end`` are where the tips alone would put them; ``start`` or ``end`` lies
    inside of them where the generated flank of the mating root ends earlier.
    """

    start: float
    end: float
    tip_start: float
    tip_end: float
    base_pitch: float
    tangent_1: float
    """Base tangent point T1 of the pinion (negative)."""
    tangent_2: float
    """Base tangent point T2 of the wheel."""

    @property
    def inner_single_contact(self) -> float:
        """B, where the previous pair leaves the mesh at the pinion tip."""
        return self.end - self.base_pitch

    @property
    def outer_single_contact(self) -> float:
        """D, where the next pair enters the mesh."""
        return self.start + self.base_pitch

    @property
    def length(self) -> float:
        """Length of the active path AE."""
        return self.end - self.start


def path_between(
    pinion: CylindricalGear,
    wheel: CylindricalGear,
    centre_distance: float,
    flanks: tuple[FlankEnds, FlankEnds] | None = None,
) -> PathOfContact:
    """Path of contact of two gears from the ends of their flanks (ISO 21771:2007).

    centre_distance : [m], above the sum of the base radii; a smaller one raises ValueError
    flanks : ends of the involutes; None: generated form circles and tip circles
    """
    ends_1, ends_2 = flanks or (PLAIN.flank_of(pinion), PLAIN.flank_of(wheel))
    ratio = tan(acos((pinion.base_radius + wheel.base_radius) / centre_distance))
    reach_1, reach_2 = pinion.base_radius * ratio, wheel.base_radius * ratio
    tip_end = pinion.roll_length(ends_1.tip_radius) - reach_1
    tip_start = reach_2 - wheel.roll_length(ends_2.tip_radius)
    return PathOfContact(
        start=max(tip_start, pinion.roll_length(ends_1.form_radius) - reach_1),
        end=min(tip_end, reach_2 - wheel.roll_length(ends_2.form_radius)),
        tip_start=tip_start,
        tip_end=tip_end,
        base_pitch=0.5 * (pinion.base_pitch + wheel.base_pitch),
        tangent_1=-reach_1,
        tangent_2=reach_2,
    )


def tip_cut_for_contact_ratio(
    gears: tuple[CylindricalGear, CylindricalGear],
    centre_distance: float,
    wanted: float,
    tip_cut: TipCut,
    details: tuple[GearDetails, GearDetails] = (PLAIN, PLAIN),
) -> tuple[float, float]:
    """Radial shortening of both tips [m] that brings the transverse contact ratio down to ``wanted``.

    The tips named by ``tip_cut`` are shortened equally, by one module at most; tip edges go with them.

    Raises GearGeometryError if the uncut tips do not reach the ratio or a cut of one module does not bring it down.
    """
    pinion, wheel = gears
    share = {"both": (1.0, 1.0), "pinion": (1.0, 0.0), "wheel": (0.0, 1.0)}[tip_cut]

    def contact_ratio(cut: float) -> float:
        shorter = (
            replace(pinion, tip_diameter=pinion.tip_diameter - 2.0 * cut * share[0]),
            replace(wheel, tip_diameter=wheel.tip_diameter - 2.0 * cut * share[1]),
        )
        first, second = (part.flank_of(gear) for part, gear in zip(details, shorter, strict=True))
        path = path_between(*shorter, centre_distance, (first, second))
        return path.length / path.base_pitch

    deepest = pinion.normal_module
    most, least = contact_ratio(0.0), contact_ratio(deepest)
    if not least <= wanted <= most:
        raise GearGeometryError(
            f"contact_ratio = {wanted} must lie between {least:.4f} (tip_cut {tip_cut!r} by one module) and "
            f"{most:.4f} (uncut); change addendum, profile shift or the gear that is cut"
        )
    if wanted == most:
        return 0.0, 0.0
    cut = brentq(lambda amount: contact_ratio(amount) - wanted, 0.0, deepest, xtol=1e-15)
    return cut * share[0], cut * share[1]


Pair = tuple[float, float]


class GearBodies(TypedDict, total=False):
    """The optional fields of :class:`PairGeometry` that ``from_centre_distance`` hands on."""

    pressure_angle: float
    helix_angle: float
    racks: tuple[Rack, Rack]
    bore_diameters: Pair
    thickness_allowances: Pair
    youngs_moduli: Pair
    poisson_ratios: Pair
    densities: Pair
    details: tuple[GearDetails, GearDetails]


@dataclass(frozen=True, kw_only=True)
class TipShortening:
    """How far the tips of a pair are shortened.

    shortening : on the radius, pinion first [m]
    contact_ratio : transverse contact ratio to which the tips are cut after that; None: not cut
    cut_gear : the gear that is cut, or both by the same amount
    """

    shortening: Pair = (0.0, 0.0)
    contact_ratio: float | None = None
    cut_gear: TipCut = "both"


FULL_TIPS = TipShortening()


@dataclass(frozen=True, kw_only=True)
class PairGeometry:
    """Two external cylindrical gears on a fixed centre distance. Lengths [m], angles [rad], pinion first.

    Tip diameters, shifts, widths, bores, allowances and details are those at the reference temperature; ``expansion``
    is the relative linear expansion of each gear body, set by :meth:`warm`, and every property includes it.
    Whether they can mesh is asked by `dynamics.gear.pair.GearPair`.
    """

    normal_module: float
    pressure_angle: float = radians(20.0)
    helix_angle: float = 0.0
    teeth: tuple[int, int]
    centre_distance: float
    face_widths: Pair
    profile_shifts: Pair
    tip_diameters: Pair
    racks: tuple[Rack, Rack] = (Rack(), Rack())
    bore_diameters: Pair = (0.0, 0.0)
    thickness_allowances: Pair = (0.0, 0.0)
    youngs_moduli: Pair = (206e9, 206e9)
    poisson_ratios: Pair = (0.3, 0.3)
    densities: Pair = (7830.0, 7830.0)
    details: tuple[GearDetails, GearDetails] = (PLAIN, PLAIN)
    expansion: Pair = (0.0, 0.0)

    @classmethod
    def from_centre_distance(
        cls,
        *,
        normal_module: float,
        teeth: tuple[int, int],
        centre_distance: float,
        face_widths: Pair,
        profile_shift_1: float | Literal["equal"],
        tips: TipShortening = FULL_TIPS,
        **bodies: Unpack[GearBodies],
    ) -> Self:
        """Pair whose profile-shift sum meshes without backlash on the centre distance (before allowances).

        Parameters
        ----------
        normal_module, centre_distance : [m]; teeth, face_widths [m] : pinion first
        profile_shift_1 : of the pinion, in modules; ``equal``: half of the sum on each gear
        tips : shortening of the tips, which are at d + 2 m_n (h_aP + x) otherwise

        Raises GearGeometryError for a pair that cannot mesh.
        """
        pressure_angle = bodies.setdefault("pressure_angle", radians(20.0))
        helix_angle = bodies.setdefault("helix_angle", 0.0)
        racks = bodies.setdefault("racks", (Rack(), Rack()))
        total = shift_sum(normal_module, pressure_angle, helix_angle, teeth, centre_distance)
        first = 0.5 * total if profile_shift_1 == "equal" else profile_shift_1
        shifts = (first, total - first)
        allowances = bodies.get("thickness_allowances", (0.0, 0.0))
        pinion, wheel = (
            CylindricalGear(
                normal_module=normal_module,
                pressure_angle=pressure_angle,
                helix_angle=helix_angle,
                teeth=teeth[i],
                profile_shift=shifts[i],
                tip_diameter=normal_module
                * (teeth[i] / cos(helix_angle) + 2.0 * (racks[i].addendum + shifts[i]))
                - 2.0 * tips.shortening[i],
                rack=racks[i],
                thickness_allowance=allowances[i],
            )
            for i in (0, 1)
        )
        cut = (0.0, 0.0)
        if tips.contact_ratio is not None:
            cut = tip_cut_for_contact_ratio(
                (pinion, wheel),
                centre_distance,
                tips.contact_ratio,
                tips.cut_gear,
                bodies.get("details", (PLAIN, PLAIN)),
            )
        return cls(
            normal_module=normal_module,
            teeth=teeth,
            centre_distance=centre_distance,
            face_widths=face_widths,
            profile_shifts=shifts,
            tip_diameters=(pinion.tip_diameter - 2.0 * cut[0], wheel.tip_diameter - 2.0 * cut[1]),
            **bodies,
        )

    @cached_property
    def gears(self) -> tuple[CylindricalGear, CylindricalGear]:
        """Pinion and wheel at their present size."""
        first, second = (
            CylindricalGear(
                normal_module=self.normal_module * (1.0 + self.expansion[i]),
                pressure_angle=self.pressure_angle,
                helix_angle=self.helix_angle,
                teeth=self.teeth[i],
                profile_shift=self.profile_shifts[i],
                tip_diameter=self.tip_diameters[i] * (1.0 + self.expansion[i]),
                rack=self.racks[i],
                thickness_allowance=self.thickness_allowances[i] * (1.0 + self.expansion[i]),
            )
            for i in (0, 1)
        )
        return first, second

    @property
    def gear_ratio(self) -> float:
        """u = z2 / z1 [-]."""
        return self.teeth[1] / self.teeth[0]

    @property
    def face_width(self) -> float:
        """Common face width: that of the narrower gear [m]."""
        return min(self.face_widths)

    @property
    def base_radii(self) -> Pair:
        """Base radii r_b1, r_b2 [m]."""
        return self.gears[0].base_radius, self.gears[1].base_radius

    @property
    def reference_radii(self) -> Pair:
        """Reference radii d/2 [m]."""
        return self.gears[0].reference_radius, self.gears[1].reference_radius

    @property
    def working_radii(self) -> Pair:
        """Radii of the working pitch circles [m]."""
        first, second = self.base_radii
        return (
            self.centre_distance * first / (first + second),
            self.centre_distance * second / (first + second),
        )

    @property
    def tip_radii(self) -> Pair:
        """Tip radii [m]."""
        return self.gears[0].tip_radius, self.gears[1].tip_radius

    @property
    def root_radii(self) -> Pair:
        """Nominal root radii [m]."""
        return self.gears[0].root_radius, self.gears[1].root_radius

    @property
    def transverse_pressure_angle(self) -> float:
        """alpha_t [rad]."""
        return self.gears[0].transverse_pressure_angle

    @property
    def working_pressure_angle(self) -> float:
        """alpha_wt from cos alpha_wt = (r_b1 + r_b2) / a [rad]."""
        return acos(sum(self.base_radii) / self.centre_distance)

    @property
    def base_helix_angle(self) -> float:
        """beta_b [rad]."""
        return self.gears[0].base_helix_angle

    @property
    def base_pitch(self) -> float:
        """Transverse base pitch p_bt, mean of both gears when they differ by thermal expansion [m]."""
        return 0.5 * (self.gears[0].base_pitch + self.gears[1].base_pitch)

    @property
    def base_pitch_difference(self) -> float:
        """Base pitch of the wheel less that of the pinion [m]; gears of unequal temperature have one."""
        return self.gears[1].base_pitch - self.gears[0].base_pitch

    @property
    def rolling_radii(self) -> Pair:
        """Distances of the pitch point from the base tangent points, T1C and T2C [m]."""
        ratio = tan(self.working_pressure_angle)
        return self.base_radii[0] * ratio, self.base_radii[1] * ratio

    @cached_property
    def forms(self) -> tuple[ToothForm, ToothForm]:
        """Tooth outlines of pinion and wheel at their present size.

        Raises GearGeometryError for a pointed tooth and for tip edges or protuberances that leave no flank.
        """
        first, second = (
            details.form_of(gear, 1.0 + expansion)
            for details, gear, expansion in zip(self.details, self.gears, self.expansion, strict=True)
        )
        return first, second

    @cached_property
    def flanks(self) -> tuple[FlankEnds, FlankEnds]:
        """Where the involutes of pinion and wheel end: at fillet and tip edge."""
        first, second = (
            details.flank_of(gear, 1.0 + expansion)
            for details, gear, expansion in zip(self.details, self.gears, self.expansion, strict=True)
        )
        return first, second

    @cached_property
    def path(self) -> PathOfContact:
        """Path of contact from the ends of both flanks: tip edges and generated form circles."""
        return path_between(*self.gears, self.centre_distance, self.flanks)

    @property
    def transverse_contact_ratio(self) -> float:
        """eps_alpha on the active flanks, form circles respected [-]."""
        return self.path.length / self.base_pitch

    @property
    def overlap_ratio(self) -> float:
        """eps_beta over the common face width [-]."""
        return self.face_width * tan(self.base_helix_angle) / self.base_pitch

    @property
    def total_contact_ratio(self) -> float:
        """eps_gamma = eps_alpha + eps_beta [-]."""
        return self.transverse_contact_ratio + self.overlap_ratio

    @property
    def tip_clearances(self) -> Pair:
        """Clearance between each tip and the root of the other gear [m]."""
        (tip_1, tip_2), (root_1, root_2) = self.tip_radii, self.root_radii
        return self.centre_distance - tip_1 - root_2, self.centre_distance - tip_2 - root_1

    @property
    def working_thicknesses(self) -> Pair:
        """Transverse tooth thicknesses on the working pitch circles [m]."""
        first, second = (
            2.0 * radius * (gear.base_half_angle - involute(self.working_pressure_angle))
            for gear, radius in zip(self.gears, self.working_radii, strict=True)
        )
        return first, second

    @property
    def transverse_backlash(self) -> float:
        """Circumferential backlash on the working pitch circles [m]; negative jams."""
        pitch = self.base_pitch / cos(self.working_pressure_angle)
        return pitch - sum(self.working_thicknesses)

    @property
    def backlash_along_path(self) -> float:
        """Backlash along the transverse line of action [m]."""
        return self.transverse_backlash * cos(self.working_pressure_angle)

    @property
    def masses(self) -> Pair:
        """Masses of the bored bodies, rim and web, with the mean tooth diameter as outside [kg]."""
        return self._body(0)[0], self._body(1)[0]

    @property
    def inertias(self) -> Pair:
        """Polar moments of inertia of the same bodies [kg m2]."""
        return self._body(0)[1], self._body(1)[1]

    def _body(self, index: int) -> Pair:
        outer, bore = self.gears[index].mean_radius, 0.5 * self.bore_diameters[index]
        rim, web = self.details[index].rim_thickness, self.details[index].web_thickness
        if rim is None:
            return self._ring(index, outer, bore, self.face_widths[index])
        inner = max(self.gears[index].root_radius - rim, bore)
        ring = self._ring(index, outer, inner, self.face_widths[index])
        disc = self._ring(index, inner, bore, self.face_widths[index] if web is None else web)
        return ring[0] + disc[0], ring[1] + disc[1]

    def _ring(self, index: int, outer: float, inner: float, width: float) -> Pair:
        mass = pi * self.densities[index] * width * (outer**2 - inner**2)
        return mass, 0.5 * mass * (outer**2 + inner**2)

    @property
    def fillet_distances(self) -> Pair:
        """Distance along the line of action from the ends of the fillets of pinion and wheel to where the mating tip
        begins to touch [m]; negative: it runs into the fillet."""
        reach_1, reach_2 = self.rolling_radii
        rolls = reach_1 + self.path.tip_start, reach_2 - self.path.tip_end
        first, second = (
            roll - gear.roll_length(flank.form_radius)
            for gear, flank, roll in zip(self.gears, self.flanks, rolls, strict=True)
        )
        return first, second

    @property
    def fillet_overlaps(self) -> Pair:
        """Overlap of the mating tip with the fillet of pinion and wheel along the line of action [m]."""
        reach_1, reach_2 = self.rolling_radii
        rolls = reach_1 + self.path.tip_start, reach_2 - self.path.tip_end
        first, second = (
            0.0 if details.protuberance else gear.fillet_overlap(roll)  # the tool leaves metal out there
            for gear, details, roll in zip(self.gears, self.details, rolls, strict=True)
        )
        return first, second

    def warm(
        self,
        temperature_1: float,
        temperature_2: float,
        centre_distance: float,
        *,
        reference_temperature: float = 293.15,
        expansion_coefficients: Pair = (11.5e-6, 11.5e-6),
        speed: float = 0.0,
    ) -> Self:
        """The gears at body temperatures [K], on the centre distance at temperature [m], at pinion ``speed`` [rad/s].

        Expansion is that of the free body: thermal strain plus the centrifugal strain of the reference circle.
        A pair that is warm already starts again from its reference temperature.
        """
        speeds = (speed, speed / self.gear_ratio)
        expansion_1, expansion_2 = (
            expansion_coefficients[i] * ((temperature_1, temperature_2)[i] - reference_temperature)
            + self.centrifugal_strain(i, speeds[i])
            for i in (0, 1)
        )
        return replace(self, expansion=(expansion_1, expansion_2), centre_distance=centre_distance)

    def centrifugal_strain(self, index: int, speed: float) -> float:
        """Relative centrifugal expansion of the reference circle of gear ``index`` spinning at ``speed`` [rad/s].

        Source: rotating disc of constant thickness with a free bore, plane stress (Timoshenko and Goodier,
        Theory of Elasticity, section 32): u/R = rho w^2 [(1 - nu) R^2 + (3 + nu) r_i^2] / (4 E).
        """
        outer = 0.5 * self.normal_module / cos(self.helix_angle) * self.teeth[index]
        bore = 0.5 * self.bore_diameters[index]
        nu = self.poisson_ratios[index]
        shape = (1.0 - nu) * outer**2 + (3.0 + nu) * bore**2
        return self.densities[index] * speed**2 * shape / (4.0 * self.youngs_moduli[index])
