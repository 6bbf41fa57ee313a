"""Where a part sits on its shaft, from its coordinate on the shaft and from its place in the gear unit."""

from math import fsum

from rigdesign.rexs.attribute_log import AttributeLog
from rigdesign.rexs.gear_unit import Vector
from rigdesign.rexs.model import AttributeValueError, Component, RexsModel
from rigdesign.rexs.versions import before_1_1

SAME_PLACE = 1e-6
"""Difference of two statements of one position that is round-off [m]."""


def shaft_of(model: RexsModel, part: int) -> int | None:
    """Id of the shaft that a part is assembled on, None for none."""
    owners = model.related("assembly", "part", part, "assembly")
    return next((owner.id for owner in owners if owner.type == "shaft"), None)


def place_of(component: Component, log: AttributeLog, target: str) -> tuple[Vector | None, Vector | None]:
    """Origin [m] and unit vector of a component's axis in the coordinates it refers to; None where not stated."""
    origin = log.vector(component, "support_vector", "mm", f"{target}.origin")
    return origin, log.direction(component, "u_axis_vector", f"{target}.axis")


def gear_position(
    model: RexsModel, log: AttributeLog, gear: Component, face_width: float | None
) -> float | None:
    """Middle of the face of a gear from the start of its shaft [m].

    ``u_coordinate_on_shaft`` counts to the middle; files of REXS 1.0 have it to the start of the face. The place of the
    gear in the gear unit always is that of its middle, so that it decides where the two differ.
    """
    target = f"gears[{gear.id}].position"
    coordinate = log.number(gear, "u_coordinate_on_shaft", "mm", target)
    shaft = shaft_of(model, gear.id)
    middle = None if shaft is None else _along(model, log, gear, model.component(shaft), target)
    if middle is not None:
        if coordinate is not None and abs(middle - coordinate) > SAME_PLACE:
            reason = (
                f"not the middle of the face, which its place in the gear unit puts at {middle * 1e3:.6g} mm"
            )
            log.refuse(gear, "u_coordinate_on_shaft", reason)
        return middle
    if coordinate is not None and face_width is not None and before_1_1(model.version):
        return coordinate + 0.5 * face_width
    return coordinate


def _along(
    model: RexsModel, log: AttributeLog, part: Component, shaft: Component, target: str
) -> float | None:
    """Distance of a part from the start of its shaft along the axis, where both refer to the same coordinates."""
    frames = [_reference(component) for component in (part, shaft)]
    if frames[0] is None or frames[0] != frames[1] or not model.has(frames[0]):
        return None
    origin, axis = place_of(shaft, log, f"shafts[{shaft.id}]")
    place = log.vector(part, "support_vector", "mm", target)
    if origin is None or axis is None or place is None:
        return None
    return fsum((there - here) * along for there, here, along in zip(place, origin, axis, strict=True))


def _reference(component: Component) -> int | None:
    found = component.attribute("reference_component_for_position")
    try:
        return found.whole_number() if found else None
    except AttributeValueError:
        return None
