"""The data sheets of the drivetrain as the case states it: shafts with their discs, joints, bearings."""

from rigdesign.report.case_sheet import CaseSheet
from rigdesign.report.input_sheets import Row, Sheet, stated_number
from rigdesign.report.numbers import number_text
from rigdesign.results.result import RunResult


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
