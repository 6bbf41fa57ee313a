"""Sections of the report in the order an engineer reads them; the page and its contents follow from this list."""

from rigdesign.report.sections.assumptions import ALL_ASSUMPTIONS, ASSUMPTIONS, OVERRIDES
from rigdesign.report.sections.checks import CHECK_BASIS, CHECKS, DRIVERS
from rigdesign.report.sections.clearances import CLEARANCE_DETAILS, CLEARANCES
from rigdesign.report.sections.decision import DECISION
from rigdesign.report.sections.events import EVENTS
from rigdesign.report.sections.ground import HAND_CHECKS, NOT_MODELLED, PROVENANCE, WARNINGS
from rigdesign.report.sections.inputs import DRIVETRAIN_INPUTS, INPUTS
from rigdesign.report.sections.lateral import LATERAL
from rigdesign.report.sections.loads import LOAD_DETAILS, LOADS
from rigdesign.report.sections.losses import LOSS_DETAILS, LOSSES
from rigdesign.report.sections.oil_circuits import OIL_CIRCUITS
from rigdesign.report.sections.ranges import RANGE_DETAILS, RANGES
from rigdesign.report.sections.rig_heat import RIG_HEAT
from rigdesign.report.sections.rolling_bearings import ROLLING_BEARINGS
from rigdesign.report.sections.section import ReportSection
from rigdesign.report.sections.temperatures import TEMPERATURE_DETAILS, TEMPERATURES
from rigdesign.report.sections.transient import TRANSIENT
from rigdesign.report.sections.vibration import VIBRATION, VIBRATION_DETAILS
from rigdesign.report.sections.viewer import VIEWER

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
