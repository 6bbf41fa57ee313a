"""Sections of the report in the order an engineer reads them; the page and its contents follow from this list."""

from rigdesign.report.sections.checks import CHECK_BASIS, CHECKS, DECISION, DRIVERS, RANGE_DETAILS, RANGES
from rigdesign.report.sections.inputs import (
    ALL_ASSUMPTIONS,
    ASSUMPTIONS,
    DRIVETRAIN_INPUTS,
    HAND_CHECKS,
    INPUTS,
    NOT_MODELLED,
    OVERRIDES,
    PROVENANCE,
    WARNINGS,
)
from rigdesign.report.sections.loads import LOAD_DETAILS, LOADS
from rigdesign.report.sections.losses import LOSS_DETAILS, LOSSES, OIL_CIRCUITS, RIG_HEAT
from rigdesign.report.sections.section import ReportSection
from rigdesign.report.sections.shafts import LATERAL, ROLLING_BEARINGS
from rigdesign.report.sections.temperatures import (
    CLEARANCE_DETAILS,
    CLEARANCES,
    TEMPERATURE_DETAILS,
    TEMPERATURES,
    VIEWER,
)
from rigdesign.report.sections.transient import EVENTS, TRANSIENT
from rigdesign.report.sections.vibration import VIBRATION, VIBRATION_DETAILS

SECTIONS: tuple[ReportSection, ...] = (
    DECISION,
    CHECKS,
    DRIVERS,
    RANGES,
    LOADS,
    VIBRATION,
    LATERAL,
    EVENTS,
    LOSSES,
    OIL_CIRCUITS,
    RIG_HEAT,
    ROLLING_BEARINGS,
    TEMPERATURES,
    VIEWER,
    CLEARANCES,
    INPUTS,
    ASSUMPTIONS,
    OVERRIDES,
    NOT_MODELLED,
    CHECK_BASIS,
    ALL_ASSUMPTIONS,
    RANGE_DETAILS,
    DRIVETRAIN_INPUTS,
    LOAD_DETAILS,
    VIBRATION_DETAILS,
    LOSS_DETAILS,
    TEMPERATURE_DETAILS,
    CLEARANCE_DETAILS,
    TRANSIENT,
    HAND_CHECKS,
    WARNINGS,
    PROVENANCE,
)
