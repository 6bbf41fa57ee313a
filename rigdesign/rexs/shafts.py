"""Shafts and their sections."""

from rigdesign.rexs.attribute_log import AttributeLog
from rigdesign.rexs.gear_unit import ShaftSection, UnitShaft
from rigdesign.rexs.model import Component, RexsModel
from rigdesign.rexs.positions import place_of


def read_shafts(model: RexsModel, log: AttributeLog) -> tuple[UnitShaft, ...]:
    """Shafts in the order of the file, each with its sections by their start."""
    return tuple(_shaft(model, log, component) for component in model.of_type("shaft"))


def _shaft(model: RexsModel, log: AttributeLog, component: Component) -> UnitShaft:
    here = f"shafts[{component.id}]"
    parts = [
        part
        for relation in ("assembly", "ordered_assembly")
        for part in model.related(relation, "assembly", component.id, "part")
        if part.type == "shaft_section"
    ]
    only = len(parts) == 1
    sections = [section for part in parts if (section := _section(log, part, here, only)) is not None]
    origin, axis = place_of(component, log, here)
    return UnitShaft(
        id=component.id,
        name=component.name,
        sections=tuple(sorted(sections, key=lambda section: section.start)),
        origin=origin,
        axis=axis,
    )


def _section(log: AttributeLog, part: Component, shaft: str, only: bool) -> ShaftSection | None:
    """A section; None, with all its attributes listed, without a length and an outer diameter."""
    here = f"{shaft}.sections[{part.id}]"
    stated = log.number(part, "u_coordinate_on_shaft", "mm", f"{here}.start")
    start = 0.0 if stated is None and only else stated
    length = log.number(part, "length", "mm", f"{here}.length", above=0.0)
    begin = log.number(part, "outer_diameter_begin", "mm", f"{here}.outer_begin", above=0.0)
    end = log.number(part, "outer_diameter_end", "mm", f"{here}.outer_end", above=0.0)
    inner_begin = log.number(part, "inner_diameter_begin", "mm", f"{here}.inner_begin") or 0.0
    inner_end = log.number(part, "inner_diameter_end", "mm", f"{here}.inner_end")
    begin, end = begin or end, end or begin
    inner_end = inner_begin if inner_end is None else inner_end
    problem = ""
    if start is None or length is None or begin is None or end is None:
        problem = "a section without start, length or outer diameter"
    elif inner_begin >= begin or inner_end >= end:
        problem = "a section whose bore is not inside its outside"
    if problem or start is None or length is None or begin is None or end is None:
        for attribute in part.attributes:
            log.refuse(part, attribute.id, problem)
        return None
    bores = max(inner_begin, 0.0), max(inner_end, 0.0)
    return ShaftSection(part.id, start, length, begin, end, *bores)
