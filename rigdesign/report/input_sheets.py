"""The data sheets of the report: gears, materials and oils as the case states them."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

from rigdesign.base.quantity_kinds import ZERO_CELSIUS
from rigdesign.base.units import QuantityError, parse
from rigdesign.properties.materials import MATERIALS
from rigdesign.properties.oil import OILS, Oil
from rigdesign.report.case_sheet import CaseSheet
from rigdesign.report.numbers import number_text, quantity_text, stated_text
from rigdesign.results.dynamics import GearboxDynamics
from rigdesign.results.result import RunResult

Row = tuple[str, list[str]]
"""Name of a quantity, and a cell for each column."""


@dataclass(frozen=True, kw_only=True)
class Sheet:
    """A table with a column for each part."""

    title: str
    columns: list[str]
    rows: list[Row]


def gear_sheets(result: RunResult) -> list[Sheet]:
    """One for each mesh: its gears side by side, as drawn and warm."""
    case = CaseSheet.of(result.inputs)
    meshes = [(b, box, m, mesh) for b, box in case.tables("gearboxes") for m, mesh in box.tables("meshes")]
    alone = {b: len(list(box.tables("meshes"))) == 1 for b, box, _, _ in meshes}
    sheets: list[Sheet] = []
    for name, box, own, mesh in meshes:
        label = name if alone[name] else f"{name}.{own}"
        dynamics = None if result.dynamics is None else result.dynamics.gearboxes.get(label)
        sheet = _gear_sheet(label, box, mesh, dynamics)
        like = next((number for number, other in enumerate(sheets) if other.rows == sheet.rows), None)
        if like is None:
            sheets.append(sheet)
        else:
            sheets[like] = _same(sheets[like], sheet)
    return sheets


def _same(first: Sheet, second: Sheet) -> Sheet:
    """Two gear pairs of the same data in one table."""
    title = f"{first.title}, {second.title.removeprefix(PAIR)}"
    columns = [a if a == b else f"{a}, {b}" for a, b in zip(first.columns, second.columns, strict=True)]
    return replace(first, title=title, columns=columns)


PAIR = "Gear pair "


def _gear_sheet(label: str, box: CaseSheet, mesh: CaseSheet, dynamics: GearboxDynamics | None) -> Sheet:
    gears = [mesh.raw("pinion"), mesh.raw("wheel")]
    tables = [box.table(f"gears.{gear}") for gear in gears]
    computed = {} if dynamics is None else dynamics.geometry

    def both(key: str) -> list[str]:
        return [table.value(key) for table in tables]

    def pair(key: str) -> list[str]:
        found = str(computed.get(key, ""))
        return [stated_text(value) for value in found.split(" / ")] if " / " in found else []

    def one(key: str, unit: str) -> str:
        value = computed.get(key)
        return quantity_text(float(value), unit) if isinstance(value, int | float) else ""

    def length(key: str) -> list[str]:
        return [f"{value} mm" for value in pair(key)]

    def warm(cold: str, hot: str) -> list[str]:
        return [f"{a} / {b} mm" for a, b in zip(pair(cold), pair(hot), strict=True)]

    given = str(computed.get("profile_shifts", ""))
    shifts = [number_text(float(value)) for value in given.split(" / ") if value]
    rows: list[Row] = [
        ("number of teeth z", both("teeth")),
        ("normal module mₙ", [mesh.value("normal_module")]),
        (
            "pressure angle αₙ, helix angle β",
            [f"{mesh.value('pressure_angle')}, {mesh.value('helix_angle')}"],
        ),
        ("profile shift coefficient x", shifts or both("profile_shift")),
        ("centre distance a, drawn / warm", [_drawn_warm(dynamics, mesh)]),
        ("face width b", both("face_width")),
        ("reference diameter d", length("reference_diameters_mm")),
        ("tip diameter dₐ, drawn / warm", warm("tip_diameters_cold_mm", "tip_diameters_hot_mm")),
        ("root diameter d_f", length("root_diameters_mm")),
        (
            "contact ratio ε_α, drawn / warm",
            [_joined(one("transverse_contact_ratio", ""), one("transverse_contact_ratio_hot", ""))],
        ),
        ("mean mesh stiffness", [one("mean_mesh_stiffness_N_um", "N_um")]),
        ("quality grade", both("quality_grade")),
        (
            "profile, lead crowning",
            [f"{t.value('flank.profile_crowning')}, {t.value('flank.lead_crowning')}" for t in tables],
        ),
        ("flank roughness Ra", both("flank_roughness")),
        ("material", [table.raw("material").replace("_", " ") or "–" for table in tables]),
    ]
    return Sheet(
        title=f"{PAIR}{label}",
        columns=[gear.replace("_", " ") for gear in gears],
        rows=[(title, cells) for title, cells in rows if any(cell.strip("– /,") for cell in cells)],
    )


def _drawn_warm(dynamics: GearboxDynamics | None, mesh: CaseSheet) -> str:
    warm = None if dynamics is None else dynamics.geometry.get("centre_distance_hot_mm")
    drawn = mesh.value("centre_distance")
    return f"{drawn.removesuffix(' mm')} / {warm:.3f} mm" if isinstance(warm, float) else drawn


def _joined(first: str, second: str) -> str:
    return f"{first} / {second}" if second else first


def oil_sheet(result: RunResult) -> Sheet | None:
    """Every oil circuit with the oil at its inlet."""
    case = CaseSheet.of(result.inputs)
    circuits = list(_circuits(case))
    if not circuits:
        return None
    cells = [_oil_cells(case, circuit) for _, circuit in circuits]
    rows = [(name, [column[number] for column in cells]) for number, name in enumerate(OIL_ROWS)]
    rows = [(name, row) for name, row in rows if set(row) != {"–"}]
    return Sheet(title="Oil", columns=[name for name, _ in circuits], rows=rows)


OIL_ROWS = (
    "oil", "kinematic viscosity at 40 °C", "kinematic viscosity at 100 °C", "temperature of inlet or sump",
    "viscosity there", "density there", "flow", "jet velocity", "level above the shafts", "oil in the sump",
)  # fmt: skip


def _circuits(case: CaseSheet) -> Iterator[tuple[str, CaseSheet]]:
    for name, box in case.tables("gearboxes"):
        for key, words in (("oil", "gear oil"), ("bearing_oil", "bearing oil")):
            if box.table(key).entries:
                yield f"{name}: {words}", box.table(key)


def _oil_cells(case: CaseSheet, circuit: CaseSheet) -> list[str]:
    oil = _oil(case, circuit.raw("oil"))
    held = "sump_temperature" if circuit.raw("sump_temperature") else "inlet_temperature"
    inlet = stated_number(circuit.raw(held), "temperature")
    viscosities = ["–"] * 4
    if oil is not None:
        at = [ZERO_CELSIUS + 40.0, ZERO_CELSIUS + 100.0, *([] if inlet is None else [inlet])]
        found = [f"{number_text(1e6 * oil.kinematic_viscosity(kelvin), 3)} mm²/s" for kelvin in at]
        viscosities[: len(found)] = found
        if inlet is not None:
            viscosities[3] = f"{number_text(oil.density(inlet), 3)} kg/m³"
    forty, hundred, warm, density = viscosities
    others = [circuit.value(key) for key in ("flow", "jet_velocity", "level", "volume")]
    return [circuit.raw("oil"), forty, hundred, circuit.value(held), warm, density, *others]


def stated_number(text: str, kind: str) -> float | None:
    """A value of the case in SI; None where it is left out."""
    try:
        return parse(text, kind)
    except QuantityError:
        return None


def _oil(case: CaseSheet, name: str) -> Oil | None:
    """A built-in oil, or the case's own by its two viscosities."""
    if name in OILS:
        return OILS[name]
    own = case.table(f"oils.{name}")
    first = stated_number(own.raw("kinematic_viscosity_40"), "kinematic_viscosity")
    second = stated_number(own.raw("kinematic_viscosity_100"), "kinematic_viscosity")
    density = stated_number(own.raw("density_15"), "density")
    if first is None or second is None or density is None:
        return None
    return Oil.from_viscosities(
        name=name, viscosity_1=first, temperature_1=ZERO_CELSIUS + 40.0, viscosity_2=second,
        temperature_2=ZERO_CELSIUS + 100.0, density_15=density, heat_capacity=1950.0,
    )  # fmt: skip


def material_sheet(result: RunResult) -> Sheet | None:
    """Every material the case names, built in or its own."""
    case = CaseSheet.of(result.inputs)
    named = [row.value for row in result.inputs if row.path.split(".")[-1] == "material"]
    names = list(dict.fromkeys([*(name for name, _ in case.tables("materials")), *named]))
    if not names:
        return None
    cells = [_material_cells(case, name) for name in names]
    rows = [(title, [column[number] for column in cells]) for number, title in enumerate(MATERIAL_ROWS)]
    return Sheet(title="Materials", columns=[name.replace("_", " ") for name in names], rows=rows)


MATERIAL_ROWS = (
    "title", "elastic modulus", "Poisson's ratio", "density", "thermal conductivity", "expansion coefficient",
    "root strength σ_FE", "tempering temperature",
)  # fmt: skip


def _material_cells(case: CaseSheet, name: str) -> list[str]:
    own = case.table(f"materials.{name}")
    if own.entries:
        keys = (
            "elastic_modulus", "poisson_ratio", "density", "conductivity", "expansion_coefficient", "root_strength",
            "tempering_temperature",
        )  # fmt: skip
        return [own.raw("title", name), *(own.value(key) for key in keys)]
    if name not in MATERIALS:
        return [name, *["–"] * (len(MATERIAL_ROWS) - 1)]
    steel = MATERIALS[name]
    tempering = steel.tempering_temperature
    return [
        steel.title,
        f"{number_text(1e-9 * steel.elastic_modulus)} GPa",
        number_text(steel.poisson_ratio),
        f"{number_text(steel.density)} kg/m³",
        f"{number_text(steel.conductivity)} W/(m K)",
        f"{number_text(1e6 * steel.expansion_coefficient)} µm/(m K)",
        "–" if steel.root_strength is None else f"{number_text(1e-6 * steel.root_strength)} N/mm²",
        "–" if tempering is None else f"{number_text(tempering - ZERO_CELSIUS)} °C",
    ]
