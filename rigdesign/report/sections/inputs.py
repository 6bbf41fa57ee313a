"""The inputs echoed: gears, materials, oil, shafts, joints and bearings."""

from rigdesign.report import drivetrain_sheets, input_sheets
from rigdesign.report.sections.section import Draw, ReportSection, Values
from rigdesign.results.result import RunResult


def _inputs(result: RunResult, draw: Draw) -> Values:
    return {"gears": input_sheets.gear_sheets(result), "oil": input_sheets.oil_sheet(result)}


def _drivetrain(result: RunResult, draw: Draw) -> Values:
    sheets = (
        input_sheets.material_sheet(result),
        drivetrain_sheets.shaft_sheet(result),
        drivetrain_sheets.joint_sheet(result),
        drivetrain_sheets.bearing_sheet(result),
    )
    return {"sheets": [sheet for sheet in sheets if sheet is not None]}


def _stated(result: RunResult) -> bool:
    return bool(result.inputs)


INPUTS = ReportSection(
    id="inputs", title="Gears and oil", template="inputs.html.j2", values=_inputs, applies=_stated
)
DRIVETRAIN_INPUTS = ReportSection(
    id="drivetrain", title="Materials and drivetrain", template="sheets.html.j2", values=_drivetrain, applies=_stated,
    place="appendix",
)  # fmt: skip
