"""Sections of the shafts: those of the file where they fit the bearings, else a step where the bores differ."""

from collections.abc import Iterator

from rigdesign.rexs.gear_unit import ShaftSection, UnitBearing, UnitShaft
from rigdesign.rexs_case.bearing_choice import tabled_bearing
from rigdesign.rexs_case.entries import CaseTable, Entry, Origins, assumed, millimetres
from rigdesign.rexs_case.stage import SAME, GearStage, SeatedGear, diameter_at, mean_diameter

STUB = 2.5
"""Length from the rear bearing to the coupling, in diameters of the shaft, as by the defaults of a drivetrain."""


def shaft_tables(origins: Origins, stage: GearStage) -> Iterator[CaseTable]:
    """Both shafts of the stage in both gearboxes; none of them where the default, one diameter, will do."""
    for seated in stage.gears:
        entry = _sections(origins, seated)
        if entry is not None:
            yield CaseTable(f"drivetrain.shafts.test_{seated.name}", (entry,))
            reason = f"as test_{seated.name}, which has its gear and bearings at the same places"
            yield CaseTable(
                f"drivetrain.shafts.slave_{seated.name}", (assumed("sections", entry.value, reason),)
            )


def _sections(origins: Origins, seated: SeatedGear) -> Entry | None:
    position, shaft = seated.position, seated.shaft
    if position is None or shaft is None:
        return None
    front, rear = (seated.bearing_at(bearing) or 0.0 for bearing in seated.bearings)
    bores = [_bore(bearing) for bearing in seated.bearings]
    if bores[0] is None or bores[1] is None:
        return None
    if _connected(shaft) and all(
        abs((diameter_at(shaft, place) or 0.0) - bore) <= SAME
        for place, bore in ((front, bores[0]), (rear, bores[1]))
    ):
        first = f"shafts[{shaft.id}].sections[{shaft.sections[0].id}]"
        value = _written([(item.length, mean_diameter(item), _inner(item)) for item in shaft.sections])
        targets = [
            item for item in origins.under(f"shafts[{shaft.id}].sections") if not item.startswith(first)
        ]
        note = f"and {len(shaft.sections) - 1} further sections" if shaft.sections[1:] else ""
        return origins.stated("sections", value, *origins.under(first), *targets, note=note)
    between = front < position < rear
    if abs(bores[0] - bores[1]) <= SAME and between and not shaft.sections:
        return None
    step, place = (position, "at the gear") if between else (0.5 * (front + rear), "between them")
    end = max(rear + STUB * bores[1], shaft.length, position + 0.5 * (seated.gear.face_width or 0.0))
    value = _written([(step, bores[0], 0.0), (end - step, bores[1], 0.0)])
    cause = "the file has none"
    if shaft.sections:
        cause = "those of the file leave gaps or have other diameters in the bearings"
    return assumed("sections", value, f"as thick as in its bearings, stepped {place}: {cause}")


def _bore(bearing: UnitBearing) -> float | None:
    tabled = tabled_bearing(bearing) if bearing.kind == "rolling" else None
    return bearing.inner_diameter if tabled is None else tabled.bore


def _connected(shaft: UnitShaft) -> bool:
    """Whether the sections follow each other from the start of the shaft without a gap."""
    end = 0.0
    for section in shaft.sections:
        if (
            abs(section.start - end) > SAME
            or section.length <= 0.0
            or _inner(section) >= mean_diameter(section)
        ):
            return False
        end += section.length
    return bool(shaft.sections)


def _inner(section: ShaftSection) -> float:
    return 0.5 * (section.inner_begin + section.inner_end)


def _written(sections: list[tuple[float, float, float]]) -> str:
    """Sections as TOML: length, outside and inside diameter [m]."""
    written = []
    for length, outer, inner in sections:
        bore = f", inner_diameter = {millimetres(inner)}" if inner > 0.0 else ""
        written.append(f"{{ length = {millimetres(length)}, outer_diameter = {millimetres(outer)}{bore} }}")
    return f"[{', '.join(written)}]"
