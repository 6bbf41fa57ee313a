"""Sections of the report in the order an engineer reads them; the page and its contents follow from this list."""

from rigdesign.report.sections.clearances import CLEARANCES
from rigdesign.report.sections.ground import (
    ASSUMPTIONS,
    HAND_CHECKS,
    NOT_MODELLED,
    OVERRIDES,
    PROVENANCE,
    WARNINGS,
)
from rigdesign.report.sections.loads import LOADS
from rigdesign.report.sections.losses import LOSSES
from rigdesign.report.sections.ranges import RANGES
from rigdesign.report.sections.section import ReportSection
from rigdesign.report.sections.temperatures import TEMPERATURES
from rigdesign.report.sections.transient import TRANSIENT
from rigdesign.report.sections.verdict import DRIVERS, VERDICT
from rigdesign.report.sections.viewer import VIEWER

SECTIONS: tuple[ReportSection, ...] = (
    VERDICT,
    DRIVERS,
    LOADS,
    LOSSES,
    TEMPERATURES,
    VIEWER,
    CLEARANCES,
    TRANSIENT,
    ASSUMPTIONS,
    RANGES,
    OVERRIDES,
    HAND_CHECKS,
    NOT_MODELLED,
    WARNINGS,
    PROVENANCE,
)
