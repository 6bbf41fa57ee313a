"""Find gears that meet what P1 prints of its test gear: tooth number, helix angle and profile shifts are not printed.

Printed: a 112.5 mm, m_n 6 mm, b 25 mm, tip shortening 2.5 mm, crownings and twist, a reference gear 28/28 (so that the
loop closes with z1 = z2 only), contact ratios 1.03 "load-free" and 1.24 at 238 N m, about 125 N/mm2 at gauge II at
189 N m, the maxima of gauges I, II, IV and V between 0.3 and 0.4 rad of rolling angle, and where the pattern is blank.

`python -m cases.strain_gauge_rig.search_gears` in the source tree takes some twenty minutes, two when its influence
numbers are in the store, and prints three tables in Markdown, those of the README:

1. Geometry alone: which helix angles a tooth number allows, and the contact ratios there.
2. Loaded contact: every reading of the printed twist and tip shortening with every tooth number; the helix angle is the
   one that meets 1.24 at 238 N m, the other figures say how well the set does in the rest.
3. The chosen set: what the figures do when one thing is changed; it and the next best on standard influence numbers.

The helix angle is looked for on analytic teeth and corrected once on coarse influence numbers. All figures of tables 2
and 3 are of influence numbers: contact, and stress at the gauges of the case, mean over their grids (`gauge_stresses`).
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from math import acos, degrees, radians

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from threadpoolctl import threadpool_limits

from dynamics.gear.cylindrical_gear import Rack
from dynamics.gear.flank import FlankField
from dynamics.gear.involute import GearGeometryError
from dynamics.gear.microgeometry import Microgeometry
from dynamics.gear.pair import GearPair
from dynamics.gear.pair_geometry import TipShortening
from dynamics.tooth.loaded_mesh import LoadedMesh
from dynamics.tooth.mesh_cycle import MeshCycle
from dynamics.tooth.pair_gap import PairGap
from dynamics.tooth.points import FaceGrid, flank_gap
from dynamics.tooth.slice_compliance import USUAL_COUPLING, SliceCompliance
from rigdesign.case import load_case
from rigdesign.case.shipped import case_folder
from rigdesign.postprocessing.loaded_contact import ElasticGear
from rigdesign.rig.model import build_rig
from rigdesign.rig.strain_gauges import RootGauge
from rigdesign.strain_gauge.measuring_point import GaugeCurve
from tests.published.p1_contact import (
    Divided,
    coarse,
    corner_load,
    cycle_at,
    elastic_contact,
    elastic_gears,
    pinion_gauges,
    ratio_without_load,
    standard,
    torque_of_ratio,
)

Array = NDArray[np.float64]

CENTRE_DISTANCE, MODULE, FACE_WIDTH, TIP_SHORTENING = 112.5e-3, 6e-3, 25e-3, 2.5e-3
PINION_LEAD, WHEEL_PROFILE, WHEEL_LEAD, HELIX_SLOPE, TWIST = 3e-6, 25e-6, 32e-6, 10e-6, 160e-6
FREE_RATIO, LOADED_RATIO, RATIO_TORQUE = 1.03, 1.24, 238.0
STRESS_TORQUE, STRESS_AT_II, PATTERN_TORQUES = 189.0, 125e6, (140.0, 336.0, 483.0)
SHOWN = ("I", "II", "IV", "V")
"""Gauges of Figure 9: III was defective."""
MAXIMA_WITHIN = 0.1
"""Rolling angle in which the maxima of Figure 9 lie, 0.3 to 0.4 rad."""
TEETH = (15, 16, 17, 18, 19, 20)
USUAL_RACK = Rack()
OTHER_PRESSURE_ANGLES = (18.0, 22.5)
"""Normal pressure angles [deg] besides 20."""
SLOPE_STEP, MOST_STEP = 0.25, 4.0
"""Change of the helix angle for a slope, and the largest correction by it [deg]."""
HELICES = np.arange(0.5, 35.01, 0.5)
"""Helix angles looked at [deg]."""


def contact_of(
    pair: GearPair,
    micro: tuple[Microgeometry, Microgeometry],
    coupling: float = USUAL_COUPLING,
    n_face: int = 21,
    n_positions: int = 128,
) -> LoadedMesh:
    """Loaded mesh on Weber and Banaschek's teeth; ``coupling`` : of the slices, in normal modules."""
    grid = FaceGrid.over(pair.face_width, n_face)
    first, second = (
        SliceCompliance(pair=pair, index=i, grid=grid, coupling_length=coupling * pair.normal_module)
        for i in (0, 1)
    )
    gap = flank_gap(PairGap.of_pair(pair, micro))
    return LoadedMesh(pair=pair, gears=(first, second), grid=grid, gap=gap, n_positions=n_positions)


@dataclass(frozen=True)
class Reading:
    """What the printed twist and tip shortening may mean.

    corner_twist : relief at the tip of the rear end of the wheel, the bilinear twist [m]; negative: the corners in
        which the mesh starts and ends are relieved
    both_cut : whether both tips are shortened, or that of the wheel alone
    """

    name: str
    corner_twist: float
    both_cut: bool = False


READINGS = (
    Reading("S_alpha = 160 um, start and end relieved", -TWIST / 4.0),
    Reading("S_alpha = 160 um, start and end kept", TWIST / 4.0),
    Reading("slope of +-160 um at each end, start and end relieved", -TWIST / 2.0),
    Reading("slope of +-160 um at each end, start and end kept", TWIST / 2.0),
    Reading("no twist", 0.0),
    Reading("both tips cut, S_alpha = 160 um, start and end relieved", -TWIST / 4.0, both_cut=True),
    Reading("both tips cut, S_alpha = 160 um, start and end kept", TWIST / 4.0, both_cut=True),
)


@dataclass(frozen=True, kw_only=True)
class GearSet:
    """One set of gears; angles [deg], lengths [m].

    shift_difference : x1 - x2; their sum follows from the centre distance
    helix_slope : f_Hbeta by which the gap opens towards the end that P1 has on the left
    rack : of the tool, in normal modules
    """

    teeth: int
    helix: float
    reading: Reading
    pressure_angle: float = 20.0
    shift_difference: float = 0.0
    helix_slope: float = HELIX_SLOPE
    rack: Rack = USUAL_RACK

    @property
    def pair(self) -> GearPair:
        """The gears; raises GearGeometryError where they cannot be made or cannot mesh."""
        equal = self._pair("equal")
        return equal if not self.shift_difference else self._pair(
            0.5 * (sum(equal.profile_shifts) + self.shift_difference)
        )  # fmt: skip

    def _pair(self, first_shift: float | str) -> GearPair:
        return GearPair.from_centre_distance(
            normal_module=MODULE,
            teeth=(self.teeth, self.teeth),
            centre_distance=CENTRE_DISTANCE,
            face_widths=(FACE_WIDTH, FACE_WIDTH),
            profile_shift_1=first_shift,  # type: ignore[arg-type]
            pressure_angle=radians(self.pressure_angle),
            helix_angle=radians(self.helix),
            racks=(self.rack, self.rack),
            tips=TipShortening(shortening=(TIP_SHORTENING if self.reading.both_cut else 0.0, TIP_SHORTENING)),
        )

    @property
    def right_is_front(self) -> bool:
        """Whether the end that P1 has on the right, whose root is blank, comes into mesh first."""
        return self.reading.corner_twist <= 0.0

    @property
    def flanks(self) -> tuple[Microgeometry, Microgeometry]:
        """Modifications of pinion and wheel."""
        slope = self.helix_slope if self.right_is_front else -self.helix_slope
        return (
            Microgeometry(lead_crowning=PINION_LEAD, helix_slope=slope),
            Microgeometry(
                profile_crowning=WHEEL_PROFILE,
                lead_crowning=WHEEL_LEAD,
                profile_twist=self.reading.corner_twist,
            ),
        )

    def loaded_ratio(self) -> float:
        """Contact ratio at 238 N m on analytic teeth [-]."""
        mesh = contact_of(self.pair, self.flanks, n_face=15, n_positions=64)
        return cycle_at(mesh, RATIO_TORQUE).contact_ratio

    def corrected(self) -> "GearSet":
        """The set at the helix angle that meets 1.24 on influence numbers too: one step by the analytic slope."""
        pair = self.pair
        mesh = elastic_contact(pair, self.flanks, elastic_gears(pair, coarse))
        miss = cycle_at(mesh, RATIO_TORQUE).contact_ratio - LOADED_RATIO
        try:
            above = replace(self, helix=self.helix + SLOPE_STEP).loaded_ratio()
        except GearGeometryError:
            return self
        step = -miss * SLOPE_STEP / (above - self.loaded_ratio())
        if abs(step) > MOST_STEP:
            return self
        other = replace(self, helix=self.helix + step)
        try:
            _ = other.pair
        except GearGeometryError:
            return self
        return other


@dataclass(frozen=True)
class GaugeStresses:
    """Root stress at gauges over the rolling angle of the pinion; ``curves`` by gauge."""

    curves: dict[str, GaugeCurve]

    @property
    def largest(self) -> dict[str, float]:
        """Largest stress by gauge [Pa]."""
        return {name: curve.peak for name, curve in self.curves.items()}

    @property
    def rise(self) -> float:
        """Rolling angle from the start of mesh to the maximum at gauge II [rad]."""
        return self.curves["II"].peak_angle - self.curves["II"].rise_angle

    @property
    def together(self) -> float:
        """Share of their maxima that gauges I, II, IV and V all reach within 0.1 rad of rolling angle, the best [-]."""
        relative = np.column_stack([self.curves[name].stress / self.curves[name].peak for name in SHOWN])
        angle = self.curves["II"].angle
        windows = [(angle >= start) & (angle <= start + MAXIMA_WITHIN) for start in angle]
        return float(max(relative[window].max(axis=0).min() for window in windows))


@cache
def gauges_of_the_case() -> dict[str, RootGauge]:
    """Gauges I to V where the case has them; a set takes them over, from its own 30 deg tangent."""
    return dict(build_rig(load_case(case_folder("strain_gauge_rig")), "quick").strain_gauges)


def gauge_stresses(cycle: MeshCycle, pinion: ElasticGear) -> GaugeStresses:
    """Stress at the gauges from influence numbers, with neighbouring teeth, mean over the grids."""
    return GaugeStresses(pinion_gauges(gauges_of_the_case(), cycle, pinion))


@dataclass(frozen=True, kw_only=True)
class Figures:
    """What a set gives of P1's figures; SI units."""

    shift_sum: float
    geometric: float
    unloaded: float
    free_torque: float
    loaded: float
    at_gauges: dict[str, float]
    rise: float
    together: float
    blank: tuple[float, ...]
    other: tuple[float, ...]
    to_the_right: tuple[float, ...]


def figures(gears: GearSet, divided: Divided = coarse) -> Figures:
    """Compute every figure of a set on influence numbers."""
    pair = gears.pair
    elastic = elastic_gears(pair, divided)
    mesh = elastic_contact(pair, gears.flanks, elastic)
    stresses = gauge_stresses(cycle_at(mesh, STRESS_TORQUE), elastic[0])
    corners = [corner_load(pair, cycle_at(mesh, torque).pattern(0)) for torque in PATTERN_TORQUES]
    diagonals = [(one.start_to_end, one.across) for one in corners]
    blank, other = zip(*(pair if gears.right_is_front else pair[::-1] for pair in diagonals), strict=True)
    side = -1.0 if gears.right_is_front else 1.0
    return Figures(
        shift_sum=sum(pair.profile_shifts),
        geometric=pair.total_contact_ratio,
        unloaded=ratio_without_load(mesh),
        free_torque=torque_of_ratio(mesh, FREE_RATIO),
        loaded=cycle_at(mesh, RATIO_TORQUE).contact_ratio,
        at_gauges=stresses.largest,
        rise=stresses.rise,
        together=stresses.together,
        blank=blank,
        other=other,
        to_the_right=tuple(side * one.centre for one in corners),
    )


def helices_of(gears: GearSet, wanted: float = LOADED_RATIO) -> Iterator[float]:
    """Helix angles [deg] at which a set, whose own is not looked at, meets the contact ratio at 238 N m."""

    def miss(helix: float) -> float:
        return replace(gears, helix=helix).loaded_ratio() - wanted

    before: tuple[float, float] | None = None
    for helix in HELICES.tolist():
        try:
            now = helix, miss(helix)
        except GearGeometryError:
            before = None
            continue
        if before is not None and before[1] * now[1] <= 0.0:
            yield float(brentq(miss, before[0], helix, xtol=0.005))
        before = now


def print_geometry() -> None:
    """Table 1."""
    print("| z1 = z2 | tips cut | beta, deg | sum of x | eps_alpha | eps_gamma |\n|---|---|---|---|---|---|")
    for both_cut in (False, True):
        for teeth in TEETH:
            found: list[tuple[float, GearPair]] = []
            reasons: list[str] = []
            for helix in HELICES.tolist():
                try:
                    pair = GearSet(teeth=teeth, helix=helix, reading=Reading("", 0.0, both_cut)).pair
                    found.append((helix, pair))
                except GearGeometryError as error:
                    reasons.append(str(error).partition(";")[0])
            cut = "both" if both_cut else "wheel"
            if not found:
                print(f"| {teeth} | {cut} | none: {reasons[0]} | | | |")
                continue
            transverse, total = ([getattr(pair, name) for _, pair in found] for name in
                                 ("transverse_contact_ratio", "total_contact_ratio"))  # fmt: skip
            shifts = [sum(pair.profile_shifts) for _, pair in found]
            print(
                f"| {teeth} | {cut} | {found[0][0]:g} to {found[-1][0]:g} | {shifts[0]:.2f} to {shifts[-1]:.2f} | "
                f"{min(transverse):.2f} to {max(transverse):.2f} | {min(total):.2f} to {max(total):.2f} |"
            )


HEAD = (
    "| {} | beta, deg | sum of x | eps_gamma, geometry | eps, no load | 1.03 at, N m | eps, 238 N m | "
    "sigma I, II, IV, V, MPa | maxima in 0.1 rad | "
    "start to maximum, rad | blank / other corners, 140 and 483 N m | to the right, mm |\n"
    + "|---" * 12
    + "|"
)


def row(name: str, gears: GearSet, divided: Divided = coarse) -> str:
    """One line of tables 2 and 3."""
    got = figures(gears, divided)
    stresses = " / ".join(f"{got.at_gauges[gauge] / 1e6:.0f}" for gauge in SHOWN)
    at = [f"{got.blank[k]:.2f}/{got.other[k]:.2f}" for k in (0, -1)]
    return (
        f"| {name} | {gears.helix:.2f} | {got.shift_sum:+.2f} | {got.geometric:.2f} | {got.unloaded:.2f} | "
        f"{got.free_torque:.0f} | {got.loaded:.3f} | {stresses} | {got.together:.2f} | {got.rise:.2f} | "
        f"{at[0]}, {at[1]} | "
        f"{1e3 * got.to_the_right[0]:.2f} to {1e3 * got.to_the_right[-1]:.2f} |"
    )


def print_fits() -> None:
    """Table 2."""
    print(HEAD.format("reading, z1 = z2"))
    readings = [(reading.name, reading, 20.0) for reading in READINGS]
    readings[1:1] = [
        (f"the same, alpha_n {angle:g} deg", READINGS[0], angle) for angle in OTHER_PRESSURE_ANGLES
    ]
    for name, reading, angle in readings:
        none = []
        for teeth in TEETH:
            gears = GearSet(teeth=teeth, helix=0.0, reading=reading, pressure_angle=angle)
            helices = list(helices_of(gears))
            for helix in helices:
                print(row(f"{name}, {teeth}", replace(gears, helix=helix).corrected()), flush=True)
            if not helices:
                none.append(str(teeth))
        print(f"| {name}, {', '.join(none)} | none |" + " |" * 10)


NEXT_BEST = GearSet(teeth=18, helix=22.18, reading=READINGS[5])
"""Of table 2 after the chosen one."""


def chosen_set() -> GearSet:
    """The set of the case: 18 teeth without profile shift, whose reference circles touch at the centre distance."""
    return GearSet(teeth=18, helix=degrees(acos(18.0 * MODULE / CENTRE_DISTANCE)), reading=READINGS[0])


def print_chosen() -> None:
    """Table 3."""
    chosen = chosen_set()
    changes: dict[str, dict[str, object]] = {
        "chosen": {},
        "beta + 1 deg": {"helix": chosen.helix + 1.0},
        "beta - 1 deg": {"helix": chosen.helix - 1.0},
        "x1 - x2 = 0.4": {"shift_difference": 0.4},
        "x1 - x2 = -0.4": {"shift_difference": -0.4},
        "alpha_n 18 deg": {"pressure_angle": 18.0},
        "alpha_n 22.5 deg": {"pressure_angle": 22.5},
        "f_Hbeta 0": {"helix_slope": 0.0},
        "f_Hbeta to the other end": {"helix_slope": -HELIX_SLOPE},
        "twist 10 % less": {"reading": Reading("", -0.9 * TWIST / 4.0)},
        "twist 30 % more": {"reading": Reading("", -1.3 * TWIST / 4.0)},
        "tip radius of the tool 0.25 m_n": {"rack": Rack(tip_radius=0.25)},
        "dedendum of the tool 1.4 m_n": {"rack": Rack(dedendum=1.4)},
    }
    print(HEAD.format("z1 = z2 = 18"))
    for name, change in changes.items():
        print(row(name, replace(chosen, **change)), flush=True)  # type: ignore[arg-type]
    print(row("chosen, standard influence numbers", chosen, standard), flush=True)
    print(row(f"next best, {NEXT_BEST.reading.name}, standard", NEXT_BEST, standard), flush=True)


def main() -> None:
    with threadpool_limits(limits=1):
        for table in (print_geometry, print_fits, print_chosen):
            table()
            print()
    crowned = Microgeometry(lead_crowning=WHEEL_LEAD, manufacturing_twist=1.0)
    natural = FlankField(pair=chosen_set().pair, index=1, micro=crowned).natural_twist
    kept = "start and end kept" if natural < 0.0 else "start and end relieved"
    print(f"Natural twist of the wheel's lead crowning: {abs(1e6 * natural):.0f} um, {kept}.")


if __name__ == "__main__":
    main()
