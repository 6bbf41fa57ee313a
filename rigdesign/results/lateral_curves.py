"""Whirl over speed as columns of a curve."""

from collections.abc import Mapping
from typing import Any

from rigdesign.results.curves import Columns


def lateral_curves(lateral: Mapping[str, Any] | None) -> dict[str, Columns]:
    """Orbit of every bearing over speed, by header; nothing for shafts that only twist."""
    if lateral is None:
        return {}
    curve = lateral["curve"]
    columns: Columns = {"speed [rpm]": curve["speed_rpm"]}
    for bearing in curve["bearings"]:
        columns[f"orbit {bearing['bearing']} [um]"] = bearing["orbit_um"]
    return {"whirl": columns}
