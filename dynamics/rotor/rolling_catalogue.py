"""Tabled rolling bearings by their designation.

The table `rolling_bearings.csv` lies next to this module; each row names catalogue and page of its numbers, and a
column `unconfirmed` the names of those that could not be read there.
"""

import csv
import difflib
import math
import re
from collections.abc import Mapping
from functools import cache
from importlib.resources import files

from dynamics.rotor.bearing import BearingError
from dynamics.rotor.rolling_friction import RPM
from dynamics.rotor.rolling_kinds import CatalogueBearing

TABLE = "rolling_bearings.csv"


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
        kind=row["kind"],
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
