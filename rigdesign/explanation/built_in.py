"""What the tool brings along: bearings, oils, materials, fluids, and the limits of a case with their defaults."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any, Literal, get_args

from rigdesign.base.errors import UsageError, shortened
from rigdesign.base.units import ZERO_CELSIUS
from rigdesign.case.defaults.rule import Given, RawTree
from rigdesign.case.defaults.runs import standard_limits
from rigdesign.checks.registry import PATH, REGISTRY
from rigdesign.explanation.keys import case_keys, starred
from rigdesign.properties.fluid import FluidError, volumetric_heat
from rigdesign.properties.materials import MATERIALS
from rigdesign.properties.oil import OILS

Kind = Literal["bearings", "oils", "materials", "fluids", "limits"]
KINDS: tuple[Kind, ...] = get_args(Kind)
Row = dict[str, Any]
"""Units stand in the keys; ``name`` is what a case writes, ``source`` where the numbers come from."""
EXAMPLE = {
    "gearboxes": {
        "rig": {
            "meshes": {"main": {"normal_module": "1 mm"}},
            "bearings": {"one": {"type": "journal", "diameter": "40 mm"}},
        }
    }
}
"""A case for which limits that grow with module or journal are shown."""
NOTES: Mapping[str, str] = {
    "bearings": "designation of a rolling bearing: gearboxes.NAME.bearings.NAME.designation; any other one by its "
    "numbers under catalogue",
    "oils": "gearboxes.NAME.oil.oil; any other one under oils.NAME",
    "materials": "material of gears, shafts and housings; any other one under materials.NAME",
    "fluids": "of coolants and of volumes and streams of a housing, by the name in CoolProp; density and heat capacity "
    "at 20 °C and 1.013 bar",
    "limits": "a limit that a case states is held; those with a default are filled in where the case has no table "
    "limits, or limits.standard_set = true. Those of module or journal are shown for 1 mm and 40 mm",
}


@dataclass(frozen=True, kw_only=True)
class BuiltIn:
    """One list: where a case uses its names, and its rows."""

    kind: Kind
    note: str
    rows: Sequence[Row]


def built_in(kind: Kind, words: Sequence[str] = ()) -> BuiltIn:
    """A list, or its rows that hold all ``words`` somewhere, whatever their case.

    Raises
    ------
    UsageError
        No row holds them; the nearest names are named.
    """
    rows = list(LISTS[kind]())
    wanted = [word.lower() for word in words]
    found = [row for row in rows if all(word in " ".join(map(str, row.values())).lower() for word in wanted)]
    if not found:
        text, names = " ".join(words), [str(row["name"]) for row in rows]
        near = get_close_matches(text, names, n=3, cutoff=0.4)
        hint = f"the nearest are {', '.join(near)}" if near else "leave the words out for all"
        raise UsageError(f"list {kind} {shortened(text)}: none of {len(rows)} has it; {hint}")
    return BuiltIn(kind=kind, note=NOTES[kind], rows=found)


def _bearings() -> Iterator[Row]:
    from dynamics.rotor.rolling_catalogue import catalogue_bearing, tabled_designations
    from dynamics.rotor.rolling_friction import RPM

    for designation in tabled_designations():
        bearing = catalogue_bearing(designation)
        unread = f"; not confirmed: {', '.join(bearing.unconfirmed)}" if bearing.unconfirmed else ""
        yield {
            "name": designation, "kind": bearing.kind.replace("_", " "), "bore_mm": 1e3 * bearing.bore,
            "outside_mm": 1e3 * bearing.outside_diameter, "width_mm": 1e3 * bearing.width,
            "dynamic_kN": 1e-3 * bearing.dynamic_rating, "static_kN": 1e-3 * bearing.static_rating,
            "reference_rpm": bearing.reference_speed / RPM, "limiting_rpm": bearing.limiting_speed / RPM,
            "source": bearing.source + unread,
        }  # fmt: skip


def _oils() -> Iterator[Row]:
    for name, oil in OILS.items():
        at_40, at_100 = (1e6 * oil.kinematic_viscosity(ZERO_CELSIUS + t) for t in (40.0, 100.0))
        yield {
            "name": name, "viscosity_40_mm2_s": at_40, "viscosity_100_mm2_s": at_100,
            "density_15_kg_m3": oil.density_15, "heat_capacity_40_J_kgK": oil.heat_capacity_40,
            "highest_degC": oil.highest_temperature - ZERO_CELSIUS, "scuffing_load_stage": oil.scuffing_load_stage,
            "source": f"{oil.source} (confidence {oil.confidence})",
        }  # fmt: skip


def _materials() -> Iterator[Row]:
    for name, item in MATERIALS.items():
        yield {
            "name": name, "modulus_GPa": 1e-9 * item.elastic_modulus, "density_kg_m3": item.density,
            "conductivity_W_mK": item.conductivity, "expansion_um_mK": 1e6 * item.expansion_coefficient,
            "root_strength_MPa": None if item.root_strength is None else 1e-6 * item.root_strength,
            "flank_strength_MPa": None if item.flank_strength is None else 1e-6 * item.flank_strength,
            "source": f"{item.title}: {item.source} (confidence {item.confidence})",
        }  # fmt: skip


def _fluids() -> Iterator[Row]:
    from CoolProp.CoolProp import get_global_param_string

    source = f"CoolProp {get_global_param_string('version')}"
    for name in sorted(get_global_param_string("FluidsList").split(","), key=str.lower):
        try:
            density, heat = volumetric_heat(name, ZERO_CELSIUS + 20.0)
        except FluidError:
            continue
        yield {"name": name, "density_kg_m3": density, "heat_capacity_J_kgK": heat, "source": source}


def _limits() -> Iterator[Row]:
    """Every key under ``limits`` but those of bought parts, with its check and what the standard set has for it."""
    checks: dict[str, list[str]] = {}
    for family in REGISTRY.families():
        for path in family.limit_keys or PATH.findall(family.source.partition(";")[0])[:1]:
            checks.setdefault(path, []).append(family.key)
    standard = standard_limits(RawTree(EXAMPLE))
    for entry in case_keys():
        path = starred(entry.path)
        table, _, key = path.removeprefix("limits.").rpartition(".")
        if not path.startswith("limits.") or entry.table or not table or table.startswith("bought_parts"):
            continue
        stated = standard.get(table, {}).get(key)
        default = stated if isinstance(stated, Given) else None
        span = (
            None if default is None or default.range is None else f"{default.range[0]} to {default.range[1]}"
        )
        yield {
            "name": path, "holds": f"{entry.kind} [{entry.units[0]}]" if entry.units else entry.kind,
            "default": entry.default if default is None else str(default.value), "range": span,
            "checks": checks.get(path, []), "filled_in": default is not None,
            "source": entry.description.partition(". ")[0].rstrip(".") if default is None else default.reason,
        }  # fmt: skip


LISTS: Mapping[Kind, Callable[[], Iterator[Row]]] = {
    "bearings": _bearings, "oils": _oils, "materials": _materials, "fluids": _fluids, "limits": _limits,
}  # fmt: skip
