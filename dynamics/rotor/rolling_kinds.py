"""Kinds of rolling bearings: what each makes of the numbers of its catalogue.

A kind is a class here, registered under its name: rolling elements, equivalent loads and least load, constants of both
friction laws, clearance classes, and what it says of a load it should not have. Nothing else asks which kind a bearing
is. Sources: ISO 281 and ISO 76 with the factors of the catalogues (SKF General Catalogue 6000, chapters of the kinds;
NSK for the same factors of angular contact ball bearings).

Catalogues give neither number nor size of the rolling elements. What is derived here gives the printed static rating
C_0 again by the formula of ISO 76, so that number, size and length fit each other; every other assumption is named in
`RollingElements.source`:

- pitch diameter: middle of bore and outside diameter, of both raceways where they are printed
- balls, deep groove: as many as a Conrad assembly takes (at most `FILLING_ANGLE` from first to last ball)
- balls, angular contact: as many as leave a tenth of the pitch circle for the cage
- rollers, cylindrical: diameter half of the difference of the printed raceways; `ROLLER_FILL` of the pitch circle
- rollers, tapered: mean diameter `TAPERED_ROLLER_SHARE` of D - d; `ROLLER_FILL` of the pitch circle filled
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import ClassVar, TypeVar

from dynamics.rotor.bearing import BearingError
from dynamics.rotor.rolling_elements import RollingElements, ball_diameter, rollers
from dynamics.rotor.rolling_friction import (
    RPM,
    FrictionConditions,
    FrictionLaw,
    FrictionTorque,
    four_sources,
)
from dynamics.standards import iso281_2007, iso5753_1_2009
from dynamics.standards import iso_tr_14179_2_2001 as palmgren
from dynamics.standards import skf_friction_2006 as skf

FILLING_ANGLE = math.radians(198.0)
"""Largest arc between the first and the last ball centre of a Conrad assembly [rad]; assumed. It gives the known ball
numbers of the series 62 and 63."""
BALL_FILL = 0.9
"""Share of the pitch circle filled with balls of an angular contact bearing; assumed."""
TAPERED_ROLLER_SHARE = 0.24
"""Mean roller diameter over D - d of a tapered roller bearing; assumed."""
MOST_BALLS = 40
LEAST_ELEMENT = 0.1
"""Diameter of rolling elements over D - d below which a static rating does not belong to its bearing (0.2 to 0.35 in
catalogues)."""
LEAST_ROLLER = 0.3
"""Length over diameter of rollers below which it does not (0.7 to 3 in catalogues)."""
LARGEST_AXIAL_SHARE = 0.5
"""F_a / F_r that flanges of a cylindrical roller bearing, F_a / C_0 that a deep groove ball bearing should carry."""
DEEP_GROOVE_FACTORS = (
    (0.172, 0.19, 2.30), (0.345, 0.22, 1.99), (0.689, 0.26, 1.71), (1.03, 0.28, 1.55), (1.38, 0.30, 1.45),
    (2.07, 0.34, 1.31), (3.45, 0.38, 1.15), (5.17, 0.42, 1.04), (6.89, 0.44, 1.00),
)  # fmt: skip
"""f_0 F_a / C_0, e, Y of deep groove ball bearings with normal clearance, X = 0.56 (SKF 6000 table 5 p. 299)."""


@dataclass(frozen=True, kw_only=True)
class CatalogueBearing:
    """One bearing with the numbers its catalogue prints.

    designation : as ordered
    kind, series : kind of bearing, one of `ROLLING_KINDS`, and one of its dimension series; it decides the friction
        coefficients
    bore, outside_diameter, width : d, D, B (T of a tapered roller bearing) [m]
    dynamic_rating, static_rating : C, C_0 [N]
    fatigue_limit : fatigue load limit P_u [N]; None takes the simplified one of ISO 281
    limiting_speed, reference_speed : mechanical and thermal limit [rad/s]
    contact_angle : [rad]; of a tapered roller bearing atan(e / 1.5)
    axial_limit, axial_factor, static_axial_factor : e, Y, Y_0 of kinds with a contact angle [-]; not read for others
    f_0 : of deep groove ball bearings [-]; None takes that of ISO 76
    minimum_load_factor : k_r of ball and cylindrical roller bearings [-]
    inner_raceway, outer_raceway : diameters F, E of kinds whose catalogues print them [m]
    locating : carries axial load; False for NU and N
    rolling_elements : where known; None derives them
    source, unconfirmed : where the numbers come from, and the names of those that could not be read there

    Raises BearingError naming key, value and remedy.
    """

    designation: str
    kind: str
    series: str
    bore: float
    outside_diameter: float
    width: float
    dynamic_rating: float
    static_rating: float
    limiting_speed: float
    reference_speed: float
    fatigue_limit: float | None = None
    contact_angle: float = 0.0
    axial_limit: float = 0.0
    axial_factor: float = 0.0
    static_axial_factor: float = 0.0
    f_0: float | None = None
    minimum_load_factor: float = 0.0
    inner_raceway: float = 0.0
    outer_raceway: float = 0.0
    locating: bool = True
    rolling_elements: RollingElements | None = None
    source: str = "given"
    unconfirmed: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.kind not in ROLLING_KINDS:
            raise self.wrong("kind", repr(self.kind), f"must be one of {', '.join(ROLLING_KINDS)}")
        if self.series not in self.rules.series:
            raise self.wrong(
                "series", repr(self.series),
                f"no friction coefficients for it; give the nearest of {', '.join(self.rules.series)}",
            )  # fmt: skip
        for name in (
            "bore", "outside_diameter", "width", "dynamic_rating", "static_rating", "limiting_speed", "reference_speed",
        ):  # fmt: skip
            value = getattr(self, name)
            if not (value > 0.0 and math.isfinite(value)):
                raise self.wrong(name, f"{value:.6g}", "must be above 0; give the number of the catalogue")
        if not self.outside_diameter > self.bore:
            raise self.wrong(
                "outside_diameter",
                f"{self.outside_diameter:.6g} m",
                f"must be above the bore {self.bore:.6g} m",
            )
        self.rules.check(self)

    def wrong(self, name: str, value: str, remedy: str) -> BearingError:
        """Error about one of its numbers."""
        return BearingError(f"rolling bearing {self.designation}: {name} = {value}: {remedy}")

    @property
    def rules(self) -> "RollingKind":
        """What its kind makes of its numbers."""
        return ROLLING_KINDS[self.kind]

    @property
    def size(self) -> skf.Size:
        """Main dimensions [mm]."""
        return skf.Size(self.bore * 1e3, self.outside_diameter * 1e3, self.width * 1e3)

    @property
    def mean_diameter(self) -> float:
        """d_m = (d + D) / 2 [m]."""
        return 0.5 * (self.bore + self.outside_diameter)

    @property
    def carries_axial_load(self) -> bool:
        """Whether its rings hold each other along the axis."""
        return self.locating and self.rules.carries_axial_load

    def check_axial(self, axial: float) -> None:
        """Raises BearingError for axial load [N] on a bearing that cannot carry it."""
        if axial > 0.0 and not self.carries_axial_load:
            raise BearingError(
                f"rolling bearing {self.designation}: axial_load = {axial:.6g} N: its rings move past each other and "
                "carry none; take the axial load up in the other bearing or choose NJ, NUP or a locating kind"
            )

    @cached_property
    def elements(self) -> RollingElements:
        """Rolling elements, given or derived.

        Raises BearingError for a static rating that no rolling elements between bore and outside diameter have.
        """
        if self.rolling_elements is not None:
            return self.rolling_elements
        derived = self.rules.elements(self)
        section, size = self.outside_diameter - self.bore, derived.diameter
        fits = LEAST_ELEMENT * section <= size < 0.5 * section
        if derived.roller:
            fits = fits and LEAST_ROLLER * size <= derived.length <= self.width
        if not fits:
            length = f" and {1e3 * derived.length:.3g} mm long" if derived.roller else ""
            raise self.wrong(
                "static_rating",
                f"{self.static_rating:.6g} N",
                f"would need {derived.count} rolling elements of {1e3 * size:.3g} mm{length}, which do not fit d = "
                f"{1e3 * self.bore:.4g}, D = {1e3 * self.outside_diameter:.4g}, B = {1e3 * self.width:.4g} mm; give "
                "C_0 and main dimensions of the catalogue",
            )
        return derived

    @cached_property
    def fatigue_load(self) -> float:
        """Fatigue load limit [N], of the catalogue or the simplified one of ISO 281."""
        if self.fatigue_limit is not None:
            return self.fatigue_limit
        return iso281_2007.C_u(self.static_rating, self.elements.pitch_diameter * 1e3, self.rules.contact)


class RollingKind(ABC):
    """What a kind of rolling bearing answers for one of its bearings; loads in N, none of them negative."""

    name: ClassVar[str]
    """As a case writes it."""
    contact: ClassVar[iso281_2007.Contact]
    """Of the rolling elements."""
    series: ClassVar[tuple[str, ...]]
    """Dimension series for which its friction laws have coefficients."""
    rexs_type: ClassVar[str] = ""
    """Type in a REXS file; empty for a kind that is not read from one."""
    carries_axial_load: ClassVar[bool] = True
    """Whether any bearing of the kind does."""
    comes_loose: ClassVar[bool] = False
    """Whether some of its bearings have rings that move past each other."""
    prints_raceways: ClassVar[bool] = False
    """Whether catalogues print its raceway diameters F and E."""
    has_contact_angle: ClassVar[bool] = False
    """Whether it has a contact angle with the factors e, Y, Y_0."""
    clearance_classes: ClassVar[iso5753_1_2009.Table | None] = None
    """Classes of the radial internal clearance; None for a kind whose clearance is set at assembly."""
    friction_sources: ClassVar[Mapping[FrictionLaw, str]]
    """Document behind the friction, by the laws that the kind has."""

    def check(self, bearing: CatalogueBearing) -> None:
        """Raise BearingError for numbers that the kind cannot have."""
        if not self.has_contact_angle:
            return
        for name in ("contact_angle", "axial_limit", "axial_factor", "static_axial_factor"):
            value = getattr(bearing, name)
            if not value > 0.0:
                raise bearing.wrong(
                    name,
                    f"{value:.6g}",
                    "must be above 0 for this kind; give alpha, e, Y, Y_0 of the catalogue",
                )

    @abstractmethod
    def elements(self, bearing: CatalogueBearing) -> RollingElements:
        """Rolling elements that have its static rating; BearingError where none have."""

    @abstractmethod
    def equivalent_load(self, bearing: CatalogueBearing, radial: float, axial: float) -> float:
        """Dynamic equivalent load P [N] of a single bearing; the axial force is the one inside it."""

    def static_equivalent_load(self, bearing: CatalogueBearing, radial: float, axial: float) -> float:
        """Static equivalent load P_0 [N] of a single bearing."""
        return max(radial, 0.5 * radial + bearing.static_axial_factor * axial)

    def induced_axial_load(self, bearing: CatalogueBearing, radial: float) -> float:
        """Axial force that a radial load produces inside the bearing [N]; 0 without a contact angle."""
        return 0.0

    def minimum_load(self, bearing: CatalogueBearing, speed: float, viscosity: float) -> float:
        """Radial load below which rolling elements may slide [N]; kinematic viscosity [m2/s], speed [rad/s].

        Balls k_r (nu n / 1000)^(2/3) (d_m / 100)^2 kN (SKF General Catalogue 6000 p. 299).
        """
        size = (bearing.mean_diameter * 10.0) ** 2
        product = viscosity * 1e6 * speed / RPM / 1000.0
        load: float = 1e3 * bearing.minimum_load_factor * product ** (2.0 / 3.0) * size
        return load

    def load_warnings(self, bearing: CatalogueBearing, radial: float, axial: float) -> Iterator[str]:
        """Sentences about loads that the bearing should not have: name, value, limit, remedy."""
        yield from ()

    def contact_angle(self, axial_limit: float) -> float | None:
        """Contact angle [rad] that follows from e; None where it does not."""
        return None

    @abstractmethod
    def friction(
        self, law: FrictionLaw, bearing: CatalogueBearing, given: FrictionConditions
    ) -> FrictionTorque:
        """Friction torque of the open bearing by one of its laws."""


ROLLING_KINDS: dict[str, RollingKind] = {}
"""Every kind by its name."""


class TwoLawKind(RollingKind):
    """A kind with the four sources of SKF and Palmgren's law."""

    skf_constants: ClassVar[skf.KindConstants]
    """Of the friction law ``skf``."""
    palmgren_constants: ClassVar[Mapping[str, palmgren.Coefficients]]
    """Of the friction law ``iso_tr_14179_2``, by series."""
    friction_sources: ClassVar[Mapping[FrictionLaw, str]] = {
        "iso_tr_14179_2": "ISO/TR 14179-2 (Palmgren), f_0 and f_1 of DIN 732-2",
        "skf": "SKF General Catalogue 6000, four-source model",
    }

    def friction(
        self, law: FrictionLaw, bearing: CatalogueBearing, given: FrictionConditions
    ) -> FrictionTorque:
        """Friction torque of the open bearing."""
        return self._skf(bearing, given) if law == "skf" else self._palmgren(bearing, given)

    @abstractmethod
    def skf_moments(self, bearing: CatalogueBearing, radial: float, axial: float, n: float) -> skf.Moments:
        """G_rr and G_sl of the SKF model at loads [N] and a speed [1/min], in its units."""

    def palmgren_load(self, bearing: CatalogueBearing, radial: float, axial: float) -> float:
        """P_1, which decides the load-dependent torque of Palmgren's law [N]."""
        return radial

    def palmgren_flange_torque(self, bearing: CatalogueBearing, given: FrictionConditions) -> float:
        """T_VL2 of Palmgren's law [N mm]."""
        return 0.0

    def _skf(self, bearing: CatalogueBearing, given: FrictionConditions) -> FrictionTorque:
        moments = self.skf_moments(bearing, given.radial, given.axial, given.speed / RPM)
        return four_sources(self.skf_constants, moments, bearing.size, bearing.elements.diameter, given)

    def _palmgren(self, bearing: CatalogueBearing, given: FrictionConditions) -> FrictionTorque:
        row = self.palmgren_constants[bearing.series]
        d_m, n, nu = bearing.mean_diameter * 1e3, given.speed / RPM, given.viscosity * 1e6
        static = self.static_equivalent_load(bearing, given.radial, given.axial)
        f_1 = palmgren.f_1(row, static, bearing.static_rating)
        load = self.palmgren_load(bearing, given.radial, given.axial)
        f_0 = row.f_0 * palmgren.LUBRICATION_FACTOR[given.lubrication]
        return FrictionTorque(
            rolling=1e-3 * palmgren.T_VL1(f_1, load, d_m),
            sliding=1e-3 * self.palmgren_flange_torque(bearing, given),
            drag=1e-3 * palmgren.T_VL0(f_0, nu, n, d_m),
        )


K = TypeVar("K", bound=RollingKind)


def _registered(kind: type[K]) -> type[K]:
    ROLLING_KINDS[kind.name] = kind()
    return kind


@_registered
class DeepGrooveBall(TwoLawKind):
    """Deep groove ball bearing, single row."""

    name = "deep_groove_ball"
    contact = "ball"
    series = ("60", "62", "63", "64", "160", "618", "619")
    rexs_type = "radial_grooved_ball_bearing"
    clearance_classes = iso5753_1_2009.DEEP_GROOVE_BALL
    skf_constants = skf.KindConstants(K_Z=3.1)
    palmgren_constants = palmgren.DEEP_GROOVE_BALL

    def elements(self, bearing: CatalogueBearing) -> RollingElements:
        """Balls: of all numbers that give C_0 the largest that can be filled in."""
        pitch = bearing.mean_diameter
        best = None
        for count in range(5, MOST_BALLS):
            diameter = ball_diameter(count, pitch, bearing.static_rating, 0.0, bearing.f_0)
            if diameter is None:
                continue
            arc = 2.0 * (count - 1) * math.asin(diameter / pitch)
            if arc <= FILLING_ANGLE:
                best = (count, diameter)
        return _balls(bearing, best, 0.0, "C_0 by ISO 76 and a filling angle of 198 degrees (assumed)")

    def equivalent_load(self, bearing: CatalogueBearing, radial: float, axial: float) -> float:
        """X = 0.56 and Y above e."""
        limit, factor = self._factors(bearing, axial)
        return radial if axial <= limit * radial else max(radial, 0.56 * radial + factor * axial)

    def static_equivalent_load(self, bearing: CatalogueBearing, radial: float, axial: float) -> float:
        """0.6 F_r + 0.5 F_a, at least F_r."""
        return max(radial, 0.6 * radial + 0.5 * axial)

    def load_warnings(self, bearing: CatalogueBearing, radial: float, axial: float) -> Iterator[str]:
        """Axial load above half of C_0."""
        if axial > LARGEST_AXIAL_SHARE * bearing.static_rating:
            yield (
                f"axial load = {axial:.0f} N: above half the static rating {bearing.static_rating:.0f} N; take an "
                "angular contact bearing"
            )

    def skf_moments(self, bearing: CatalogueBearing, radial: float, axial: float, n: float) -> skf.Moments:
        """Table 2a."""
        d_m = bearing.mean_diameter * 1e3
        return skf.deep_groove(skf.DEEP_GROOVE[bearing.series], d_m, radial, axial, bearing.static_rating)

    def palmgren_load(self, bearing: CatalogueBearing, radial: float, axial: float) -> float:
        """3 F_a - 0.1 F_r, at least F_r."""
        return max(radial, 3.0 * axial - 0.1 * radial)

    def _factors(self, bearing: CatalogueBearing, axial: float) -> tuple[float, float]:
        """e and Y, linear between the printed values and constant outside them."""
        f_0 = 14.0 if bearing.f_0 is None else bearing.f_0
        relative = f_0 * axial / bearing.static_rating
        first, last = DEEP_GROOVE_FACTORS[0], DEEP_GROOVE_FACTORS[-1]
        if relative <= first[0]:
            return first[1], first[2]
        for low, high in pairwise(DEEP_GROOVE_FACTORS):
            if relative <= high[0]:
                share = (relative - low[0]) / (high[0] - low[0])
                return low[1] + share * (high[1] - low[1]), low[2] + share * (high[2] - low[2])
        return last[1], last[2]


@_registered
class CylindricalRoller(TwoLawKind):
    """Cylindrical roller bearing with cage, single row."""

    name = "cylindrical_roller"
    contact = "roller"
    series = ("2", "3", "4", "10", "22", "23")
    rexs_type = "radial_roller_bearing"
    comes_loose = True
    prints_raceways = True
    clearance_classes = iso5753_1_2009.CYLINDRICAL_ROLLER
    skf_constants = skf.KindConstants(K_Z=5.1, K_L=0.65, mu_EHL=0.02)
    palmgren_constants = palmgren.CYLINDRICAL_ROLLER

    def check(self, bearing: CatalogueBearing) -> None:
        """Raceways between bore and outside diameter."""
        inside = bearing.bore < bearing.inner_raceway < bearing.outer_raceway < bearing.outside_diameter
        if bearing.rolling_elements is None and not inside:
            raise bearing.wrong(
                "inner_raceway, outer_raceway", f"{bearing.inner_raceway:.6g}, {bearing.outer_raceway:.6g} m",
                "must lie between bore and outside diameter; give F and E of the catalogue or the rolling elements",
            )  # fmt: skip

    def elements(self, bearing: CatalogueBearing) -> RollingElements:
        """Rollers from the printed raceway diameters F, E."""
        inner, outer = bearing.inner_raceway, bearing.outer_raceway
        return rollers(
            0.5 * (inner + outer), 0.5 * (outer - inner), bearing.static_rating, 0.0,
            "raceways, C_0 by ISO 76 and 82 % of the pitch circle filled (assumed)",
        )  # fmt: skip

    def equivalent_load(self, bearing: CatalogueBearing, radial: float, axial: float) -> float:
        """0.92 F_r + Y F_a above e."""
        limit, factor = (0.2, 0.6) if bearing.series in ("10", "2", "3", "4") else (0.3, 0.4)
        return radial if axial <= limit * radial else 0.92 * radial + factor * axial

    def static_equivalent_load(self, bearing: CatalogueBearing, radial: float, axial: float) -> float:
        """F_r."""
        return radial

    def minimum_load(self, bearing: CatalogueBearing, speed: float, viscosity: float) -> float:
        """k_r (6 + 4 n / n_r) (d_m / 100)^2 kN (SKF General Catalogue 6000 p. 518)."""
        size = (bearing.mean_diameter * 10.0) ** 2
        return 1e3 * bearing.minimum_load_factor * (6.0 + 4.0 * speed / bearing.reference_speed) * size

    def load_warnings(self, bearing: CatalogueBearing, radial: float, axial: float) -> Iterator[str]:
        """Axial load above half of the radial one."""
        if axial > LARGEST_AXIAL_SHARE * radial:
            yield (
                f"axial load = {axial:.0f} N: above half the radial load {radial:.0f} N, flanges overload; take "
                "the axial load up elsewhere"
            )

    def skf_moments(self, bearing: CatalogueBearing, radial: float, axial: float, n: float) -> skf.Moments:
        """Table 2a."""
        return skf.cylindrical(skf.CYLINDRICAL[bearing.series], bearing.mean_diameter * 1e3, radial, axial)

    def palmgren_flange_torque(self, bearing: CatalogueBearing, given: FrictionConditions) -> float:
        """Of the flange contacts under axial load."""
        f_2 = palmgren.F_2["grease" if given.lubrication == "grease" else "oil"]
        return palmgren.T_VL2(f_2, given.axial, bearing.mean_diameter * 1e3)


@_registered
class TaperedRoller(TwoLawKind):
    """Tapered roller bearing, single row."""

    name = "tapered_roller"
    contact = "roller"
    series = ("302", "303", "313", "320", "322", "323", "329", "330", "331", "332")
    rexs_type = "radial_tapered_roller_bearing"
    has_contact_angle = True
    skf_constants = skf.KindConstants(K_Z=6.0, K_L=0.7, mu_EHL=0.002)
    palmgren_constants = palmgren.TAPERED_ROLLER

    def elements(self, bearing: CatalogueBearing) -> RollingElements:
        """Rollers from the main dimensions and the contact angle."""
        return rollers(
            0.5 * (bearing.bore + bearing.outside_diameter),
            TAPERED_ROLLER_SHARE * (bearing.outside_diameter - bearing.bore),
            bearing.static_rating,
            bearing.contact_angle,
            "C_0 by ISO 76, roller diameter 0.24 (D - d) and 82 % of the pitch circle filled (assumed)",
        )

    def equivalent_load(self, bearing: CatalogueBearing, radial: float, axial: float) -> float:
        """0.4 F_r + Y F_a above e."""
        return (
            radial if axial <= bearing.axial_limit * radial else 0.4 * radial + bearing.axial_factor * axial
        )

    def induced_axial_load(self, bearing: CatalogueBearing, radial: float) -> float:
        """F_r / (2 Y) (SKF 6000 table 3 p. 613)."""
        return radial / (2.0 * bearing.axial_factor)

    def minimum_load(self, bearing: CatalogueBearing, speed: float, viscosity: float) -> float:
        """0.02 C (SKF General Catalogue 6000 p. 611)."""
        return 0.02 * bearing.dynamic_rating

    def contact_angle(self, axial_limit: float) -> float | None:
        """e = 1.5 tan(alpha) (ISO 281)."""
        return math.atan(axial_limit / 1.5)

    def skf_moments(self, bearing: CatalogueBearing, radial: float, axial: float, n: float) -> skf.Moments:
        """Table 2a."""
        row, d_m = skf.TAPERED[bearing.series], bearing.mean_diameter * 1e3
        return skf.tapered(row, d_m, radial, axial, bearing.axial_factor)

    def palmgren_load(self, bearing: CatalogueBearing, radial: float, axial: float) -> float:
        """2 Y F_a, at least F_r."""
        return max(radial, 2.0 * bearing.axial_factor * axial)


@_registered
class AngularContactBall(TwoLawKind):
    """Angular contact ball bearing of 40 degrees, single row."""

    name = "angular_contact_ball"
    contact = "ball"
    series = ("72B", "73B")
    rexs_type = "angular_contact_ball_bearing"
    has_contact_angle = True
    skf_constants = skf.KindConstants(K_Z=4.4)
    palmgren_constants = palmgren.ANGULAR_CONTACT_BALL

    def elements(self, bearing: CatalogueBearing) -> RollingElements:
        """Balls: the largest number that leaves a tenth of the pitch circle for the cage."""
        pitch, angle = bearing.mean_diameter, bearing.contact_angle
        best = None
        for count in range(5, MOST_BALLS):
            diameter = ball_diameter(count, pitch, bearing.static_rating, angle, None)
            if diameter is not None and count * diameter <= BALL_FILL * math.pi * pitch:
                best = (count, diameter)
        source = "C_0 by ISO 76 and nine tenths of the pitch circle filled (assumed)"
        return _balls(bearing, best, angle, source)

    def equivalent_load(self, bearing: CatalogueBearing, radial: float, axial: float) -> float:
        """0.35 F_r + Y F_a above e."""
        return (
            radial if axial <= bearing.axial_limit * radial else 0.35 * radial + bearing.axial_factor * axial
        )

    def induced_axial_load(self, bearing: CatalogueBearing, radial: float) -> float:
        """e F_r (the value at high load; less below it)."""
        return bearing.axial_limit * radial

    def skf_moments(self, bearing: CatalogueBearing, radial: float, axial: float, n: float) -> skf.Moments:
        """Table 2a."""
        return skf.angular_contact(skf.ANGULAR_CONTACT, bearing.mean_diameter * 1e3, radial, axial, n)

    def palmgren_load(self, bearing: CatalogueBearing, radial: float, axial: float) -> float:
        """F_a - 0.1 F_r, at least F_r."""
        return max(radial, axial - 0.1 * radial)


@_registered
class NeedleRoller(RollingKind):
    """Needle roller bearing with machined rings and cage, single row.

    Its rings and needles move past each other: it carries no axial load, another bearing has to guide the shaft. SKF
    has no constants of the four-source model for it, only a constant coefficient M = 0.5 mu P d (Rolling bearings,
    chapter Friction, table 1: 0.0020 for needle roller bearings with a cage; P near 0.1 C, good lubrication, normal
    operating conditions), which holds the usual drag of its oil as well. Loads: SKF, needle roller bearings: P = P_0 =
    F_r, least load 0.02 C. Clearance classes are those of cylindrical roller bearings (from memory).
    """

    name = "needle_roller"
    contact = "roller"
    series = ("48", "49", "59", "69")
    carries_axial_load = False
    prints_raceways = True
    clearance_classes = iso5753_1_2009.CYLINDRICAL_ROLLER
    friction_sources: ClassVar[Mapping[FrictionLaw, str]] = {
        "skf": "SKF Rolling bearings, constant coefficient of friction",
    }
    mu = 0.0020
    """Constant coefficient of friction, on the radius of the bore [-]."""
    needle_share = 0.2
    """Needle diameter over D - d where E is not given; assumed. With F and C_0 given, the length of the needles does
    not depend on it, their stiffness is inversely proportional."""
    load_range = (0.05, 0.2)
    """P / C in which the coefficient is taken to hold; assumed about the 0.1 of SKF."""

    def check(self, bearing: CatalogueBearing) -> None:
        """Raceways between bore and outside diameter; E may be left out."""
        inner, outer = bearing.inner_raceway, bearing.outer_raceway
        inside = (
            bearing.bore < inner < (outer or bearing.outside_diameter) and outer < bearing.outside_diameter
        )
        if bearing.rolling_elements is None and not inside:
            raise bearing.wrong(
                "inner_raceway, outer_raceway", f"{inner:.6g}, {outer:.6g} m",
                "must lie between bore and outside diameter; give F of the catalogue, E or the rolling elements",
            )  # fmt: skip

    def elements(self, bearing: CatalogueBearing) -> RollingElements:
        """Needles on the raceway F; their diameter from E, or a share of the section."""
        inner, outer = bearing.inner_raceway, bearing.outer_raceway
        known = 0.5 * (outer - inner)
        diameter = known if outer else self.needle_share * (bearing.outside_diameter - bearing.bore)
        size = "raceways" if outer else "raceway F, needle diameter 0.2 (D - d) (assumed)"
        source = f"{size}, C_0 by ISO 76 and 82 % of the pitch circle filled (assumed)"
        return rollers(inner + diameter, diameter, bearing.static_rating, 0.0, source)

    def equivalent_load(self, bearing: CatalogueBearing, radial: float, axial: float) -> float:
        """F_r."""
        return radial

    def static_equivalent_load(self, bearing: CatalogueBearing, radial: float, axial: float) -> float:
        """F_r."""
        return radial

    def minimum_load(self, bearing: CatalogueBearing, speed: float, viscosity: float) -> float:
        """0.02 C."""
        return 0.02 * bearing.dynamic_rating

    def load_warnings(self, bearing: CatalogueBearing, radial: float, axial: float) -> Iterator[str]:
        """Load far from that at which the coefficient of friction is stated."""
        low, high = (share * bearing.dynamic_rating for share in self.load_range)
        if radial and not low <= radial <= high:
            yield (
                f"radial load = {radial:.0f} N: outside {low:.0f} to {high:.0f} N, about 0.1 C, where the constant "
                "coefficient of friction of a needle roller bearing holds; measure its friction, or take another size"
            )

    def friction(
        self, law: FrictionLaw, bearing: CatalogueBearing, given: FrictionConditions
    ) -> FrictionTorque:
        """0.5 mu P d, as rolling friction."""
        return FrictionTorque(rolling=0.5 * self.mu * given.radial * bearing.bore)


def _balls(
    bearing: CatalogueBearing, best: tuple[int, float] | None, angle: float, source: str
) -> RollingElements:
    if best is None:
        raise BearingError(
            f"rolling elements: static_rating = {bearing.static_rating:.6g} N: no number of balls from 5 to "
            f"{MOST_BALLS - 1} has it between bore and outside diameter; correct C_0, bore and outside diameter or "
            "give the rolling elements themselves"
        )
    count, diameter = best
    return RollingElements(
        count=count,
        diameter=diameter,
        pitch_diameter=bearing.mean_diameter,
        contact_angle=angle,
        source=source,
    )
