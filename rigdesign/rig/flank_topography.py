"""Measured topographies of the gears of a case, held against their flanks."""

from collections.abc import Mapping

import numpy as np

from dynamics.errors import DynamicsInputError
from dynamics.flank.topography import Topography
from dynamics.gear.cylindrical_gear import CylindricalGear
from dynamics.gear.details import FlankEnds
from dynamics.gear.pair import GearPair
from rigdesign.base.errors import CaseError, Fault
from rigdesign.case.faults import written
from rigdesign.case.gears import Gear
from rigdesign.case.model import Case
from rigdesign.case.topography_file import TopographyGrid, read_topography

FlankTopographies = tuple[Topography | None, Topography | None]
"""Of the front and back flanks of a gear."""
NOT_MEASURED: FlankTopographies = (None, None)
KEYS = ("topography", "back_topography")


def flank_topographies(case: Case, pairs: Mapping[str, GearPair]) -> dict[str, FlankTopographies]:
    """Topographies by ``gearbox.gear`` of the gears that have any.

    Raises
    ------
    CaseError
        As `rigdesign.case.topography_file.read_topography`, and for a grid that does not cover the flank from form to
        tip circle and the whole face, or has the flanks of some teeth only.
    """
    found = {}
    for box_name, box in case.gearboxes.items():
        for mesh_name, mesh in box.meshes.items():
            pair = pairs[f"{box_name}.{mesh_name}"]
            for name, toothing, ends in zip((mesh.pinion, mesh.wheel), pair.gears, pair.flanks, strict=True):
                gear = box.gears[name]
                if gear.flank.topography is None and gear.flank.back_topography is None:
                    continue
                at = f"gearboxes.{box_name}.gears.{name}.flank"
                front, back = (_topography(case, gear, (toothing, ends), f"{at}.{key}") for key in KEYS)
                found[f"{box_name}.{name}"] = front, back
    return found


def _topography(
    case: Case, gear: Gear, flank: tuple[CylindricalGear, FlankEnds], at: str
) -> Topography | None:
    toothing, involute = flank
    name = getattr(gear.flank, at.rpartition(".")[2])
    if name is None:
        return None
    grid = read_topography(case.path.parent / name, at, case.path)
    if len(grid.removed) not in (1, gear.teeth):
        problem = f"has the flanks of {len(grid.removed)} teeth, the gear has {gear.teeth}"
        raise CaseError([Fault(at, written(name), problem, "give all teeth or one for all")], str(case.path))
    try:
        topography = Topography(
            roll_angle=_roll_angle(grid, toothing),
            face=np.array(grid.face),
            removed=np.array(grid.removed),
            interpolation=gear.flank.topography_interpolation,
        )
        ends = (toothing.roll_length(radius) for radius in (involute.form_radius, involute.tip_radius))
        root, tip = (roll / toothing.base_radius for roll in ends)
        topography.require_cover((root, tip), gear.face_width)
    except DynamicsInputError as error:
        problem, _, remedy = str(error).removeprefix("topography: ").rpartition("; ")
        raise CaseError([Fault(at, written(name), problem, remedy)], str(case.path)) from None
    return topography


def _roll_angle(
    grid: TopographyGrid, toothing: CylindricalGear
) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    places, base = np.array(grid.profile), toothing.base_radius
    if grid.coordinate == "roll_angle":
        return places
    if grid.coordinate == "roll_length":
        return places / base
    if places[0] < 2.0 * base:
        raise DynamicsInputError(
            f"diameter {1e3 * places[0]:.3f} mm is below the base diameter {2e3 * base:.3f} mm; "
            "remove places without involute"
        )
    return np.sqrt((0.5 * places / base) ** 2 - 1.0)
