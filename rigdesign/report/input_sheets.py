"""The data sheets of the report: gears, materials and oils as the case states them."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import date
from typing import Any

from rigdesign.base.units import ZERO_CELSIUS, QuantityError, parse
from rigdesign.case.assumptions import AssumptionRecord
from rigdesign.case.provenance import InputRow
from rigdesign.properties.materials import MATERIALS
from rigdesign.properties.oil import OILS, Oil
from rigdesign.report.numbers import number_text, quantity_text, stated_text
from rigdesign.results.check import Check
from rigdesign.results.dynamics import GearboxDynamics
from rigdesign.results.result import RunResult

# The stated values of a case as a tree again: what the input sheets and the drawing of the rig read.


@dataclass(frozen=True)
class CaseSheet:
    """A table of the case by key: a table again, or a row with value and basis."""

    entries: Mapping[str, Any]

    @classmethod
    def of(cls, rows: Sequence[InputRow]) -> "CaseSheet":
        """The tree of ``RunResult.inputs``."""
        tree: dict[str, Any] = {}
        for row in rows:
            *tables, key = row.path.split(".")
            node = tree
            for table in tables:
                node = node.setdefault(table, {})
            node[key] = row
        return cls(tree)

    def table(self, path: str) -> "CaseSheet":
        """The table at a dotted path; an empty one where the case has none."""
        node: Any = self.entries
        for key in path.split("."):
            node = node.get(key, {}) if isinstance(node, Mapping) else {}
        return CaseSheet(node if isinstance(node, Mapping) else {})

    def tables(self, path: str) -> Iterator[tuple[str, "CaseSheet"]]:
        """Name and content of every table in the table at a path."""
        for name, node in self.table(path).entries.items():
            if isinstance(node, Mapping):
                yield name, CaseSheet(node)

    def raw(self, path: str, absent: str = "") -> str:
        """A value as the case writes it."""
        parent, _, key = path.rpartition(".")
        row = (self.table(parent) if parent else self).entries.get(key)
        return row.value if isinstance(row, InputRow) else absent

    def value(self, path: str, absent: str = "–") -> str:
        """A value as it reads in a report."""
        found = self.raw(path)
        return stated_text(found) if found else absent


# What makes a printed report a document: who prepared it, for what, and when it was issued.


@dataclass(frozen=True, kw_only=True)
class Issue:
    """One issue of a report.

    date : the one thing of the page that differs between two runs of one case, apart from computing times
    author : in place of ``document.author`` of the case
    """

    date: date = field(default_factory=date.today)
    author: str = ""


@dataclass(frozen=True, kw_only=True)
class Signatures:
    """What stands in and above the block of signatures; empty where the case says nothing."""

    project: str
    number: str
    prepared: str
    checked: str
    approved: str


def signatures(result: RunResult, issue: Issue) -> Signatures:
    """From the table ``document`` of the case."""
    document = CaseSheet.of(result.inputs).table("document")
    return Signatures(
        project=document.raw("project"),
        number=document.raw("number"),
        prepared=issue.author or document.raw("author"),
        checked=document.raw("checked_by"),
        approved=document.raw("approved_by"),
    )


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


# The data sheets of the drivetrain as the case states it: shafts with their discs, joints, bearings.


def shaft_sheet(result: RunResult) -> Sheet | None:
    """Shafts of the drivetrain: length, diameters, discs."""
    case = CaseSheet.of(result.inputs)
    shafts = list(case.tables("drivetrain.shafts"))
    if not shafts:
        return None
    rows = [(name.replace("_", " "), _shaft_cells(shaft)) for name, shaft in shafts]
    return Sheet(title="Shafts", columns=["length", "outer diameters", "discs", "material"], rows=rows)


def _shaft_cells(shaft: CaseSheet) -> list[str]:
    sections = [section for _, section in shaft.tables("sections")]
    lengths = [stated_number(section.raw("length"), "length") for section in sections]
    total = sum(length for length in lengths if length is not None)
    diameters = [section.value("outer_diameter").removesuffix(" mm") for section in sections]
    discs = [
        f"{name.replace('_', ' ')} {_together(disc, 'inertia', 'mass', 'diametral_inertia')}"
        for name, disc in shaft.tables("discs")
    ]
    return [
        f"{number_text(1e3 * total)} mm",
        f"{', '.join(diameters)} mm",
        ", ".join(discs) or "–",
        shaft.raw("material").replace("_", " "),
    ]


def _together(part: CaseSheet, *keys: str) -> str:
    """Those of the values that the case states."""
    return ", ".join(part.value(key) for key in keys if part.raw(key)) or "–"


def bearing_sheet(result: RunResult) -> Sheet | None:
    """What the case states of the bearings as springs under shafts that bend; None where it leaves all to the run."""
    case = CaseSheet.of(result.inputs)
    power = case.table("drivetrain")
    if not power.entries or power.raw("shaft_model") == "torsional":
        return None
    radial = power.raw("bearing_coefficients") == "stated"
    rows: list[Row] = [
        (
            f"{box_name}.{name}",
            [
                bearing.raw("shaft").replace("_", " "),
                _together(bearing, "radial_stiffness", "radial_damping") if radial else "computed",
                bearing.value("axial_stiffness"),
                _together(bearing, "support_stiffness", "support_damping", "support_mass"),
            ],
        )
        for box_name, box in case.tables("gearboxes")
        for name, bearing in box.tables("bearings")
    ]
    if not radial and all(cells[2:] == ["–", "–"] for _, cells in rows):
        return None
    columns = ["on", "radial stiffness, damping", "axial stiffness", "support"]
    return Sheet(title="Bearings under the shafts", columns=columns, rows=rows)


def joint_sheet(result: RunResult) -> Sheet | None:
    """Couplings, splines and motor: stiffness, damping, inertia."""
    case = CaseSheet.of(result.inputs)
    rows: list[Row] = [
        (
            f"coupling {name.replace('_', ' ')}",
            [
                coupling.raw("shafts").replace("_", " "),
                coupling.value("torsional_stiffness"),
                coupling.value("torsional_damping"),
                "–",
                _together(coupling, "radial_stiffness", "axial_stiffness", "angular_stiffness"),
            ],
        )
        for name, coupling in case.tables("drivetrain.couplings")
    ]
    for box_name, box in case.tables("gearboxes"):
        for name, gear in box.tables("gears"):
            spline = gear.table("spline")
            cells = [
                gear.raw("shaft").replace("_", " "),
                spline.value("torsional_stiffness"),
                f"loss factor {spline.value('loss_factor')}"
                if float(spline.raw("loss_factor") or 0.0)
                else spline.value("torsional_damping"),
                gear.value("inertia"),
                "–",
            ]
            rows.append((f"gear {box_name}.{name}", cells))
    motor = case.table("drivetrain.motor")
    if motor.entries:
        limit = f"torque limit {motor.value('torque_limit')}"
        rows.append(
            (f"motor, {limit}", [motor.raw("shaft").replace("_", " "), "–", "–", motor.value("inertia"), "–"])
        )
    columns = [
        "on",
        "torsional stiffness",
        "torsional damping",
        "inertia",
        "radial, axial, angular stiffness",
    ]
    return Sheet(title="Couplings, splines, motor", columns=columns, rows=rows) if rows else None


# Assumed inputs by part of the rig: by what they do to the governing margins where that is known, else by name.

NEAR = 0.1
"""Distance from which a check counts as near its limit."""


@dataclass(frozen=True, kw_only=True)
class AssumptionLine:
    """One assumption, or several that say the same of like parts.

    path : relative to its group, names of like parts in braces
    moved : largest shift of the distance of a governing check over its range; None where it was not evaluated
    """

    path: str
    value: str
    range: str
    reason: str
    moved: float | None
    count: int = 1

    @property
    def order(self) -> tuple[float, str]:
        """To sort by: what it moves, then its path."""
        return -(self.moved or 0.0), self.path


def assumption_groups(result: RunResult) -> dict[str, list[AssumptionLine]]:
    """Lines by part of the rig; groups and lines by what they move, without ranges by name."""
    moved = _moved(result)
    groups: dict[str, list[tuple[str, AssumptionRecord]]] = {}
    for record in result.assumptions:
        group, rest = _split(record.path)
        groups.setdefault(group, []).append((rest, record))
    lined = {group: _lines(records, moved) for group, records in groups.items()}
    return dict(sorted(lined.items(), key=lambda item: (item[1][0].order[0], item[0])))


def most_influential(result: RunResult, number: int) -> list[AssumptionLine]:
    """Those that move a governing margin most, with full paths; none where no range was evaluated."""
    lines = _lines([(record.path, record) for record in result.assumptions], _moved(result))
    return [line for line in lines if line.moved][:number]


def governing_ids(checks: Sequence[Check]) -> set[str]:
    """Checks that fail; without one those with less than `NEAR` of their limit left, else the nearest to it."""
    predicted = [check for check in checks if not check.by_definition]
    left = {check.id: check.distance for check in predicted if check.distance is not None}
    failing = {check.id for check in checks if check.status == "fail"}
    near = {identity for identity, distance in left.items() if distance < NEAR}
    return failing or near or ({min(left, key=lambda identity: left[identity])} if left else set())


def _moved(result: RunResult) -> dict[str, float]:
    """Largest shift of the distance of a governing check by path; every range that was evaluated has one."""
    ranges = result.ranges
    if ranges is None:
        return {}
    governing = governing_ids(result.checks)
    stated = {row.check: row.distance or 0.0 for row in ranges.checks if row.check in governing}
    found = {entry.path: 0.0 for entry in ranges.inputs}
    for row in ranges.margins:
        if row.check in stated:
            ends = (end for end in (row.distance_low, row.distance_high) if end is not None)
            shift = max((abs(end - stated[row.check]) for end in ends), default=0.0)
            found[row.path] = max(found.get(row.path, 0.0), shift)
    return found


def _split(path: str) -> tuple[str, str]:
    """Part of the rig and the rest: ``gearboxes.test.gears.pinion.teeth`` -> (``test: gears``, ``pinion.teeth``)."""
    parts = path.split(".")
    if parts[0] == "gearboxes" and len(parts) > 3:
        return f"{parts[1]}: {parts[2].replace('_', ' ')}", ".".join(parts[3:])
    depth = 2 if parts[0] == "drivetrain" and len(parts) > 2 else 1
    return ": ".join(part.replace("_", " ") for part in parts[:depth]), ".".join(parts[depth:]) or path


def _lines(
    records: Iterable[tuple[str, AssumptionRecord]], moved: Mapping[str, float]
) -> list[AssumptionLine]:
    """Records that say the same of like parts as one line, in their order."""
    alike: dict[tuple[object, ...], list[tuple[str, AssumptionRecord]]] = {}
    for rest, record in records:
        parts = rest.split(".")
        key = (
            len(parts),
            parts[0] if len(parts) > 3 else "",
            parts[-1],
            record.value,
            record.reason,
            record.range,
        )
        alike.setdefault(key, []).append((rest, record))
    return sorted((_line(same, moved) for same in alike.values()), key=lambda line: line.order)


def _line(same: Sequence[tuple[str, AssumptionRecord]], moved: Mapping[str, float]) -> AssumptionLine:
    first = same[0][1]
    shifts = [moved[record.path] for _, record in same if record.path in moved]
    return AssumptionLine(
        path=in_braces([rest for rest, _ in same]),
        value=stated_text(first.value),
        range="" if first.range is None else stated_text(f"{first.range[0]} to {first.range[1]}"),
        reason=first.reason,
        moved=max(shifts) if shifts else None,
        count=len(same),
    )


def in_braces(paths: Sequence[str]) -> str:
    """``a.x.k`` and ``a.y.k`` -> ``a.{x,y}.k``; paths of one length."""
    columns = zip(*(path.split(".") for path in paths), strict=True)
    names = (list(dict.fromkeys(column)) for column in columns)
    return ".".join(found[0] if len(found) == 1 else "{" + ",".join(found) + "}" for found in names)
