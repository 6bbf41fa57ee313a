"""Catalogue numbers of rolling bearings: a small table by designation, any other bearing by its numbers.

The table `rolling_bearings.csv` lies next to this module; each row names catalogue and page of its numbers, and a
column `unconfirmed` the names of those that could not be read there.
"""

import csv
import difflib
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from importlib.resources import files
from typing import Literal, cast, get_args

from dynamics.rotor.bearing import BearingError
from dynamics.rotor.rolling_row import (
    RollingElements,
    angular_contact_balls,
    cylindrical_rollers,
    deep_groove_balls,
    tapered_rollers,
)
from dynamics.standards import iso281_2007

BearingKind = Literal["deep_groove_ball", "cylindrical_roller", "tapered_roller", "angular_contact_ball"]
KINDS: tuple[BearingKind, ...] = get_args(BearingKind)

DESCRIBED_SERIES: dict[BearingKind, tuple[str, ...]] = {
    "deep_groove_ball": ("60", "62", "63", "64", "160", "618", "619"),
    "cylindrical_roller": ("2", "3", "4", "10", "22", "23"),
    "tapered_roller": ("302", "303", "313", "320", "322", "323", "329", "330", "331", "332"),
    "angular_contact_ball": ("72B", "73B"),
}
"""Dimension series for which both friction laws have coefficients."""

LEAST_ELEMENT = 0.1
"""Diameter of rolling elements over D - d below which a static rating does not belong to its bearing (0.2 to 0.35 in
catalogues)."""
LEAST_ROLLER = 0.3
"""Length over diameter of rollers below which it does not (0.7 to 3 in catalogues)."""
TABLE = "rolling_bearings.csv"
RPM = math.pi / 30.0


@dataclass(frozen=True, kw_only=True)
class CatalogueBearing:
    """One bearing with the numbers its catalogue prints.

    designation : as ordered
    kind, series : kind of bearing and its dimension series, one of `DESCRIBED_SERIES`; it decides the friction
        coefficients
    bore, outside_diameter, width : d, D, B (T of a tapered roller bearing) [m]
    dynamic_rating, static_rating : C, C_0 [N]
    fatigue_limit : fatigue load limit P_u [N]; None takes the simplified one of ISO 281
    limiting_speed, reference_speed : mechanical and thermal limit [rad/s]
    contact_angle : [rad]; of a tapered roller bearing atan(e / 1.5)
    axial_limit, axial_factor, static_axial_factor : e, Y, Y_0 of tapered and angular contact bearings [-]; not read
        for other kinds
    f_0 : of deep groove ball bearings [-]; None takes that of ISO 76
    minimum_load_factor : k_r of ball and cylindrical roller bearings [-]
    inner_raceway, outer_raceway : diameters F, E of cylindrical roller bearings [m]
    locating : carries axial load; False for NU and N
    rolling_elements : where known; None derives them, see `dynamics.rotor.rolling_row`
    source, unconfirmed : where the numbers come from, and the names of those that could not be read there

    Raises BearingError naming key, value and remedy.
    """

    designation: str
    kind: BearingKind
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
        if self.kind not in KINDS:
            raise self._wrong("kind", repr(self.kind), f"must be one of {', '.join(KINDS)}")
        if self.series not in DESCRIBED_SERIES[self.kind]:
            raise self._wrong(
                "series", repr(self.series),
                f"no friction coefficients for it; give the nearest of {', '.join(DESCRIBED_SERIES[self.kind])}",
            )  # fmt: skip
        for name in (
            "bore", "outside_diameter", "width", "dynamic_rating", "static_rating", "limiting_speed", "reference_speed",
        ):  # fmt: skip
            value = getattr(self, name)
            if not (value > 0.0 and math.isfinite(value)):
                raise self._wrong(name, f"{value:.6g}", "must be above 0; give the number of the catalogue")
        if not self.outside_diameter > self.bore:
            raise self._wrong(
                "outside_diameter",
                f"{self.outside_diameter:.6g} m",
                f"must be above the bore {self.bore:.6g} m",
            )
        self._check_kind()

    def _check_kind(self) -> None:
        if self.kind == "cylindrical_roller" and self.rolling_elements is None:
            inside = self.bore < self.inner_raceway < self.outer_raceway < self.outside_diameter
            if not inside:
                raise self._wrong(
                    "inner_raceway, outer_raceway", f"{self.inner_raceway:.6g}, {self.outer_raceway:.6g} m",
                    "must lie between bore and outside diameter; give F and E of the catalogue or the rolling elements",
                )  # fmt: skip
        if self.kind in ("tapered_roller", "angular_contact_ball"):
            for name in ("contact_angle", "axial_limit", "axial_factor", "static_axial_factor"):
                value = getattr(self, name)
                if not value > 0.0:
                    raise self._wrong(
                        name,
                        f"{value:.6g}",
                        "must be above 0 for this kind; give alpha, e, Y, Y_0 of the catalogue",
                    )

    def _wrong(self, name: str, value: str, remedy: str) -> BearingError:
        return BearingError(f"rolling bearing {self.designation}: {name} = {value}: {remedy}")

    @property
    def mean_diameter(self) -> float:
        """d_m = (d + D) / 2 [m]."""
        return 0.5 * (self.bore + self.outside_diameter)

    @property
    def contact(self) -> iso281_2007.Contact:
        """Contact of the rolling elements: ``ball`` or ``roller``."""
        return "ball" if self.kind in ("deep_groove_ball", "angular_contact_ball") else "roller"

    @cached_property
    def elements(self) -> RollingElements:
        """Rolling elements, given or derived.

        Raises BearingError for a static rating that no rolling elements between bore and outside diameter have.
        """
        if self.rolling_elements is not None:
            return self.rolling_elements
        derived = self._derived_elements()
        section, size = self.outside_diameter - self.bore, derived.diameter
        fits = LEAST_ELEMENT * section <= size < 0.5 * section
        if derived.roller:
            fits = fits and LEAST_ROLLER * size <= derived.length <= self.width
        if not fits:
            length = f" and {1e3 * derived.length:.3g} mm long" if derived.roller else ""
            raise self._wrong(
                "static_rating",
                f"{self.static_rating:.6g} N",
                f"would need {derived.count} rolling elements of {1e3 * size:.3g} mm{length}, which do not fit d = "
                f"{1e3 * self.bore:.4g}, D = {1e3 * self.outside_diameter:.4g}, B = {1e3 * self.width:.4g} mm; give "
                "C_0 and main dimensions of the catalogue",
            )
        return derived

    def _derived_elements(self) -> RollingElements:
        if self.kind == "deep_groove_ball":
            return deep_groove_balls(self.mean_diameter, self.static_rating, self.f_0)
        if self.kind == "angular_contact_ball":
            return angular_contact_balls(self.mean_diameter, self.static_rating, self.contact_angle)
        if self.kind == "cylindrical_roller":
            return cylindrical_rollers(self.inner_raceway, self.outer_raceway, self.static_rating)
        return tapered_rollers(self.bore, self.outside_diameter, self.static_rating, self.contact_angle)

    @cached_property
    def fatigue_load(self) -> float:
        """Fatigue load limit [N], of the catalogue or the simplified one of ISO 281."""
        if self.fatigue_limit is not None:
            return self.fatigue_limit
        return iso281_2007.C_u(self.static_rating, self.elements.pitch_diameter * 1e3, self.contact)


def catalogue_bearing(designation: str) -> CatalogueBearing:
    """Bearing of the table by its designation, with or without the suffix of cage and make: ``NU 208``, ``nu208ecp``.

    Raises BearingError naming the nearest designations for one that is not in the table.
    """
    wanted = _key(designation)
    table = _table()
    if wanted in table:
        return table[wanted]
    basics = {_key(row.designation): row.designation for row in table.values()}
    letters = re.match(r"[A-Z]*", wanted)
    alike = [key for key in basics if letters and letters[0] and key.startswith(letters[0])]
    near = difflib.get_close_matches(wanted, basics, n=4, cutoff=0.5) or (alike or list(basics))[:4]
    raise BearingError(
        f"bearing designation = {designation!r}: not among the {len(basics)} tabled bearings (nearest: "
        f"{', '.join(basics[key] for key in near)}); take one of these or give the catalogue numbers of the bearing"
    )


def tabled_designations() -> tuple[str, ...]:
    """Designations of the table in its order."""
    return tuple(dict.fromkeys(row.designation for row in _table().values()))


def _key(designation: str) -> str:
    return re.sub(r"[\s\-]+", "", designation).upper()


@cache
def _table() -> Mapping[str, CatalogueBearing]:
    """The table by full and by basic designation."""
    found: dict[str, CatalogueBearing] = {}
    text = files("dynamics.rotor").joinpath(TABLE).read_text(encoding="utf-8")
    for row in csv.DictReader(text.splitlines()):
        bearing = _bearing(row)
        for name in (row["designation"], row["basic"]):
            found[_key(name)] = bearing
    return found


def _bearing(row: Mapping[str, str]) -> CatalogueBearing:
    def number(column: str, factor: float) -> float:
        return float(row[column]) * factor if row[column] else 0.0

    return CatalogueBearing(
        designation=row["designation"],
        kind=cast(BearingKind, row["kind"]),
        series=row["series"],
        bore=number("bore_mm", 1e-3),
        outside_diameter=number("outside_mm", 1e-3),
        width=number("width_mm", 1e-3),
        dynamic_rating=number("dynamic_kN", 1e3),
        static_rating=number("static_kN", 1e3),
        fatigue_limit=number("fatigue_kN", 1e3),
        limiting_speed=number("limiting_rpm", RPM),
        reference_speed=number("reference_rpm", RPM),
        contact_angle=math.radians(number("contact_angle_deg", 1.0)),
        axial_limit=number("e", 1.0),
        axial_factor=number("y", 1.0),
        static_axial_factor=number("y0", 1.0),
        f_0=number("f0", 1.0) or None,
        minimum_load_factor=number("k_r", 1.0),
        inner_raceway=number("inner_raceway_mm", 1e-3),
        outer_raceway=number("outer_raceway_mm", 1e-3),
        locating=row["locating"] == "1",
        source=row["source"],
        unconfirmed=tuple(row["unconfirmed"].split()),
    )
